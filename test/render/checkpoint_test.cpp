// An interrupted and resumed render ends with the bits of an uninterrupted one.
#include "test/render/mixed_scene.h"
#include "test/sanitized.h"
#include "test/temporary_folder.h"
#include <filesystem>
#include <gtest/gtest.h>

#include "montelux/mc/math/error.h"
#include "montelux/mc/random/hash.h"
#include "montelux/render/checkpoint.h"

namespace montelux::testing {
namespace {

class Checkpoint : public ::testing::Test {
  protected:
    TemporaryFolder folder_;
    std::filesystem::path path_ = folder_ / "render.state";
};

void expect_same(const Film& a, const Film& b) {
    int differing = 0;
    for (std::size_t i = 0; i < a.pixels().size(); ++i)
        differing += !same_pixel(a.pixels()[i], b.pixels()[i]);
    EXPECT_EQ(differing, 0);
}

// Interrupts the render after some more samples each time, and resumes it from the file.
TEST_F(Checkpoint, InterruptedRendersEndWithTheSameBits) {
    const SceneDescription scene = mixed_scene(1, 16, 12).description;
    const auto prepared = prepared_scene(scene);
    for (SamplerKind kind : {SamplerKind::independent, SamplerKind::sobol, SamplerKind::stratified})
        for (bool adaptive : {false, true}) {
            SceneDescription uninterrupted = scene;
            uninterrupted.sampler.kind = kind;
            uninterrupted.sampler.spp = under_sanitizers ? 24 : 100;
            const RenderTarget target{.adaptive = adaptive};
            RenderState whole(uninterrupted.film);
            Renderer(uninterrupted, target, 0, prepared).render(whole);

            int stops = 0;
            for (bool ended = false; !ended;) {
                RenderState state(uninterrupted.film);
                SceneDescription description = uninterrupted;
                if (stops > 0) {
                    RestoredRender restored = load_checkpoint(path_, description, target);
                    description.sampler.replicate_points = restored.replicate_points;
                    state = std::move(restored.state);
                }
                const Renderer renderer(description, target, 0, prepared);
                CancelFlag cancel;
                const std::uint64_t begin = state.report.samples, more = 1 + hash_key(7, stops) % 4000;
                RenderControl control;
                control.cancel = &cancel;
                control.checkpoint_seconds = 0.002;
                control.progress = [&](const RenderProgress& p) {
                    if (p.samples_done >= begin + more) cancel.request();
                };
                control.checkpoint = [&](const RenderState& s) {
                    save_checkpoint(path_, renderer, s);
                    if (s.report.samples >= begin + more) cancel.request();
                };
                renderer.render(state, control);
                ended = !state.report.cancelled();
                if (ended) expect_same(state.film, whole.film);
                ++stops;
                ASSERT_LT(stops, 1000);
            }
            EXPECT_GT(stops, 3) << int(kind);
        }
}

// The last generation may end anywhere; a finished render may be continued to more samples.
TEST_F(Checkpoint, FinishedRendersCanBeRaised) {
    SceneBuilder b = mixed_scene(1, 16, 16);
    const auto prepared = prepared_scene(b.description);
    for (SamplerKind kind : {SamplerKind::independent, SamplerKind::sobol}) {
        b.description.sampler = {.kind = kind, .spp = 36};
        RenderState first(b.description.film);
        Renderer renderer(b.description, {}, 0, prepared);
        RenderControl control;
        control.checkpoint = [&](const RenderState& s) { save_checkpoint(path_, renderer, s); };
        renderer.render(first, control);
        b.description.sampler.spp = 90;
        RestoredRender restored = load_checkpoint(path_, b.description, {});
        b.description.sampler.replicate_points = restored.replicate_points;
        Renderer(b.description, {}, 0, prepared).render(restored.state);
        RenderState whole(b.description.film);
        Renderer(b.description, {}, 0, prepared).render(whole);
        expect_same(restored.state.film, whole.film);
        EXPECT_EQ(restored.state.film.pixel(0, 0).samples(), 90u);
    }
}

TEST_F(Checkpoint, OtherRendersAreRefusedWithTheReason) {
    SceneBuilder b = mixed_scene(1, 8, 8);
    const Renderer renderer(b.description);
    save_checkpoint(path_, renderer, RenderState(b.description.film));
    EXPECT_NO_THROW(load_checkpoint(path_, b.description, {}));
    auto refused = [&](const SceneDescription& d, const RenderTarget& target, const std::string& why) {
        try {
            load_checkpoint(path_, d, target);
            ADD_FAILURE() << why;
        } catch (const Error& e) {
            EXPECT_NE(std::string(e.what()).find(why), std::string::npos) << e.what();
        }
    };
    auto changed = [&](auto change) {
        SceneDescription d = b.description;
        change(d);
        return d;
    };
    // A scene is known by its values, wherever it comes from.
    auto of_grey = [&](float reflectance) {
        return changed(
            [&](SceneDescription& d) { d.scene.materials[0] = DiffuseMaterial{gray(reflectance)}; });
    };
    refused(of_grey(0.1f), {}, "the scene's materials differ");
    save_checkpoint(path_, Renderer(of_grey(0.1f)), RenderState(b.description.film));
    refused(of_grey(0.9f), {}, "the scene's materials differ");
    EXPECT_NO_THROW(load_checkpoint(path_, of_grey(0.1f), {}));
    save_checkpoint(path_, renderer, RenderState(b.description.film));
    refused(changed([](SceneDescription& d) { d.scene.meshes[0].positions[0].z += 1e-3f; }), {},
            "the scene's geometry differs");
    refused(changed([](SceneDescription& d) { d.scene.environments[0].f32()[7] = 2; }), {},
            "the scene's lights differ");
    refused(changed([](SceneDescription& d) { std::get<PerspectiveCamera>(d.scene.camera.model).fov = 30; }),
            {}, "the scene's camera differs");
    refused(changed([](SceneDescription& d) { d.film.iso *= 2; }), {}, "film");
    refused(changed([](SceneDescription& d) { d.film.exposure_time *= 2; }), {}, "film");
    refused(changed([](SceneDescription& d) { d.film.white_balance = 5000; }), {}, "film");
    refused(changed([](SceneDescription& d) { d.film.max_component_value = 10; }), {}, "film");
    refused(changed([](SceneDescription& d) {
                d.film.filter = GaussianFilter{{1.5f, 1.5f}, 0.4f};
            }),
            {}, "film");
    refused(changed([](SceneDescription& d) { ++d.sampler.seed; }), {}, "sampler or seed");
    refused(changed([](SceneDescription& d) { ++d.integrator.max_depth; }), {}, "integrator");
    const auto refused_integrator = [&](auto change) {
        refused(changed([&](SceneDescription& d) { change(d.integrator); }), {}, "integrator");
    };
    refused_integrator([](IntegratorSettings& s) { s.regularize = true; });
    refused_integrator([](IntegratorSettings& s) { s.equiangular = !s.equiangular; });
    refused_integrator([](IntegratorSettings& s) { s.shading_terminator = ShadingTerminator::soft; });
    refused_integrator(
        [](IntegratorSettings& s) { s.microfacet_scattering = MicrofacetScattering::multiple; });
    refused_integrator([](IntegratorSettings& s) { s.occlusion = OcclusionSettings{}; });
    const SceneDescription occlusion =
        changed([](SceneDescription& d) { d.integrator.occlusion = OcclusionSettings{}; });
    save_checkpoint(path_, Renderer(occlusion), RenderState(occlusion.film));
    EXPECT_NO_THROW(load_checkpoint(path_, occlusion, {}));
    refused_integrator([](IntegratorSettings& s) { s.occlusion = OcclusionSettings{.max_distance = 1}; });
    refused_integrator([](IntegratorSettings& s) { s.occlusion = OcclusionSettings{.cosine = false}; });
    save_checkpoint(path_, renderer, RenderState(b.description.film));
    refused(changed([](SceneDescription& d) { d.film.sensor = "nikon_d850"; }), {}, "film");
    refused(changed([](SceneDescription& d) { d.film.spectral = SpectralSettings{}; }), {}, "film");
    refused(b.description, {.adaptive = true}, "allocation");
    refused(b.description, {.slice = {0, 2}}, "slice");
    refused(changed([](SceneDescription& d) {
                d.film.width = d.film.height = 4;
                d.film.crop = {0, 0, 4, 4};
            }),
            {}, "film");
    // Damage is found by the file (generation_file_test); the previous one is used.
    save_checkpoint(path_, renderer, RenderState(b.description.film));
    std::filesystem::resize_file(path_, 1000);
    EXPECT_FALSE(load_checkpoint(path_, b.description, {}).newest_refused_because.empty());
}

} // namespace
} // namespace montelux::testing
