// MicrofacetDistribution: the name of a distribution of microfacet normals.
#pragma once

#include <cstdint>

namespace montelux {

// With its masking and shadowing: height-correlated for `ggx`, G1(wo) G1(wi) for the others, as in Mitsuba.
enum class MicrofacetDistribution : std::uint8_t { ggx, ggx_separable, beckmann };

} // namespace montelux
