#include "montelux/scene/bsdf/multiscatter_dielectric.h"

#include "montelux/scene/bsdf/microsurface_walk.h"

namespace montelux {

namespace {

// ln Gamma(x), x >= 1: Stirling's series from 8 on, with an error below 1e-9.
double log_gamma(double x) {
    double product = 1;
    for (; x < 8; x += 1) product *= x;
    const double r = 1 / x, r2 = r * r;
    return (x - 0.5) * std::log(x) - x + 0.91893853320467274 + r * (1.0 / 12 - r2 * (1.0 / 360 - r2 / 1260)) -
           std::log(product);
}

// The masking of light that passes one facet over the correlated one, B(1 + a, 1 + b) (1 + a + b), for Lambda = a and b
// on the two sides.
float transmission_masking(float a, float b) {
    const double x = double(a), y = double(b);
    if (!(x + y < 1e8)) return 0; // in the plane of the surface
    return static_cast<float>(std::exp(log_gamma(1 + x) + log_gamma(1 + y) - log_gamma(1 + x + y)));
}

// A walk on either side of an interface.
struct InterfaceWalk {
    MicrosurfaceWalk walk; // in the frame of the side where the light is
    float eta;             // index below that side over that above
    bool beyond = false; // the light is on the other side than at first; the frame is reflected about a point

    // Reflects or refracts at a facet. False if rounding has gone wrong.
    bool scatters(PhiloxStream& rng) {
        const Vec3f v = -walk.w, m = walk.sample_facet(rng.next_2d());
        const float cosine = dot(v, m);
        if (!(cosine > 0)) return false;
        const float u = rng.next_1d();
        if (!(u < fresnel_dielectric(cosine, eta)))
            if (const auto refraction = refract(v, m, eta)) {
                walk.w = -refraction->wt;
                walk.log_height = walk.log_height_beyond();
                eta = 1 / eta;
                beyond = !beyond;
                return true;
            }
        walk.w = reflect(v, m);
        return true;
    }

    // Density of scattering at the next facet into wi (in the first frame), times the probability of leaving.
    float leaves_along(Vec3f wi) const {
        if (beyond) wi = -wi;
        const Vec3f v = -walk.w;
        const bool reflects = wi.z > 0;
        Vec3f m = reflects ? v + wi : v + wi * eta;
        const float len2 = length_squared(m);
        if (!(len2 > 0)) return 0;
        m = m / std::sqrt(len2);
        if (m.z < 0) m = -m;
        const float v_m = dot(v, m), i_m = dot(wi, m);
        if (!(v_m > 0) || (i_m > 0) != reflects || !(m.z > 0)) return 0;
        const float r = fresnel_dielectric(v_m, eta);
        const float d = walk.ggx.d(m) * walk.facet_density_scale();
        if (reflects) return r * d / 4 * walk.escape(wi);
        const float denominator = i_m + v_m / eta;
        return (1 - r) * d * v_m * std::abs(i_m) / (denominator * denominator) *
               walk.escape(-wi, walk.log_height_beyond());
    }
};

} // namespace

float MultiscatterDielectricBsdf::further_events(Vec3f wo, Vec3f wi, PhiloxStream& rng) const {
    float eta = facets.eta;
    if (wo.z < 0) {
        wo.z = -wo.z;
        wi.z = -wi.z;
        eta = 1 / eta;
    }
    InterfaceWalk light{{facets.normals, -wo}, eta};
    float sum = 0;
    for (int event = 0; event < MicrosurfaceWalk::most_events; ++event) {
        if (!light.walk.advance(rng.next_1d())) break;
        if (event > 0) sum += light.leaves_along(wi);
        if (!light.scatters(rng)) break;
    }
    return sum;
}

float MultiscatterDielectricBsdf::pdf_lobes(Vec3f wo, Vec3f wi, TransportMode mode, Lobes lobes) const {
    const float first = facets.evaluate_lobes(wo, wi, mode, lobes).pdf;
    if (is_specular()) return first;
    if (lobes != Lobes::both && same_hemisphere(wo, wi) != (lobes == Lobes::reflection)) return 0;
    const float further = share_of_further_events(facets.normals);
    const float sides = lobes == Lobes::both ? 0.5f : 1;
    return (1 - further) * first + further * sides * inv_pi_f * abs_cos_theta(wi);
}

BsdfEvaluation MultiscatterDielectricBsdf::evaluate_lobes(Vec3f wo, Vec3f wi, TransportMode mode, Lobes lobes,
                                                          PhiloxStream& rng) const {
    if (is_specular() || wo.z == 0 || wi.z == 0) return {};
    const bool reflects = same_hemisphere(wo, wi);
    if (lobes != Lobes::both && reflects != (lobes == Lobes::reflection)) return {};
    float f = facets.evaluate_lobes(wo, wi, mode, lobes).f[0];
    float further = further_events(wo, wi, rng);
    if (!reflects) {
        f *= transmission_masking(facets.normals.lambda(wo), facets.normals.lambda(wi));
        const float eta = facets.transmitted_eta(wo);
        if (mode == TransportMode::radiance) further /= eta * eta;
    }
    return {SampledSpectrum(f + further), pdf_lobes(wo, wi, mode, lobes)};
}

std::optional<BsdfSample> MultiscatterDielectricBsdf::sample_lobes(Vec3f wo, float uc, Vec2f u,
                                                                   TransportMode mode, Lobes lobes) const {
    if (is_specular()) return facets.sample_lobes(wo, uc, u, mode, lobes);
    if (wo.z == 0) return std::nullopt;
    PhiloxStream rng = PhiloxStream::of_pair(u);
    const bool below = wo.z < 0;
    InterfaceWalk light{{facets.normals, below ? Vec3f{-wo.x, -wo.y, wo.z} : -wo},
                        below ? 1 / facets.eta : facets.eta};
    for (int event = 0; light.walk.advance(rng.next_1d()); ++event)
        if (event == MicrosurfaceWalk::most_events || !light.scatters(rng)) return std::nullopt;
    BsdfSample s;
    s.wi = light.beyond ? -light.walk.w : light.walk.w;
    if (s.wi.z == 0) return std::nullopt;
    if (below) s.wi.z = -s.wi.z;
    s.transmission = light.beyond;
    if (lobes != Lobes::both && s.transmission == (lobes == Lobes::reflection)) return std::nullopt;
    s.eta = s.transmission ? facets.transmitted_eta(wo) : 1;
    s.pdf = pdf_lobes(wo, s.wi, mode, lobes);
    s.weight = SampledSpectrum(s.transmission && mode == TransportMode::radiance ? 1 / (s.eta * s.eta) : 1);
    if (!(s.pdf > 0)) return std::nullopt;
    return s;
}

} // namespace montelux
