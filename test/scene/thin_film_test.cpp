// Thin films against the transfer matrices of optics.
#include <array>
#include <cmath>
#include <complex>
#include <gtest/gtest.h>

#include "montelux/scene/bsdf/fresnel.h"
#include "montelux/scene/bsdf/thin_film.h"

namespace montelux {
namespace {

using Complex = std::complex<double>;

// The characteristic matrix of one layer between air and a substrate (Born and Wolf, section 1.6), the mean of both
// polarisations.
double transfer_matrix_reflectance(double cos1, double n2, double n3, double thickness, double wavelength) {
    const double sin1 = std::sqrt(1 - cos1 * cos1);
    const double cos2 = std::sqrt(1 - sin1 * sin1 / (n2 * n2)), cos3 = std::sqrt(1 - sin1 * sin1 / (n3 * n3));
    const double beta = 2 * pi / wavelength * n2 * thickness * cos2;
    double sum = 0;
    for (bool s : {true, false}) {
        const double p1 = s ? cos1 : 1 / cos1, p2 = s ? n2 * cos2 : n2 / cos2, p3 = s ? n3 * cos3 : n3 / cos3;
        const Complex i(0, 1), c = std::cos(beta), d = std::sin(beta);
        const Complex b = c + i * d / p2 * p3, h = i * p2 * d + c * p3;
        sum += std::norm((p1 * b - h) / (p1 * b + h));
    }
    return sum / 2;
}

constexpr Float4 film_lambda{400, 500, 600, 700};

TEST(ThinFilm, EqualsTransferMatrices) {
    for (float cos1 : {1.0f, 0.8f, 0.5f, 0.2f, 0.05f})
        for (float n2 : {1.1f, 1.3f, 1.5f, 2.2f})
            for (float n3 : {1.0f, 1.33f, 1.5f, 3.0f, 20.0f})
                for (float thickness : {10.0f, 150.0f, 400.0f, 1200.0f}) {
                    const SampledSpectrum r =
                        ThinFilm::make(n2, thickness, film_lambda).reflectance(cos1, SampledSpectrum(n3));
                    for (int k = 0; k < 4; ++k)
                        EXPECT_NEAR(
                            r[k], transfer_matrix_reflectance(cos1, n2, n3, thickness, film_lambda[k]), 2e-5)
                            << cos1 << ' ' << n2 << ' ' << n3 << ' ' << thickness;
                }
}

TEST(ThinFilm, OfNoThicknessIsTheBareInterface) {
    for (float cos1 : {1.0f, 0.5f, 0.1f})
        for (float n : {1.2f, 1.5f, 2.5f})
            EXPECT_NEAR(ThinFilm::make(1.4f, 0, film_lambda).reflectance(cos1, SampledSpectrum(n))[2],
                        fresnel_dielectric(cos1, n), 1e-5f);
}

TEST(ThinFilm, AtGrazingIncidenceReflectsAll) {
    EXPECT_EQ(ThinFilm::make(1.4f, 300, film_lambda).reflectance(0, SampledSpectrum(1.5f)),
              SampledSpectrum(1));
}

TEST(ThinFilm, IsNeverAboveItsBounds) {
    for (float n2 : {1.0f, 1.1f, 1.3f, 1.5f, 2.2f, 3.0f})
        for (float n3 : {1.0f, 1.33f, 1.5f, 2.4f, 5.0f, 100.0f})
            for (float cos1 = 0.01f; cos1 < 1; cos1 += 0.03f) {
                const SampledSpectrum base(n3);
                const ThinFilm film = ThinFilm::make(n2, 800, film_lambda);
                const SampledSpectrum greatest = film.greatest_reflectance(cos1, base);
                EXPECT_LE(max_value(film.reflectance(cos1, base) - greatest), 1e-5f);
                const SampledSpectrum bound = fresnel_schlick(cos1, film.schlick_bound(base), 1);
                EXPECT_LE(max_value(greatest - bound), 1e-5f) << n2 << ' ' << n3 << ' ' << cos1;
            }
}

TEST(ThinFilm, IndexAndReflectanceAtNormalIncidenceAgree) {
    for (float n : {1.0f, 1.3f, 1.5f, 3.0f, 10.0f}) {
        const float r = (n - 1) / (n + 1);
        EXPECT_NEAR(ior_from_reflectance(SampledSpectrum(r * r))[0], n, 1e-4f * n);
    }
    EXPECT_TRUE(all_finite(ior_from_reflectance(SampledSpectrum(1))));
}

} // namespace
} // namespace montelux
