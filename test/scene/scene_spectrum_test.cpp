// Spectra that materials, textures and lights refer to.
#include <gtest/gtest.h>
#include <vector>

#include "montelux/scene/material/material_model.h"
#include "montelux/scene/material/parameter_evaluator.h"
#include "montelux/spectrum/named_spectra.h"

namespace montelux {
namespace {

TEST(SceneSpectra, AreConstantsOrEntries) {
    Scene scene;
    EXPECT_TRUE(add_spectrum(scene, Spectrum(0.25f)).is_constant());
    EXPECT_TRUE(scene.spectra.empty());
    const Spectrum warm(BlackbodySpectrum(3000)), cold(BlackbodySpectrum(9000));
    const SceneSpectrum first = add_spectrum(scene, warm), second = add_spectrum(scene, cold);
    ASSERT_EQ(scene.spectra.size(), 2u);
    const SceneView view(scene);
    const SampledWavelengths lambda = SampledWavelengths::sample_visible(0.4f);
    for (int i = 0; i < 4; ++i) {
        EXPECT_EQ(view.sample(first, lambda)[i], warm.sample(lambda)[i]);
        EXPECT_EQ(view.sample(second, lambda)[i], cold.sample(lambda)[i]);
        EXPECT_EQ(view.sample(0.25f, lambda)[i], 0.25f);
        EXPECT_EQ(view.sample({}, lambda)[i], 0);
    }
    EXPECT_EQ(view.spectrum(second)(600), cold(600));
    EXPECT_EQ(view.spectrum(0.25f)(600), 0.25f);
}

// Only a refractive index that varies ends wavelengths, wherever it is.
TEST(SceneSpectra, DispersionEndsWavelengths) {
    Scene scene;
    scene.spectra = {Spectrum(1.5f), *find_named_spectrum("glass-BK7")};
    const SceneView view(scene);
    auto terminated = [&](SceneSpectrum eta) {
        SampledWavelengths lambda = SampledWavelengths::sample_visible(0.4f);
        const TextureContext context;
        const float value = ParameterEvaluator(view, 0, context, lambda).refractive_index(eta);
        EXPECT_NEAR(value, 1.51f, 0.02f);
        return lambda.secondary_terminated();
    };
    EXPECT_FALSE(terminated(1.5f));
    EXPECT_FALSE(terminated(SceneSpectrum::at(0)));
    EXPECT_TRUE(terminated(SceneSpectrum::at(1)));
}

TEST(SceneSpectra, MetalsAreCopperByDefault) {
    const MetalParameter grey;
    EXPECT_NEAR(grey.eta.value.constant, (*find_named_spectrum("metal-Al-eta"))(550), 0.005f);
    EXPECT_NEAR(grey.k.value.constant, (*find_named_spectrum("metal-Al-k"))(550), 0.005f);

    std::vector<Spectrum> spectra;
    const auto add = [&](const Spectrum& s) { return add_spectrum(spectra, s); };
    const MetalParameter copper = default_material<CoatedConductorMaterial>(add).metal;
    for (const float lambda : {400.0f, 550.0f, 700.0f}) {
        EXPECT_EQ(spectrum_of(copper.eta.value, spectra)(lambda),
                  (*find_named_spectrum("metal-Cu-eta"))(lambda));
        EXPECT_EQ(spectrum_of(copper.k.value, spectra)(lambda), (*find_named_spectrum("metal-Cu-k"))(lambda));
    }
    default_material<DielectricMaterial>(add);
    EXPECT_EQ(spectra.size(), 2u);
}

} // namespace
} // namespace montelux
