// Checkpoints: the state of a render in a file, with fingerprints of the render that may resume it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "montelux/render/render_state.h"
#include "montelux/render/render_target.h"
#include "montelux/render/renderer.h"
#include "montelux/scene/render_settings.h"

namespace montelux {

// Writes a generation file (mc/io/generation_file.h): the state and fingerprints of everything that samples
// depend on. Limits (samples per pixel, error, time) are not among these: a render may be resumed with higher
// ones. Throws Error.
void save_checkpoint(const std::filesystem::path& path, const Renderer& renderer, const RenderState& state);

struct RestoredRender {
    RenderState state;
    // Of the saved render; the resumed one keeps it, although another number of samples may imply another.
    std::uint32_t replicate_points = 0;
    // Why the newest file was not used but the previous generation; empty if it was used.
    std::string newest_refused_because;
};

// Throws Error, with the reason, for a file that is missing, damaged, or of another version of the program,
// and for a render with another scene, film, sampler, integrator, allocation or slice.
RestoredRender load_checkpoint(const std::filesystem::path& path, const SceneDescription& description,
                               const RenderTarget& target);

// The integrator of the saved render, for a render whose integrator is automatic. Throws Error as load_checkpoint() does
// for a file that is not usable.
IntegratorKind integrator_of_checkpoint(const std::filesystem::path& path,
                                        const SceneDescription& description);

// Hash of everything that the values and replicates of samples depend on: equal for the slices of one render.
std::uint64_t render_fingerprint(const Renderer& renderer);

// Hash of everything that a finished picture depends on; of a render with a limit of time, that limit.
std::uint64_t picture_fingerprint(const SceneDescription& description, const RenderTarget& target);

} // namespace montelux
