#include "montelux/scene/medium/body_surface.h"

#include <algorithm>
#include <array>

#include "montelux/scene/medium/semi_infinite_albedo.h"
#include "montelux/scene/texture/evaluate.h"

namespace montelux {

MediumPoint BodySurface::at(const SceneView& scene, const TextureContext& context,
                            const SampledWavelengths& lambda) const {
    const SampledSpectrum a = clamp_zero(evaluate(scene, first, context, lambda)),
                          b = clamp_zero(evaluate(scene, second, context, lambda));
    if (kind == Kind::coefficients) return {a * scale, b * scale, {}};
    std::array<float, 4> sigma_s{}, sigma_a{};
    for (int i = 0; i < 4; ++i) {
        const float albedo = body_albedo(a[i], eta, g);
        const float extinction = 1 / std::max(b[i] * scale, 1e-9f);
        sigma_s[static_cast<std::size_t>(i)] = albedo * extinction;
        sigma_a[static_cast<std::size_t>(i)] = (1 - albedo) * extinction;
    }
    const auto spectrum = [](const std::array<float, 4>& v) {
        return SampledSpectrum(v[0], v[1], v[2], v[3]);
    };
    return {spectrum(sigma_a), spectrum(sigma_s), {}};
}

} // namespace montelux
