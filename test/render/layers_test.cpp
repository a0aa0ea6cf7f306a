// Layers that are switched on change no bit of the mean, and are those of single paths; checkpoints know them.
#include "test/render/layer_testing.h"
#include "test/sanitized.h"
#include "test/temporary_folder.h"
#include <algorithm>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <gtest/gtest.h>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "montelux/mc/math/error.h"
#include "montelux/render/checkpoint.h"
#include "montelux/render/sample_record.h"

namespace montelux::testing {
namespace {

int differing_pixels(const Film& a, const Film& b) {
    int count = 0;
    for (std::size_t i = 0; i < a.pixels().size(); ++i) count += !same_pixel(a.pixels()[i], b.pixels()[i]);
    return count;
}

TEST(Layers, ChangeNoBitOfTheMean) {
    for (const SceneBuilder& scene : {layered_scene(), foggy_scene()}) {
        SceneBuilder b = scene;
        b.description.sampler = {.kind = SamplerKind::sobol, .spp = 40};
        const auto prepared = prepared_scene(b.description);
        const RenderState plain = render_state(b.description, prepared);
        b.description.film.layers.set = every_layer();
        const RenderState layered = render_state(b.description, prepared);
        EXPECT_EQ(differing_pixels(plain.film, layered.film), 0);
        EXPECT_EQ(plain.report.rays.rays(), layered.report.rays.rays());
    }
}

// Paths that are traced in batches and lanes give the numbers of single ones.
TEST(Layers, AreThoseOfSinglePathsBitForBit) {
    for (const SceneBuilder& scene : {layered_scene(), foggy_scene()}) {
        SceneBuilder b = scene;
        std::map<bool, std::shared_ptr<const PreparedScene>>
            prepared; // with tables of the map for MIS or not
        for (const Strategy strategy : {Strategy::mis, Strategy::bsdf, Strategy::light}) {
            const std::uint32_t spp = under_sanitizers ? 2 : 8;
            b.description.sampler = {.kind = SamplerKind::independent, .spp = spp};
            b.description.integrator.strategy = strategy;
            b.description.film.filter = MitchellFilter{};
            b.description.film.max_component_value = 2;
            b.description.film.layers.set = every_layer();
            auto& of_strategy = prepared[strategy == Strategy::mis];
            if (!of_strategy) of_strategy = prepared_scene(b.description);
            const Renderer renderer(b.description, {}, 0, of_strategy);
            RenderState state(b.description);
            renderer.render(state);
            const FilmLayers& layers = state.film.layers();
            const PixelBounds& bounds = state.film.bounds();
            int different = 0;
            std::size_t i = 0;
            for (int y = bounds.y0; y < bounds.y1; ++y)
                for (int x = bounds.x0; x < bounds.x1; ++x, ++i) {
                    std::vector<double> sums(layers.sums());
                    for (std::uint32_t k = 0; k < spp; ++k) {
                        const SampleRecord record = renderer.replay(x, y, k);
                        if (!record.bad) layers.add(sums.data(), record.layer_values.data());
                        layers.end_replicate(sums.data(), 1);
                    }
                    for (std::size_t j = 0; j < sums.size(); ++j)
                        different +=
                            std::bit_cast<std::uint64_t>(sums[j]) !=
                            std::bit_cast<std::uint64_t>(state.film.layer_sums()[i * sums.size() + j]);
                }
            EXPECT_EQ(different, 0);
        }
    }
}

TEST(Layers, AreSavedInCheckpointsAndOtherLayersAreRefused) {
    TemporaryFolder folder;
    const std::filesystem::path path = folder / "render.state";
    SceneBuilder b = layered_scene();
    b.description.sampler = {.kind = SamplerKind::sobol, .spp = 64};
    b.description.film.layers.set = every_layer();
    const auto prepared = prepared_scene(b.description);
    const RenderState whole = render_state(b.description, prepared);
    RenderState state(b.description);
    const Renderer renderer(b.description, {}, 0, prepared);
    CancelFlag cancel;
    RenderControl control;
    control.cancel = &cancel;
    control.checkpoint_seconds = 0.001;
    control.checkpoint = [&](const RenderState& s) {
        save_checkpoint(path, renderer, s);
        if (s.report.samples > 4000) cancel.request();
    };
    renderer.render(state, control);
    ASSERT_TRUE(state.report.cancelled());
    RestoredRender restored = load_checkpoint(path, b.description, {});
    SceneDescription description = b.description;
    description.sampler.replicate_points = restored.replicate_points;
    Renderer(description, {}, 0, prepared).render(restored.state);
    EXPECT_EQ(differing_pixels(restored.state.film, whole.film), 0);
    EXPECT_TRUE(std::ranges::equal(restored.state.film.layer_sums(), whole.film.layer_sums()));

    const auto expect_refused = [&](const SceneDescription& d) {
        try {
            load_checkpoint(path, d, {});
            ADD_FAILURE();
        } catch (const Error& e) {
            EXPECT_NE(std::string(e.what()).find("the layers of the film (--layers) differ"),
                      std::string::npos)
                << e.what();
        }
    };
    SceneDescription other = b.description;
    other.film.layers.set = LayerSet::standard();
    expect_refused(other);
    other.film.layers.set = {Layer::uv};
    expect_refused(other);
    other = b.description;
    other.film.layers.in_camera_space = true;
    expect_refused(other);
    other = b.description;
    other.scene.light_groups = {"", "lamp"};
    expect_refused(other);
    other = b.description;
    other.scene.shape_names = {"wall"};
    expect_refused(other);
    save_checkpoint(path, renderer, whole);
    // What is computed from the pixels alone may be chosen anew.
    other = b.description;
    other.film.layers.set = LayerSet::standard();
    save_checkpoint(path, Renderer(other), RenderState(other));
    other.film.layers.set = {Layer::variance};
    EXPECT_NO_THROW(load_checkpoint(path, other, {}));
}

TEST(Layers, SlicesHaveTheStandardOnes) {
    SceneBuilder b = layered_scene();
    b.description.film.layers.set.add(Layer::uv);
    EXPECT_THROW(Renderer(b.description, {.slice = {0, 2}}), Error);
}

} // namespace
} // namespace montelux::testing
