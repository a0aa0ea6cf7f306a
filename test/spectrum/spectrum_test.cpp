#include <gtest/gtest.h>

#include "montelux/mc/math/error.h"
#include "montelux/mc/stats/chi_squared.h"
#include "montelux/spectrum/spectrum.h"

namespace montelux {
namespace {

SampledWavelengths at(float a, float b, float c, float d) {
    SampledWavelengths w;
    w.lambda = Float4{a, b, c, d};
    w.pdf = SampledSpectrum(1);
    return w;
}

TEST(Spectrum, SampleAgreesWithEvaluationForEveryKind) {
    const RgbColorSpace& space = RgbColorSpace::srgb();
    const float lambda[] = {350, 400, 433, 580, 900}, values[] = {1, 3, 2, 5, 4};
    const Spectrum kinds[] = {Spectrum(0.7f),
                              Spectrum(SpectrumTable::from([](float l) { return l * l; })),
                              Spectrum(PiecewiseLinear(lambda, values)),
                              BlackbodySpectrum(3000),
                              RgbAlbedoSpectrum(space, {0.2f, 0.5f, 0.1f}),
                              RgbUnboundedSpectrum(space, {3, 0.5f, 0.1f}),
                              RgbIlluminantSpectrum(space, {3, 0.5f, 8})};
    TestUniforms uniforms(2);
    for (const Spectrum& s : kinds) {
        float largest = s.max_value();
        for (int i = 0; i < 2000; ++i) {
            auto w = SampledWavelengths::sample_visible(uniforms.next_float());
            SampledSpectrum v = s.sample(w);
            for (int k = 0; k < 4; ++k) {
                EXPECT_NEAR(v[k], s(w.lambda[k]), 2e-6f * (1 + std::abs(v[k]))) << s.kind().index();
                EXPECT_LE(v[k], largest * 1.00001f) << s.kind().index();
            }
        }
    }
}

TEST(Spectrum, TablesTakeTheNearestNanometre) {
    SpectrumTable t = SpectrumTable::from([](float l) { return l; });
    EXPECT_EQ(t.sample(at(360, 360.49f, 360.51f, 829.6f)), SampledSpectrum(360, 360, 361, 830));
    EXPECT_EQ(t(444.4f), 444);
    EXPECT_EQ(t(359.4f), 0);
    EXPECT_EQ(t(830.6f), 0);
    EXPECT_EQ(t.max_value(), 830);
}

TEST(PiecewiseLinear, InterpolatesAndIsZeroOutside) {
    const float pairs[] = {400, 1, 400.25f, 2, 400.5f, 0, 600, 4};
    PiecewiseLinear s = PiecewiseLinear::from_pairs(pairs);
    EXPECT_EQ(s(400), 1);
    EXPECT_FLOAT_EQ(s(400.125f), 1.5f);
    EXPECT_FLOAT_EQ(s(400.375f), 1);
    EXPECT_NEAR(s(500.25f), 2, 1e-5);
    EXPECT_FLOAT_EQ(s(600), 4);
    EXPECT_EQ(s(399.9f), 0);
    EXPECT_EQ(s(600.1f), 0);
    EXPECT_EQ(s.max_value(), 4);
    PiecewiseLinear wide = PiecewiseLinear::from_pairs(pairs, SpectrumEnds::constant);
    EXPECT_EQ(wide(360), 1);
    EXPECT_FLOAT_EQ(wide(830), 4);
}

TEST(PiecewiseLinear, AgreesWithASearchForRandomKnots) {
    TestUniforms uniforms(4);
    std::vector<float> lambda, values;
    float l = 250;
    while (l < 1000) {
        lambda.push_back(l);
        values.push_back(uniforms.next_float());
        float gap = uniforms.next_float();
        l += 0.01f + 8 * gap * gap * gap;
    }
    PiecewiseLinear s(lambda, values);
    for (int i = 0; i < 20000; ++i) {
        float x = lambda.front() + (lambda.back() - lambda.front()) * uniforms.next_float();
        std::size_t k = static_cast<std::size_t>(std::ranges::upper_bound(lambda, x) - lambda.begin()) - 1;
        k = std::min(k, lambda.size() - 2);
        double t = (x - lambda[k]) / (lambda[k + 1] - lambda[k]);
        ASSERT_NEAR(s(x), (1 - t) * values[k] + t * values[k + 1], 1e-4) << x;
    }
}

// The lines go on beyond both ends of the visible range, where the values are larger still.
TEST(PiecewiseLinear, LargestValueMayBeAtEitherEndOfTheVisibleRange) {
    const float lambda[] = {300, 900}, rising[] = {0, 600}, falling[] = {600, 0};
    EXPECT_NEAR(PiecewiseLinear(lambda, rising).max_value(), 830 - 300, 1e-3);
    EXPECT_NEAR(PiecewiseLinear(lambda, falling).max_value(), 900 - 360, 1e-3);
}

TEST(PiecewiseLinear, ScalesItsValuesAtKnotsAndBetweenThem) {
    const float lambda[] = {380, 450, 451, 620, 800}, values[] = {1, 3, 0.5f, 8, 2};
    const PiecewiseLinear plain(lambda, values);
    PiecewiseLinear scaled = plain;
    scaled.scale(2.5f);
    for (float l = 360; l <= 830; l += 0.25f) ASSERT_NEAR(scaled(l), 2.5f * plain(l), 1e-4) << l;
    EXPECT_EQ(scaled.max_value(), 20);
}

TEST(PiecewiseLinear, BadKnotsAreRefused) {
    const float ascending[] = {400, 500}, equal[] = {400, 400}, two[] = {1, 2}, one[] = {1};
    const float nan_value[] = {1, std::numeric_limits<float>::quiet_NaN()};
    EXPECT_NO_THROW(PiecewiseLinear(ascending, two));
    EXPECT_THROW(PiecewiseLinear(equal, two), Error);
    EXPECT_THROW(PiecewiseLinear(ascending, one), Error);
    EXPECT_THROW(PiecewiseLinear(ascending, nan_value), Error);
    EXPECT_THROW(PiecewiseLinear({}, {}), Error);
    EXPECT_THROW(PiecewiseLinear::from_pairs(one), Error);
}

TEST(Blackbody, FollowsPlanckWienAndStefanBoltzmann) {
    for (double t : {1500.0, 5772.0, 9000.0}) {
        // Integral over all wavelengths in steps of the logarithm: sigma T^4 / pi.
        double sum = 0;
        for (double x = std::log(20.0); x < std::log(1e7); x += 1e-3) {
            double lambda = std::exp(x);
            sum += planck_radiance(lambda, t) * lambda * 1e-3;
        }
        EXPECT_NEAR(sum / (5.670374419e-8 * t * t * t * t / pi), 1, 2e-6);
        double peak = wien_displacement * 1e9 / t;
        EXPECT_GT(planck_radiance(peak, t), planck_radiance(peak * 1.001, t));
        EXPECT_GT(planck_radiance(peak, t), planck_radiance(peak * 0.999, t));
    }
    EXPECT_EQ(planck_radiance(500, 0), 0);
    // 2 h c^2 / (l^5 (e^x - 1)) worked out by hand for 500 nm and 6000 K.
    EXPECT_NEAR(planck_radiance(500, 6000), 31757, 1); // W/(m^2 sr nm)
}

TEST(Blackbody, SpectrumIsRelativeToItsPeak) {
    for (float t : {500.0f, 2700.0f, 6500.0f, 30000.0f}) {
        BlackbodySpectrum s(t);
        double peak = planck_radiance(wien_displacement * 1e9 / t, t);
        for (float lambda : {360.0f, 450.0f, 555.0f, 700.0f, 830.0f})
            EXPECT_NEAR(s(lambda) / (planck_radiance(lambda, t) / peak), 1, 2e-5) << t << " " << lambda;
    }
    BlackbodySpectrum cold(20);
    EXPECT_EQ(cold.sample(at(360, 400, 500, 600)), SampledSpectrum(0));
}

TEST(Spectrum, IntegralsAgreeWithTheObserver) {
    Spectrum one(1.0f);
    EXPECT_NEAR(to_photometric(one), cie_y_integral, 1e-4);
    Vec3d equal_energy = to_xyz(one);
    EXPECT_NEAR(equal_energy.y, 1, 1e-7);
    EXPECT_NEAR(chromaticity(equal_energy).x, 1.0 / 3, 1e-4);
    EXPECT_NEAR(chromaticity(equal_energy).y, 1.0 / 3, 1e-4);
    EXPECT_NEAR(inner_product(Spectrum(2.0f), Spectrum(3.0f)), 6.0 * visible_samples, 1e-9);
    // The colour of a light does not count in its photometric integral.
    const RgbColorSpace& space = RgbColorSpace::srgb();
    EXPECT_EQ(to_photometric(RgbIlluminantSpectrum(space, {5, 1, 0})),
              to_photometric(RgbIlluminantSpectrum(space, {1, 1, 1})));
}

TEST(Spectrum, TabulationKeepsIntegrals) {
    Spectrum s = BlackbodySpectrum(4000);
    EXPECT_NEAR(to_photometric(Spectrum(s.tabulate(3))), 3 * to_photometric(s), 1e-4);
}

TEST(RgbColorSpace, MatricesAgreeWithTheStandards) {
    // IEC 61966-2-1, to the four decimals that it prints.
    const Matrix3& m = RgbColorSpace::srgb().xyz_from_rgb();
    const double standard[3][3] = {
        {0.4124, 0.3576, 0.1805}, {0.2126, 0.7152, 0.0722}, {0.0193, 0.1192, 0.9505}};
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) EXPECT_NEAR(m.rows[i][j], standard[i][j], 3e-4);
    for (auto name : rgb_color_space_names()) {
        const RgbColorSpace& space = *find_rgb_color_space(name);
        EXPECT_EQ(space.name(), name);
        Matrix3 identity = space.rgb_from_xyz() * space.xyz_from_rgb();
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) EXPECT_NEAR(identity.rows[i][j], i == j, 1e-12);
        Vec2d red = chromaticity(space.xyz_from_rgb() * Vec3d(1, 0, 0));
        EXPECT_NEAR(red.x, space.red().x, 1e-12);
        Vec3d white = space.xyz_from_rgb() * Vec3d(1, 1, 1);
        EXPECT_NEAR(white.y, 1, 1e-6);
    }
    EXPECT_EQ(find_rgb_color_space("sRGB"), &RgbColorSpace::srgb());
    EXPECT_EQ(find_rgb_color_space("srgb2"), nullptr);
    EXPECT_NEAR(RgbColorSpace::aces2065_1().white().x, 0.32168, 2e-4);
    EXPECT_NEAR(RgbColorSpace::aces2065_1().white().y, 0.33767, 2e-4);
}

} // namespace
} // namespace montelux
