// render_picture: one picture, from its scene to its files and what is printed about it.
#pragma once

#include "app/render/cluster_render.h"
#include "app/render/render_options.h"
#include "app/tone_options.h"
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "montelux/denoise/denoiser.h"
#include "montelux/mc/random/sampler_settings.h"
#include "montelux/render/render_target.h"
#include "montelux/scene/render_settings.h"

namespace montelux::app {

struct PictureTask {
    std::shared_ptr<SceneDescription> description; // changes only where a viewer restarts the render
    RenderTarget target;
    std::vector<std::string> outputs;
    ToneOptions tone{};
    double load_seconds = 0;
    // Of a sequence: nothing is written of an interrupted one.
    bool is_frame = false;
    std::string doing = "rendering"; // for lines of progress
};

struct PictureResult {
    int exit_code = 0;
    std::optional<float> exposure{}; // stops, of the first file that has one
};

// Throws UsageError for outputs and slices that cannot be, and Error for what fails.
PictureResult render_picture(const PictureTask& task, const RenderOptions& options, SharedRender& shared,
                             const std::optional<Denoiser>& denoiser);

// Throws UsageError for a render that cannot be cut into slices.
void check_slice_option(const SamplerSettings& sampler, const RenderTarget& target);

} // namespace montelux::app
