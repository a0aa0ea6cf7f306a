// MergingSample: what merging adds to a sample.
#pragma once

#include "montelux/mc/random/sample_stream.h"
#include "montelux/spectrum/sampled_spectrum.h"

namespace montelux {

struct MergingSample {
    SampleStream light; // numbers of the light's path, which is traced before the camera's is known
    // What the radiance would gain if only vertices within the radius over sqrt(2) merged.
    SampledSpectrum narrower{};
};

} // namespace montelux
