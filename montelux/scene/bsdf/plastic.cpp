#include "montelux/scene/bsdf/plastic.h"

#include <cmath>

namespace montelux {

namespace {

struct Crossing {
    double transmitted = 0, reflected = 0;
};

// What the interface lets pass and reflects of light from wo, whose cosine is negative from the inside: the mean
// over the visible normals at the points of a lattice (Sloan and Joe 1994, "Lattice Methods for Multiple Integration").
Crossing crossing(const DielectricBsdfOf<MicrofacetNormals>& interface, float cos_theta) {
    if (interface.is_specular()) {
        const double r = static_cast<double>(fresnel_dielectric(cos_theta, interface.eta));
        return {1 - r, r};
    }
    constexpr int n = 987, generator = 610; // neighbours in Fibonacci's sequence
    const MicrofacetNormals& normals = interface.normals;
    const Vec3f wo{std::sqrt(std::max(0.0f, 1 - cos_theta * cos_theta)), 0, cos_theta};
    const auto left = [&](Vec3f wi) { // by the masking of wi
        const InverseMasking masking = normals.inverse_masking(wo, wi);
        return static_cast<double>(masking.visible / masking.both);
    };
    Crossing sum;
    for (int i = 0; i < n; ++i) {
        const int j = i * generator % n;
        const Vec3f m = normals.sample_visible(
            wo, {(static_cast<float>(i) + 0.5f) / n, (static_cast<float>(j) + 0.5f) / n});
        const auto r = static_cast<double>(fresnel_dielectric(dot(wo, m), interface.eta));
        if (const Vec3f wi = reflect(wo, m); same_hemisphere(wo, wi)) sum.reflected += r * left(wi);
        if (const auto refraction = refract(wo, m, interface.eta))
            if (wo.z * refraction->wt.z < 0) sum.transmitted += (1 - r) * left(refraction->wt);
    }
    return {sum.transmitted / n, sum.reflected / n};
}

} // namespace

PlasticTable::PlasticTable(float eta, float alpha, MicrofacetDistribution distribution)
    : eta_(eta), transmittance_(129) {
    const DielectricBsdfOf<MicrofacetNormals> interface {
        eta, { Ggx{alpha, alpha}, distribution }
    };
    for (std::size_t i = 0; i < transmittance_.size(); ++i) {
        // At grazing incidence the interface reflects everything.
        const float mu = static_cast<float>(i) / static_cast<float>(transmittance_.size() - 1);
        transmittance_[i] = static_cast<float>(crossing(interface, std::max(mu, 1e-4f)).transmitted);
    }
    // Midpoint rules in mu^2, the measure of a cosine-weighted hemisphere.
    const auto mean = [](int cells, const auto& value) {
        double sum = 0;
        for (int i = 0; i < cells; ++i)
            sum += value(std::sqrt((static_cast<float>(i) + 0.5f) / static_cast<float>(cells)));
        return static_cast<float>(sum / cells);
    };
    mean_transmittance_ = mean(4096, [&](float mu) { return static_cast<double>(transmittance(mu)); });
    // A smooth interface has a sharp critical angle.
    internal_reflectance_ = mean(interface.is_specular() ? 20000 : 64,
                                 [&](float mu) { return crossing(interface, -mu).reflected; });
}

} // namespace montelux
