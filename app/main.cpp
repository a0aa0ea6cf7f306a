#include "app/commands.h"
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <new>

#include "montelux/mc/math/error.h"

int main(int argc, char** argv) {
    using namespace montelux::app;
    int exit_code = exit_done;
    try {
        CLI::App app("Montelux: Monte Carlo integration and light transport", "montelux");
        app.set_version_flag("--version", "montelux " MONTELUX_VERSION);
        app.require_subcommand(1);
        app.footer("Exit codes: 0 done, 1 could not do it, 2 wrong usage, 130 interrupted (what there was is "
                   "saved).");
        add_render(app, exit_code);
        add_compare(app, exit_code);
        add_info(app, exit_code);
        try {
            app.parse(argc, argv);
        } catch (const CLI::ParseError& e) {
            // Asking for help or the version is no mistake.
            return app.exit(e) == 0 ? exit_done : exit_usage;
        }
        // A full disk behind a redirection is a failure too.
        if (std::fflush(stdout) != 0) throw montelux::Error("standard output", "cannot be written");
    } catch (const montelux::Error& e) {
        std::fprintf(stderr, "montelux: error: %s\n", e.what());
        return exit_failed;
    } catch (const std::bad_alloc&) {
        std::fprintf(stderr, "montelux: error: there is not enough memory\n");
        return exit_failed;
    } catch (const std::exception& e) {
        std::fprintf(stderr, "montelux: error: %s\n", e.what());
        return exit_failed;
    }
    return exit_code;
}
