#include "montelux/scene/bsdf/coating.h"

namespace montelux {

namespace {

constexpr int table_size = 257;

struct Integrals {
    double transmitted = 0, reflected = 0;
};

// Albedos of the interface for light from wo, weighted by the absorption of the layer along each direction:
// transmitted light always crosses it, reflected light only on the inside.
Integrals interface_integrals(const DielectricBsdf& coat, float mu, float thickness, bool from_inside) {
    Vec3f wo{std::sqrt(std::max(0.0f, 1 - mu * mu)), 0, from_inside ? -mu : mu};
    auto absorption = [&](Vec3f w) { return std::exp(-double(thickness) / std::abs(double(w.z))); };
    Integrals sum;
    // Midpoint rule over the microfacets: exact in the limit of a smooth interface with a single point.
    const int n1 = coat.is_specular() ? 1 : 16, n2 = coat.is_specular() ? 1 : 64;
    for (int i = 0; i < n1; ++i)
        for (int j = 0; j < n2; ++j) {
            Vec2f u{(static_cast<float>(i) + 0.5f) / static_cast<float>(n1),
                    (static_cast<float>(j) + 0.5f) / static_cast<float>(n2)};
            float r = coat.is_specular()
                          ? fresnel_dielectric(wo.z, coat.eta)
                          : fresnel_dielectric(dot(wo, coat.normals.sample_visible(wo, u)), coat.eta);
            auto reflected = coat.sample_lobes(wo, 0, u, TransportMode::importance, Lobes::reflection);
            if (reflected && r > 0)
                sum.reflected += double(reflected->weight[0]) * (from_inside ? absorption(reflected->wi) : 1);
            auto transmitted = coat.sample_lobes(wo, 1, u, TransportMode::importance, Lobes::transmission);
            if (transmitted && r < 1)
                sum.transmitted += double(transmitted->weight[0]) * absorption(transmitted->wi);
        }
    sum.reflected /= n1 * n2;
    sum.transmitted /= n1 * n2;
    return sum;
}

} // namespace

CoatingTable::CoatingTable(float eta, float alpha, float thickness, int max_depth)
    : coat_{eta, {alpha, alpha}}, base_visits_((max_depth + 1) / 2), transmittance_(table_size),
      reflectance_(table_size) {
    for (int i = 0; i < table_size; ++i) {
        // At grazing incidence the interface reflects everything.
        float mu = std::max(static_cast<float>(i) / (table_size - 1), 1e-4f);
        Integrals outside = interface_integrals(coat_, mu, thickness, false);
        transmittance_[static_cast<std::size_t>(i)] = static_cast<float>(outside.transmitted);
        reflectance_[static_cast<std::size_t>(i)] = static_cast<float>(outside.reflected);
    }
    // Midpoint rule in mu^2, the measure of a cosine-weighted hemisphere.
    constexpr int cells = 512;
    double transmitted = 0, reflected = 0;
    for (int i = 0; i < cells; ++i) {
        float mu = std::sqrt((static_cast<float>(i) + 0.5f) / cells);
        transmitted += double(transmittance(mu));
        Integrals inside = interface_integrals(coat_, mu, thickness, true);
        reflected += inside.reflected * std::exp(-double(thickness) / double(mu));
    }
    mean_transmittance_ = static_cast<float>(transmitted / cells);
    internal_reflectance_ = static_cast<float>(reflected / cells);
}

} // namespace montelux
