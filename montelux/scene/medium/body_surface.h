// BodySurface: coefficients of a translucent body that vary over its surface.
#pragma once

#include "montelux/scene/medium/medium_model.h"
#include "montelux/scene/texture/texture.h"

namespace montelux {

struct TextureContext;

// A path keeps the coefficients of the point at which it has entered the body until it leaves: there are textures on
// the surface alone. Negative values count as 0; reflectances are limited to 0 to 1.
struct BodySurface {
    enum class Kind : std::uint8_t {
        none,         // the same everywhere: those of the medium
        coefficients, // sigma_a and sigma_s
        reflectance,  // of a wide flat body, and the mean free path
    };
    Kind kind = Kind::none;
    SpectrumParameter first{}, second{1};
    float scale = 1; // of both coefficients, or of the mean free path
    float eta = 1.33f, g = 0;

    bool is_given() const { return kind != Kind::none; }
    MediumPoint at(const SceneView& scene, const TextureContext& context,
                   const SampledWavelengths& lambda) const;
};

} // namespace montelux
