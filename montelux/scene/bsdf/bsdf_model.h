// BsdfModel: the concept of a BSDF.
#pragma once

#include <concepts>
#include <optional>
#include <type_traits>
#include <variant>

#include "montelux/mc/random/philox_stream.h"
#include "montelux/scene/bsdf/bsdf_types.h"

namespace montelux {

// Plain values in the local frame of the shading normal. sample and evaluate agree: E[weight over a set of
// directions] is the integral of f |cos theta_i| over it, without delta lobes. sample takes at most one
// number and one pair from the stream, evaluate at most one pair.
template <typename B>
concept BsdfModel = std::is_trivially_copyable_v<B> && std::same_as<decltype(B::traits), const BsdfTraits> &&
    requires(const B& b, Vec3f w, TransportMode mode, PhiloxStream& stream) {
    // Its name, and its fields as (name, value) pairs: numbers, spectra, Ggx or another BSDF.
    { B::name } -> std::convertible_to<const char*>;
    b.visit_fields([](const char*, const auto&) {});
    // All lobes are deltas.
    { b.is_specular() } -> std::same_as<bool>;
    // Some lobe is a delta.
    { b.has_specular() } -> std::same_as<bool>;
    // Some lobe is diffuse: Lambert's, sheen, scattering below the surface. Microfacets count by their alpha, hair and
    // measured BRDFs as narrow (narrow_lobes.h). Guides learn, split and end paths by it; no expected value depends on it.
    { b.has_diffuse() } -> std::same_as<bool>;
    // Directional albedo, possibly approximate: a feature for denoisers, not part of an estimate.
    { b.albedo(w) } -> std::same_as<SampledSpectrum>;
    { b.evaluate(w, w, mode, stream) } -> std::same_as<BsdfEvaluation>;
    { b.sample(w, mode, stream) } -> std::same_as<std::optional<BsdfSample>>;
} &&(!B::traits.transmits || requires(const B& b, Vec3f wo) {
    // Relative index of refraction, far side over the side of wo: BsdfSample::eta of transmitted directions.
    { b.transmitted_eta(wo) } -> std::same_as<float>;
});

// BsdfModel::transmitted_eta of the BSDF in a variant; 1 if it does not transmit.
template <typename... B>
float transmitted_eta(const std::variant<B...>& bsdf, Vec3f wo) {
    return std::visit(
        [&]<typename T>(const T& b) {
            if constexpr (T::traits.transmits)
                return b.transmitted_eta(wo);
            else
                return 1.0f;
        },
        bsdf);
}

} // namespace montelux
