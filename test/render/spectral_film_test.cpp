// Spectral films: known spectra, calibrated errors, the same RGB, resumed renders.
#include "test/render/scene_testing.h"
#include "test/temporary_folder.h"
#include <gtest/gtest.h>

#include "montelux/mc/math/error.h"
#include "montelux/render/render_session.h"

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
