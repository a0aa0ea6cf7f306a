// The closed set of integrators.
#pragma once

#include <variant>

#include "montelux/mc/random/sample_stream.h"
#include "montelux/transport/occlusion_integrator.h"
#include "montelux/transport/path_integrator.h"
#include "montelux/transport/volume_path_integrator.h"

namespace montelux {

using Integrator = std::variant<PathIntegrator, VolumePathIntegrator, OcclusionIntegrator>;

static_assert(IntegratorModel<PathIntegrator, SampleStream>);
static_assert(IntegratorModel<VolumePathIntegrator, SampleStream>);
static_assert(IntegratorModel<OcclusionIntegrator, SampleStream>);

} // namespace montelux
