// MultiscatterConductorBsdf: a metal whose microfacets light one another, so that roughness loses no energy.
#pragma once

#include <optional>

#include "montelux/mc/random/philox_stream.h"
#include "montelux/scene/bsdf/conductor.h"

namespace montelux {

// The first reflection is that of ConductorBsdf; all further ones are found by random walks between the facets
// (microsurface_walk.h). `evaluate` is an unbiased estimate, not the value. The weight of `sample` is f |cos| over the
// true density, which is not known in closed form: both report as pdf a fixed positive function of the two directions.
// MIS weights may use it (they sum to 1 for any).
struct MultiscatterConductorBsdf {
    ConductorBsdf facets;

    static constexpr const char* name = "conductor with multiple scattering";
    static constexpr BsdfTraits traits{.uses_tangents = true, .stochastic = true};
    template <typename Visit>
    void visit_fields(Visit&& visit) const {
        facets.visit_fields(visit);
    }

    bool is_specular() const { return facets.is_specular(); }
    bool has_specular() const { return facets.has_specular(); }
    bool has_diffuse() const { return facets.has_diffuse(); }
    SampledSpectrum albedo(Vec3f wo) const { return facets.albedo(wo); }

    template <typename Stream>
    BsdfEvaluation evaluate(Vec3f wo, Vec3f wi, TransportMode mode, Stream& stream) const {
        BsdfEvaluation result = facets.evaluate(wo, wi, mode, stream);
        if (is_specular() || !same_hemisphere(wo, wi)) return result;
        PhiloxStream rng = PhiloxStream::split(stream);
        result.f += further_reflections(wo, wi, rng);
        result.pdf = reported_pdf(wo, wi, result.pdf);
        return result;
    }

    template <typename Stream>
    std::optional<BsdfSample> sample(Vec3f wo, TransportMode mode, Stream& stream) const {
        if (is_specular()) return facets.sample(wo, mode, stream);
        if (wo.z == 0) return std::nullopt;
        PhiloxStream rng = PhiloxStream::split(stream);
        return walk(wo, rng);
    }

  private:
    // Compiled separately: the sampling loop keeps its size.
    SampledSpectrum further_reflections(Vec3f wo, Vec3f wi, PhiloxStream& rng) const;
    std::optional<BsdfSample> walk(Vec3f wo, PhiloxStream& rng) const;
    // From the density of the first reflection.
    float reported_pdf(Vec3f wo, Vec3f wi, float first) const;
};

} // namespace montelux
