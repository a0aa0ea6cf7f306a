// montelux view: a render in the browser, from its first sample on.
#include "app/commands.h"
#include "app/render/render_command.h"
#include "app/render/render_options.h"
#include <CLI/CLI.hpp>
#include <memory>

namespace montelux::app {

void add_view(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<RenderOptions>();
    options->view.page = options->view.stays = true;
    CLI::App* command = app.add_subcommand("view", "Render a scene and watch it in a browser");
    declare(*command, *options);
    // Of single samples, of sequences, and of renders that several processes share.
    for (const char* name :
         {"--debug-sample", "--frames", "--frame-rate", "--turntable", "--slice", "--rank-timeout"})
        command->remove_option(command->get_option(name));
    command->get_option("--output")
        ->description("Picture to write at the end: .exr, .png, .jpg, .hdr or .pfm; may be given several "
                      "times. Default: none");
    command->footer("Examples:\n"
                    "  montelux view scene.pbrt\n"
                    "  montelux view model.glb --target-error 2%\n"
                    "  montelux view scene.pbrt --reference reference.exr\n"
                    "\n"
                    "Prints the address of a page on which the picture appears while it is rendered, with "
                    "the error of every "
                    "pixel.\n"
                    "The page can pause and continue the render, change its target, turn the camera, mix the "
                    "lights and save "
                    "pictures.\n"
                    "Ends when the page says so, or by Ctrl-C.");
    command->callback([options, &exit_code] { exit_code = run_render(*options); });
}

} // namespace montelux::app
