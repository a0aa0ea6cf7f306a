// Mitsuba's own test scenes against its spectral reference pictures, by its own test: a z-test of each pixel by the
// reference's variance, at a significance of 1 % with the correction of Sidak for their number, which 99.75 % of the
// pixels must pass at 256 samples; and means within 1 %, of more samples, so that noise does not decide. Scenes that need
// more than that are named, with the reason.
#include "test/formats/mitsuba/shared_scenes.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <gtest/gtest.h>
#include <iostream>
#include <map>
#include <string>
#include <vector>

#include "montelux/formats/load_scene.h"
#include "montelux/image/image_read.h"
#include "montelux/mc/math/error.h"
#include "montelux/render/renderer.h"

namespace montelux::mitsuba_references {
namespace {

const std::filesystem::path tests = test::mitsuba_scenes() / "tests";
constexpr std::uint32_t samples = 256, samples_of_means = 2048, samples_of_reference = 32000;
// Of a sample: what Mitsuba takes for the least variance.
constexpr double least_variance = 1e-4;

// Rows of the matrix from linear sRGB to CIE XYZ (IEC 61966-2-1).
constexpr double xyz_from_rgb[3][3] = {
    {0.4124564, 0.3575761, 0.1804375}, {0.2126729, 0.7151522, 0.0721750}, {0.0193339, 0.1191920, 0.9503041}};

// The reference's variance of a sample in X, Y or Z: its picture holds them transformed as if they were a colour.
double xyz_variance(const Image& variances, int x, int y, std::size_t channel) {
    double variance = 0;
    for (std::size_t k = 0; k < 3; ++k)
        variance += xyz_from_rgb[channel][k] * double(variances.value(x, y, static_cast<int>(k)));
    return std::max(variance, 0.0);
}

// Of a standard normal number.
double probability_beyond(double z) { return std::erfc(z / std::sqrt(2.0)); }

// What a scene may differ by, beyond Mitsuba's own test (docs/mitsuba.md).
struct Allowance {
    double means = 0.01;
    int standard_errors = 0; // of the means, in addition
    double share = 0.9975;
    bool by_both = false; // pixels are tested by the error bars of both pictures
    std::uint32_t samples = montelux::mitsuba_references::samples;
};
const std::map<std::string, Allowance> allowances{
    // Few paths carry much light: the standard error of a mean is about 1 % or above.
    {"bsdf_spheres/test_pointlight_path", {.standard_errors = 3}},
    {"bsdf_spheres/test_roughdielectric_path", {.standard_errors = 3}},
    // Our samples vary more than Mitsuba's.
    {"bsdf_spheres/test_normalmap_identity_roughconductor_path", {.by_both = true}},
    {"participating_media/test_hetero_sigmat_volpath", {.by_both = true}},
    {"participating_media/test_surf_area_light_volpath", {.by_both = true}},
    // Mitsuba's spectral variants show this environment map in another hue than its RGB ones.
    {"participating_media/test_hetero_spectral_sigmat_no_scattering_volpath", {.means = 0.02}},
    {"participating_media/test_hetero_spectral_sigmat_volpathmis", {.means = 0.04}},
    {"participating_media/test_homo_spectral_sigmat_volpathmis", {.means = 0.02}},
    {"participating_media/test_homo_dielectric_envmap_volpath", {.share = 0.99}},
    // Paths find the light behind panes by chance: error bars of few samples are too small. Mitsuba's spectrum for the
    // first one's albedo of 0.99 in red and blue is 0.997 there.
    {"participating_media/test_homo_area_light_volpath",
     {.means = 0.015, .share = 0.995, .by_both = true, .samples = 8192}},
    {"participating_media/test_homo_emitter_inside_medium_volpath", {.by_both = true, .samples = 4096}},
    {"participating_media/test_homo_obj_inside_medium_volpath", {.by_both = true, .samples = 4096}},
};

// R, G, B and their standard errors.
Image rendered(SceneDescription& d, std::uint32_t spp) {
    d.sampler = {.kind = SamplerKind::independent, .seed = 5, .spp = spp};
    Film film(d.film);
    const RenderReport report = Renderer(d).render(film);
    EXPECT_EQ(report.bad.count(), 0u);
    return film.develop().select(std::vector<std::string>{"R", "G", "B", "stderr.R", "stderr.G", "stderr.B"});
}

class MitsubaReferencePicturesSlowTest : public ::testing::TestWithParam<const char*> {};

TEST_P(MitsubaReferencePicturesSlowTest, Agree) {
    if (!std::filesystem::exists(tests)) GTEST_SKIP() << "no shared files";
    const std::string name = GetParam();
    const std::filesystem::path scene = tests / (name + ".xml");
    std::string stem = scene.stem().string();
    stem.resize(stem.rfind('_')); // without the integrator
    const auto reference_file = [&](const std::string& ending) {
        return scene.parent_path() / "refs" / (stem + "_ref_spectral" + ending + ".exr");
    };
    Warnings warnings;
    SceneDescription d;
    try {
        d = load_scene(scene, warnings);
    } catch (const Error& e) {
        if (std::string(e.what()).find("there is no file") != std::string::npos) GTEST_SKIP() << e.what();
        throw;
    }
    const auto known = allowances.find(name);
    const Allowance allowed = known == allowances.end() ? Allowance() : known->second;
    const Image few = rendered(d, allowed.samples), many = rendered(d, samples_of_means);
    const Image reference = read_image(reference_file("")), variances = read_image(reference_file("_var"));
    ASSERT_EQ(reference.width(), few.width());
    ASSERT_EQ(reference.height(), few.height());

    const double pixels = static_cast<double>(reference.pixel_count());
    const double alpha = 1 - std::pow(1 - 0.01, 1 / pixels);
    double passed = 0, passed_by_both = 0;
    std::array<double, 3> sums{}, squares{}, expected{};
    for (int y = 0; y < few.height(); ++y)
        for (int x = 0; x < few.width(); ++x) {
            bool passes = true, passes_by_both = true;
            for (int c = 0; c < 3; ++c) {
                const auto i = static_cast<std::size_t>(c);
                sums[i] += double(many.value(x, y, c));
                squares[i] += std::pow(double(many.value(x, y, c + 3)), 2);
                expected[i] += double(reference.value(x, y, c));
                double difference = 0,
                       error = 0; // the errors of the colours as if of one number: at most that
                for (std::size_t k = 0; k < 3; ++k) {
                    const int channel = static_cast<int>(k);
                    difference += xyz_from_rgb[i][k] *
                                  (double(few.value(x, y, channel)) - double(reference.value(x, y, channel)));
                    error += xyz_from_rgb[i][k] * double(few.value(x, y, channel + 3));
                }
                const double variance = std::max(xyz_variance(variances, x, y, i), least_variance);
                const auto agrees = [&](double squared_error) {
                    return probability_beyond(std::abs(difference) / std::sqrt(squared_error)) > alpha;
                };
                passes = passes && agrees(variance / allowed.samples);
                passes_by_both = passes_by_both && agrees(error * error + variance / samples_of_reference);
            }
            if (passes) ++passed;
            if (passes_by_both) ++passed_by_both;
        }
    const double share = passed / pixels, share_by_both = passed_by_both / pixels;
    std::string ratios;
    for (std::size_t i = 0; i < 3; ++i)
        ratios += " " + std::to_string(sums[i] / expected[i]) + "(" +
                  std::to_string(std::sqrt(squares[i]) / expected[i]) + ")";
    std::cout << name << ": " << 100 * share << " % pass, by both error bars " << 100 * share_by_both
              << " %; means (standard errors)" << ratios << '\n';
    EXPECT_GE(allowed.by_both ? share_by_both : share, allowed.share);
    for (std::size_t i = 0; i < 3; ++i)
        EXPECT_NEAR(sums[i] / expected[i], 1,
                    allowed.means + allowed.standard_errors * std::sqrt(squares[i]) / expected[i])
            << "channel " << i;
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, MitsubaReferencePicturesSlowTest,
    ::testing::Values("bsdf_spheres/test_arealight_path", "bsdf_spheres/test_bumpmap_path",
                      "bsdf_spheres/test_constant_path", "bsdf_spheres/test_envmap_path",
                      "bsdf_spheres/test_normalmap_identity_roughconductor_path",
                      "bsdf_spheres/test_normalmap_path", "bsdf_spheres/test_pointlight_path",
                      "bsdf_spheres/test_roughdielectric_path", "bsdf_spheres/test_roughplastic_linear_path",
                      "bsdf_spheres/test_textured_diffuse_path",
                      "bsdf_spheres/test_textured_roughconductor_path",
                      "bsdf_spheres/test_texturedprincipled1_path",
                      "bsdf_spheres/test_texturedprincipledthin_path", "infinite_mirrors/scene_path",
                      "instancing/test_instancing_path", "orthographic_sensor/test_orthographic_path",
                      "participating_media/test_hetero_sigmat_volpath",
                      "participating_media/test_hetero_spectral_sigmat_no_scattering_volpath",
                      "participating_media/test_hetero_spectral_sigmat_volpathmis",
                      "participating_media/test_homo_area_light_volpath",
                      "participating_media/test_homo_dielectric_envmap_volpath",
                      "participating_media/test_homo_emitter_inside_medium_volpath",
                      "participating_media/test_homo_obj_inside_medium_volpath",
                      "participating_media/test_homo_spectral_sigmat_volpathmis",
                      "participating_media/test_surf_area_light_volpath", "spot_light/test_spot_direct"),
    [](const auto& test) {
        std::string name = std::filesystem::path(test.param).filename().string();
        std::replace(name.begin(), name.end(), '.', '_');
        return name;
    });

} // namespace
} // namespace montelux::mitsuba_references
