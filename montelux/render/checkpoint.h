// Renders that survive: the state of a render in a file, and what it must fit to be continued.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "montelux/render/render_state.h"
#include "montelux/render/render_target.h"
#include "montelux/render/renderer.h"
#include "montelux/scene/render_settings.h"

namespace montelux {

// Writes a generation file (mc/io/generation_file.h): the state beside fingerprints of what its samples
// depend on. How far the render shall go (samples per pixel, error, time) is not among these: a render may be
// resumed further than was first asked for. Throws Error.
void save_checkpoint(const std::filesystem::path& path, const Renderer& renderer, const RenderState& state);

struct RestoredRender {
    RenderState state;
    // Of the render that was saved; to be taken over, for another number of samples may ask for others.
    std::uint32_t replicate_points = 0;
    // Why the newest file was not used but the generation before it; empty where it was.
    std::string newest_refused_because;
};

// Throws Error, with the reason, for a file that is missing or damaged, of another version of the program, or
// of a render whose scene, film, sampler, integrator, allocation or slice was another.
RestoredRender load_checkpoint(const std::filesystem::path& path, const SceneDescription& description,
                               const RenderTarget& target);

// Of all that the values of samples depend on, and of the replicates they form: equal for slices of one
// render.
std::uint64_t render_fingerprint(const Renderer& renderer);

} // namespace montelux
