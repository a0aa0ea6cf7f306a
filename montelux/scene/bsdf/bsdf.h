// Bsdf, the variant of all BSDFs of surfaces (bsdf_list.h), with their definitions.
#pragma once

#include <type_traits>
#include <variant>

#include "montelux/scene/bsdf/bsdf_model.h"
#include "montelux/scene/bsdf/tilted.h"
#include "montelux/scene/bsdf/untilted_bsdf.h"

namespace montelux {

template <typename... B>
constexpr bool all_are_models(std::type_identity<std::variant<B...>>) {
    return (BsdfModel<B> && ...);
}
static_assert(all_are_models(std::type_identity<Bsdf>{}));

// BsdfModel's functions of whatever the variant holds.
bool is_specular(const Bsdf& bsdf);
SampledSpectrum albedo(const Bsdf& bsdf, Vec3f wo);
// The functions of narrow_lobes.h.
bool is_glossy(const Bsdf& bsdf);
float least_alpha(const Bsdf& bsdf);
// Whether light from the other side of the surface than wo is never scattered to it.
bool is_opaque(const Bsdf& bsdf);

} // namespace montelux
