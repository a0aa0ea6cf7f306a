// The choice of an integrator: what pilots decide, and that their samples are those of the render.
#include "test/render/mixed_scene.h"
#include "test/temporary_folder.h"
#include <functional>
#include <gtest/gtest.h>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "montelux/mc/math/error.h"
#include "montelux/mc/parallel/parallel_for.h"
#include "montelux/render/checkpoint.h"
#include "montelux/render/integrator_choice.h"
#include "montelux/render/integrator_pilot.h"
#include "montelux/render/render_session.h"
#include "montelux/render/tile_renderer.h"

namespace montelux::testing {
namespace {

int count_differing(const Film& a, const Film& b) {
    int n = 0;
    for (std::size_t i = 0; i < a.pixels().size(); ++i) n += !same_pixel(a.pixels()[i], b.pixels()[i]);
    return n;
}

SceneBuilder large(int width, int height, std::uint32_t spp) {
    SceneBuilder b;
    b.description.film.width = width;
    b.description.film.height = height;
    b.description.film.crop = {0, 0, width, height};
    b.description.sampler = {.kind = SamplerKind::sobol, .seed = 3, .spp = spp};
    b.description.integrator.method = IntegratorKind::automatic;
    return b;
}

// A floor under a wide lamp.
SceneBuilder lit_floor(int size = 64, std::uint32_t spp = 1024) {
    SceneBuilder b = large(size, size, spp);
    b.add_mesh(square(Transform::scale({3, 3, 1})), b.add(DiffuseMaterial{gray(0.6f)}));
    b.add_mesh(square(Transform::translate({0, 0, 3}) * Transform::rotate(180, {1, 0, 0})),
               b.add(DiffuseMaterial{gray(0)}), 5);
    b.look({0, -5, 3}, {0, 0, 0}, 40);
    return b;
}

// All of the floor's light comes through the glass that surrounds the lamp above the picture: one of radius 0.02, which paths from the camera hit
// once in a while, or a point, which they never hit.
SceneBuilder lamp_in_glass(bool is_point, int size = 64, std::uint32_t spp = 1024) {
    SceneBuilder b = large(size, size, spp);
    b.description.integrator.max_depth = 6;
    b.add_mesh(square(Transform::scale({3, 3, 1})), b.add(DiffuseMaterial{gray(0.6f)}));
    const Transform place = Transform::translate({0, 0, 1.5});
    b.add_quadric(Sphere{.world_from_object = place * Transform::scale({0.3, 0.3, 0.3})},
                  b.add(DielectricMaterial{1.5f, alpha_of(0)}));
    if (is_point)
        b.scene.lights.push_back(PointLight{white_light(b.scene), white_scale() * 5, {0, 0, 1.5f}});
    else
        b.add_quadric(Sphere{.world_from_object = place * Transform::scale({0.02, 0.02, 0.02})},
                      b.add(DiffuseMaterial{gray(0)}), 2000);
    b.look({0, -5, 3}, {0, 0, 0}, 20);
    return b;
}

IntegratorChoiceSettings settings_for(const RenderTarget& target, const CancelFlag* cancel = nullptr) {
    return {.target =
                [target](IntegratorKind kind) {
                    RenderTarget t = target;
                    t.adaptive = t.adaptive && kind == IntegratorKind::path;
                    return t;
                },
            .cancel = cancel};
}
std::shared_ptr<ChosenIntegrator> chosen_for(SceneDescription& d, const RenderTarget& target = {}) {
    return choose_integrator(d, settings_for(target));
}

CandidateOutcome outcome_of(const IntegratorChoice& choice, IntegratorKind kind) {
    for (const IntegratorChoice::Candidate& c : choice.candidates)
        if (c.kind == kind) return c.outcome;
    return CandidateOutcome::refused;
}

TEST(IntegratorChoice, PathTracingWinsUnderAWideLamp) {
    SceneBuilder b = lit_floor();
    const auto chosen = chosen_for(b.description);
    EXPECT_EQ(b.description.integrator.method, IntegratorKind::path);
    const IntegratorChoice& choice = chosen->state.report.choice;
    EXPECT_TRUE(choice.decided);
    EXPECT_EQ(outcome_of(choice, IntegratorKind::bidirectional), CandidateOutcome::measured);
    EXPECT_NE(choice_text(choice).find("path: to the same error bidirectional would take"), std::string::npos)
        << choice_text(choice);
    EXPECT_TRUE(chosen->refusals.empty());
}

// A polished ball reflects bright light of a small lamp: now and then the few samples of a pilot make path tracing look
// hopeless. By the ratio of the efforts alone two of these seeds would choose `bidirectional`.
TEST(IntegratorChoice, FirefliesDoNotDecide) {
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
        SceneBuilder b = lit_floor();
        b.description.sampler.seed = seed;
        b.add_quadric(Sphere{.world_from_object =
                                 Transform::translate({0, -0.8, 0.4}) * Transform::scale({0.4, 0.4, 0.4})},
                      b.add(ConductorMaterial{.metal = {.eta = gray(0.2f), .k = gray(4)},
                                              .roughness = alpha_of(0.1f)}));
        b.add_mesh(square(Transform::translate({1, -1, 2.5}) * Transform::rotate(180, {1, 0, 0}) *
                          Transform::scale({0.1, 0.1, 1})),
                   b.add(DiffuseMaterial{gray(0)}), 200);
        chosen_for(b.description);
        EXPECT_EQ(b.description.integrator.method, IntegratorKind::path) << seed;
    }
}

TEST(IntegratorChoice, LightPathsWinWhereLampsAreInGlass) {
    for (const bool is_point : {false, true})
        for (const double error : {0.0, 0.01}) {
            SceneBuilder b = lamp_in_glass(is_point);
            const auto chosen = chosen_for(b.description, {.error = error});
            EXPECT_EQ(b.description.integrator.method, IntegratorKind::bidirectional) << is_point << error;
            const IntegratorChoice& choice = chosen->state.report.choice;
            EXPECT_GT(choice.time_ratio(choice.candidates[0]), 50) << choice_text(choice);
            EXPECT_EQ(choice.seconds_to_target > 0, error > 0);
        }
}

// With a small target error groups of chains are short, and their pilot affordable.
TEST(IntegratorChoice, MeasuresChainsInLongRenders) {
    SceneBuilder b = lit_floor(32, 1u << 20);
    const auto chosen = chosen_for(b.description, {.error = 2e-3});
    const IntegratorChoice& choice = chosen->state.report.choice;
    EXPECT_EQ(outcome_of(choice, IntegratorKind::metropolis), CandidateOutcome::measured);
    EXPECT_GT(choice.candidates[2].effort, 0);
    SceneBuilder brief = lit_floor(32, 256);
    EXPECT_EQ(outcome_of(chosen_for(brief.description)->state.report.choice, IntegratorKind::metropolis),
              CandidateOutcome::unaffordable);
}

// A render continued from a pilot of any integrator has the bits of one without a pilot.
TEST(IntegratorChoice, PilotsTakeTheSamplesOfTheRender) {
    struct Case {
        IntegratorKind kind;
        SamplerKind sampler;
        RenderTarget target;
        Guiding guiding = Guiding::off;
        std::uint32_t spp = 18;
    };
    const RenderTarget none, aimed{.error = 0.05}, adaptive{.error = 0.05, .adaptive = true};
    using K = IntegratorKind;
    using S = SamplerKind;
    SceneDescription d = mixed_scene(1, 30, 26).description;
    d.film.filter = GaussianFilter{};
    d.integrator.method = K::bidirectional; // whose tables serve all
    const auto prepared = prepared_scene(d);
    for (const Case& c : std::vector<Case>{{K::path, S::sobol, none},
                                           {K::path, S::independent, adaptive},
                                           {K::path, S::independent, aimed},
                                           {K::path, S::sobol, none, Guiding::on},
                                           {K::bidirectional, S::sobol, none},
                                           {K::bidirectional, S::sobol, aimed},
                                           {K::bidirectional, S::independent, none},
                                           {K::path, S::sobol, none, Guiding::off, 1},
                                           {K::bidirectional, S::independent, none, Guiding::off, 1},
                                           {K::metropolis, S::sobol, aimed}}) {
        d.sampler = {.kind = c.sampler, .seed = 4, .spp = c.spp};
        d.integrator.method = c.kind;
        d.integrator.guiding = c.guiding;
        const Renderer renderer(d, c.target, 0, prepared);
        RenderState plain(d);
        renderer.render(plain);
        std::vector<PixelBounds> tiles = tiles_of(d.film.crop, 8);
        std::swap(tiles[1], tiles[11]);
        IntegratorPilot pilot(renderer, tiles);
        if (c.kind == K::metropolis)
            ASSERT_TRUE(pilot.take_groups(7, nullptr));
        else
            ASSERT_TRUE(pilot.take_tiles(7, nullptr));
        RenderState continued = pilot.take_state();
        EXPECT_GT(continued.report.samples, 0u);
        renderer.render(continued);
        EXPECT_EQ(count_differing(continued.film, plain.film), 0) << int(c.kind) << int(c.sampler);
        EXPECT_EQ(continued.report.samples, plain.report.samples);
        EXPECT_EQ(continued.report.stop, plain.report.stop);
        EXPECT_EQ(continued.guide != nullptr, c.guiding == Guiding::on);
    }
}

TEST(IntegratorChoice, DoesNotDependOnThreads) {
    SceneBuilder b = lamp_in_glass(false, 48, 512);
    std::vector<double> efforts;
    std::optional<Film> film;
    for (const int threads : {1, 2, 7})
        with_threads(threads, [&] {
            SceneDescription d = b.description;
            const auto chosen = chosen_for(d);
            const IntegratorChoice& choice = chosen->state.report.choice;
            std::vector<double> now;
            for (const auto& c : choice.candidates) now.push_back(c.effort);
            if (efforts.empty()) efforts = now;
            EXPECT_EQ(now, efforts) << threads;
            EXPECT_EQ(d.integrator.method, IntegratorKind::bidirectional);
            if (!film) film = chosen->state.film;
            EXPECT_EQ(count_differing(chosen->state.film, *film), 0);
        });
}

TEST(IntegratorChoice, ResumedRendersKeepIt) {
    TemporaryFolder folder;
    const auto path = folder / "render.ckpt";
    SceneBuilder b = lamp_in_glass(true, 24, 1024);
    SceneDescription by_name = b.description;
    by_name.integrator.method = IntegratorKind::bidirectional;
    const Film whole = render(by_name);
    for (int run = 0; run < 2; ++run) {
        const auto d = std::make_shared<SceneDescription>(b.description);
        RenderSessionSettings settings{.checkpoint = path, .resume = run > 0};
        ASSERT_TRUE(decide_integrator(*d, settings, settings_for({})));
        EXPECT_EQ(d->integrator.method, IntegratorKind::bidirectional);
        EXPECT_EQ(settings.chosen == nullptr, run > 0);
        RenderSession session(d, settings);
        EXPECT_EQ(session.resumed(), run > 0);
        CancelFlag cancel;
        RenderCompany company;
        if (run == 0) {
            company.cancel = &cancel;
            company.progress = [&](const RenderProgress&) { cancel.request(); };
        }
        session.render(company);
        EXPECT_EQ(session.report().cancelled(), run == 0);
        const RenderSnapshot picture = session.finish();
        EXPECT_EQ(picture.report.choice.chosen, IntegratorKind::bidirectional);
        if (run == 0) continue;
        for (int y = 0; y < 24; ++y)
            for (int x = 0; x < 24; ++x)
                ASSERT_EQ(picture.image->value(x, y, 1),
                          static_cast<float>(whole.pixel(x, y).replicates().mean(1)));
    }
    // Of another render.
    SceneDescription other = b.description;
    other.integrator.max_depth = 2;
    EXPECT_THROW(integrator_of_checkpoint(path, other), Error);
    EXPECT_THROW(integrator_of_checkpoint(folder / "none", other), Error);
}

TEST(IntegratorChoice, SaysWhyOthersCannotRender) {
    const auto refusals = [](const std::function<void(SceneDescription&)>& change, RenderTarget target = {}) {
        SceneBuilder b = lit_floor(32, 64);
        change(b.description);
        const auto chosen =
            choose_integrator(b.description, {.target = [target](IntegratorKind) { return target; }});
        EXPECT_EQ(b.description.integrator.method, IntegratorKind::path);
        std::string all;
        for (const std::string& r : chosen->refusals) all += r + "\n";
        return all;
    };
    const std::string panorama =
        refusals([](SceneDescription& d) { d.scene.camera.model = SphericalCamera{}; });
    EXPECT_NE(panorama.find("bidirectional: spherical cameras"), std::string::npos) << panorama;
    EXPECT_EQ(panorama.find("metropolis"), std::string::npos) << panorama;
    EXPECT_EQ(panorama.find("choose"), std::string::npos) << panorama;
    const std::string guided = refusals([](SceneDescription& d) { d.integrator.guiding = Guiding::on; });
    EXPECT_NE(guided.find("guided"), std::string::npos) << guided;
    EXPECT_NE(refusals([](SceneDescription&) {}, {.adaptive = true}).find("chains choose themselves"),
              std::string::npos);
    SceneBuilder b = lit_floor(32, 64);
    EXPECT_THROW(chosen_for(b.description, {.slice = {0, 2}}), Error);
    EXPECT_THROW(Renderer{b.description}, Error); // not chosen
    b.description.integrator.merging = MergingSettings{};
    EXPECT_THROW(chosen_for(b.description), Error);
    SceneBuilder alone = lit_floor(32, 64);
    alone.description.integrator.guiding = Guiding::on;
    EXPECT_EQ(choice_text(chosen_for(alone.description)->state.report.choice),
              "path: no other integrator can render this scene with these settings");
}

TEST(IntegratorChoice, OfDarkScenesAndShortRenders) {
    SceneBuilder dark = lit_floor(), brief = lit_floor(64, 4);
    for (Light& light : dark.scene.lights)
        if (auto* area = std::get_if<AreaLight>(&light)) area->scale = 0;
    const auto chosen = chosen_for(dark.description);
    EXPECT_EQ(choice_text(chosen->state.report.choice).find("path: the pilot found no light"), 0u)
        << choice_text(chosen->state.report.choice);
    const std::string text = choice_text(chosen_for(brief.description)->state.report.choice);
    EXPECT_EQ(text, "path: the render is too short to try bidirectional and metropolis");
}

TEST(IntegratorChoice, CancelledChoosesNothing) {
    SceneBuilder b = lit_floor();
    CancelFlag cancel;
    cancel.request();
    EXPECT_EQ(choose_integrator(b.description, settings_for({}, &cancel)), nullptr);
    EXPECT_EQ(b.description.integrator.method, IntegratorKind::automatic);
}

} // namespace
} // namespace montelux::testing
