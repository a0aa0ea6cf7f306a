// Spectral films: known spectra, calibrated errors, the same RGB, resumed renders.
#include "test/render/scene_testing.h"
#include "test/temporary_folder.h"
#include <gtest/gtest.h>

#include "montelux/mc/math/error.h"
#include "montelux/render/render_session.h"
#include "montelux/render/sample_record.h"
#include "montelux/spectrum/sensor.h"

namespace montelux::testing {
namespace {

// A matt square of a coloured reflectance under uniform white light, which it reflects alone.
SceneDescription colored_square() {
    SceneBuilder b;
    b.add_uniform_light(1);
    const SpectrumParameter red{
        add_spectrum(b.scene, RgbAlbedoSpectrum(RgbColorSpace::srgb(), {0.7f, 0.3f, 0.1f}))};
    b.add_mesh(square(Transform::scale({9, 9, 1})), b.add(DiffuseMaterial{red}));
    b.look({0, 0, 1}, {0, 0, 0}, 40);
    b.description.integrator.max_depth = 1;
    b.description.film.spectral = SpectralSettings{.lambda_min = 400, .lambda_max = 720, .buckets = 8};
    return b.description;
}

TEST(SpectralFilm, MeansAreTheRadianceAndErrorsAreCalibrated) {
    SceneDescription d = colored_square();
    for (const SamplerKind sampler : {SamplerKind::independent, SamplerKind::sobol}) {
        d.sampler.kind = sampler;
        d.sampler.spp = 256;
        const Film film = render(d);
        const BucketLayout layout(*d.film.spectral);
        const Spectrum light = white_spectrum();
        const Spectrum red = RgbAlbedoSpectrum(RgbColorSpace::srgb(), {0.7f, 0.3f, 0.1f});
        for (int i = 0; i < 8; ++i) {
            double truth = 0;
            constexpr int steps = 4000;
            for (int k = 0; k < steps; ++k) {
                const float l =
                    layout.center(i) + layout.width() * ((static_cast<float>(k) + 0.5f) / steps - 0.5f);
                truth += static_cast<double>(light(l)) * static_cast<double>(red(l));
            }
            truth *= static_cast<double>(white_scale()) * cie_y_integral / steps;
            double sum = 0, variance = 0, z2 = 0;
            for (std::size_t p = 0; p < 64; ++p) {
                const BucketMoments& m = film.buckets()[8 * p + static_cast<std::size_t>(i)];
                const double e = m.standard_error(film.pixels()[p].replicates().count());
                sum += m.mean;
                variance += e * e;
                z2 += (m.mean - truth) * (m.mean - truth) / (e * e);
            }
            EXPECT_NEAR(sum / 64, truth, 5.5 * std::sqrt(variance) / 64) << i;
            // The mean of 64 squared z-scores is 1 with a standard deviation of 0.18, wider with few replicates.
            EXPECT_GT(z2 / 64, 0.3) << i;
            EXPECT_LT(z2 / 64, sampler == SamplerKind::independent ? 2.2 : 4) << i;
        }
    }
}

// In uniform light: each sample has the wavelengths of its path's end and the factors that it has in RGB.
struct SampleCounts {
    int clamped = 0, negative = 0, terminated = 0;
};
SampleCounts expect_factors_of_colours(SceneBuilder& b, float radiance) {
    b.add_uniform_light(radiance);
    b.description.film.spectral = SpectralSettings{.lambda_min = 400, .lambda_max = 720, .buckets = 8};
    b.description.sampler.spp = 16;
    const Film film = render(b.description);
    const Image image = film.develop();
    const Renderer renderer(b.description);
    const BucketLayout layout(*b.description.film.spectral);
    const Spectrum white = white_spectrum();
    const Sensor eye;
    SampleCounts counts;
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; ++x) {
            std::vector<BucketMoments> expected(8);
            for (std::uint32_t k = 0; k < 16; ++k) {
                const SampleRecord r = renderer.replay(x, y, k);
                const SampledSpectrum light = white.sample(r.lambda_end) * (white_scale() * radiance);
                const Vec3f plain = eye.to_rgb(light, r.lambda_end);
                const float factor = dot(r.rgb, plain) / length_squared(plain);
                add_sample(expected, spectral_sample(layout, light, r.lambda_end, factor));
                for (BucketMoments& m : expected) m.end_replicate(1, k + 1);
                counts.clamped += r.clamp < 1;
                counts.negative += r.filter.weight < 0;
                counts.terminated += r.lambda_end.secondary_terminated();
            }
            for (int i = 0; i < 8; ++i) {
                const BucketMoments& m = expected[static_cast<std::size_t>(i)];
                const double error = m.standard_error(16);
                const std::string layer = spectral_layer(layout.center(i));
                EXPECT_NEAR(image.value(x, y, *image.find_channel(layer)), m.mean, 1e-4 * error + 1e-6);
                EXPECT_NEAR(image.value(x, y, *image.find_channel("stderr." + layer)), error,
                            1e-4 * error + 1e-6);
            }
        }
    return counts;
}

TEST(SpectralFilm, BucketsHaveTheFactorsOfTheColours) {
    SceneBuilder b;
    b.scene.camera.model = RealisticCamera{
        .surfaces = {{0.05f, 0.003f, 1.5f, 0.01f}, {-0.05f, 0.001f, 1, 0.01f}, {0, 0.05f, 0, 0.002f}},
        .focus_distance = 2,
        .film_diagonal = 0.02f};
    b.description.film.filter = MitchellFilter{};
    b.description.film.max_component_value = 1;
    const SampleCounts counts = expect_factors_of_colours(b, 200);
    EXPECT_GT(counts.clamped, 100);
    EXPECT_GT(counts.negative, 50);
}

// Behind dispersive glass one wavelength of a path is left, and counts for four.
TEST(SpectralFilm, DispersionLeavesOneWavelength) {
    SceneBuilder b;
    const Spectrum dispersive(PiecewiseLinear(std::vector<float>{360, 830}, std::vector<float>{1.6f, 1.4f}));
    b.add_quadric(Sphere{}, b.add(DielectricMaterial{add_spectrum(b.scene, dispersive)}));
    b.look({0, -4, 0}, {0, 0, 0}, 40);
    const SampleCounts counts = expect_factors_of_colours(b, 1);
    EXPECT_GT(counts.terminated, 100);
    EXPECT_LT(counts.terminated, 900);
}

TEST(SpectralFilm, LeavesTheColoursAsTheyAre) {
    SceneDescription d = colored_square();
    const Film spectral = render(d);
    d.film.spectral.reset();
    const Film plain = render(d);
    for (std::size_t i = 0; i < plain.pixels().size(); ++i)
        EXPECT_TRUE(same_pixel(plain.pixels()[i], spectral.pixels()[i]));
    EXPECT_TRUE(plain.buckets().empty());
    const Image image = spectral.develop();
    EXPECT_TRUE(image.find_channel("S0.420,000nm"));
    EXPECT_EQ(std::get<std::string>(image.attributes().at("spectralLayoutVersion")), "1.0");
    EXPECT_FALSE(plain.develop().find_channel("S0.420,000nm"));
}

TEST(SpectralFilm, ResumesToTheSameBits) {
    TemporaryFolder folder;
    auto d = std::make_shared<SceneDescription>(colored_square());
    d->sampler.spp = 64;
    const Film whole = render(*d);
    const std::filesystem::path file = folder / "a.mlx";
    CancelFlag cancel;
    {
        RenderSession session(d,
                              {.target = {}, .scene_name = "s", .checkpoint = file, .checkpoint_every = 0});
        session.render({.progress =
                            [&](const RenderProgress& p) {
                                if (p.samples_done > 64 * 16) cancel.request();
                            },
                        .cancel = &cancel});
    }
    RenderSession session(d, {.target = {}, .scene_name = "s", .checkpoint = file, .resume = true});
    session.render();
    const std::shared_ptr<const Image> resumed = session.finish().image;
    const Image expected = whole.develop();
    for (const std::string& layer : {std::string("S0.420,000nm"), std::string("stderr.S0.700,000nm")})
        for (int y = 0; y < 8; ++y)
            for (int x = 0; x < 8; ++x)
                EXPECT_EQ(resumed->value(x, y, *resumed->find_channel(layer)),
                          expected.value(x, y, *expected.find_channel(layer)));
    // Another layout is another film.
    auto other = std::make_shared<SceneDescription>(*d);
    other->film.spectral->buckets = 9;
    EXPECT_THROW(RenderSession(other, {.target = {}, .scene_name = "s", .checkpoint = file, .resume = true}),
                 Error);
    EXPECT_THROW(Renderer(*d, {.slice = {0, 2}}), Error);
}

} // namespace
} // namespace montelux::testing
