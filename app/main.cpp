#include "app/commands.h"
#include "app/completion.h"
#include "app/integrate/integrate_options.h"
#include "app/joined.h"
#include "app/usage_error.h"
#include "app/version_text.h"
#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <exception>
#include <fcntl.h>
#include <new>
#include <span>
#include <string>
#include <string_view>
#include <unistd.h>
#include <utility>
#include <vector>
#ifdef MONTELUX_WITH_RENDER
#include "app/cluster_job.h"
#endif

#include "montelux/mc/math/error.h"
#include "montelux/mc/math/nearest_name.h"

namespace {

using namespace montelux::app;

// A file that is opened while a standard stream is closed would get its number, and messages inside it.
void occupy_standard_streams() {
    int fd = 0;
    do fd = ::open("/dev/null", O_RDONLY);
    while (fd >= 0 && fd <= STDERR_FILENO);
    if (fd >= 0) ::close(fd);
}

#ifdef MONTELUX_WITH_RENDER
bool can_be_shared(std::string_view command) { return command == "render" || command == "integrate"; }
#endif

// Prints the error. Only rank 0 of a job prints, so the others wait for it to end first.
int give_up(const std::string& message, int exit_code) {
    std::fprintf(stderr, "montelux: error: %s\n", message.c_str());
#ifdef MONTELUX_WITH_RENDER
    if (is_silent_rank()) wait_for_rank_0(message);
#endif
    return exit_code;
}

// Why the word after `command`, or nothing, is none of its subcommands.
std::string command_wanted(const CLI::App& command, std::string_view word) {
    std::vector<std::string_view> names;
    for (const CLI::App* sub : command.get_subcommands({})) names.push_back(sub->get_name());
    const std::string known = joined(names), of = command.get_parent() ? command.get_name() + " " : "";
    if (word.empty()) return "a " + of + "command is expected: " + known;
    if (word.starts_with('-'))
        return "there is no option '" + std::string(word) + "' without a " + of +
               "command; expected one of " + known;
    return "there is no " + of + "command '" + std::string(word) + "'" + montelux::did_you_mean(word, names) +
           "; expected one of " + known;
}

// What is left over: the first option that the command does not know, else the first word. An option comes
// before what would have been its value.
std::string not_expected(const CLI::App& command, const std::vector<std::string>& left, std::string message) {
    std::vector<std::string> known;
    for (const CLI::Option* option : command.get_options())
        for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
    const std::vector<std::string_view> names(known.begin(), known.end());
    for (const std::string& word : left)
        if (word.size() > 1 && word[0] == '-') {
            const std::string name = word.substr(0, word.find('='));
            return "there is no option '" + name + "'" + montelux::did_you_mean(name, names);
        }
    return left.empty() ? std::move(message) : "'" + left.front() + "' is not expected";
}

// A mistake of the command line in the program's own style.
int report_usage(const CLI::App& app, const CLI::ParseError& e, int argc, char** argv) {
    std::string line = "montelux", message = e.what();
    const CLI::App* command = &app;
    int words = 1;
    for (; !command->get_subcommands().empty(); ++words) {
        command = command->get_subcommands().front();
        line += " " + command->get_name();
    }
    if (!command->get_subcommands({}).empty())
        message = command_wanted(*command, words < argc ? argv[words] : "");
    else if (dynamic_cast<const CLI::ExtrasError*>(&e) != nullptr)
        message = not_expected(*command, command->remaining(), std::move(message));
    return give_up(message + "\nRun '" + line + " --help' for its options.", exit_usage);
}

void parse(CLI::App& app, int argc, char** argv) {
    const std::string_view command = argc < 2 ? "" : argv[1];
    if (command != "integrate" && command != "sample") return app.parse(argc, argv);
    std::vector<std::string> words =
        with_negative_formulas(*app.get_subcommand(std::string(command)), {argv + 2, argv + argc});
    words.insert(words.begin(), argv[1]);
    app.parse(std::vector<std::string>(words.rbegin(), words.rend())); // the last one first
}

int run(int argc, char** argv) {
    occupy_standard_streams();
#ifdef MONTELUX_WITH_RENDER
    silence_other_ranks();
    // What cannot be shared is done once.
    if (is_silent_rank() && (argc < 2 || !can_be_shared(argv[1]))) return exit_done;
#endif
    // Writing beyond a limit on the size of files is to fail with a sentence, not to end the program.
    std::signal(SIGXFSZ, SIG_IGN);
    int exit_code = exit_done;
    try {
        CLI::App app("Montelux: Monte Carlo integration and light transport", "montelux");
        app.set_version_flag("--version", version_text);
        app.require_subcommand(1);
        add_integrate(app, exit_code);
        add_sample(app, exit_code);
#ifdef MONTELUX_WITH_RENDER
        add_render(app, exit_code);
        add_view(app, exit_code);
        add_merge(app, exit_code);
        add_compare(app, exit_code);
        add_denoise(app, exit_code);
        add_bake(app, exit_code);
        add_convert(app, exit_code);
        add_info(app, exit_code);
        add_formats(app, exit_code);
#endif
        add_completion(app, exit_code);
        add_manual(app, exit_code);
        // After the commands, which would inherit it.
        app.footer("Examples:\n"
                   "  montelux integrate 'sin(x)*y' --over x=0:pi/2 --over y=0:1 --relative-error 1e-4\n"
                   "  montelux sample --set sobol --n 1024 --dim 2 -o points.csv\n"
                   "  montelux render scene.pbrt --spp 64 -o out.exr\n"
                   "  montelux view scene.pbrt\n"
                   "  montelux denoise out.exr -o out.png\n"
                   "  montelux bake environment sky.hdr -o sky.ktx2\n"
                   "  montelux convert out.exr out.png --tone agx\n"
                   "  montelux info out.exr\n"
                   "  montelux compare out.exr reference.exr\n"
                   "\n"
                   "'montelux COMMAND --help' lists a command's options.\n"
                   "Exit codes: 0 done, 1 failed, 2 wrong usage, 3 stopped before the target error,\n"
                   "130 interrupted (the result so far is saved).");
        const std::span<const char* const> words(argv, argv + argc);
        if (argc > 2 && std::string_view(argv[1]) == "completion" && std::string_view(argv[2]) == "words") {
            std::fputs(completions(app, words.subspan(3)).c_str(), stdout);
            return exit_done;
        }
        try {
            parse(app, argc, argv);
        } catch (const CLI::Success& e) { // asking for help or the version
            app.exit(e);
        } catch (const CLI::ParseError& e) {
            return report_usage(app, e, argc, argv);
        }
        // A full disk behind a redirection is a failure too; the stream remembers what was lost before its
        // last piece.
        if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0)
            throw montelux::Error("standard output", "cannot be written");
    } catch (const UsageError& e) {
        return give_up(e.what(), exit_usage);
    } catch (const std::bad_alloc&) {
        return give_up("there is not enough memory", exit_failed);
    } catch (const std::exception& e) {
        return give_up(e.what(), exit_failed);
    }
    return exit_code;
}

} // namespace

int main(int argc, char** argv) {
    const int exit_code = run(argc, argv);
#ifdef MONTELUX_WITH_RENDER
    leave_job(exit_code);
#endif
    return exit_code;
}
