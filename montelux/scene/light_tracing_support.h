// light_tracing_obstacle: why an integrator that traces light cannot render a scene.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "montelux/scene/render_settings.h"

namespace montelux {

// Of IntegratorKind::light_tracing, for warnings.
inline constexpr std::string_view light_tracing_warning =
    "light tracing shows no light that reaches the camera straight from a mirror or smooth glass";

// The reason, or empty: for cameras without importance, and for what does not scatter the same in both
// directions of a path.
std::optional<std::string> light_tracing_obstacle(const Scene& scene, const IntegratorSettings& settings);

} // namespace montelux
