// The parts of montelux bake: each function registers one and sets the exit code it ends with.
#pragma once

namespace CLI {
class App;
}

namespace montelux::app {

void add_bake_environment(CLI::App& bake, int& exit_code);
void add_bake_brdf(CLI::App& bake, int& exit_code);
void add_bake_report(CLI::App& bake, int& exit_code);
void add_bake_sky(CLI::App& bake, int& exit_code);

} // namespace montelux::app
