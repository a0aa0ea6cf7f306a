#include "montelux/scene/bsdf/principled.h"

#include "montelux/mc/warp/hemisphere.h"
#include "montelux/scene/bsdf/microfacet_pair.h"

namespace montelux {

// What depends on wo alone: albedos, and the probabilities with which `sample` chooses among the lobes, in
// proportion to their estimated albedos.
struct PrincipledLayers::Shares {
    float coat_albedo;
    SampledSpectrum sheen_albedo, dielectric_albedo;
    float coat, sheen, interface, diffuse, transmitting;

    float total() const { return coat + sheen + interface + diffuse + transmitting; }
    void normalize() {
        const float t = total();
        if (!(t > 0)) return;
        for (float* p : {&coat, &sheen, &interface, &diffuse, &transmitting}) *p /= t;
    }
};

namespace {

// Between reflection and transmission at a microfacet.
float reflection_probability(SampledSpectrum reflectance, SampledSpectrum transmittance) {
    const float r = average(reflectance), t = average(transmittance);
    return r + t > 0 ? r / (r + t) : 1;
}

Vec3f through_plane(Vec3f w) { return {w.x, w.y, -w.z}; }

} // namespace

bool PrincipledLayers::is_specular() const {
    return is_black(diffuse) && is_black(transmitting) && is_black(sheen_color) &&
           interface.ggx.is_smooth() && (coat == 0 || coat_ggx.is_smooth());
}
bool PrincipledLayers::has_specular() const {
    return interface.ggx.is_smooth() || (interface.is_clear() && interface.is_straight()) ||
           (coat > 0 && coat_ggx.is_smooth());
}

void PrincipledLayers::set_coat_normal(Normal3f n) {
    // Upright at least a little, so that z follows from x and y.
    const float sine = std::sqrt(n.x * n.x + n.y * n.y);
    constexpr float most_sine = 0.999f;
    const float shrink = n.z > 0 && sine < most_sine ? 1 : most_sine / std::max(sine, 1e-6f);
    coat_tilt = {n.x * shrink, n.y * shrink};
}
Frame PrincipledLayers::coat_frame() const {
    const float x = coat_tilt.x, y = coat_tilt.y;
    return Frame::from_normal({x, y, std::sqrt(std::max(1 - x * x - y * y, 0.0f))});
}
Vec3f PrincipledLayers::in_coat(Vec3f w) const {
    if (!is_coat_tilted()) return w;
    const Vec3f turned = coat_frame().to_local(w);
    return same_hemisphere(w, turned) ? turned : Vec3f{};
}
Vec3f PrincipledLayers::from_coat(Vec3f w) const { return is_coat_tilted() ? coat_frame().to_world(w) : w; }

float PrincipledLayers::coat_albedo(Vec3f w) const {
    if (coat == 0 || !is_outside(w)) return 0;
    const float cosine = abs_cos_theta(in_coat(w));
    if (cosine == 0 && is_coat_tilted()) return 0;
    return coat * ggx_schlick_albedo(coat_ggx, cosine, SampledSpectrum(coat_f0), 1)[0];
}
SampledSpectrum PrincipledLayers::sheen_albedo(Vec3f w) const {
    if (is_black(sheen_color) || !is_outside(w)) return SampledSpectrum(0);
    return sheen.albedo(w) * sheen_color;
}

float PrincipledLayers::below_coat(const Shares& p, Vec3f wi) const {
    return 1 - std::max(p.coat_albedo, coat_albedo(wi));
}
SampledSpectrum PrincipledLayers::below_sheen(const Shares& p, Vec3f wi) const {
    return 1.0f - max(p.sheen_albedo, sheen_albedo(wi));
}
SampledSpectrum PrincipledLayers::below_interface(const Shares& p, Vec3f wi) const {
    return 1.0f - max(p.dielectric_albedo, interface.dielectric_albedo(abs_cos_theta(wi)));
}

Vec3f PrincipledLayers::turned(Vec3f w) const {
    const float c = interface.turn_cos, s = interface.turn_sin;
    return {c * w.x + s * w.y, c * w.y - s * w.x, w.z};
}
Vec3f PrincipledLayers::turned_back(Vec3f w) const {
    const float c = interface.turn_cos, s = interface.turn_sin;
    return {c * w.x - s * w.y, c * w.y + s * w.x, w.z};
}

// Of the light that arrives at a denser side from all directions, only the squared ratio of the indices can cross; the
// rest is reflected diffusely.
SampledSpectrum PrincipledLayers::lambertian_reflectance(Vec3f wo) const {
    const float eta = transmitted_eta(wo);
    return eta < 1 ? diffuse + (1 - eta * eta) * transmitting : diffuse;
}

PrincipledLayers::Shares PrincipledLayers::shares(Vec3f wo) const {
    const float cos_o = abs_cos_theta(wo);
    const bool above = wo.z > 0;
    Shares s{};
    s.coat = s.coat_albedo = coat_albedo(wo);
    const SampledSpectrum fibres = s.sheen_albedo = sheen_albedo(wo);
    s.sheen = (1 - s.coat) * average(fibres);
    const SampledSpectrum rest = (1 - s.coat) * (1.0f - fibres);

    SampledSpectrum through(0), reflected = interface.metal * interface.metal_albedo(cos_o);
    if (interface.dielectric > 0) {
        const SampledSpectrum r = s.dielectric_albedo = interface.dielectric_albedo(cos_o);
        reflected += interface.dielectric * r;
        s.diffuse = average(rest * lambertian_reflectance(wo) * (1.0f - r));
        s.transmitting = average(rest * transmitting * (1.0f - r));
        if (interface.is_clear()) {
            through = interface.transmittance(cos_o, above);
            if (!above) reflected = interface.reflectance(cos_o, above);
            // Microfacets at other angles may transmit more, or reflect totally.
            reflected += SampledSpectrum(0.02f * interface.clear * interface.dielectric);
        }
    }
    s.interface = average(rest * (reflected + through));
    s.normalize();
    return s;
}

SampledSpectrum PrincipledLayers::albedo(Vec3f wo) const {
    const float cos_o = abs_cos_theta(wo);
    const bool above = wo.z > 0;
    const float coated = coat_albedo(wo);
    const SampledSpectrum fibres = sheen_albedo(wo);
    SampledSpectrum base = (diffuse + transmitting) * (1.0f - interface.dielectric_albedo(cos_o));
    if (interface.is_clear())
        base += interface.reflectance(cos_o, above) + interface.transmittance(cos_o, above);
    else
        base += interface.dielectric * interface.dielectric_albedo(cos_o) +
                interface.metal * interface.metal_albedo(cos_o);
    return clamp(coated + (1 - coated) * (fibres + (1.0f - fibres) * base), 0, 1);
}

BsdfEvaluation PrincipledLayers::evaluate(Vec3f wo, Vec3f wi, TransportMode mode) const {
    if (wo.z == 0 || wi.z == 0) return {};
    return evaluate(shares(wo), wo, wi, mode);
}

BsdfEvaluation PrincipledLayers::evaluate(const Shares& p, Vec3f wo, Vec3f wi, TransportMode mode) const {
    const bool reflects = same_hemisphere(wo, wi);
    const bool above = wo.z > 0;
    const float eta_p = reflects ? 1 : transmitted_eta(wo);
    const float crossing = mode == TransportMode::radiance ? 1 / (eta_p * eta_p) : 1;
    SampledSpectrum base(0);
    float pdf = 0;

    if (!interface.ggx.is_smooth() && (reflects || (interface.is_clear() && !interface.is_straight()))) {
        const Vec3f o = turned(wo), i = turned(wi);
        const bool mirrors = reflects || interface.thin;
        const auto facet = MicrofacetPair::find(
            interface.ggx, o, reflects || !interface.thin ? i : through_plane(i), mirrors, eta_p);
        if (facet) {
            const float c = std::abs(facet->o_m);
            const SampledSpectrum r = interface.reflectance(c, above);
            const SampledSpectrum t =
                interface.is_clear() ? interface.transmittance(c, above) : SampledSpectrum(0);
            const float p_reflect = reflection_probability(r, t);
            base += facet->density * facet->shadowing * (reflects ? r : t * crossing);
            pdf += p.interface * facet->density * (reflects ? p_reflect : 1 - p_reflect);
        }
    }
    SampledSpectrum lambertian = reflects ? lambertian_reflectance(wo) : transmitting;
    if (!is_black(lambertian)) {
        if (!reflects)
            lambertian *= std::min(1.0f, mode == TransportMode::radiance ? crossing : eta_p * eta_p);
        const float cosine_pdf = inv_pi_f * abs_cos_theta(wi);
        base += cosine_pdf * lambertian * below_interface(p, wi);
        pdf += (reflects ? p.diffuse : p.transmitting) * cosine_pdf;
    }
    const float under_coat = below_coat(p, wi);
    SampledSpectrum f = under_coat * below_sheen(p, wi) * base;
    if (reflects && is_outside(wo)) {
        if (!is_black(sheen_color)) {
            f += under_coat * sheen.value(wo, wi) * sheen_color;
            pdf += p.sheen * inv_two_pi_f;
        }
        if (coat > 0 && !coat_ggx.is_smooth()) {
            const Vec3f o = in_coat(wo), i = in_coat(wi);
            const bool faces = o.z != 0 && i.z != 0;
            if (const auto facet = faces ? MicrofacetPair::find(coat_ggx, o, i, true, 1) : std::nullopt) {
                const SampledSpectrum r = fresnel_schlick(std::abs(facet->o_m), SampledSpectrum(coat_f0), 1);
                f += coat * facet->density * facet->shadowing * r;
                pdf += p.coat * facet->density;
            }
        }
    }
    return {f, pdf};
}

std::optional<BsdfSample> PrincipledLayers::sample(Vec3f wo, TransportMode mode, float uc, Vec2f u) const {
    if (wo.z == 0) return std::nullopt;
    const Shares p = shares(wo);
    if (!(p.total() > 0)) return std::nullopt;

    const auto to_side = [&](Vec3f w, bool same) { return (wo.z > 0) == same ? w : through_plane(w); };
    BsdfSample s;
    if (uc < p.interface) {
        auto chosen = sample_interface(p, wo, mode, uc / p.interface, u);
        if (!chosen || chosen->specular) return chosen;
        s = *chosen;
    } else if ((uc -= p.interface) < p.diffuse) {
        s.wi = to_side(sample_cosine_hemisphere(u), true);
    } else if ((uc -= p.diffuse) < p.transmitting) {
        s.wi = to_side(sample_cosine_hemisphere(u), false);
    } else if ((uc -= p.transmitting) < p.sheen) {
        s.wi = to_side(sample_uniform_hemisphere(u), true);
    } else if (p.coat > 0) {
        const Vec3f o = in_coat(wo);
        const bool smooth = coat_ggx.is_smooth();
        s.wi = from_coat(smooth ? Vec3f{-o.x, -o.y, o.z} : reflect(o, coat_ggx.sample_visible(o, u)));
        if (!same_hemisphere(wo, s.wi)) return std::nullopt;
        if (smooth) {
            const SampledSpectrum r = fresnel_schlick(abs_cos_theta(o), SampledSpectrum(coat_f0), 1);
            return BsdfSample{.weight = coat / p.coat * r, .wi = s.wi, .pdf = p.coat, .specular = true};
        }
    } else {
        return std::nullopt;
    }
    if (s.wi.z == 0) return std::nullopt;
    const BsdfEvaluation e = evaluate(p, wo, s.wi, mode);
    if (!(e.pdf > 0)) return std::nullopt;
    s.weight = e.f / e.pdf;
    s.pdf = e.pdf;
    s.transmission = !same_hemisphere(wo, s.wi);
    s.eta = s.transmission ? transmitted_eta(wo) : 1;
    return s;
}

// Weight and density only of delta lobes.
std::optional<BsdfSample> PrincipledLayers::sample_interface(const Shares& p, Vec3f wo, TransportMode mode,
                                                             float uc, Vec2f u) const {
    const bool above = wo.z > 0, smooth = interface.ggx.is_smooth();
    const Vec3f o = turned(wo);
    const Vec3f m = smooth ? Vec3f{0, 0, 1} : interface.ggx.sample_visible(o, u);
    const float c = std::abs(dot(o, m));
    const SampledSpectrum r = interface.reflectance(c, above);
    const SampledSpectrum t = interface.is_clear() ? interface.transmittance(c, above) : SampledSpectrum(0);
    const float p_reflect = reflection_probability(r, t);
    const bool reflects = uc < p_reflect;

    BsdfSample s;
    s.specular = smooth;
    s.transmission = !reflects;
    if (reflects) {
        s.wi = smooth ? Vec3f{-o.x, -o.y, o.z} : reflect(o, m);
    } else if (interface.thin) {
        s.wi = smooth ? -o : through_plane(reflect(o, m));
    } else if (interface.is_straight()) {
        s.wi = -o;
        s.specular = true;
    } else {
        const auto refraction = refract(o, m, interface.eta);
        if (!refraction) return std::nullopt;
        s.wi = refraction->wt;
        s.eta = refraction->eta;
    }
    if (same_hemisphere(o, s.wi) != reflects || s.wi.z == 0) return std::nullopt;
    s.wi = turned_back(s.wi);
    if (!s.specular) return s;
    s.pdf = p.interface * (reflects ? p_reflect : 1 - p_reflect);
    s.weight = below_coat(p, s.wi) * below_sheen(p, s.wi) * (reflects ? r : t) / s.pdf;
    if (!reflects && mode == TransportMode::radiance) s.weight /= s.eta * s.eta;
    return s;
}

} // namespace montelux
