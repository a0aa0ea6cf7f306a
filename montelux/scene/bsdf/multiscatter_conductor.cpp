#include "montelux/scene/bsdf/multiscatter_conductor.h"

#include "montelux/scene/bsdf/microsurface_walk.h"

namespace montelux {

namespace {

// One reflection: turns the walk and takes the facet's reflectance. False if nothing is left.
bool reflects_at_facet(MicrosurfaceWalk& walk, const ConductorBsdf& facets, SampledSpectrum& beta,
                       PhiloxStream& rng) {
    const Vec3f v = -walk.w, m = walk.sample_facet(rng.next_2d());
    const float cosine = dot(v, m);
    if (!(cosine > 0)) return false; // by rounding
    beta *= fresnel_conductor(cosine, facets.eta, facets.k);
    walk.w = reflect(v, m);
    return true;
}

} // namespace

SampledSpectrum MultiscatterConductorBsdf::further_reflections(Vec3f wo, Vec3f wi, PhiloxStream& rng) const {
    if (wo.z < 0) {
        wo.z = -wo.z;
        wi.z = -wi.z;
    }
    MicrosurfaceWalk walk{facets.normals, -wo};
    SampledSpectrum sum, beta(1);
    for (int event = 0; event < MicrosurfaceWalk::most_events; ++event) {
        if (!walk.advance(rng.next_1d())) break;
        if (event > 0) {
            const Vec3f v = -walk.w;
            const Vec3f m = normalize(v + wi);
            if (m.z > 0) {
                const float phase = facets.normals.d(m) * walk.facet_density_scale() / 4;
                sum += beta * fresnel_conductor(dot(v, m), facets.eta, facets.k) * (phase * walk.escape(wi));
            }
            if (!survives_roulette(event, beta, rng)) break;
        }
        if (!reflects_at_facet(walk, facets, beta, rng)) break;
    }
    return sum;
}

std::optional<BsdfSample> MultiscatterConductorBsdf::walk(Vec3f wo, PhiloxStream& rng) const {
    const bool below = wo.z < 0;
    if (below) wo.z = -wo.z;
    MicrosurfaceWalk walk{facets.normals, -wo};
    SampledSpectrum beta(1);
    for (int event = 0; walk.advance(rng.next_1d()); ++event) {
        if (event == MicrosurfaceWalk::most_events || !survives_roulette(event, beta, rng))
            return std::nullopt;
        if (!reflects_at_facet(walk, facets, beta, rng)) return std::nullopt;
    }
    Vec3f wi = walk.w;
    if (!(wi.z > 0)) return std::nullopt; // by rounding
    const Vec3f m = normalize(wo + wi);
    const float first = facets.normals.visible_pdf(wo, m) / (4 * std::max(dot(wo, m), 1e-9f));
    BsdfSample s{.weight = beta, .wi = wi, .pdf = reported_pdf(wo, wi, first)};
    if (!(s.pdf > 0)) return std::nullopt;
    if (below) s.wi.z = -s.wi.z;
    return s;
}

float MultiscatterConductorBsdf::reported_pdf(Vec3f, Vec3f wi, float first) const {
    const float further = share_of_further_events(facets.normals);
    return (1 - further) * first + further * inv_pi_f * abs_cos_theta(wi);
}

} // namespace montelux
