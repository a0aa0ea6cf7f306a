// The subcommands of the command line program: each function registers one and sets the exit code it ends
// with.
#pragma once

namespace CLI {
class App;
}

namespace montelux::app {

// Exit codes of the program.
inline constexpr int exit_done = 0, exit_failed = 1, exit_usage = 2, exit_stopped = 3, exit_interrupted = 130;

void add_integrate(CLI::App& app, int& exit_code);
void add_sample(CLI::App& app, int& exit_code);
void add_render(CLI::App& app, int& exit_code);
void add_view(CLI::App& app, int& exit_code);
void add_merge(CLI::App& app, int& exit_code);
void add_compare(CLI::App& app, int& exit_code);
void add_denoise(CLI::App& app, int& exit_code);
void add_bake(CLI::App& app, int& exit_code);
void add_convert(CLI::App& app, int& exit_code);
void add_info(CLI::App& app, int& exit_code);
void add_formats(CLI::App& app, int& exit_code);
void add_completion(CLI::App& app, int& exit_code);
void add_manual(CLI::App& app, int& exit_code);

} // namespace montelux::app
