#include "montelux/scene/bsdf/disney.h"

#include <cmath>

#include "montelux/mc/warp/hemisphere.h"
#include "montelux/scene/bsdf/fresnel.h"
#include "montelux/scene/bsdf/microfacet_pair.h"

namespace montelux {

namespace {

// Schlick's rise towards grazing incidence.
float grazing_rise(float cos_theta) {
    const float m = 1 - std::clamp(cos_theta, 0.0f, 1.0f);
    return (m * m) * (m * m) * m;
}

// Schlick's reflectance by the cosine on the side of the smaller index, so that it is the same in both directions.
SampledSpectrum schlick(SampledSpectrum f0, float cos_theta, float eta) {
    if (eta < 1) cos_theta = std::sqrt(std::max(0.0f, 1 - (1 - cos_theta * cos_theta) / (eta * eta)));
    return fresnel_schlick(cos_theta, f0, 1);
}

float share_of_first(SampledSpectrum first, SampledSpectrum second) {
    const float a = average(first), b = average(second);
    return a + b > 0 ? a / (a + b) : 1;
}

Vec3f mirrored_below(Vec3f w) { return {w.x, w.y, -w.z}; }

// The coat's distribution of normals GTR1 (Burley 2012, appendix B), its masking with an alpha of 0.25, and its
// reflectance.
struct Coat {
    float alpha;

    float d(Vec3f m) const {
        const float a2 = alpha * alpha;
        return inv_pi_f * (a2 - 1) / (std::log(a2) * (1 + (a2 - 1) * m.z * m.z));
    }
    // A normal with density d(m) m.z.
    Vec3f sample(Vec2f u) const {
        const float a2 = alpha * alpha;
        const float z2 = std::clamp((1 - std::pow(a2, 1 - u.y)) / (1 - a2), 0.0f, 1.0f);
        const float sine = std::sqrt(1 - z2), phi = two_pi_f * u.x;
        return {sine * std::cos(phi), sine * std::sin(phi), std::sqrt(z2)};
    }
    // Of wi; both above the surface.
    float pdf(Vec3f wo, Vec3f wi) const {
        const Vec3f m = normalize(wo + wi);
        return d(m) * m.z / (4 * std::max(dot(wo, m), 1e-9f));
    }
    float value(Vec3f wo, Vec3f wi) const {
        constexpr Ggx masking{0.25f, 0.25f};
        const Vec3f m = normalize(wo + wi);
        const float fresnel = fresnel_schlick(dot(wo, m), SampledSpectrum(0.04f), 1)[0];
        return 0.25f * fresnel * d(m) * masking.g1(wo) * masking.g1(wi) * wi.z;
    }
};

} // namespace

SampledSpectrum DisneyBase::value(Vec3f wo, Vec3f wi) const {
    const float rise_o = grazing_rise(wo.z), rise_i = grazing_rise(wi.z);
    const float cos_d = dot(normalize(wo + wi), wi);
    const float retro = 2 * roughness * cos_d * cos_d;
    float f =
        (1 - 0.5f * rise_o) * (1 - 0.5f * rise_i) + retro * (rise_o + rise_i + rise_o * rise_i * (retro - 1));
    if (flatness > 0) {
        const float fss90 = retro / 2;
        const float fss = (1 + (fss90 - 1) * rise_o) * (1 + (fss90 - 1) * rise_i);
        const float flat = 1.25f * (fss * (1 / (wo.z + wi.z) - 0.5f) + 0.5f);
        f += flatness * (flat - f);
    }
    return wi.z * (f * inv_pi_f * color + grazing_rise(cos_d) * sheen_color);
}

// Probabilities of the lobes, in proportion to their estimated albedos.
struct DisneySolid::Shares {
    float facets, diffuse, coat;
};

SampledSpectrum DisneySolid::reflectance(float cos_theta, bool outside) const {
    const float f = fresnel_dielectric(outside ? cos_theta : -cos_theta, eta);
    if (!outside) return SampledSpectrum(transmitting * f);
    SampledSpectrum r((1 - metallic) * (1 - tinted) * f);
    if (metallic > 0) r += metallic * schlick(color, cos_theta, eta);
    if (tinted > 0) r += (1 - metallic) * tinted * schlick(tinted_f0, cos_theta, eta);
    return r;
}
// From outside and, with the negative cosine, from inside.
SampledSpectrum DisneySolid::transmittance(float cos_theta) const {
    return transmitting * (1 - fresnel_dielectric(cos_theta, eta)) * sqrt(color);
}

DisneySolid::Shares DisneySolid::shares(Vec3f wo) const {
    const bool outside = wo.z > 0;
    const float facets = average(reflectance(std::abs(wo.z), outside) + transmittance(wo.z));
    // Microfacets at other angles may reflect or transmit where those along the normal do not.
    Shares s{std::max(facets, 0.02f), 0, 0};
    if (outside) {
        s.diffuse = average(base.color) + 0.1f * average(base.sheen_color);
        s.coat = 0.1f * coat;
    }
    const float total = s.facets + s.diffuse + s.coat;
    return {s.facets / total, s.diffuse / total, s.coat / total};
}

SampledSpectrum DisneySolid::albedo(Vec3f wo) const {
    const bool outside = wo.z > 0;
    SampledSpectrum a = reflectance(std::abs(wo.z), outside) + transmittance(wo.z);
    if (outside) a += base.color;
    return clamp(a, 0, 1);
}

BsdfEvaluation DisneySolid::evaluate(Vec3f wo, Vec3f wi, TransportMode mode) const {
    if (wo.z == 0 || wi.z == 0) return {};
    return evaluate(shares(wo), wo, wi, mode);
}

BsdfEvaluation DisneySolid::evaluate(const Shares& p, Vec3f wo, Vec3f wi, TransportMode mode) const {
    const bool reflects = same_hemisphere(wo, wi), outside = wo.z > 0;
    BsdfEvaluation e;
    if (reflects || transmits()) {
        const float eta_p = reflects ? 1 : transmitted_eta(wo);
        if (const auto facet = MicrofacetPair::find(normals, wo, wi, reflects, eta_p)) {
            const SampledSpectrum r = reflectance(std::abs(facet->o_m), outside);
            const SampledSpectrum t = transmittance(facet->o_m);
            const float crossing = !reflects && mode == TransportMode::radiance ? 1 / (eta_p * eta_p) : 1;
            const float p_reflect = share_of_first(r, t);
            e.f += facet->density * facet->shadowing * crossing * (reflects ? r : t);
            e.pdf += p.facets * facet->density * (reflects ? p_reflect : 1 - p_reflect);
        }
    }
    if (!reflects || !outside) return e;
    e.f += base.value(wo, wi);
    e.pdf += p.diffuse * inv_pi_f * wi.z;
    if (coat > 0) {
        const Coat lacquer{coat_alpha};
        e.f += SampledSpectrum(coat * lacquer.value(wo, wi));
        e.pdf += p.coat * lacquer.pdf(wo, wi);
    }
    return e;
}

std::optional<BsdfSample> DisneySolid::sample(Vec3f wo, TransportMode mode, float uc, Vec2f u) const {
    if (wo.z == 0) return std::nullopt;
    const Shares p = shares(wo);
    BsdfSample s;
    if (uc < p.facets) {
        const Vec3f m = normals.sample_visible(wo, u);
        const float o_m = dot(wo, m);
        const float p_reflect = share_of_first(reflectance(std::abs(o_m), wo.z > 0), transmittance(o_m));
        s.transmission = uc >= p.facets * p_reflect;
        if (s.transmission) {
            const auto refraction = refract(wo, m, eta);
            if (!refraction) return std::nullopt;
            s.wi = refraction->wt;
            s.eta = refraction->eta;
        } else {
            s.wi = reflect(wo, m);
        }
    } else if (uc < p.facets + p.diffuse || !(p.coat > 0)) {
        s.wi = sample_cosine_hemisphere(u);
    } else {
        s.wi = reflect(wo, Coat{coat_alpha}.sample(u));
    }
    if (s.wi.z == 0 || same_hemisphere(wo, s.wi) == s.transmission) return std::nullopt;
    const BsdfEvaluation e = evaluate(p, wo, s.wi, mode);
    if (!(e.pdf > 0)) return std::nullopt;
    s.weight = e.f / e.pdf;
    s.pdf = e.pdf;
    return s;
}

struct DisneySheet::Shares {
    float reflected, crossing, diffuse, transmitting;
};

SampledSpectrum DisneySheet::reflectance(float cos_theta) const {
    SampledSpectrum r((1 - tinted) * fresnel_dielectric(cos_theta, eta));
    if (tinted > 0) r += tinted * schlick(tinted_f0, cos_theta, eta);
    return clear * r;
}

DisneySheet::Shares DisneySheet::shares(Vec3f wo) const {
    const float cos_o = std::abs(wo.z);
    const Shares s{
        .reflected = average(reflectance(cos_o)) + 0.02f * clear,
        .crossing = clear * ((1 - fresnel_dielectric(cos_o, eta)) * average(color) + 0.02f),
        .diffuse = average(base.color) + 0.1f * average(base.sheen_color),
        .transmitting = average(transmitting),
    };
    const float total = std::max(s.reflected + s.crossing + s.diffuse + s.transmitting, 1e-9f);
    return {s.reflected / total, s.crossing / total, s.diffuse / total, s.transmitting / total};
}

SampledSpectrum DisneySheet::albedo(Vec3f wo) const {
    const float cos_o = std::abs(wo.z);
    return clamp(reflectance(cos_o) + clear * (1 - fresnel_dielectric(cos_o, eta)) * color + base.color +
                     transmitting,
                 0, 1);
}

BsdfEvaluation DisneySheet::evaluate(Vec3f wo, Vec3f wi, TransportMode) const {
    if (wo.z == 0 || wi.z == 0) return {};
    return wo.z > 0 ? evaluate(shares(wo), wo, wi) : evaluate(shares(wo), -wo, -wi);
}

BsdfEvaluation DisneySheet::evaluate(const Shares& p, Vec3f wo, Vec3f wi) const {
    BsdfEvaluation e;
    const bool reflects = wi.z > 0;
    const Vec3f above = reflects ? wi : mirrored_below(wi);
    if (clear > 0) {
        const auto facet = MicrofacetPair::find(reflects ? reflecting : crossing, wo, above, true, 1);
        if (facet) {
            const float c = facet->o_m;
            const SampledSpectrum share =
                reflects ? reflectance(c) : clear * (1 - fresnel_dielectric(c, eta)) * color;
            // Light that crosses a microfacet leaves on its other side, or is lost.
            if (reflects || dot(wi, facet->m) < 0) e.f += facet->density * facet->shadowing * share;
            e.pdf += (reflects ? p.reflected : p.crossing) * facet->density;
        }
    }
    const float cosine_pdf = inv_pi_f * above.z;
    e.f += reflects ? base.value(wo, wi) : cosine_pdf * transmitting;
    e.pdf += (reflects ? p.diffuse : p.transmitting) * cosine_pdf;
    return e;
}

std::optional<BsdfSample> DisneySheet::sample(Vec3f wo, TransportMode, float uc, Vec2f u) const {
    if (wo.z == 0) return std::nullopt;
    const bool below = wo.z < 0;
    if (below) wo = -wo;
    const Shares p = shares(wo);
    BsdfSample s;
    s.transmission = false;
    if (uc < p.reflected) {
        s.wi = reflect(wo, reflecting.sample_visible(wo, u));
    } else if ((uc -= p.reflected) < p.crossing) {
        s.wi = mirrored_below(reflect(wo, crossing.sample_visible(wo, u)));
        s.transmission = true;
    } else if ((uc -= p.crossing) < p.diffuse) {
        s.wi = sample_cosine_hemisphere(u);
    } else {
        s.wi = mirrored_below(sample_cosine_hemisphere(u));
        s.transmission = true;
    }
    if (s.wi.z == 0 || (s.wi.z < 0) != s.transmission) return std::nullopt;
    const BsdfEvaluation e = evaluate(p, wo, s.wi);
    if (!(e.pdf > 0)) return std::nullopt;
    s.weight = e.f / e.pdf;
    s.pdf = e.pdf;
    if (below) s.wi = -s.wi;
    return s;
}

} // namespace montelux
