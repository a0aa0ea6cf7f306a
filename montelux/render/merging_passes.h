// MergingPasses: the light maps of a render whose paths merge, one for each sample of all pixels.
#pragma once

#include <cstdint>
#include <mutex>
#include <span>
#include <vector>

#include "montelux/accel/accelerator.h"
#include "montelux/mc/parallel/cancel_flag.h"
#include "montelux/render/render_state.h"
#include "montelux/render/sample_context.h"

namespace montelux {

// A pass takes the samples of one index of all pixels. First all their light paths are traced, then their camera paths
// merge with them. The map is a function of the scene, the film and the index: not of threads, and a resumed render
// builds the same.
//
// The radius of pass i is r_1 (i + 1)^((alpha - 1) / 2), alpha = 3/4: discs shrink so slowly that the variance of the
// mean over the passes vanishes as their bias does (Knaus, Zwicker 2011, "Progressive Photon Mapping: A Probabilistic
// Approach"; Kaplanyan, Dachsbacher 2013, "Adaptive Progressive Photon Mapping").
class MergingPasses {
  public:
    // The context and the accelerator must outlive it. Throws Error where the radius does not suit the scene.
    MergingPasses(SampleContext& context, const Accelerator& accelerator, const MergingSettings& settings,
                  const PixelBounds& crop);

    // Gives the context the map of the samples of that index. Rays and times are added to `report` under its mutex.
    // Makes no map if the render is cancelled meanwhile.
    void prepare(std::uint64_t index, RenderReport& report, std::mutex& mutex, const CancelFlag* cancel);
    double radius(std::uint64_t index) const;

  private:
    void plan();
    // Throws Error where the first radius does not suit the scene.
    void check_radius() const;
    std::vector<LightPaths> trace(std::uint64_t index, std::uint64_t paths, RenderReport& report,
                                  std::mutex& mutex, const CancelFlag* cancel) const;

    SampleContext& context_;
    const Accelerator& accelerator_;
    MergingSettings settings_;
    PixelBounds crop_;
    std::uint64_t pixels_, paths_ = 0; // paths in a map
    double first_radius_ = 0;
    std::uint64_t prepared_ = ~std::uint64_t{0};
};

// The radius of merging of the first pass: 1.5 sides of the pixel that is seen, the median over these samples; a small
// one where none sees a surface.
double merging_radius(const SampleContext& context, const Accelerator& accelerator,
                      std::span<const SampleContext::Key> keys);

// Ends the open pass of so many samples of all pixels in the bias of the state and its report.
void close_bias(RenderState& state, std::uint64_t samples);

} // namespace montelux
