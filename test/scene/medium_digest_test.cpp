// Digests of media: every value counts, and nothing in scenes without media.
#include "test/scene/scene_digest_testing.h"
#include <gtest/gtest.h>

#include "montelux/scene/scene_digest.h"

namespace montelux {
namespace {

using testing::expect_changes;
using testing::scene_of_all_kinds;

TEST(SceneDigest, MediaCount) {
    const auto at = []<typename M>(Scene& s, std::type_identity<M>) -> M& {
        for (Medium& m : s.media)
            if (auto* found = std::get_if<M>(&m)) return *found;
        throw std::bad_variant_access();
    };
    const std::type_identity<HomogeneousMedium> fog;
    const std::type_identity<GridMedium> grid;
    const std::type_identity<RgbGridMedium> rgb;
    const std::type_identity<CloudMedium> cloud;
    const std::type_identity<SparseGridMedium> sparse;
    const std::type_identity<FieldMedium> field;
    const Transform moved = Transform::translate({1, 0, 0});
    const auto surface_with = [=](auto change) {
        return [=](Scene& s) {
            at(s, fog).surface.kind = BodySurface::Kind::coefficients;
            change(at(s, fog).surface);
        };
    };
    expect_changes(&SceneDigest::materials,
                   {[=](Scene& s) { at(s, fog).sigma_a = 2; },
                    [=](Scene& s) { at(s, fog).sigma_s = 2; },
                    [=](Scene& s) { at(s, fog).scale = 2; },
                    [=](Scene& s) { at(s, fog).le = 2; },
                    [=](Scene& s) { at(s, fog).le_scale = 2; },
                    [=](Scene& s) { at(s, fog).phase = HenyeyGreenstein{0.5f}; },
                    [=](Scene& s) { at(s, fog).phase = Draine{}; },
                    [=](Scene& s) {
                        at(s, fog).phase = Draine{0, 0.5f};
                    },
                    [=](Scene& s) { at(s, fog).is_body = true; },
                    surface_with([](BodySurface&) {}),
                    surface_with([](BodySurface& b) { b.kind = BodySurface::Kind::reflectance; }),
                    surface_with([](BodySurface& b) { b.first.value = 2; }),
                    surface_with([](BodySurface& b) { b.first.texture = 0; }),
                    surface_with([](BodySurface& b) { b.second.value = 2; }),
                    surface_with([](BodySurface& b) { b.second.texture = 0; }),
                    surface_with([](BodySurface& b) { b.scale = 2; }),
                    surface_with([](BodySurface& b) { b.eta = 1.5f; }),
                    surface_with([](BodySurface& b) { b.g = 0.5f; }),
                    [=](Scene& s) { at(s, grid).box.p0.x = -1; },
                    [=](Scene& s) { at(s, grid).box.p1.z = 2; },
                    [=](Scene& s) { at(s, grid).box.world_from_medium = moved; },
                    [=](Scene& s) { at(s, grid).density = 0; },
                    [=](Scene& s) { at(s, grid).sigma_a = 2; },
                    [=](Scene& s) { at(s, grid).sigma_s = 2; },
                    [=](Scene& s) { at(s, grid).scale = 2; },
                    [=](Scene& s) { at(s, grid).le = 2; },
                    [=](Scene& s) { at(s, grid).le_scale = 2; },
                    [=](Scene& s) { at(s, grid).le_grid = 0; },
                    [=](Scene& s) { at(s, grid).temperature = 0; },
                    [=](Scene& s) { at(s, grid).temperature_offset = 2; },
                    [=](Scene& s) { at(s, grid).temperature_scale = 2; },
                    [=](Scene& s) { at(s, grid).phase = Draine{}; },
                    [=](Scene& s) { at(s, rgb).box.p0.y = -1; },
                    [=](Scene& s) { at(s, rgb).sigma_a = 0; },
                    [=](Scene& s) { at(s, rgb).sigma_s = 0; },
                    [=](Scene& s) { at(s, rgb).scale = 2; },
                    [=](Scene& s) { at(s, rgb).le = 0; },
                    [=](Scene& s) { at(s, rgb).illuminant = 1; },
                    [=](Scene& s) { at(s, rgb).le_scale = 2; },
                    [=](Scene& s) { at(s, rgb).phase = Draine{}; },
                    [=](Scene& s) { at(s, cloud).box.p0.z = -1; },
                    [=](Scene& s) { at(s, cloud).sigma_a = 2; },
                    [=](Scene& s) { at(s, cloud).sigma_s = 2; },
                    [=](Scene& s) { at(s, cloud).density = 2; },
                    [=](Scene& s) { at(s, cloud).wispiness = 2; },
                    [=](Scene& s) { at(s, cloud).frequency = 2; },
                    [=](Scene& s) { at(s, cloud).phase = Draine{}; },
                    [=](Scene& s) { at(s, sparse).box.p0.y = -1; },
                    [=](Scene& s) { at(s, sparse).density = 0; },
                    [=](Scene& s) { at(s, sparse).sigma_a = 2; },
                    [=](Scene& s) { at(s, sparse).sigma_s = 2; },
                    [=](Scene& s) { at(s, sparse).scale = 2; },
                    [=](Scene& s) { at(s, sparse).temperature = 0; },
                    [=](Scene& s) { at(s, sparse).temperature_space_from_density = moved; },
                    [=](Scene& s) { at(s, sparse).le_scale = 2; },
                    [=](Scene& s) { at(s, sparse).temperature_offset = 2; },
                    [=](Scene& s) { at(s, sparse).temperature_scale = 2; },
                    [=](Scene& s) { at(s, sparse).phase = Draine{}; },
                    [=](Scene& s) { at(s, field).box.p0.x = -1; },
                    [=](Scene& s) { at(s, field).bounded = false; },
                    [=](Scene& s) { at(s, field).extinction.value = 2; },
                    [=](Scene& s) { at(s, field).extinction.scalars = 0; },
                    [=](Scene& s) { at(s, field).extinction.nearest = true; },
                    [=](Scene& s) { at(s, field).extinction.unit_from_world.rows[1].z = 2; },
                    [=](Scene& s) { at(s, field).albedo.colors = 0; },
                    [=](Scene& s) { at(s, field).albedo.unit_from_world.offset.x = 2; },
                    [=](Scene& s) { at(s, field).scale = 2; },
                    [=](Scene& s) { at(s, field).phase = Draine{}; },
                    [](Scene& s) { s.sparse_grids[0].node_count[0] = 1; },
                    [](Scene& s) { s.sparse_grids[0].nodes = {0}; },
                    [](Scene& s) { s.sparse_grids[0].blocks = {0}; },
                    [](Scene& s) { s.sparse_grids[0].values = {0}; },
                    [](Scene& s) { s.sparse_grids[0].constants[0] = 1; },
                    [](Scene& s) { s.sparse_grids.emplace_back(); },
                    [](Scene& s) { s.media.pop_back(); },
                    [](Scene& s) { s.scalar_grids[0].size[0] = 1; },
                    [](Scene& s) { s.scalar_grids[0].values = {0}; },
                    [](Scene& s) { s.color_grids[0].size[1] = 1; },
                    [](Scene& s) { s.color_grids[0].values.resize(1); },
                    [](Scene& s) { s.color_grids.emplace_back(); },
                    [](Scene& s) { s.camera.medium = 0; },
                    [](Scene& s) { s.shapes[0].media.inside = 0; },
                    [](Scene& s) { s.shapes[0].media.outside = 0; },
                    [](Scene& s) { s.shapes[1].media.inside = 0; }});
}

// Checkpoints of scenes without media stay valid.
TEST(SceneDigest, WithoutMediaTheirPlacesDoNotCount) {
    Scene scene = scene_of_all_kinds();
    scene.media.clear();
    scene.scalar_grids.clear();
    scene.color_grids.clear();
    scene.sparse_grids.clear();
    const SceneDigest before = digest_of(scene);
    scene.shapes[0].media.inside = 0;
    EXPECT_EQ(digest_of(scene), before);
}

} // namespace
} // namespace montelux
