// The clear sky: its atmosphere against published tables and fine quadrature, its light against random walks,
// a standard's spectra and what is known of daylight. Random walks: 12 comparisons at 5.5 standard errors
// beyond a stated bias, 5e-7.
#include "test/scene/sky_testing.h"
#include <functional>
#include <gtest/gtest.h>
#include <string>

#include "montelux/mc/math/error.h"
#include "montelux/mc/math/quadrature.h"
#include "montelux/scene/light/sky/line_of_sight.h"
#include "montelux/scene/light/sky/sky_data.h"
#include "montelux/scene/light/sky/sky_map.h"
#include "montelux/scene/light/sky/sky_model.h"

namespace montelux {
namespace {

using testing::SkyWalk;

SkyModel sky_of(double elevation, double turbidity = 2, float albedo = 0.2f) {
    SkySettings s;
    s.elevation = elevation;
    s.atmosphere.turbidity = turbidity;
    s.ground_albedo = Spectrum(albedo);
    return SkyModel(s);
}
Vec3d at_angles(double elevation, double azimuth) {
    const double e = elevation * pi / 180, a = azimuth * pi / 180;
    return {std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e)};
}
double photometric_sum(const SpectrumTable& t) {
    return luminous_efficacy * integrate_luminance([&](float lambda) { return t(lambda); });
}
Vec2d color_of(const SpectrumTable& t) {
    return chromaticity(integrate_xyz([&](float lambda) { return t(lambda); }));
}
double radiometric_sum(const SpectrumTable& t) {
    double sum = 0;
    for (float v : t.values()) sum += double(v);
    return sum;
}

// Density ratios of the tables of the US Standard Atmosphere 1976 at geometric heights.
TEST(Atmosphere, DensityOfTheStandardTables) {
    const std::pair<double, double> table[] = {{0, 1},         {5, 0.60117},   {10, 0.33756},
                                               {20, 0.072580}, {30, 0.015029}, {50, 8.3828e-4},
                                               {80, 1.5068e-5}};
    for (auto [height, ratio] : table) EXPECT_NEAR(standard_air_density(height) / ratio, 1, 1e-3) << height;
    const Atmosphere atmosphere({});
    EXPECT_NEAR(atmosphere.density(7.77).air, standard_air_density(7.77), 1e-5);
    // 2.152e25 molecules above a cm^2, 2.5469e19 in a cm^3 at sea level (Bodhaine et al. 1999).
    EXPECT_NEAR(atmosphere.path_to_space(0, 1).air, 8.450, 0.005);
}

// Against the formula of Hansen and Travis 1974, "Light scattering in planetary atmospheres", equation 2.30.
TEST(Atmosphere, RayleighThickness) {
    for (double lambda = 360; lambda <= 830; lambda += 10) {
        const double l2 = lambda * lambda * 1e-6;
        const double expected = 0.008569 / (l2 * l2) * (1 + 0.0113 / l2 + 0.00013 / (l2 * l2));
        EXPECT_NEAR(rayleigh_optical_thickness(lambda) / expected, 1, 0.01) << lambda;
    }
}

TEST(Atmosphere, PhaseFunctionsAreDensities) {
    auto air = ScatteredLight::phase_moments([](double mu, double) { return rayleigh_phase(mu); }, 0, 3);
    EXPECT_NEAR(air[0], 1, 1e-12);
    EXPECT_NEAR(air[1], 0, 1e-12);
    EXPECT_NEAR(air[2], 0.1 * (1 - 0.0279 / 1.9721) / (1 + 2 * 0.0279 / 1.9721), 1e-12);
    for (double g : {-0.3, 0.0, 0.7, 0.85}) {
        auto aerosol = ScatteredLight::phase_moments(aerosol_phase, g, 2);
        EXPECT_NEAR(aerosol[0], 1, 1e-9) << g;
        EXPECT_NEAR(aerosol[1], 3 * g * (4 + g * g) / (5 * (2 + g * g)), 1e-9) << g;
    }
}

// Column by column against composite quadrature of the densities themselves.
TEST(Atmosphere, PathsAgreeWithFineQuadrature) {
    const Atmosphere atmosphere({});
    const auto rule = gauss_legendre_rule(4);
    for (double height : {0.0, 0.37, 3.0, 11.7, 30.0})
        for (double above : {90.0, 30.0, 5.0, 1.0, 0.1, -0.5}) { // of the horizon there, degrees
            const double mu =
                std::cos(std::acos(Atmosphere::horizon_cosine(height)) - std::max(0.0, above) * pi / 180);
            const double length = Atmosphere::distance_to_space(height, mu), r = earth_radius + height;
            Constituents expected;
            constexpr int pieces = 4000;
            for (int i = 0; i < pieces; ++i)
                for (const QuadratureNode& n : rule) {
                    const double s = length * (i + n.x) / pieces;
                    const double h = std::max(0.0, std::sqrt(r * r + s * s + 2 * r * s * mu) - earth_radius);
                    expected += n.weight * length / pieces *
                                Constituents{standard_air_density(h), std::exp(-h / 1.2),
                                             std::max(0.0, h < 25 ? (h - 10) / 15 : (40 - h) / 15)};
                }
            const Constituents found = atmosphere.path_to_space(height, mu);
            const std::string what = std::to_string(height) + " km, " + std::to_string(above) + " degrees";
            EXPECT_NEAR(found.air / expected.air, 1, 2e-3) << what;
            EXPECT_NEAR(found.aerosol, expected.aerosol, 7e-3 * expected.aerosol + 1e-3) << what;
            EXPECT_NEAR(found.ozone / expected.ozone, 1, 5e-3) << what;
        }
}

// Kasten and Young 1989, "Revised optical air mass tables": they have refraction, which counts near the
// horizon only.
TEST(Atmosphere, AirMassesOfTheTables) {
    const Atmosphere atmosphere({});
    const double vertical = atmosphere.path_to_space(0, 1).air;
    const std::pair<double, double> table[] = {{60, 1.994}, {75, 3.816}, {80, 5.586}, {85, 10.32}};
    for (auto [angle, mass] : table)
        EXPECT_NEAR(atmosphere.path_to_space(0, std::cos(angle * pi / 180)).air / vertical / mass, 1,
                    angle < 85 ? 0.005 : 0.015)
            << angle;
}

// Light that aerosol scatters once, by many small steps and the closed forms.
TEST(Sky, SingleScatteringAgreesWithFineQuadrature) {
    const Atmosphere atmosphere({.turbidity = 3});
    for (double elevation : {5.0, -1.0}) {
        const double zenith = (90 - elevation) * pi / 180;
        const ScatteredLight scattered(atmosphere, Bands(0.1f), zenith, 0.16);
        for (Vec3d w : {at_angles(90, 0), at_angles(20, 120), at_angles(1, 30), at_angles(0.05, 180)}) {
            const double cos_azimuth[] = {w.x / std::max(1e-9, std::hypot(w.x, w.y))};
            const LineOfSight seen = look(atmosphere, scattered, zenith, w.z, cos_azimuth)[0];
            const Vec3d sun = at_angles(elevation, 0);
            const double length = Atmosphere::distance_to_space(0, w.z);
            constexpr int pieces = 20000;
            Bands expected;
            Constituents passed;
            double begin = 0;
            for (int i = 0; i < pieces; ++i) {
                const double t = (i + 1.0) / pieces, end = length * t * t, s = 0.5 * (begin + end);
                const Vec3d p = Vec3d{0, 0, earth_radius} + s * w;
                const double r = std::sqrt(dot(p, p)), h = r - earth_radius;
                const Constituents half = 0.5 * (end - begin) * atmosphere.density(h);
                passed += half;
                expected += static_cast<float>((end - begin) * std::exp(-h / 1.2) *
                                               atmosphere.settings().aerosol_albedo) *
                            atmosphere.aerosol_extinction() * atmosphere.transmittance(passed) *
                            atmosphere.sunlight(h, dot(p, sun) / r);
                passed += half;
                begin = end;
            }
            // Behind the shadow's edge little is left, of which the steps see less well.
            const double tolerance = elevation > 0 ? 0.01 : 0.05;
            for (int band : {0, 15, 30, 47})
                EXPECT_NEAR(double(seen.aureole[band]), double(expected[band]),
                            tolerance * double(expected[band]) + 1e-9)
                    << elevation << " " << w.z << " " << band;
        }
    }
}

// All orders of scattering.
TEST(Sky, AgreesWithRandomWalks) {
    for (double elevation : {60.0, 20.0}) {
        const SkyModel sky = sky_of(elevation);
        const Atmosphere atmosphere(sky.settings().atmosphere);
        for (int band : {4, 19}) {
            SkyWalk walk(atmosphere, band, 0.2, elevation, 11);
            for (Vec3d w : {at_angles(90, 0), at_angles(45, 90), at_angles(4, 180)}) {
                const RunningMoments m = walk.radiance(w, 4000);
                const double found = double(sky.radiance(Vec3f(w), Bands::wavelength(band))) /
                                     double(solar_irradiance[static_cast<std::size_t>(10 * band)]);
                EXPECT_NEAR(found, m.mean(), 5.5 * m.standard_error() + 0.02 * m.mean())
                    << elevation << " " << band << " " << w.z;
            }
        }
    }
}

// ASTM G173-03: direct spectral irradiance for the sun at 1.5 air masses, W/(m^2 nm).
struct StandardSpectrum {
    double lambda, direct;
};
constexpr StandardSpectrum standard_spectra[] = {
    {380, 0.4975}, {420, 0.8847}, {450, 1.288}, {480, 1.383}, {500, 1.339}, {530, 1.36},
    {550, 1.365},  {600, 1.328},  {640, 1.296}, {670, 1.285}, {750, 1.127}, {780, 1.069},
};
TEST(Sky, SunlightOfTheStandardSpectrum) {
    // Aerosol of optical thickness 0.084 at 500 nm, ozone of 0.3438 cm.
    SkySettings s;
    s.elevation = 90 - 48.19;
    s.atmosphere.turbidity = 1.753;
    s.atmosphere.ozone = 343.8;
    const SkyModel sky(s);
    const double disc = SunDisc::of_radius(sky.sun_direction(), sun_angular_radius).solid_angle();
    for (const StandardSpectrum& r : standard_spectra)
        EXPECT_NEAR(double(sky.sun_radiance()(static_cast<float>(r.lambda))) * disc / r.direct, 1, 0.03)
            << r.lambda;
    // Diffuse irradiance of the horizontal ground over that of the sun outside, by the simple model of Bird
    // and Riordan 1986, "Simple Solar Spectral Model for Direct and Diffuse Irradiance", for the same air.
    const std::pair<float, double> diffuse[] = {
        {420, 0.1672}, {500, 0.1205}, {550, 0.0958}, {630, 0.0724}, {780, 0.0505}};
    for (auto [lambda, share] : diffuse)
        EXPECT_NEAR(double(sky.sky_irradiance()(lambda)) /
                        double(solar_irradiance[static_cast<std::size_t>(lambda - 360)]) / share,
                    1, 0.12)
            << lambda;
}

// What is known of daylight under clear skies.
TEST(Sky, DaylightIsAsBrightAsItIs) {
    const SkyModel noon = sky_of(60), low = sky_of(10);
    const double sun = photometric_sum(noon.sun_irradiance()), dome = photometric_sum(noon.sky_irradiance());
    EXPECT_GT(sun + dome, 90e3);
    EXPECT_LT(sun + dome, 120e3);
    EXPECT_GT(dome / (sun + dome), 0.1);
    EXPECT_LT(dome / (sun + dome), 0.2);
    // About half of the 900 W/m^2 of all wavelengths is in those that the sky is computed for.
    EXPECT_NEAR(radiometric_sum(noon.sun_irradiance()) + radiometric_sum(noon.sky_irradiance()), 590, 40);
    const double low_dome = photometric_sum(low.sky_irradiance());
    EXPECT_LT(low_dome, dome);
    EXPECT_GT(low_dome / (photometric_sum(low.sun_irradiance()) + low_dome), 0.35);
    // 1.6e9 cd/m^2 at noon.
    EXPECT_NEAR(photometric_sum(noon.sun_radiance()), 1.5e9, 0.15e9);
    // Civil dusk ends at 3.4 lx, without a moon (Seidelmann 1992, Explanatory Supplement, table 9.3).
    const double dusk = photometric_sum(sky_of(-6).sky_irradiance());
    EXPECT_GT(dusk, 1.2);
    EXPECT_LT(dusk, 6);
    EXPECT_GT(low_dome, dusk);
}

TEST(Sky, ColorsOfTheDay) {
    const SkyModel noon = sky_of(60);
    const Vec2d zenith = color_of(noon.radiance(Vec3f(0, 0, 1)));
    const Vec2d horizon = color_of(noon.radiance(Vec3f(at_angles(1, 90))));
    EXPECT_LT(zenith.x, 0.29);
    EXPECT_LT(zenith.y, 0.30);
    EXPECT_GT(horizon.x, zenith.x + 0.02);
    const double low_sun = color_of(sky_of(2).sun_radiance()).x;
    EXPECT_GT(low_sun, color_of(noon.sun_radiance()).x);
    EXPECT_GT(low_sun, 0.5);
    // Ozone keeps dusk blue; without it the zenith is yellowish then.
    SkySettings s;
    s.elevation = -4;
    const double with_ozone = color_of(SkyModel(s).radiance(Vec3f(0, 0, 1))).x;
    s.atmosphere.ozone = 0;
    EXPECT_GT(color_of(SkyModel(s).radiance(Vec3f(0, 0, 1))).x, with_ozone + 0.03);
}

TEST(Sky, FollowsItsSettings) {
    const SkyModel clear = sky_of(35, 1.5), hazy = sky_of(35, 6), white = sky_of(35, 1.5, 0.9f);
    const Vec3f up{0, 0, 1}, beside_sun(at_angles(38, 5)), down(at_angles(-30, 60));
    EXPECT_GT(hazy.radiance(beside_sun, 550), 2 * clear.radiance(beside_sun, 550));
    EXPECT_LT(hazy.sun_radiance()(450), clear.sun_radiance()(450));
    EXPECT_GT(color_of(hazy.radiance(up)).x, color_of(clear.radiance(up)).x + 0.01);
    EXPECT_GT(white.radiance(up, 400), 1.1f * clear.radiance(up, 400));
    EXPECT_GT(white.sun_radiance()(400), 0.999f * clear.sun_radiance()(400));
    // Lambertian ground in the light of sun and sky.
    for (float lambda : {400.0f, 700.0f})
        EXPECT_NEAR(double(white.radiance(down, lambda)),
                    0.9 / pi * double(white.sky_irradiance()(lambda) + white.sun_irradiance()(lambda)), 1e-5);
    // The azimuth turns it.
    SkySettings turned = clear.settings();
    turned.azimuth = 70;
    const SkyModel other(turned);
    EXPECT_NEAR(double(other.radiance(Vec3f(at_angles(20, 100)), 500)),
                double(clear.radiance(Vec3f(at_angles(20, 30)), 500)), 1e-5);
    EXPECT_LT(length(other.sun_direction() - Vec3f(at_angles(35, 70))), 1e-6f);
}

// Every way to ask gives the same light; nothing is negative or not finite, and the table's cells show no
// seams.
TEST(Sky, RadianceIsOneFunction) {
    for (double elevation : {90.0, 0.1}) {
        const SkyModel sky = sky_of(elevation);
        double irradiance = 0;
        for (const QuadratureNode& u : gauss_legendre_rule(150))
            for (const QuadratureNode& v : gauss_legendre_rule(96)) {
                const double side = std::sqrt(1 - u.x * u.x), phi = 2 * pi * v.x;
                const Vec3f w(Vec3d{side * std::cos(phi), side * std::sin(phi), u.x});
                const float here = sky.radiance(w, 480);
                ASSERT_TRUE(std::isfinite(here));
                ASSERT_GT(here, 0) << elevation << " " << w.z;
                irradiance += 2 * pi * u.weight * v.weight * u.x * double(here);
            }
        EXPECT_NEAR(irradiance / double(sky.sky_irradiance()(480)), 1, 2e-3) << elevation;
        for (Vec3d w : {at_angles(90, 0), at_angles(0, 40), at_angles(33.3, 181), at_angles(-20, 10)}) {
            const auto lambda = SampledWavelengths::sample_visible(0.3f);
            const SampledSpectrum sampled = sky.radiance(Vec3f(w), lambda);
            const SpectrumTable table = sky.radiance(Vec3f(w));
            for (int i = 0; i < spectrum_samples; ++i)
                EXPECT_NEAR(double(sampled[i] / table(lambda.lambda[i])), 1, 0.02) << w.z;
            const Vec3d xyz = sky.tristimulus(Vec3f(w));
            EXPECT_NEAR(xyz.y * luminous_efficacy / photometric_sum(table), 1, 1e-5);
            EXPECT_NEAR(sky.mean_radiance(Vec3f(w)) * visible_samples / radiometric_sum(table), 1, 1e-5);
        }
    }
}

TEST(Sky, BadSettingsGetASentence) {
    auto message = [](const std::function<void(SkySettings&)>& change) {
        SkySettings s;
        change(s);
        try {
            SkyModel sky(s);
        } catch (const Error& e) {
            return std::string(e.what());
        }
        return std::string("accepted");
    };
    EXPECT_EQ(message([](SkySettings& s) { s.elevation = 91; }),
              "sky: elevation of the sun (degrees) is 91; expected a number from -6 to 90");
    EXPECT_NE(message([](SkySettings& s) { s.atmosphere.turbidity = 0.5; }).find("from 1 to 10"),
              std::string::npos);
    EXPECT_NE(message([](SkySettings& s) { s.atmosphere.turbidity = NAN; }).find("turbidity is nan"),
              std::string::npos);
    EXPECT_NE(message([](SkySettings& s) { s.ground_albedo = Spectrum(1.5f); }).find("albedo of the ground"),
              std::string::npos);
}

} // namespace
} // namespace montelux
