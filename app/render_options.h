// What the render command can be told, and how that overrides a scene file.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "montelux/mc/math/error.h"
#include "montelux/scene/render_settings.h"

namespace CLI {
class App;
}

namespace montelux::app {

struct RenderOptions {
    std::string scene;
    std::vector<std::string> outputs;
    std::optional<long long> spp, seed, max_depth;
    std::optional<std::string> resolution, sampler, strategy, heuristic;
    std::vector<double> crop;
    long long threads = 0;
    bool stats = false, quiet = false;
};

void declare(CLI::App& command, RenderOptions& options);

// Throws UsageError (montelux::Error) with a sentence when an option's value makes no sense.
void apply(const RenderOptions& options, SceneDescription& description);

// A mistake of the command line, as opposed to one of a file: exit code 2.
struct UsageError : Error {
    using Error::Error;
};

std::string name_of(SamplerKind kind);
std::string name_of(Strategy strategy);

} // namespace montelux::app
