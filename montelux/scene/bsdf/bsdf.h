// Bsdf: the variant of all BSDFs of surfaces.
#pragma once

#include <concepts>
#include <type_traits>
#include <variant>

#include "montelux/scene/bsdf/bsdf_model.h"
#include "montelux/scene/bsdf/tilted.h"
#include "montelux/scene/bsdf/untilted_bsdf.h"

namespace montelux {

template <typename... B>
std::variant<B..., TiltedBsdf> with_tilted(std::type_identity<std::variant<B...>>);
// The BSDFs of materials (untilted_bsdf.h), and those tilted by a normal map or bumps.
using Bsdf = decltype(with_tilted(std::type_identity<UntiltedBsdf>{}));

template <typename... B>
constexpr bool all_are_models(std::type_identity<std::variant<B...>>) {
    return (BsdfModel<B> && ...);
}
static_assert(all_are_models(std::type_identity<Bsdf>{}));

// Whether light from the other side of the surface than wo is never scattered to it.
inline bool is_opaque(const UntiltedBsdf& bsdf) {
    return std::visit([](const auto& b) { return !b.traits.transmits; }, bsdf);
}
inline bool is_opaque(const Bsdf& bsdf) {
    return std::visit(
        []<typename B>(const B& b) {
            if constexpr (std::same_as<B, TiltedBsdf>)
                return is_opaque(b.base);
            else
                return !B::traits.transmits;
        },
        bsdf);
}

} // namespace montelux
