// MultiscatterDielectricBsdf: rough glass whose microfacets light one another, so that roughness loses no energy.
#pragma once

#include <optional>

#include "montelux/mc/random/philox_stream.h"
#include "montelux/scene/bsdf/dielectric.h"

namespace montelux {

// Light that meets one facet is evaluated in closed form, all other by random walks between the facets, on both sides
// of the surface (microsurface_walk.h). Reflection at one facet is that of DielectricBsdf. Transmission differs in
// its masking: a facet at height C1 seen from one side is at 1 - C1 from the other, so the masking is a Beta
// function, the mean of C1^a (1 - C1)^b, instead of the height-correlated one for two directions on the same side.
//
// `evaluate` is an unbiased estimate, not the value; its density is reported as MultiscatterConductorBsdf does.
struct MultiscatterDielectricBsdf {
    DielectricBsdf facets;

    static constexpr const char* name = "dielectric with multiple scattering";
    static constexpr BsdfTraits traits{.transmits = true, .uses_tangents = true, .stochastic = true};
    template <typename Visit>
    void visit_fields(Visit&& visit) const {
        facets.visit_fields(visit);
    }

    bool is_specular() const { return facets.is_specular(); }
    bool has_specular() const { return facets.has_specular(); }
    bool has_diffuse() const { return facets.has_diffuse(); }
    float transmitted_eta(Vec3f wo) const { return facets.transmitted_eta(wo); }
    SampledSpectrum albedo(Vec3f wo) const { return facets.albedo(wo); }

    template <typename Stream>
    BsdfEvaluation evaluate(Vec3f wo, Vec3f wi, TransportMode mode, Stream& stream) const {
        if (is_specular()) return {};
        PhiloxStream rng = PhiloxStream::split(stream);
        return evaluate_lobes(wo, wi, mode, Lobes::both, rng);
    }
    template <typename Stream>
    std::optional<BsdfSample> sample(Vec3f wo, TransportMode mode, Stream& stream) const {
        const float uc = is_specular() ? stream.next_1d() : 0;
        const Vec2f u = is_specular() ? Vec2f{} : stream.next_2d();
        return sample_lobes(wo, uc, u, mode, Lobes::both);
    }

    // As those of DielectricBsdf. A walk that leaves by the other lobe is no sample.
    BsdfEvaluation evaluate_lobes(Vec3f wo, Vec3f wi, TransportMode mode, Lobes lobes,
                                  PhiloxStream& rng) const;
    std::optional<BsdfSample> sample_lobes(Vec3f wo, float uc, Vec2f u, TransportMode mode,
                                           Lobes lobes) const;
    // The density that both report.
    float pdf_lobes(Vec3f wo, Vec3f wi, TransportMode mode, Lobes lobes) const;

  private:
    float further_events(Vec3f wo, Vec3f wi, PhiloxStream& rng) const;
};

} // namespace montelux
