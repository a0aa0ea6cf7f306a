// The closed set of BSDFs.
#pragma once

#include <concepts>
#include <variant>

#include "montelux/scene/bsdf/coating.h"
#include "montelux/scene/bsdf/conductor.h"
#include "montelux/scene/bsdf/dielectric.h"
#include "montelux/scene/bsdf/diffuse.h"
#include "montelux/scene/bsdf/layered.h"
#include "montelux/scene/bsdf/thin_dielectric.h"

namespace montelux {

// Plain values in the local frame of the shading normal. sample and evaluate agree: E[weight over a set of
// directions] is the integral of f |cos theta_i| over it, delta lobes apart.
template <typename B, typename Stream>
concept BsdfModel = std::is_trivially_copyable_v<B> &&
    requires(const B& b, Vec3f w, TransportMode mode, Stream& stream) {
    { b.is_specular() } -> std::same_as<bool>;
    // Some lobe is a delta.
    { b.has_specular() } -> std::same_as<bool>;
    // Directional albedo, perhaps approximate: a guide for denoisers, not part of an estimate.
    { b.albedo(w) } -> std::same_as<SampledSpectrum>;
    { b.evaluate(w, w, mode, stream) } -> std::same_as<BsdfEvaluation>;
    { b.sample(w, mode, stream) } -> std::same_as<std::optional<BsdfSample>>;
};

using Bsdf = std::variant<DiffuseBsdf, ConductorBsdf, DielectricBsdf, ThinDielectricBsdf, CoatedDiffuseBsdf,
                          LayeredBsdf<DiffuseBsdf>, LayeredBsdf<ConductorBsdf>>;

} // namespace montelux
