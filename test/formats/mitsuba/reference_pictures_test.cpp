// Mitsuba's own test scenes against its reference pictures, by its own test: a z-test of each pixel at a significance of
// 1 % with the correction of Sidak for their number, which 99.75 % of the pixels must pass. A pixel passes by our error
// bars, or as there by the variance of the reference, which knows of rare bright samples.
#include "test/formats/mitsuba/shared_scenes.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <gtest/gtest.h>
#include <iostream>
#include <string>
#include <vector>

#include "montelux/formats/load_scene.h"
#include "montelux/image/image_read.h"
#include "montelux/mc/math/error.h"
#include "montelux/render/renderer.h"

namespace montelux::mitsuba_references {
namespace {

const std::filesystem::path tests = test::mitsuba_scenes() / "tests";
constexpr std::uint32_t samples = 256;
constexpr double reference_samples = 32'000;
// Of a sample: what Mitsuba takes for the least variance.
constexpr double least_variance = 1e-4;

// Rows of the matrix from CIE XYZ to linear sRGB (IEC 61966-2-1) and of its inverse.
constexpr double rgb_from_xyz[3][3] = {{3.2404542, -1.5371385, -0.4985314},
                                       {-0.9692660, 1.8760108, 0.0415560},
                                       {0.0556434, -0.2040259, 1.0572252}};
constexpr double xyz_from_rgb[3][3] = {
    {0.4124564, 0.3575761, 0.1804375}, {0.2126729, 0.7151522, 0.0721750}, {0.0193339, 0.1191920, 0.9503041}};

// The reference's variance of a sample in X, Y or Z: its picture holds them transformed as if they were a colour.
double xyz_variance(const Image& variances, int x, int y, std::size_t channel) {
    double variance = 0;
    for (std::size_t k = 0; k < 3; ++k)
        variance += xyz_from_rgb[channel][k] * double(variances.value(x, y, static_cast<int>(k)));
    return std::max(variance, 0.0);
}

// In a channel of RGB at most: the covariances are not known.
double variance_at_most(const Image& variances, int x, int y, std::size_t channel) {
    double deviation = 0;
    for (std::size_t i = 0; i < 3; ++i)
        deviation += std::abs(rgb_from_xyz[channel][i]) * std::sqrt(xyz_variance(variances, x, y, i));
    return deviation * deviation;
}

// Of a standard normal number.
double probability_beyond(double z) { return std::erfc(z / std::sqrt(2.0)); }

class MitsubaReferencePicturesSlowTest : public ::testing::TestWithParam<const char*> {};

TEST_P(MitsubaReferencePicturesSlowTest, Agree) {
    if (!std::filesystem::exists(tests)) GTEST_SKIP() << "no shared files";
    const std::string name = GetParam();
    const std::filesystem::path scene = tests / (name + ".xml");
    std::string stem = scene.stem().string();
    stem.resize(stem.rfind('_')); // without the integrator
    const auto reference_file = [&](const std::string& variant, const std::string& ending) {
        return scene.parent_path() / "refs" / (stem + "_ref_" + variant + ending + ".exr");
    };
    // Mitsuba's paths in media do not count what goes straight through a thin pane; ours do, and end earlier.
    const bool cut_short = name.find("homo_area_light") != std::string::npos ||
                           name.find("homo_emitter_inside") != std::string::npos ||
                           name.find("homo_obj_inside") != std::string::npos;
    Warnings warnings;
    test::MitsubaFiles files;
    LoadOptions options;
    options.source = &files;
    SceneDescription d;
    try {
        d = load_scene(scene, warnings, options);
    } catch (const Error& e) {
        if (std::string(e.what()).find("there is no file") != std::string::npos) GTEST_SKIP() << e.what();
        throw;
    }
    // Of few lights, by chance alone: a small spot beside a large sky would get too few samples for a z-test.
    d.integrator.light_sampling = LightSampling::uniform;
    d.sampler = {.kind = SamplerKind::independent, .seed = 5, .spp = samples};
    Film film(d.film);
    const RenderReport report = Renderer(d).render(film);
    EXPECT_EQ(report.bad.count(), 0u);
    const Image picture = film.develop();
    const Image mean = picture.select(std::vector<std::string>{"R", "G", "B"}),
                error = picture.select(std::vector<std::string>{"stderr.R", "stderr.G", "stderr.B"});
    // Where colours of an environment are interpolated, Mitsuba's spectral pictures differ from its RGB ones by up to
    // 3 %: the mean may lie between them.
    const Image reference = read_image(reference_file("spectral", "")),
                variances = read_image(reference_file("spectral", "_var")),
                rgb_reference = read_image(reference_file("rgb", ""));
    ASSERT_EQ(reference.width(), mean.width());
    ASSERT_EQ(reference.height(), mean.height());

    const double pixels = static_cast<double>(reference.pixel_count());
    const double alpha = 1 - std::pow(1 - 0.01, 1 / pixels);
    double passed = 0;
    std::array<double, 3> sums{}, variances_of_sums{}, low{}, high{};
    for (int y = 0; y < mean.height(); ++y)
        for (int x = 0; x < mean.width(); ++x) {
            bool by_ours = true, by_theirs = true;
            for (int c = 0; c < 3; ++c) {
                const auto i = static_cast<std::size_t>(c);
                const double ours = mean.value(x, y, c), theirs = reference.value(x, y, c);
                const double s = error.value(x, y, c), other = rgb_reference.value(x, y, c);
                sums[i] += ours;
                variances_of_sums[i] += s * s;
                low[i] += theirs;
                high[i] += other;
                const double variance = std::max(s * s, least_variance / samples) +
                                        variance_at_most(variances, x, y, i) / reference_samples;
                by_ours =
                    by_ours && probability_beyond(std::abs(ours - theirs) / std::sqrt(variance)) > alpha;
                double difference = 0;
                for (std::size_t k = 0; k < 3; ++k)
                    difference += xyz_from_rgb[i][k] * (double(mean.value(x, y, static_cast<int>(k))) -
                                                        double(reference.value(x, y, static_cast<int>(k))));
                const double their_variance = std::max(xyz_variance(variances, x, y, i), least_variance);
                by_theirs = by_theirs && probability_beyond(std::abs(difference) *
                                                            std::sqrt(samples / their_variance)) > alpha;
            }
            if (by_ours || by_theirs) ++passed;
        }
    const double share = passed / pixels;
    std::string ratios;
    for (std::size_t i = 0; i < 3; ++i) {
        if (low[i] > high[i]) std::swap(low[i], high[i]);
        ratios += " " + std::to_string(2 * sums[i] / (low[i] + high[i]));
        const double noise = 4 * std::sqrt(variances_of_sums[i]);
        EXPECT_LT(sums[i], 1.01 * high[i] + noise) << "channel " << i;
        if (!cut_short) {
            EXPECT_GT(sums[i], 0.99 * low[i] - noise) << "channel " << i;
        }
    }
    std::cout << name << ": " << 100 * share << " % pass; means" << ratios << '\n';
    if (!cut_short) {
        EXPECT_GE(share, 0.9975);
    }
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
