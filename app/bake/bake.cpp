// montelux bake: tables and prefiltered maps for real-time engines.
#include "app/bake/bake.h"

#include "app/commands.h"
#include <CLI/CLI.hpp>

namespace montelux::app {

void add_bake(CLI::App& app, int& exit_code) {
    CLI::App* bake =
        app.add_subcommand("bake", "Prefilter environment maps and tabulate the BRDF for real-time engines");
    bake->require_subcommand(1);
    add_bake_environment(*bake, exit_code);
    add_bake_brdf(*bake, exit_code);
    add_bake_report(*bake, exit_code);
    add_bake_sky(*bake, exit_code);
    bake->footer("Examples:\n"
                 "  montelux bake environment sky.hdr -o sky.ktx2 --preview sky.png\n"
                 "  montelux bake brdf -o brdf.exr --size 256\n"
                 "  montelux bake report sky.hdr -o spheres.png\n"
                 "  montelux bake sky --elevation 20 --turbidity 3 -o sky.exr");
}

} // namespace montelux::app
