// Training of a guide: samples beside those of the film, whose paths teach it where light comes from.
#pragma once

#include <cstdint>
#include <memory>

#include "montelux/mc/parallel/cancel_flag.h"
#include "montelux/render/guide_summary.h"
#include "montelux/render/sample_context.h"

namespace montelux {

class RoundExecutor;

// What a render wants of a guide.
struct GuideTrainingPlan {
    PixelBounds bounds;
    std::uint64_t samples = 0; // per pixel, that the render may take
    double error = 0;          // relative error that it aims at; 0: none
    double seconds = 0;        // that it may take; 0: no limit
    const CancelFlag* cancel = nullptr;
};

struct TrainedGuide {
    std::shared_ptr<const GuidingField> guide; // null: it would not pay
    GuideSummary summary;
};

// Rounds of samples, each twice as many as the round before, and each guided by what the paths of the round before have
// found, up to a sixth of the samples that the render may take. With Guiding::automatic the first rounds are smaller, of some of
// the pixels, and the training ends after one in sixty samples at most, without a guide, if that does not pay by then; if it
// is not clear, after one in 32. A guide that gains little is trained less, unless its gain
// grows.
//
// Leaves the context with the guide. The result depends on scene, settings, plan and seed, not on the number of
// threads; with a time limit also on how fast the machine is. Not decided if it was cancelled.
TrainedGuide train_guide(SampleContext& context, const Accelerator& accelerator,
                         const IntegratorSettings& settings, const GuideTrainingPlan& plan);
// The same in a render whose samples the executor takes, if it is not null: other processes wait meanwhile. Not decided if
// the executor fails.
TrainedGuide train_guide(SampleContext& context, const Accelerator& accelerator,
                         const IntegratorSettings& settings, const GuideTrainingPlan& plan,
                         RoundExecutor* executor);

} // namespace montelux
