// Every BSDF: density, weights, reciprocity, energy. False alarms below 1e-5 for all tests together.
#include "test/scene/bsdf_testing.h"
#include <gtest/gtest.h>

#include "montelux/mc/stats/moments.h"

namespace montelux::testing {
namespace {

class EveryBsdf : public ::testing::TestWithParam<std::size_t> {
  protected:
    const BsdfCase c = all_bsdf_cases()[GetParam()];
    const Bsdf bsdf = c.make();
};

std::string case_name(const ::testing::TestParamInfo<std::size_t>& info) {
    return all_bsdf_cases()[info.param].name;
}

INSTANTIATE_TEST_SUITE_P(Bsdf, EveryBsdf, ::testing::Range(std::size_t{0}, all_bsdf_cases().size()),
                         case_name);

const Vec3f directions_out[] = {direction(10, 20), direction(50, 100), direction(80, 300), direction(125, 10),
                                direction(165, 200)};

TEST_P(EveryBsdf, SamplesFollowThePdf) {
    if (is_specular(bsdf) || !c.exact_pdf) GTEST_SKIP() << "no density to test";
    std::uint64_t seed = 1;
    for (Vec3f wo : directions_out) {
        auto draw = [&](Vec2f u, float uc) -> std::optional<Vec3f> {
            FixedStream stream(u, uc);
            auto s = sample(bsdf, wo, stream);
            if (!s || s->specular) return std::nullopt;
            return s->wi;
        };
        auto pdf = [&](Vec3f wi) {
            FixedStream stream({0.5f, 0.5f}, 0.5f);
            return evaluate(bsdf, wo, wi, stream).pdf;
        };
        TestResult r = spherical_chi_squared_test(
            draw, pdf, {.samples = 50000, .cells_x = 16, .cells_y = 24, .seed = seed++});
        EXPECT_TRUE(r.passes(1e-8)) << r.description;
    }
}

TEST_P(EveryBsdf, WeightsAreValueOverPdf) {
    if (!c.exact_pdf) GTEST_SKIP() << "the value is estimated anew each time";
    TestStream stream(7);
    int checked = 0;
    for (Vec3f wo : directions_out)
        for (int i = 0; i < 2000; ++i) {
            auto s = sample(bsdf, wo, stream);
            if (!s) continue;
            EXPECT_NEAR(length(s->wi), 1, 1e-4);
            EXPECT_GT(s->pdf, 0);
            if (s->specular) continue;
            BsdfEvaluation e = evaluate(bsdf, wo, s->wi, stream);
            EXPECT_NEAR(e.pdf, s->pdf, 2e-3f * s->pdf + 1e-5f) << c.name;
            for (int k = 0; k < 4; ++k)
                EXPECT_NEAR(e.f[k] / e.pdf, s->weight[k], 5e-3f * s->weight[k] + 1e-4f) << c.name;
            ++checked;
        }
    EXPECT_TRUE(is_specular(bsdf) || checked > 1000);
}

// f(wo, wi) / eta_i^2 is symmetric (Veach 1997, section 5.2); evaluate holds the cosine of wi too.
TEST_P(EveryBsdf, IsReciprocal) {
    if (is_specular(bsdf)) GTEST_SKIP() << "delta lobes have no value";
    if (!c.reciprocal) GTEST_SKIP() << "the model is not reciprocal";
    TestStream stream(11);
    const int repeats = c.exact_pdf ? 1 : 15000;
    const int pairs = c.exact_pdf ? 200 : 4;
    for (int i = 0; i < pairs; ++i) {
        Vec3f wo =
            direction(std::acos(1 - 2 * double(stream.next_1d())) * 180 / pi, 360 * double(stream.next_1d()));
        Vec3f wi =
            direction(std::acos(1 - 2 * double(stream.next_1d())) * 180 / pi, 360 * double(stream.next_1d()));
        const bool transmits = std::visit([](const auto& b) { return b.traits.transmits; }, bsdf);
        if (!c.exact_pdf && !transmits && wo.z * wi.z < 0) wi.z = -wi.z;
        RunningMoments forward, backward;
        for (int n = 0; n < repeats; ++n) {
            forward.add(double(evaluate(bsdf, wo, wi, stream).f[1] / std::abs(wi.z)));
            backward.add(double(evaluate(bsdf, wi, wo, stream).f[1] / std::abs(wo.z)));
        }
        double a = forward.mean(), b = backward.mean();
        if (wo.z * wi.z < 0) {
            // Radiance is larger by the squared index on the denser side.
            a *= transmitted_eta(bsdf, wo);
            b *= transmitted_eta(bsdf, wi);
        }
        double tolerance = 2e-4 * (a + b) + 1e-6;
        if (!c.exact_pdf) tolerance = 6 * std::hypot(forward.standard_error(), backward.standard_error());
        EXPECT_NEAR(a, b, tolerance) << c.name;
    }
}

// The traits say what samples do: which side they leave on, and how the index changes there.
TEST_P(EveryBsdf, SamplesAreAsTheTraitsSay) {
    TestStream stream(23);
    int transmitted = 0;
    for (Vec3f wo : directions_out)
        for (int i = 0; i < 500; ++i) {
            auto s = sample(bsdf, wo, stream);
            if (!s) continue;
            EXPECT_EQ(s->transmission, !same_hemisphere(wo, s->wi)) << c.name;
            transmitted += s->transmission ? 1 : 0;
            EXPECT_NEAR(s->eta, s->transmission ? transmitted_eta(bsdf, wo) : 1, 1e-6f) << c.name;
        }
    EXPECT_EQ(transmitted > 0, std::visit([](const auto& b) { return b.traits.transmits; }, bsdf)) << c.name;
}

// Tilted BSDFs hand on one number and one pair, and no pair to evaluate what is not stochastic.
TEST_P(EveryBsdf, TakesNoMoreNumbersThanTheConceptSays) {
    struct Counted {
        TestStream source{31};
        int numbers = 0, pairs = 0;
        float next_1d() {
            ++numbers;
            return source.next_1d();
        }
        Vec2f next_2d() {
            ++pairs;
            return source.next_2d();
        }
    };
    for (Vec3f wo : directions_out)
        for (Vec3f wi : directions_out)
            std::visit(
                [&]<typename B>(const B& b) {
                    Counted sampling, evaluation;
                    b.sample(wo, TransportMode::radiance, sampling);
                    EXPECT_LE(sampling.numbers, 1) << c.name;
                    EXPECT_LE(sampling.pairs, 1) << c.name;
                    b.evaluate(wo, wi, TransportMode::radiance, evaluation);
                    EXPECT_EQ(evaluation.numbers, 0) << c.name;
                    EXPECT_LE(evaluation.pairs, B::traits.stochastic ? 1 : 0) << c.name;
                },
                bsdf);
}

// Without a tangent in its traits a BSDF does not see that wo and wi are turned about the normal.
TEST_P(EveryBsdf, TurnsWithTheTangentsOnlyIfItSaysSo) {
    if (is_specular(bsdf) || std::visit([](const auto& b) { return b.traits.uses_tangents; }, bsdf))
        GTEST_SKIP() << "no value, or lobes that may turn";
    TestStream stream(29);
    auto turned = [](Vec3f w) { return Vec3f{0.6f * w.x - 0.8f * w.y, 0.8f * w.x + 0.6f * w.y, w.z}; };
    for (Vec3f wo : directions_out)
        for (Vec3f wi : {direction(20, 60), direction(70, 200), direction(150, 30)}) {
            const BsdfEvaluation a = evaluate(bsdf, wo, wi, stream);
            const BsdfEvaluation b = evaluate(bsdf, turned(wo), turned(wi), stream);
            EXPECT_NEAR(a.f[0], b.f[0], 2e-5f * a.f[0] + 1e-7f) << c.name;
            EXPECT_NEAR(a.pdf, b.pdf, 2e-5f * a.pdf + 1e-7f) << c.name;
        }
}

// Value and probability of each side of a sheet.
TEST(DiffuseTransmission, SidesHaveTheirShares) {
    const DiffuseTransmissionBsdf b{SampledSpectrum(0.6f), SampledSpectrum(0.3f)};
    for (Vec3f wo : {direction(30), direction(150)}) {
        FixedStream stream({0.3f, 0.4f}, 0);
        const Vec3f wi = direction(40, 70);
        const bool reflects = same_hemisphere(wo, wi);
        const BsdfEvaluation e = b.evaluate(wo, wi, TransportMode::radiance, stream);
        EXPECT_NEAR(e.f[0], (reflects ? 0.6f : 0.3f) * inv_pi_f * wi.z, 1e-6f);
        EXPECT_NEAR(e.pdf, (reflects ? 2 : 1) / 3.0f * inv_pi_f * wi.z, 1e-6f);
        TestStream random(31);
        RunningMoments reflected, transmitted;
        for (int i = 0; i < 40000; ++i) {
            auto s = b.sample(wo, TransportMode::radiance, random);
            ASSERT_TRUE(s);
            const bool same = same_hemisphere(wo, s->wi);
            reflected.add(same ? double(s->weight[0]) : 0);
            transmitted.add(same ? 0 : double(s->weight[0]));
        }
        EXPECT_NEAR(reflected.mean(), 0.6, 6 * reflected.standard_error());
        EXPECT_NEAR(transmitted.mean(), 0.3, 6 * transmitted.standard_error());
    }
    EXPECT_FALSE(b.traits.uses_tangents);
    EXPECT_FLOAT_EQ(b.albedo(direction(10))[0], 0.9f);
}

// Importance that leaves a lossless surface equals what came in; with losses it is less. Of the principled BSDFs at each
// wavelength alone: what one lobe leaves of a colour another may scatter. The mean of the greatest weight is more.
TEST_P(EveryBsdf, ConservesEnergy) {
    TestStream stream(13);
    for (Vec3f wo : directions_out) {
        RunningMoments albedo[spectrum_samples], most;
        for (int i = 0; i < 50000; ++i) {
            auto s = sample(bsdf, wo, stream, TransportMode::importance);
            most.add(s ? double(max_value(s->weight)) : 0);
            for (int k = 0; k < spectrum_samples; ++k) albedo[k].add(s ? double(s->weight[k]) : 0);
        }
        double greatest = 0;
        for (const RunningMoments& a : albedo) {
            EXPECT_LT(a.mean(), 1 + 6 * a.standard_error() + 1e-4) << c.name;
            greatest = std::max(greatest, a.mean());
        }
        if (c.black_below && wo.z < 0) {
            EXPECT_EQ(greatest, 0) << c.name;
        } else {
            EXPECT_GT(greatest, 0.05) << c.name;
        }
        if (!c.name.starts_with("principled")) {
            EXPECT_LT(most.mean(), 1 + 6 * most.standard_error() + 1e-4) << c.name;
        }
    }
}

// The mean of the weights is the integral of the value over directions: nothing is sampled too rarely or left
// out.
TEST_P(EveryBsdf, MeanWeightIsTheIntegralOfTheValue) {
    if (is_specular(bsdf)) GTEST_SKIP() << "delta lobes have no value";
    TestStream stream(17);
    for (Vec3f wo : {direction(30, 40), direction(70, 10), direction(140, 70)}) {
        RunningMoments sampled, integrated;
        for (int i = 0; i < 50000; ++i) {
            auto s = sample(bsdf, wo, stream);
            sampled.add(s && !s->specular ? double(s->weight[2]) : 0);
            // Half cosine-weighted about both poles, half around the mirror direction.
            Vec2f u = stream.next_2d();
            float z = 1 - 2 * u.x, r = std::sqrt(std::max(0.0f, 1 - z * z));
            Vec3f wi{r * std::cos(two_pi_f * u.y), r * std::sin(two_pi_f * u.y), z};
            integrated.add(double(evaluate(bsdf, wo, wi, stream).f[2]) * 4 * pi);
        }
        EXPECT_NEAR(sampled.mean(), integrated.mean(),
                    6 * std::hypot(sampled.standard_error(), integrated.standard_error()))
            << c.name;
    }
}

} // namespace
} // namespace montelux::testing
