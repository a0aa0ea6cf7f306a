// The closed set of integrators.
#pragma once

#include <concepts>
#include <variant>

#include "montelux/mc/random/sample_stream.h"
#include "montelux/transport/bidirectional_integrator.h"
#include "montelux/transport/occlusion_integrator.h"
#include "montelux/transport/path_integrator.h"
#include "montelux/transport/volume_path_integrator.h"

namespace montelux {

using Integrator =
    std::variant<PathIntegrator, VolumePathIntegrator, OcclusionIntegrator, BidirectionalIntegrator>;

static_assert(IntegratorModel<PathIntegrator, SampleStream>);
static_assert(IntegratorModel<VolumePathIntegrator, SampleStream>);
static_assert(IntegratorModel<OcclusionIntegrator, SampleStream>);
static_assert(IntegratorModel<BidirectionalIntegrator, SampleStream>);

// The memory of any of them.
struct IntegratorBatch {
    PathBatch path;
    BidirectionalMemory bidirectional;

    template <typename I>
    auto& of() {
        if constexpr (std::same_as<typename I::Batch, PathBatch>)
            return path;
        else
            return bidirectional;
    }
};

} // namespace montelux
