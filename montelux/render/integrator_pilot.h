// IntegratorPilot: the first samples of a render by one integrator, on some tiles or in whole groups of chains.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "montelux/mc/parallel/cancel_flag.h"
#include "montelux/render/pilot_variance.h"
#include "montelux/render/renderer.h"

namespace montelux {

// Takes a sample per pixel of some tiles, with which the render by this integrator begins, and one of another replicate
// beside it, to compare; of chains the first two groups, which reach all pixels.
class IntegratorPilot {
  public:
    // The renderer's description has the integrator. The renderer and the tiles must outlive it.
    IntegratorPilot(const Renderer& renderer, std::span<const PixelBounds> tiles);

    // Takes the tiles up to the first `count`; with splats, all of them at once. Returns false if it was cancelled.
    bool take_tiles(std::size_t count, const CancelFlag* cancel);
    // Takes two groups; the picture then is that of the first `count` tiles.
    bool take_groups(std::size_t count, const CancelFlag* cancel);

    const PilotPicture& picture() const { return picture_; }
    // Rays of a sample.
    double rays_per_sample() const { return samples_ > 0 ? rays_ / samples_ : 0; }
    double samples() const { return samples_; } // taken of all pixels
    double cpu_seconds() const { return cpu_seconds_; }
    // To be continued by a render.
    RenderState take_state() { return std::move(state_); }

  private:
    // Takes a sample of every pixel of the tiles that are not yet taken, up to the first `end`.
    bool sweep(const TileRenderer& renderer, RenderState& state, std::size_t end, const CancelFlag* cancel);
    void count(const RenderReport& before, const RenderReport& after);

    const Renderer& renderer_;
    std::span<const PixelBounds> tiles_;
    std::size_t taken_ = 0; // tiles
    RenderState state_;
    PilotPicture picture_;
    double rays_ = 0, samples_ = 0, cpu_seconds_ = 0;
};

} // namespace montelux
