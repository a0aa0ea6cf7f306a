// The closed set of integrators.
#pragma once

#include <variant>

#include "montelux/mc/random/sample_stream.h"
#include "montelux/transport/path_integrator.h"

namespace montelux {

using Integrator = std::variant<PathIntegrator>;

static_assert(IntegratorModel<PathIntegrator, SampleStream>);

} // namespace montelux
