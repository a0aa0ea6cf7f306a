// Metropolis light transport on scenes that path tracing finds hard, if available.
#include <filesystem>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "montelux/formats/load_scene.h"
#include "montelux/image/image_read.h"
#include "montelux/image/metrics.h"
#include "montelux/render/renderer.h"

namespace montelux {
namespace {

std::filesystem::path folder_of(const char* scene) {
    return std::filesystem::path(MONTELUX_SHARED_DIR) / "scenes" / "pbrt" / scene;
}

Image rendered(SceneDescription d, IntegratorKind method, std::uint32_t spp, std::uint64_t seed = 0) {
    d.integrator.method = method;
    d.sampler.kind = SamplerKind::independent;
    d.sampler.spp = spp;
    d.sampler.seed = seed;
    Film film(d.film);
    Renderer(d).render(film);
    return film.develop();
}

// Light through a door that is ajar, against pbrt-v4's picture: the same mean, and less error than path tracing has
// with as many paths.
TEST(MetropolisReferenceSlowTest, DoorThatIsAjar) {
    const std::filesystem::path folder = folder_of("veach-ajar");
    if (!std::filesystem::exists(folder / "ref" / "mean.exr")) GTEST_SKIP() << "no reference pictures";
    Warnings warnings;
    const SceneDescription d = load_scene(folder / "scene.pbrt", warnings);
    const Image mean = read_image(folder / "ref" / "mean.exr"),
                error = read_image(folder / "ref" / "stderr.exr");
    const MeasuredPicture reference = measured_picture("reference", mean, "its error", error);
    const Image by_chains = rendered(d, IntegratorKind::metropolis, 64),
                by_paths = rendered(d, IntegratorKind::path, 64);
    const ComparisonOptions options{.relative_epsilon = 0.01, .set_aside_percent = 1};
    const Comparison chains = compare_pictures(measured_picture("chains", by_chains), reference, options);
    const Comparison paths = compare_pictures(measured_picture("paths", by_paths), reference, options);
    // Pixels of a group share its estimate of the mean light: the means of pictures scatter by 3 %, so many are averaged.
    constexpr std::uint64_t pictures = 8;
    std::vector<double> differences(chains.channels.size());
    for (std::uint64_t seed = 0; seed < pictures; ++seed) {
        const Image picture = seed == 0 ? by_chains : rendered(d, IntegratorKind::metropolis, 64, seed);
        const Comparison c = compare_pictures(measured_picture("chains", picture), reference, options);
        for (std::size_t i = 0; i < differences.size(); ++i)
            differences[i] += c.channels[i].relative_mean_difference / double(pictures);
    }
    for (const double difference : differences) EXPECT_NEAR(difference, 0, 0.06);
    EXPECT_NEAR(chains.pooled.mean, 0, 0.25);
    EXPECT_GT(chains.pooled.standard_deviation, 0.9);
    EXPECT_LT(chains.pooled.standard_deviation, 1.2);
    EXPECT_LT(chains.rel_mse, 0.7 * paths.rel_mse);
}

// A caustic of a glass, against many paths of the path tracer.
TEST(MetropolisReferenceSlowTest, CausticOfAGlass) {
    const std::filesystem::path folder = folder_of("caustic-glass");
    if (!std::filesystem::exists(folder / "scene.pbrt")) GTEST_SKIP() << "no scene";
    Warnings warnings;
    SceneDescription d = load_scene(folder / "scene.pbrt", warnings);
    d.film.width = 50;
    d.film.height = 70;
    d.film.crop = {0, 0, 50, 70};
    const Image by_chains = rendered(d, IntegratorKind::metropolis, 512),
                by_paths = rendered(d, IntegratorKind::path, 8192);
    const Comparison c =
        compare_pictures(measured_picture("chains", by_chains), measured_picture("paths", by_paths),
                         {.relative_epsilon = 0.01, .set_aside_percent = 1});
    for (const ChannelComparison& channel : c.channels)
        EXPECT_NEAR(channel.relative_mean_difference, 0, 0.06) << channel.name;
    EXPECT_NEAR(c.pooled.mean, 0, 0.5);
    EXPECT_GT(c.pooled.standard_deviation, 0.85);
    EXPECT_LT(c.pooled.standard_deviation, 1.25);
}

} // namespace
} // namespace montelux
