// Bidirectional path tracing as a render: known answers, the errors of its pixels, and that the picture depends on scene
// and seed alone.
#include "test/render/mixed_scene.h"
#include "test/render/render_in_pieces.h"
#include "test/render/seed_means.h"
#include "test/sanitized.h"
#include "test/temporary_folder.h"
#include <cmath>
#include <filesystem>
#include <functional>
#include <gtest/gtest.h>
#include <vector>

#include "montelux/mc/math/error.h"
#include "montelux/mc/parallel/parallel_for.h"
#include "montelux/render/render_session.h"
#include "montelux/render/sample_record.h"
#include "montelux/render/splat_pass.h"

namespace montelux::testing {
namespace {

// Inside a closed surface of albedo rho that emits E, radiance is E (1 + rho + rho^2 + ...).
TEST(BidirectionalPictures, Furnace) {
    SceneBuilder b;
    b.add_quadric(Sphere{}, b.add(DiffuseMaterial{gray(0.5f)}), 1, true);
    b.look({0.2, 0.1, -0.3}, {1, 0, 0}, 60);
    for (const int depth : {0, 1, 2, 200}) {
        b.description.integrator.max_depth = depth;
        const double truth = 2 - std::pow(0.5, depth);
        for (const Heuristic heuristic : {Heuristic::balance, Heuristic::power}) {
            b.description.integrator.heuristic = heuristic;
            const SeedMeans m = render_of_seeds(b.description, IntegratorKind::bidirectional, 16);
            EXPECT_NEAR(m.channel[1].mean(), truth, 7 * m.channel[1].standard_error() + 2e-4 * truth)
                << depth;
        }
    }
}

// The share of seeds in which the truth lies within one and two errors of a pixel, by Student's law of the passes.
TEST(BidirectionalPictures, ErrorsOfPixelsAreCalibrated) {
    SceneBuilder b = lit_corner();
    add_box_lamp(b);
    const SeedMeans truth = render_of_seeds(b.description, IntegratorKind::path, 2048);
    for (const SamplerKind kind : {SamplerKind::independent, SamplerKind::sobol}) {
        b.description.sampler.kind = kind;
        b.description.sampler.replicates = kind == SamplerKind::sobol ? 32 : 0;
        const SeedMeans renders = render_of_seeds(b.description, IntegratorKind::bidirectional, 512, 60);
        double within_one = 0, within_two = 0, count = 0;
        for (std::size_t p = 0; p < renders.films[0].pixels().size(); ++p) {
            double expected = 0, variance = 0;
            for (const Film& film : truth.films) {
                expected += film.pixels()[p].replicates().mean(1) / bidirectional_seeds;
                variance += film.pixels()[p].replicates().variance_of_mean(1) /
                            (bidirectional_seeds * bidirectional_seeds);
            }
            for (const Film& film : renders.films) {
                const SkewMoments<3>& r = film.pixels()[p].replicates();
                EXPECT_EQ(r.count(), kind == SamplerKind::sobol ? 32u : 512u);
                if (!(variance > 0)) continue; // past the floor
                const double t = std::abs(r.mean(1) - expected) / std::sqrt(r.variance_of_mean(1) + variance);
                within_one += t < 1;
                within_two += t < 2;
                ++count;
            }
        }
        // Of Student's law with 31 and 511 degrees of freedom: 67.5 and 68.2 %, 94.6 and 95.4 %. A little less here: few
        // light paths reach a pixel, so that its mean is skewed. The scores of one render are dependent.
        EXPECT_GT(within_one / count, 0.62) << int(kind);
        EXPECT_LT(within_one / count, 0.72) << int(kind);
        EXPECT_GT(within_two / count, 0.90) << int(kind);
        EXPECT_LT(within_two / count, 0.97) << int(kind);
    }
}

int differing(const Film& a, const Film& b) {
    int n = 0;
    for (std::size_t i = 0; i < a.pixels().size(); ++i) n += !same_pixel(a.pixels()[i], b.pixels()[i]);
    return n;
}

SceneBuilder bidirectional_room(int width, int height) {
    SceneBuilder b = mixed_scene(1, width, height);
    b.description.integrator.method = IntegratorKind::bidirectional;
    b.description.film.filter = GaussianFilter{};
    return b;
}

TEST(BidirectionalPictures, AnyNumberOfThreadsGivesTheSameBits) {
    SceneBuilder b = bidirectional_room(40, 24);
    b.description.sampler.spp = under_sanitizers ? 2 : 6;
    const auto prepared = prepared_scene(b.description);
    for (const SamplerKind kind : {SamplerKind::independent, SamplerKind::sobol}) {
        b.description.sampler.kind = kind;
        b.description.sampler.replicates = kind == SamplerKind::sobol ? 2 : 0;
        std::vector<Film> films;
        for (const int threads : {1, 2, 7})
            with_threads(threads, [&] { films.push_back(render(b.description, prepared)); });
        for (std::size_t i = 1; i < films.size(); ++i)
            EXPECT_EQ(differing(films[0], films[i]), 0) << int(kind);
        b.description.sampler.seed = 2;
        EXPECT_GT(differing(films[0], render(b.description, prepared)), 900);
        b.description.sampler.seed = 0;
    }
}

// A light path may bring to one pixel as much as the pixels of the film together: of a bright lamp, a large number.
TEST(BidirectionalPictures, BrightLightPathsAreNotLost) {
    SceneBuilder b = bidirectional_room(40, 24);
    b.description.sampler.spp = 4;
    const auto prepared = prepared_scene(b.description);
    const Image plain = render(b.description, prepared).develop();
    constexpr float scale = 0x1p20f;
    b.description.film.iso *= scale;
    Film film(b.description.film);
    EXPECT_EQ(Renderer(b.description, {}, 0, prepared).render(film).bad.count(), 0u);
    const Image bright = film.develop();
    double sum = 0, scaled = 0;
    for (int y = 0; y < plain.height(); ++y)
        for (int x = 0; x < plain.width(); ++x) {
            sum += double(plain.value(x, y, 1));
            scaled += double(bright.value(x, y, 1) / scale);
        }
    EXPECT_GT(sum, 0);
    EXPECT_NEAR(scaled / sum, 1, 1e-6);
}

// Interrupted within passes, saved, and resumed.
TEST(BidirectionalPictures, ResumedRendersHaveTheSameBits) {
    const TemporaryFolder folder;
    const std::filesystem::path path = folder / "render.state";
    SceneBuilder b = bidirectional_room(40, 24);
    const auto prepared = prepared_scene(b.description);
    for (const SamplerKind kind : {SamplerKind::independent, SamplerKind::sobol}) {
        b.description.sampler.kind = kind;
        b.description.sampler.spp = under_sanitizers ? 6 : 28;
        RenderState whole(b.description);
        Renderer(b.description, {}, 0, prepared).render(whole);
        const Pieces pieces = render_in_pieces(b.description, path, whole.report.samples, prepared);
        EXPECT_EQ(differing(pieces.state.film, whole.film), 0) << int(kind);
        EXPECT_GT(pieces.count, 2) << int(kind);
        EXPECT_GT(pieces.begun_within_a_pass, 0) << int(kind);
    }
}

// A picture of an interrupted render contains whole passes only; one that was kept open goes on to the same bits.
TEST(BidirectionalPictures, OpenPassesAreLeftOut) {
    SceneBuilder b = bidirectional_room(40, 24);
    b.description.sampler = {.kind = SamplerKind::sobol, .seed = 5, .spp = 32};
    b.description.sampler.replicates = 4;
    const auto description = std::make_shared<const SceneDescription>(b.description);
    const auto prepared = prepared_scene(*description);
    RenderState whole(*description);
    Renderer(*description, {}, 0, prepared).render(whole);
    RenderSession session(description, {.prepared = prepared});
    CancelFlag cancel;
    RenderCompany company;
    company.keep_open = true;
    company.cancel = &cancel;
    company.progress = [&](const RenderProgress& p) {
        if (p.samples_done >= 12 * 960) cancel.request();
    };
    session.render(company);
    ASSERT_TRUE(session.report().cancelled());
    const RenderSnapshot part = session.picture();
    const std::optional<int> replicates = part.image->find_channel("replicates");
    ASSERT_TRUE(replicates);
    for (int y = 0; y < 24; ++y)
        for (int x = 0; x < 40; ++x)
            EXPECT_EQ(part.image->value(x, y, *replicates), part.image->value(0, 0, *replicates));
    session.render({});
    const RenderSnapshot finished = session.finish();
    for (int y = 0; y < 24; ++y)
        for (int x = 0; x < 40; ++x)
            ASSERT_EQ(finished.image->value(x, y, 1),
                      static_cast<float>(whole.film.pixel(x, y).replicates().mean(1)));
}

std::string refusal_of(const SceneDescription& d, const RenderTarget& target = {}) {
    try {
        Renderer renderer(d, target);
    } catch (const Error& e) {
        return e.what();
    }
    return "";
}

TEST(BidirectionalPictures, RefusesWhatItCannotDo) {
    SceneBuilder corner = lit_corner();
    corner.description.integrator.method = IntegratorKind::bidirectional;
    EXPECT_EQ(refusal_of(corner.description), "");
    const auto expect_refused = [&](const std::function<void(SceneDescription&)>& change, const char* word) {
        SceneDescription d = corner.description;
        change(d);
        EXPECT_NE(refusal_of(d).find(word), std::string::npos) << word << ": " << refusal_of(d);
        d.integrator.method = IntegratorKind::path;
        EXPECT_EQ(refusal_of(d), "") << word;
    };
    expect_refused([](auto& d) { d.scene.media.push_back(HomogeneousMedium{.is_body = true}); },
                   "translucent bodies");
    expect_refused([](auto& d) { d.scene.camera.model = SphericalCamera{}; }, "spherical");
    expect_refused([](auto& d) { d.integrator.strategy = Strategy::light; }, "strategies");
    expect_refused([](auto& d) { d.integrator.regularize = true; }, "regularization");
    expect_refused([](auto& d) { d.integrator.shading_terminator = ShadingTerminator::soft; }, "terminator");
    expect_refused([](auto& d) { d.film.layers.set.add(Layer::direct); }, "parts of the light");
    expect_refused([](auto& d) { d.film.spectral = SpectralSettings{}; }, "spectral");
    EXPECT_NE(refusal_of(corner.description, {.adaptive = true}).find("--adaptive"), std::string::npos);
    EXPECT_THROW(Renderer(corner.description).replay(1, 1, 0), Error);
}

} // namespace
} // namespace montelux::testing
