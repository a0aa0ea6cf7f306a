// PhaseFunction: the variant of all phase functions; all satisfy PhaseModel.
#pragma once

#include <concepts>
#include <type_traits>
#include <variant>

#include "montelux/scene/medium/draine.h"

namespace montelux {

// The distribution of directions after a scattering event: plain values. wo and wi are of unit length and
// point away from the event. Samples follow `pdf` exactly, which is the phase function's value: 1/sr.
template <typename P>
concept PhaseModel = std::is_trivially_copyable_v<P> && requires(const P& p, Vec3f w, Vec2f u) {
    { P::name } -> std::convertible_to<const char*>;
    { p.pdf(w, w) } -> std::same_as<float>;
    { p.sample(w, u) } -> std::same_as<PhaseSample>;
    // Of the angle of deflection: positive forward.
    { p.mean_cosine() } -> std::same_as<float>;
};

using PhaseFunction = std::variant<HenyeyGreenstein, Draine>;

template <typename... P>
constexpr bool all_are_phase_models(std::type_identity<std::variant<P...>>) {
    return (PhaseModel<P> && ...);
}
static_assert(all_are_phase_models(std::type_identity<PhaseFunction>{}));

} // namespace montelux
