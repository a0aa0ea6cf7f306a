// Rough surfaces with multiple scattering between microfacets. False alarms below 1e-6 for each test.
#include "test/scene/bsdf_testing.h"
#include <gtest/gtest.h>

#include "montelux/mc/math/special.h"
#include "montelux/mc/stats/moments.h"
#include "montelux/scene/bsdf/microsurface_walk.h"
#include "montelux/scene/bsdf/multiple_scattering.h"

namespace montelux::testing {
namespace {

// Fresnel's formula gives 1 for an index of i.
ConductorBsdf white_metal(Ggx ggx) { return {SampledSpectrum(0), SampledSpectrum(1), ggx}; }

const Ggx surfaces[] = {{0.01f, 0.01f}, {0.1f, 0.1f},  {0.3f, 0.3f}, {0.6f, 0.6f},
                        {1, 1},         {0.05f, 0.8f}, {1, 0.01f},   {2.5f, 2.5f}};
const Vec3f directions_above[] = {direction(0), direction(40, 30), direction(75, 200), direction(88, 100)};

std::string text(const Ggx& ggx, Vec3f wo) {
    return "alpha " + std::to_string(ggx.alpha_x) + ", " + std::to_string(ggx.alpha_y) + ", cos " +
           std::to_string(wo.z);
}

double mean_weight(const auto& bsdf, Vec3f wo, int samples, TransportMode mode = TransportMode::importance) {
    TestStream stream(3);
    double sum = 0;
    for (int i = 0; i < samples; ++i)
        if (auto s = bsdf.sample(wo, mode, stream)) sum += double(s->weight[0]);
    return sum / samples;
}

// The integral of the value, by samples of two densities: that of single scattering, and a cosine.
template <typename Single, typename Multiple>
RunningMoments integral_of(const Single& single, const Multiple& multiple, Vec3f wo, int samples) {
    TestStream stream(5);
    RunningMoments moments;
    const bool both_sides = Multiple::traits.transmits;
    for (int i = 0; i < samples; ++i) {
        Vec3f wi;
        if (stream.next_1d() < 0.7f) {
            const auto s = single.sample(wo, TransportMode::importance, stream);
            if (!s) {
                moments.add(0);
                continue;
            }
            wi = s->wi;
        } else {
            wi = sample_cosine_hemisphere(stream.next_2d());
            if (wi.z == 0) continue;
            if ((both_sides && stream.next_1d() < 0.5f) != (wo.z < 0)) wi.z = -wi.z;
        }
        const float density = 0.7f * single.evaluate(wo, wi, TransportMode::importance, stream).pdf +
                              0.3f * inv_pi_f * std::abs(wi.z) *
                                  (both_sides                ? 0.5f
                                   : same_hemisphere(wo, wi) ? 1.0f
                                                             : 0.0f);
        moments.add(double(multiple.evaluate(wo, wi, TransportMode::importance, stream).f[0] / density));
    }
    return moments;
}

// A furnace: what does not absorb returns all, whatever its roughness. Samples end after many events or by rounding.
TEST(MultipleScattering, MetalsThatAbsorbNothingAreWhite) {
    for (const Ggx& ggx : surfaces)
        for (Vec3f wo : directions_above) {
            EXPECT_NEAR(mean_weight(MultiscatterConductorBsdf{white_metal(ggx)}, wo, 10000), 1, 3e-4)
                << text(ggx, wo);
            EXPECT_NEAR(mean_weight(MultiscatterConductorBsdf{white_metal(ggx)}, {wo.x, wo.y, -wo.z}, 10000),
                        1, 3e-4)
                << text(ggx, wo);
        }
}

TEST(MultipleScattering, GlassReflectsAndTransmitsAllLight) {
    for (const Ggx& ggx : surfaces)
        for (float eta : {1.5f, 0.7f, 3.0f})
            for (Vec3f wo : directions_above) {
                const MultiscatterDielectricBsdf glass{{eta, ggx}};
                EXPECT_NEAR(mean_weight(glass, wo, 5000), 1, 5e-4) << text(ggx, wo);
                EXPECT_NEAR(mean_weight(glass, {wo.x, wo.y, -wo.z}, 5000), 1, 5e-4) << text(ggx, wo);
            }
}

// The same of the values, which are computed in another way than the samples.
TEST(MultipleScattering, ValuesReturnAllLight) {
    for (const Ggx& ggx : {Ggx{0.2f, 0.2f}, Ggx{0.6f, 0.6f}, Ggx{1, 1}, Ggx{0.3f, 0.9f}})
        for (Vec3f wo : {direction(10, 30), direction(65, 200), direction(130, 40)}) {
            const ConductorBsdf metal = white_metal(ggx);
            const DielectricBsdf glass{1.5f, ggx};
            const RunningMoments m = integral_of(metal, MultiscatterConductorBsdf{metal}, wo, 200000);
            EXPECT_NEAR(m.mean(), 1, 5.5 * m.standard_error()) << text(ggx, wo);
            EXPECT_LT(m.standard_error(), 5e-3) << text(ggx, wo);
            const RunningMoments g = integral_of(glass, MultiscatterDielectricBsdf{glass}, wo, 200000);
            EXPECT_NEAR(g.mean(), 1, 5.5 * g.standard_error()) << text(ggx, wo);
            EXPECT_LT(g.standard_error(), 9e-3) << text(ggx, wo);
        }
}

// At alpha 1, D is constant: of light along the normal, 1 - ln 2 leaves after one reflection. The rest goes on.
TEST(MultipleScattering, SingleReflectionAtNormalIncidenceHasAClosedForm) {
    const ConductorBsdf metal = white_metal({1, 1});
    const int n = 400000;
    TestStream stream(9);
    RunningMoments single;
    for (int i = 0; i < n; ++i) {
        const auto s = metal.sample({0, 0, 1}, TransportMode::radiance, stream);
        single.add(s ? double(s->weight[0]) : 0);
    }
    EXPECT_NEAR(single.mean(), 1 - std::log(2.0), 5.5 * single.standard_error());
}

// Light of each further reflection is coloured once more.
TEST(MultipleScattering, FurtherReflectionsAreSaturated) {
    const SampledSpectrum eta(0.2f, 0.4f, 0.9f, 1.1f), k(3.9f, 3.0f, 2.4f, 2.1f);
    const ConductorBsdf metal{eta, k, {0.9f, 0.9f}};
    TestStream stream(10);
    const Vec3f wo = direction(30);
    RunningMoments single[4], multiple[4];
    for (int i = 0; i < 200000; ++i) {
        const auto s = metal.sample(wo, TransportMode::radiance, stream);
        const auto m = MultiscatterConductorBsdf{metal}.sample(wo, TransportMode::radiance, stream);
        for (int c = 0; c < 4; ++c) {
            single[c].add(s ? double(s->weight[c]) : 0);
            multiple[c].add(m ? double(m->weight[c]) : 0);
        }
    }
    double fresnel[4], whole_single = 0; // reflectance of one facet, and the energy of single scattering
    for (int i = 0; i < 4; ++i) fresnel[i] = double(fresnel_conductor(0.8f, eta, k)[i]);
    {
        TestStream again(10);
        RunningMoments white;
        for (int i = 0; i < 200000; ++i) {
            const auto s = white_metal({0.9f, 0.9f}).sample(wo, TransportMode::radiance, again);
            white.add(s ? double(s->weight[0]) : 0);
        }
        whole_single = white.mean();
    }
    for (int c = 0; c < 4; ++c) {
        // All further events together reflect between F^10 and F^2 of their light, per unit.
        const double share = (multiple[c].mean() - single[c].mean()) / (1 - whole_single);
        EXPECT_LT(share, std::pow(fresnel[c], 2) * 1.02) << c;
        EXPECT_GT(share, std::pow(fresnel[c], 4)) << c;
    }
    EXPECT_GT(multiple[0].mean() / multiple[3].mean(), single[0].mean() / single[3].mean() * 1.05);
}

// Walks of low throughput end by Russian roulette: the mean is that of walks to their end.
TEST(MultipleScattering, RouletteKeepsTheMean) {
    const ConductorBsdf metal{SampledSpectrum(2.5f), SampledSpectrum(3), {3, 3}};
    const Vec3f wo = direction(25);
    TestStream stream(27);
    RunningMoments ended, followed;
    for (int i = 0; i < 300000; ++i) {
        const auto s = MultiscatterConductorBsdf{metal}.sample(wo, TransportMode::radiance, stream);
        ended.add(s ? double(s->weight[0]) : 0);
        MicrosurfaceWalk walk{metal.normals, -wo};
        float weight = 1;
        while (walk.advance(stream.next_1d())) {
            const Vec3f v = -walk.w, m = walk.sample_facet(stream.next_2d());
            weight *= fresnel_conductor(dot(v, m), metal.eta, metal.k)[0];
            walk.w = reflect(v, m);
        }
        followed.add(double(weight));
    }
    EXPECT_NEAR(ended.mean(), followed.mean(),
                5.5 * std::hypot(ended.standard_error(), followed.standard_error()));
    EXPECT_LT(ended.standard_error(), 2e-3);
}

// Samples of a white metal have weight 1, so their density is the value.
TEST(MultipleScattering, WhiteSamplesFollowTheValue) {
    constexpr int rows = 6, columns = 12, samples = 200000, points = 4000;
    for (const auto& [ggx, wo] :
         {std::pair{Ggx{0.4f, 0.4f}, direction(60, 20)}, std::pair{Ggx{0.3f, 1.0f}, direction(30, 250)},
          std::pair{Ggx{1, 1}, direction(85, 0)}}) {
        const MultiscatterConductorBsdf metal{white_metal(ggx)};
        TestStream stream(21);
        std::vector<double> observed(rows * columns);
        for (int i = 0; i < samples; ++i) {
            const auto s = metal.sample(wo, TransportMode::radiance, stream);
            ASSERT_TRUE(s);
            const int row = std::min(static_cast<int>(s->wi.z * rows), rows - 1);
            const double phi = std::atan2(double(s->wi.y), double(s->wi.x)) / (2 * pi) + 0.5;
            ++observed[static_cast<std::size_t>(row * columns +
                                                std::min(static_cast<int>(phi * columns), columns - 1))];
        }
        double chi_squared = 0;
        for (int row = 0; row < rows; ++row)
            for (int column = 0; column < columns; ++column) {
                RunningMoments value;
                for (int i = 0; i < points; ++i) {
                    const Vec2f u = stream.next_2d();
                    const float z = (static_cast<float>(row) + u.x) / rows;
                    const float phi = two_pi_f * ((static_cast<float>(column) + u.y) / columns - 0.5f);
                    const float r = std::sqrt(1 - z * z);
                    value.add(double(metal
                                         .evaluate(wo, {r * std::cos(phi), r * std::sin(phi), z},
                                                   TransportMode::radiance, stream)
                                         .f[0]));
                }
                const double solid_angle = 2 * pi / (rows * columns), p = value.mean() * solid_angle;
                const double difference =
                    observed[static_cast<std::size_t>(row * columns + column)] / samples - p;
                const double error = value.standard_error() * solid_angle;
                chi_squared += difference * difference / (p / samples + error * error);
            }
        EXPECT_GT(chi_squared_p_value(chi_squared, rows * columns), 1e-8) << text(ggx, wo);
    }
}

TEST(MultipleScattering, ReplacesRoughMicrofacetsOnly) {
    const auto replaced = [](const Bsdf& b) { return with_multiple_scattering(b); };
    const Ggx rough{0.3f, 0.5f}, smooth{};
    EXPECT_TRUE(std::holds_alternative<MultiscatterConductorBsdf>(replaced(white_metal(rough))));
    EXPECT_TRUE(std::holds_alternative<ConductorBsdf>(replaced(white_metal(smooth))));
    EXPECT_TRUE(std::holds_alternative<MultiscatterDielectricBsdf>(replaced(DielectricBsdf{1.5f, rough})));
    EXPECT_TRUE(std::holds_alternative<DielectricBsdf>(replaced(DielectricBsdf{1.5f, smooth})));
    EXPECT_TRUE(std::holds_alternative<DielectricBsdf>(replaced(DielectricBsdf{1, rough})));
    EXPECT_TRUE(std::holds_alternative<DiffuseBsdf>(replaced(DiffuseBsdf{})));
    const TintedDielectricBsdf tinted{{1.5f, {rough, MicrofacetDistribution::beckmann}}};
    EXPECT_TRUE(std::holds_alternative<TintedDielectricBsdf>(replaced(tinted)));
    const Bsdf tilted = replaced(TiltedBsdf{white_metal(rough), direction(10), 0.3f});
    ASSERT_TRUE(std::holds_alternative<TiltedBsdf>(tilted));
    EXPECT_TRUE(std::holds_alternative<MultiscatterConductorBsdf>(std::get<TiltedBsdf>(tilted).base));
    EXPECT_EQ(std::get<TiltedBsdf>(tilted).geometric_normal, direction(10));
    EXPECT_EQ(std::get<TiltedBsdf>(tilted).shadowing, 0.3f);

    using RoughDiffuse = LayeredBsdf<DiffuseBsdf, MultiscatterDielectricBsdf>;
    using RoughConductor = LayeredBsdf<MultiscatterConductorBsdf, MultiscatterDielectricBsdf>;
    const Bsdf coated = replaced(in_fog(layered_diffuse(0.4f, 0.6f), 7));
    ASSERT_TRUE(std::holds_alternative<RoughDiffuse>(coated));
    const auto& layers = std::get<RoughDiffuse>(coated);
    const auto original = in_fog(layered_diffuse(0.4f, 0.6f), 7);
    EXPECT_EQ(layers.coat.facets.normals.alpha_x, 0.4f);
    EXPECT_EQ(layers.base.reflectance, original.base.reflectance);
    EXPECT_EQ(layers.medium_albedo, original.medium_albedo);
    EXPECT_EQ(layers.g, original.g);
    EXPECT_EQ(layers.thickness, original.thickness);
    EXPECT_EQ(layers.max_depth, original.max_depth);
    EXPECT_EQ(layers.sample_count, original.sample_count);
    EXPECT_TRUE(std::holds_alternative<RoughConductor>(replaced(layered_conductor(0, 0.3f))));
    EXPECT_TRUE(std::holds_alternative<RoughConductor>(replaced(layered_conductor(0.2f, 0))));
    EXPECT_TRUE(std::holds_alternative<LayeredBsdf<ConductorBsdf>>(replaced(layered_conductor(0, 0))));
    EXPECT_TRUE(std::holds_alternative<LayeredBsdf<DiffuseBsdf>>(replaced(layered_diffuse(0, 0.5f))));
}

// A white base under a rough coat that absorbs nothing, for walks that are long enough.
TEST(MultipleScattering, CoatsOverWhiteBasesLoseNothing) {
    for (float alpha : {0.2f, 0.7f})
        for (Vec3f wo : {direction(20, 30), direction(70, 10)}) {
            LayeredBsdf<DiffuseBsdf> diffuse = cut_at(layered_diffuse(alpha, 1), 4000);
            diffuse.thickness = 1e-30f;
            LayeredBsdf<ConductorBsdf> metal = cut_at(layered_conductor(alpha, 0.5f), 4000);
            metal.thickness = 1e-30f;
            metal.base = white_metal({0.5f, 0.5f});
            for (const Bsdf& b : {with_multiple_scattering(diffuse), with_multiple_scattering(metal)})
                EXPECT_NEAR(std::visit([&](const auto& x) { return mean_weight(x, wo, 20000); }, b), 1, 1e-3)
                    << alpha;
        }
}

} // namespace
} // namespace montelux::testing
