// Digests of spectra: they count by their values and where they are used, not by their places.
#include "test/scene/scene_digest_testing.h"
#include <gtest/gtest.h>

#include "montelux/scene/scene_digest.h"

namespace montelux {
namespace {

using testing::Change;
using testing::change_spectrum_of_light;
using testing::expect_changes;
using testing::Part;
using testing::with_spectrum;

TEST(SceneDigest, EveryKindOfSpectrumCounts) {
    const RgbColorSpace &srgb = RgbColorSpace::srgb(), &wide = RgbColorSpace::aces2065_1();
    const float lambda[] = {400, 500, 600}, values[] = {1, 2, 3}, others[] = {1, 2, 3.5f};
    const Spectrum kinds[] = {Spectrum(2.0f),
                              Spectrum(Spectrum(3.0f).tabulate()),
                              Spectrum(Spectrum(3.0f).tabulate(2)),
                              Spectrum(PiecewiseLinear(lambda, values)),
                              Spectrum(PiecewiseLinear(lambda, others)),
                              Spectrum(PiecewiseLinear(lambda, values, SpectrumEnds::constant)),
                              Spectrum(BlackbodySpectrum(3000)),
                              Spectrum(BlackbodySpectrum(4000)),
                              Spectrum(RgbAlbedoSpectrum(srgb, {0.5f, 0.4f, 0.3f})),
                              Spectrum(RgbAlbedoSpectrum(wide, {0.5f, 0.4f, 0.3f})),
                              Spectrum(RgbUnboundedSpectrum(srgb, {0.5f, 0.4f, 0.3f})),
                              Spectrum(RgbUnboundedSpectrum(srgb, {5, 4, 3})),
                              Spectrum(RgbIlluminantSpectrum(srgb, {5, 4, 3})),
                              Spectrum(RgbIlluminantSpectrum(wide, {1, 1, 1})),
                              Spectrum(RgbIlluminantSpectrum(srgb, {1, 1, 1}))};
    std::vector<Change> changes;
    for (const Spectrum& s : kinds) changes.push_back(change_spectrum_of_light<PointLight>(s));
    expect_changes(&SceneDigest::lights, changes);
    // Data in two places with the same values.
    Scene a, b;
    for (Scene* s : {&a, &b})
        s->lights = {with_spectrum<PointLight>(add_spectrum(*s, Spectrum(PiecewiseLinear(lambda, values))))};
    EXPECT_EQ(digest_of(a), digest_of(b));
}

// A material, a texture and a light with one spectrum each.
Scene scene_of_spectra(SceneSpectrum material, SceneSpectrum texture, SceneSpectrum light,
                       std::vector<Spectrum> spectra) {
    Scene s;
    s.spectra = std::move(spectra);
    s.materials = {DielectricMaterial{material}};
    s.spectrum_textures = {ConstantTexture<SpectrumParameter>{{texture}}};
    s.lights = {with_spectrum<PointLight>(light)};
    return s;
}

TEST(SceneDigest, SpectraCountByTheirValues) {
    const auto at = [](Index i) { return SceneSpectrum::at(i); };
    const Spectrum warm(BlackbodySpectrum(3000)), cold(BlackbodySpectrum(9000)), two(2.0f);
    const SceneDigest expected = digest_of(scene_of_spectra(at(0), at(1), 2, {warm, cold}));
    EXPECT_EQ(digest_of(scene_of_spectra(at(1), at(0), 2, {cold, warm})), expected);
    EXPECT_EQ(digest_of(scene_of_spectra(at(3), at(2), at(1), {two, two, cold, warm, cold})), expected);
    EXPECT_NE(digest_of(scene_of_spectra(at(1), at(0), 2, {warm, cold})), expected);
}

TEST(SceneDigest, ASpectrumCountsWhereItIsUsed) {
    const Spectrum other(BlackbodySpectrum(9000));
    const Scene scene = scene_of_spectra(SceneSpectrum::at(0), SceneSpectrum::at(1), SceneSpectrum::at(2),
                                         std::vector<Spectrum>(4, Spectrum(BlackbodySpectrum(3000))));
    const SceneDigest before = digest_of(scene);
    const Part users[] = {&SceneDigest::materials, &SceneDigest::textures, &SceneDigest::lights};
    for (std::size_t i = 0; i < 4; ++i) {
        Scene changed = scene;
        changed.spectra[i] = other;
        SceneDigest after = digest_of(changed);
        if (i < 3) {
            EXPECT_NE(after.*users[i], before.*users[i]) << i;
            after.*users[i] = before.*users[i];
        }
        EXPECT_EQ(after, before) << i;
    }
}

} // namespace
} // namespace montelux
