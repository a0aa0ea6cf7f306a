// The principled BSDF against formulas of the glTF specification that are evaluated here, its energy, its limits.
#include "test/scene/bsdf_testing.h"
#include <cmath>
#include <gtest/gtest.h>

namespace montelux::testing {
namespace {

using Principled = PrincipledMaterial;

SampledSpectrum bsdf_value(const Bsdf& bsdf, Vec3f wo, Vec3f wi) {
    FixedStream unused({}, 0);
    return evaluate(bsdf, wo, wi, unused).f;
}

// glTF 2.0, appendix B.3.2: visibility times distribution; alpha along x and y.
double ggx_specular(Vec3f v, Vec3f l, double ax, double ay) {
    const Vec3f h = normalize(v + l);
    const double x = h.x / ax, y = h.y / ay, t = x * x + y * y + double(h.z) * h.z;
    const double d = 1 / (pi * ax * ay * t * t);
    const auto root = [&](Vec3f w) {
        return std::sqrt(ax * ax * w.x * w.x + ay * ay * w.y * w.y + double(w.z) * w.z);
    };
    return d * 0.5 / (v.z * root(l) + l.z * root(v));
}
double schlick(Vec3f v, Vec3f l, double f0) {
    return f0 + (1 - f0) * std::pow(1 - double(dot(v, normalize(v + l))), 5);
}

// KHR_materials_sheen.
double charlie(Vec3f v, Vec3f l, double roughness) {
    const double alpha = roughness * roughness;
    const auto lambda = [&](double x) {
        const double w = (1 - alpha) * (1 - alpha);
        const auto fit = [&](double t) {
            const double a = std::lerp(21.5473, 25.3245, w), b = std::lerp(3.82987, 3.32435, w),
                         c = std::lerp(0.19823, 0.16801, w), d = std::lerp(-1.97760, -1.27393, w),
                         e = std::lerp(-4.32054, -4.85967, w);
            return a / (1 + b * std::pow(t, c)) + d * t + e;
        };
        return x < 0.5 ? std::exp(fit(x)) : std::exp(2 * fit(0.5) - fit(1 - x));
    };
    const double nh = normalize(v + l).z;
    const double d = (2 + 1 / alpha) * std::pow(1 - nh * nh, 0.5 / alpha) / (2 * pi);
    return d / ((1 + lambda(v.z) + lambda(l.z)) * 4 * v.z * l.z);
}

// The albedo of f(v, l) without cosine, by the midpoint rule over the hemisphere.
template <typename F>
double integrated_albedo(Vec3f v, const F& f) {
    const int n = 200;
    double sum = 0;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const double t = (i + 0.5) / n, z = t * t, r = std::sqrt(1 - z * z), phi = 2 * pi * (j + 0.5) / n;
            sum += f(v, Vec3f{float(r * std::cos(phi)), float(r * std::sin(phi)), float(z)}) * z * 2 * t;
        }
    return sum * 2 * pi / (n * n);
}

const Vec3f some_directions[] = {direction(5, 20), direction(35, 130), direction(60, 250), direction(80, 10)};

template <typename F>
void expect_values(const Bsdf& bsdf, const F& expected) {
    for (Vec3f v : some_directions)
        for (Vec3f l : {direction(10, 100), direction(50, 300), direction(75, 190)}) {
            const double e = expected(v, l) * double(l.z);
            EXPECT_NEAR(bsdf_value(bsdf, v, l)[1], e, 2e-4 * e + 1e-7) << v.z << ' ' << l.z;
        }
}

TEST(Principled, DielectricReflectsAsInTheSpecification) {
    expect_values(principled(Principled{.base_color = {0},
                                        .roughness = {0.6f},
                                        .ior = {1.8f},
                                        .specular = {0.7f},
                                        .specular_color = {0.5f}}),
                  [](Vec3f v, Vec3f l) {
                      const double f0 = 0.5 * std::pow(0.8 / 2.8, 2);
                      return 0.7 * schlick(v, l, f0) * ggx_specular(v, l, 0.36, 0.36);
                  });
}

TEST(Principled, MetalReflectsAsInTheSpecification) {
    expect_values(principled(Principled{.base_color = {0.6f}, .metallic = {1}, .roughness = {0.5f}}),
                  [](Vec3f v, Vec3f l) { return schlick(v, l, 0.6) * ggx_specular(v, l, 0.25, 0.25); });
}

TEST(Principled, AnisotropyAsInTheSpecification) {
    const float angle = 0.5f;
    const auto turned = [&](Vec3f w) {
        return Vec3f{std::cos(angle) * w.x + std::sin(angle) * w.y,
                     std::cos(angle) * w.y - std::sin(angle) * w.x, w.z};
    };
    expect_values(principled(Principled{.base_color = {0.6f},
                                        .metallic = {1},
                                        .roughness = {0.5f},
                                        .anisotropy = {0.8f},
                                        .anisotropy_rotation = {angle}}),
                  [&](Vec3f v, Vec3f l) {
                      return schlick(v, l, 0.6) *
                             ggx_specular(turned(v), turned(l), 0.25 + 0.75 * 0.64, 0.25);
                  });
}

TEST(Principled, ClearcoatReflectsAsInTheSpecification) {
    expect_values(
        principled(Principled{.base_color = {0},
                              .roughness = {1},
                              .specular = {0},
                              .clearcoat = {0.8f},
                              .clearcoat_roughness = {0.5f}}),
        [](Vec3f v, Vec3f l) { return 0.8 * schlick(v, l, 0.04) * ggx_specular(v, l, 0.25, 0.25); });
}

TEST(Principled, CoatHasItsOwnNormal) {
    const Vec3f n = direction(25, 70);
    const Frame frame = Frame::from_normal(n);
    Bsdf bsdf = principled(Principled{.base_color = {0},
                                      .roughness = {1},
                                      .specular = {0},
                                      .clearcoat = {0.8f},
                                      .clearcoat_roughness = {0.5f}});
    std::get<PrincipledBsdf<false>>(bsdf).layers.set_coat_normal(n);
    int hidden = 0;
    for (Vec3f v : some_directions)
        for (Vec3f l : {direction(10, 100), direction(50, 300), direction(75, 190), direction(88, 250)}) {
            const Vec3f o = frame.to_local(v), i = frame.to_local(l);
            const bool faces = o.z > 0 && i.z > 0;
            hidden += faces ? 0 : 1;
            const double e =
                faces ? 0.8 * schlick(v, l, 0.04) * ggx_specular(o, i, 0.25, 0.25) * double(i.z) : 0;
            EXPECT_NEAR(bsdf_value(bsdf, v, l)[1], e, 2e-4 * e + 1e-7) << v.z << ' ' << l.z;
        }
    EXPECT_GT(hidden, 0);
}

TEST(Principled, SheenReflectsAsInTheSpecification) {
    for (float roughness : {0.4f, 0.7f, 1.0f})
        expect_values(
            principled(Principled{
                .base_color = {0}, .specular = {0}, .sheen_color = {0.6f}, .sheen_roughness = {roughness}}),
            [&](Vec3f v, Vec3f l) { return 0.6 * charlie(v, l, double(roughness)); });
}

// A layer leaves 1 - max(E(wo), E(wi)) to those below. `excess`: how much tables may be above E.
template <typename Layer>
void expect_base_below(const Bsdf& layered, const Layer& layer, double base, double excess) {
    for (Vec3f v : some_directions)
        for (Vec3f l : some_directions) {
            const double below = 1 - std::max(integrated_albedo(v, layer), integrated_albedo(l, layer));
            const double base_part = double(bsdf_value(layered, v, l)[1]) / double(l.z) - layer(v, l);
            EXPECT_LE(base_part, base / pi * below + 1e-3) << v.z << ' ' << l.z;
            EXPECT_GE(base_part, base / pi * (below - excess) - 1e-3) << v.z << ' ' << l.z;
        }
}

TEST(Principled, DiffuseBaseLiesBelowTheDielectric) {
    for (float roughness : {0.3f, 0.6f, 1.0f}) {
        const double a = double(roughness) * double(roughness);
        // Light that masking takes away is not given to the base.
        expect_base_below(
            principled(Principled{.base_color = {0.9f}, .roughness = {roughness}}),
            [&](Vec3f v, Vec3f l) { return schlick(v, l, 0.04) * ggx_specular(v, l, a, a); }, 0.9, 0.07);
    }
}

TEST(Principled, BaseLiesBelowTheCoat) {
    expect_base_below(
        principled(Principled{
            .base_color = {0.8f}, .specular = {0}, .clearcoat = {1}, .clearcoat_roughness = {0.5f}}),
        [](Vec3f v, Vec3f l) { return schlick(v, l, 0.04) * ggx_specular(v, l, 0.25, 0.25); }, 0.8, 0.07);
}

TEST(Principled, GrazingLightIsNeverNegative) {
    std::vector<Principled> materials;
    for (const float roughness : {0.0f, 0.2f, 0.37f, 1.0f}) {
        materials.push_back({.base_color = {0.9f},
                             .roughness = {0.6f},
                             .clearcoat = {1},
                             .clearcoat_roughness = {roughness},
                             .sheen_color = {1}});
        // A dielectric that reflects everything, white or nearly so, and an ordinary one.
        for (const float ior : {0.0f, 1.5f, 300.0f})
            materials.push_back({.base_color = {0.9f}, .roughness = {roughness}, .ior = {ior}});
        materials.push_back({.base_color = {0.9f},
                             .roughness = {roughness},
                             .anisotropy = {0.8f},
                             .ior = {0},
                             .specular = {0.9f},
                             .specular_color = {0.99f},
                             .sheen_color = {0.5f},
                             .sheen_roughness = {roughness}});
    }
    for (const Principled& material : materials) {
        const Bsdf bsdf = principled(material);
        for (int i = 0; i < 4000; ++i) {
            const float z = std::pow(10.0f, -7.0f * static_cast<float>(i) / 4000);
            const Vec3f wi{-std::sqrt(1 - z * z), 0, z}, wo{0.6f, 0, 0.8f};
            EXPECT_GE(min_value(bsdf_value(bsdf, wo, wi)), 0) << z;
            EXPECT_GE(min_value(bsdf_value(bsdf, wi, wo)), 0) << z;
        }
    }
}

TEST(Principled, BaseLiesBelowTheSheen) {
    expect_base_below(
        principled(Principled{
            .base_color = {0.8f}, .specular = {0}, .sheen_color = {0.7f}, .sheen_roughness = {0.5f}}),
        [](Vec3f v, Vec3f l) { return 0.7 * charlie(v, l, 0.5); }, 0.8, 0.04);
}

// The albedos of tables are upper bounds: otherwise layers would shine.
TEST(Principled, TablesBoundTheAlbedos) {
    for (float roughness : {0.33f, 0.47f, 0.8f, 0.97f})
        for (float theta : {0.0f, 25.0f, 50.0f, 65.0f, 80.0f, 86.0f}) {
            const Vec3f v = direction(double(theta), 0);
            const double a = double(roughness) * double(roughness);
            const double b = integrated_albedo(v, [&](Vec3f o, Vec3f l) {
                return std::pow(1 - double(dot(o, normalize(o + l))), 5) * ggx_specular(o, l, a, a);
            });
            const float alpha = roughness * roughness;
            EXPECT_GE(ggx_grazing_albedo({alpha, alpha}, v.z), b - 5e-4) << roughness << ' ' << theta;
            EXPECT_LE(ggx_grazing_albedo({alpha, alpha}, v.z), b + 0.05) << roughness << ' ' << theta;
            const double e =
                integrated_albedo(v, [&](Vec3f o, Vec3f l) { return charlie(o, l, double(roughness)); });
            EXPECT_GE(Sheen::from_roughness(roughness).albedo(v), e - 1e-3) << roughness << ' ' << theta;
            EXPECT_LE(Sheen::from_roughness(roughness).albedo(v), e + 0.04) << roughness << ' ' << theta;
        }
    EXPECT_NEAR(ggx_grazing_albedo({0, 0}, 0.5f), std::pow(0.5f, 5.0f), 0.01f);
    // Where fibres would reflect more than they receive.
    EXPECT_EQ(Sheen::from_roughness(0.1f).albedo(direction(89.5)), 1);
    EXPECT_EQ(Sheen::from_roughness(0).alpha, Sheen::from_roughness(Sheen::least_roughness).alpha);
}

// White furnace: the mean weight at the brightest wavelength over a lattice of random numbers (steps: powers of the
// inverse of the real root of x^4 = x + 1).
double furnace(const Bsdf& bsdf, Vec3f wo, std::uint32_t points) {
    double sum[spectrum_samples] = {};
    for (std::uint32_t i = 0; i < points; ++i) {
        const auto part = [&](double step) { return float(std::fmod((i + 0.5) * step, 1.0)); };
        FixedStream stream({part(0.8191725134), part(0.6710436067)}, part(0.5497004779));
        const auto s = sample(bsdf, wo, stream, TransportMode::importance);
        for (int k = 0; s && k < spectrum_samples; ++k) sum[k] += double(s->weight[k]);
    }
    return *std::max_element(sum, sum + spectrum_samples) / points;
}

template <typename Check>
void for_all_lobes(const Check& check) {
    for (unsigned lobes = 0; lobes < 256; ++lobes)
        for (float roughness : {0.0f, 0.15f, 0.4f, 0.7f, 1.0f}) {
            Principled m{.roughness = {roughness}};
            if (lobes & 1) m.metallic = {0.5f};
            if (lobes & 2) m.transmission = {0.5f};
            if (lobes & 4) m.diffuse_transmission = {0.5f};
            if (lobes & 8) m.clearcoat = {1}, m.clearcoat_roughness = {roughness};
            if (lobes & 16) m.sheen_color = {1}, m.sheen_roughness = {roughness};
            if (lobes & 32) m.iridescence = {1}, m.iridescence_ior = {1.8f};
            if (lobes & 64) m.anisotropy = {0.7f};
            if (lobes & 128) m.thin_walled = true;
            check(m, lobes, roughness);
        }
}

TEST(Principled, WhiteFurnaceWithAllLobes) {
    for_all_lobes([](const Principled& m, unsigned lobes, float roughness) {
        const Bsdf bsdf = principled(m);
        for (Vec3f wo : {direction(20, 30), direction(75, 100), direction(120, 20)})
            EXPECT_LT(furnace(bsdf, wo, 200), 1.04) << lobes << ' ' << roughness << ' ' << wo.z;
    });
}

TEST(PrincipledSlowTest, WhiteFurnaceWithAllLobes) {
    for_all_lobes([](const Principled& m, unsigned lobes, float roughness) {
        const Bsdf bsdf = principled(m);
        for (double theta : {0.0, 40.0, 60.0, 75.0, 85.0, 89.0, 100.0, 130.0, 170.0}) {
            const Vec3f wo = direction(theta, 35);
            double albedo = furnace(bsdf, wo, 8000);
            // At grazing angles on rough surfaces so few points are up to 0.012 off.
            if (!(albedo < 1.003)) albedo = furnace(bsdf, wo, 1 << 20);
            EXPECT_LT(albedo, 1.003) << lobes << ' ' << roughness << ' ' << theta;
        }
    });
}

// White materials lose little: what they do not reflect, masking takes away.
TEST(Principled, WhiteSmoothMaterialsKeepMostEnergy) {
    for (double theta : {10.0, 45.0, 70.0}) {
        const Vec3f wo = direction(theta);
        EXPECT_GT(furnace(principled(Principled{.roughness = {0}}), wo, 2000), 0.93);
        EXPECT_GT(furnace(principled(Principled{.metallic = {1}, .roughness = {0.2f}}), wo, 2000), 0.98);
        EXPECT_NEAR(furnace(principled(Principled{.roughness = {0}, .transmission = {1}}), wo, 2000), 1,
                    1e-3);
        EXPECT_NEAR(
            furnace(principled(Principled{.roughness = {0.2f}, .transmission = {1}, .thin_walled = true}), wo,
                    2000),
            1, 0.02);
    }
}

TEST(Principled, LayersOfWeightZeroAreNone) {
    const Principled plain{.base_color = {red_paint}, .roughness = {0.4f}};
    for (auto change : std::initializer_list<void (*)(Principled&)>{
             [](Principled& m) { m.clearcoat_roughness = {0.7f}; },
             [](Principled& m) { m.sheen_roughness = {0.7f}; },
             [](Principled& m) { m.iridescence_ior = {2}; },
             [](Principled& m) { m.iridescence = {1}, m.iridescence_thickness = {0}; },
             [](Principled& m) { m.anisotropy_rotation = {1}; },
             [](Principled& m) { m.diffuse_transmission_color = {blue_paint}; },
             [](Principled& m) { m.dispersion = {1}; },
         }) {
        Principled changed = plain;
        change(changed);
        for (Vec3f v : some_directions)
            for (Vec3f l : some_directions)
                for (int k = 0; k < 4; ++k)
                    EXPECT_NEAR(bsdf_value(principled(changed), v, l)[k],
                                bsdf_value(principled(plain), v, l)[k], 1e-6f);
    }
}

// Far below a wavelength the film is a bare interface, with Fresnel's equations instead of Schlick's.
TEST(Principled, FilmFadesWithItsThickness) {
    const Bsdf film = principled(Principled{
        .base_color = {0}, .roughness = {0.5f}, .iridescence = {1}, .iridescence_thickness = {0.1f}});
    expect_values(film, [](Vec3f v, Vec3f l) {
        return double(fresnel_dielectric(dot(v, normalize(v + l)), 1.5f)) * ggx_specular(v, l, 0.25, 0.25);
    });
}

TEST(Principled, OnlyWhatTransmitsIsOfTheTransmittingType) {
    const auto opaque = [](const Principled& m) { return is_opaque(principled(m)); };
    EXPECT_TRUE(opaque({}));
    EXPECT_TRUE(opaque({.metallic = {1}, .transmission = {1}, .diffuse_transmission = {1}}));
    EXPECT_FALSE(opaque({.transmission = {0.1f}}));
    EXPECT_FALSE(opaque({.diffuse_transmission = {0.1f}}));
}

TEST(Principled, SmoothGlassRefractsAndAPaneDoesNot) {
    const Vec3f wo = direction(50);
    FixedStream stream({}, 0.99f);
    const auto glass =
        sample(principled(Principled{.base_color = {0.5f}, .roughness = {0}, .transmission = {1}}), wo,
               stream, TransportMode::importance);
    ASSERT_TRUE(glass && glass->transmission && glass->specular);
    EXPECT_NEAR(std::hypot(glass->wi.x, glass->wi.y), std::sin(50 * pi / 180) / 1.5, 1e-5);
    const double passed = 1 - (0.04 + 0.96 * std::pow(1 - double(wo.z), 5));
    EXPECT_NEAR(glass->weight[0] * glass->pdf, 0.5 * passed, 1e-4);
    const auto pane =
        sample(principled(Principled{
                   .base_color = {0.5f}, .roughness = {0}, .transmission = {1}, .thin_walled = true}),
               wo, stream);
    ASSERT_TRUE(pane && pane->transmission);
    EXPECT_NEAR(length(pane->wi + wo), 0, 1e-6);
    EXPECT_NEAR(pane->weight[0] * pane->pdf, 0.5 * passed, 1e-4);
}

TEST(Principled, InsideGlassLightIsReflectedTotally) {
    for (float specular : {0.0f, 1.0f}) {
        const Bsdf glass =
            principled(Principled{.roughness = {0}, .specular = {specular}, .transmission = {1}});
        for (float uc : {0.01f, 0.5f, 0.99f}) {
            FixedStream stream({}, uc);
            const auto s = sample(glass, direction(130), stream);
            ASSERT_TRUE(s);
            EXPECT_FALSE(s->transmission);
            EXPECT_NEAR(s->weight[0], 1, 1e-5f);
        }
    }
}

// KHR_materials_dispersion: the Abbe number is (n_d - 1) / (n_F - n_C).
TEST(Principled, DispersionHasItsAbbeNumber) {
    const auto index = [](float wavelength, Principled m) {
        SampledWavelengths lambda = SampledWavelengths::sample_uniform(0, wavelength, wavelength + 1);
        const Bsdf bsdf = principled(m, lambda);
        EXPECT_EQ(lambda.secondary_terminated(), !m.thin_walled);
        return std::get<PrincipledBsdf<true>>(bsdf).layers.interface.eta;
    };
    const Principled glass{.ior = {1.6f}, .transmission = {1}, .dispersion = {0.5f}};
    EXPECT_NEAR(index(587.6f, glass), 1.6, 1e-4);
    EXPECT_NEAR(0.6 / double(index(486.1f, glass) - index(656.3f, glass)), 40, 0.2);
    EXPECT_EQ(
        index(500, Principled{.ior = {1.6f}, .transmission = {1}, .dispersion = {1}, .thin_walled = true}),
        1.6f);
    SampledWavelengths lambda = SampledWavelengths::sample_visible(0.5f);
    principled(Principled{.dispersion = {1}}, lambda);
    EXPECT_FALSE(lambda.secondary_terminated()) << "opaque surfaces do not refract";
}

// ior 0 stands for an infinite index (KHR_materials_ior): the specular colour is the reflectance.
TEST(Principled, IndexZeroIsInfinite) {
    const auto b =
        std::get<PrincipledBsdf<false>>(principled(Principled{.ior = {0}, .specular_color = {0.3f}}));
    EXPECT_FLOAT_EQ(b.layers.interface.dielectric_f0[0], 0.3f);
}

TEST(Principled, TextureValuesOutOfRangeAreLimited) {
    const Bsdf b = principled(Principled{.base_color = {7},
                                         .metallic = {-3},
                                         .roughness = {9},
                                         .ior = {1.5f},
                                         .specular = {5},
                                         .transmission = {-1},
                                         .clearcoat = {4},
                                         .sheen_color = {-2},
                                         .iridescence = {2},
                                         .iridescence_ior = {0}});
    EXPECT_LT(furnace(b, direction(40), 500), 1.02);
    EXPECT_FALSE(has_nan(bsdf_value(b, direction(40), direction(20, 80))));
}

} // namespace
} // namespace montelux::testing
