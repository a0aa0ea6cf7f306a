// Small scenes of our own against converged pictures that were made with the plainest strategy.
// test/render/references/README.md says how.
#include <gtest/gtest.h>
#include <string>

#include "montelux/formats/load_scene.h"
#include "montelux/image/image_read.h"
#include "montelux/image/image_write.h"
#include "montelux/image/metrics.h"
#include "montelux/render/renderer.h"

namespace montelux {
namespace {

const std::filesystem::path references =
    std::filesystem::path(MONTELUX_SOURCE_DIR) / "test/render/references";
constexpr const char* names[] = {"room", "terrace"};

struct Way {
    const char* name;
    SamplerKind sampler;
    Strategy strategy;
    Heuristic heuristic;
};

// A scene by its name, rendered.
Image picture_of(const std::string& name, const Way& way, std::uint32_t spp, std::uint64_t seed) {
    Warnings warnings;
    SceneDescription d = load_scene(references / (name + ".pbrt"), warnings);
    EXPECT_TRUE(warnings.messages().empty()) << warnings.messages().front();
    d.sampler = {.kind = way.sampler, .seed = seed, .spp = spp};
    d.integrator.strategy = way.strategy;
    d.integrator.heuristic = way.heuristic;
    Film film(d.film);
    const RenderReport report = Renderer(d).render(film);
    EXPECT_EQ(report.bad.count(), 0u);
    return film.develop();
}

class ReferencePictures : public ::testing::TestWithParam<std::tuple<const char*, Way>> {};

// Errors are pooled over 3 x 3 pixels, without which scores of samples below the truth are too large; what is
// left is not quite the normal law, since neighbours have other errors.
TEST_P(ReferencePictures, Agree) {
    const auto& [name, way] = GetParam();
    const Image picture = picture_of(name, way, 128, 7),
                reference = read_image(references / (std::string(name) + ".exr"));
    const Comparison c =
        compare_pictures(measured_picture("render", picture), measured_picture("reference", reference));
    ASSERT_TRUE(c.a_has_error && c.b_has_error);
    EXPECT_EQ(c.not_finite, 0u);
    for (const ChannelComparison& channel : c.channels)
        EXPECT_LT(std::abs(channel.mean_a - channel.mean_b), 4 * channel.mean_difference_error)
            << channel.name;
    const ZScores& z = c.pooled;
    RecordProperty("z mean", std::to_string(z.mean));
    RecordProperty("z sd", std::to_string(z.standard_deviation));
    EXPECT_EQ(z.unexplained, 0u);
    EXPECT_NEAR(z.mean, 0, 0.12); // rare caustics of the glass ball: -0.08
    EXPECT_NEAR(z.standard_deviation, 1, 0.1);
    EXPECT_NEAR(z.within[0], 0.69, 0.04);
    EXPECT_NEAR(z.within[1], 0.95, 0.02);
    EXPECT_GT(z.within[2], 0.99);
}

constexpr Way ways[] = {{"mis", SamplerKind::independent, Strategy::mis, Heuristic::power},
                        {"balance_sobol", SamplerKind::sobol, Strategy::mis, Heuristic::balance},
                        {"light", SamplerKind::independent, Strategy::light, Heuristic::power}};

INSTANTIATE_TEST_SUITE_P(Scenes, ReferencePictures,
                         ::testing::Combine(::testing::ValuesIn(names), ::testing::ValuesIn(ways)),
                         [](const auto& test) {
                             return std::string(std::get<0>(test.param)) + "_" + std::get<1>(test.param).name;
                         });

TEST(ReferencePicturesSlowTest, DISABLED_MakeReferences) {
    const std::string layers[] = {"R", "G", "B", "stderr.R", "stderr.G", "stderr.B"};
    for (const char* name : names) {
        const Way plain{"plain", SamplerKind::independent, Strategy::bsdf, Heuristic::power};
        const Image picture = picture_of(name, plain, 1 << 14, 20260101).select(layers);
        write_image(references / (std::string(name) + ".exr"), picture);
    }
}

} // namespace
} // namespace montelux
