// Digests of scenes: every value of geometry and camera counts, by itself and in its part; addresses do not.
#include "test/scene/scene_digest_testing.h"
#include <gtest/gtest.h>

#include "montelux/scene/scene_digest.h"

namespace montelux {
namespace {

using testing::expect_changes;
using testing::scene_of_all_kinds;

TEST(SceneDigest, CopiesAreEqual) {
    const Scene scene = scene_of_all_kinds(), again = scene_of_all_kinds(), copy = scene;
    EXPECT_EQ(digest_of(scene), digest_of(copy));
    EXPECT_EQ(digest_of(scene), digest_of(again));
    EXPECT_EQ(digest_of(scene).whole(), digest_of(again).whole());
    EXPECT_NE(digest_of(scene), digest_of(Scene()));
}

TEST(SceneDigest, GeometryCounts) {
    expect_changes(&SceneDigest::geometry,
                   {[](Scene& s) { s.meshes[0].positions[2].z = 1e-30f; },
                    [](Scene& s) { s.meshes[0].normals[1].x = -0.0f; },
                    [](Scene& s) { s.meshes[0].normals.clear(); },
                    [](Scene& s) { s.meshes[0].uvs[0].y = 1; },
                    [](Scene& s) {
                        s.meshes[0].tangents = {{1, 0, 0}, {1, 0, 0}, {1, 0, 0}};
                    },
                    [](Scene& s) {
                        s.meshes[0].colors = {{1, 0, 0}, {1, 0, 0}, {1, 0, 0}};
                    },
                    [](Scene& s) {
                        s.meshes[0].opacities = {1, 0, 1};
                    },
                    [](Scene& s) { s.meshes[0].second_uvs = s.meshes[0].uvs; },
                    [](Scene& s) { s.meshes[0].end_positions = s.meshes[0].positions; },
                    [](Scene& s) {
                        s.meshes[0].end_positions = s.meshes[0].positions;
                        s.meshes[0].end_positions[1].y = 1e-30f;
                    },
                    [](Scene& s) {
                        s.meshes[0].end_positions = s.meshes[0].positions;
                        s.meshes[0].end_normals = s.meshes[0].normals;
                    },
                    [](Scene& s) { std::swap(s.meshes[0].indices[0], s.meshes[0].indices[1]); },
                    [](Scene& s) { std::get<Sphere>(s.quadrics[0]).z_max = 0.5f; },
                    [](Scene& s) { std::get<Disk>(s.quadrics[1]).inner_radius = 0.5f; },
                    [](Scene& s) { std::get<Disk>(s.quadrics[1]).polar = true; },
                    [](Scene& s) {
                        std::get<Disk>(s.quadrics[1]).world_from_object = Transform::scale({1, 1, 2});
                    },
                    [](Scene& s) { std::swap(s.quadrics[0], s.quadrics[1]); },
                    [](Scene& s) { s.shapes[0].material = 3; },
                    [](Scene& s) { s.shapes[0].light = 0; },
                    [](Scene& s) { s.shapes[1].alpha.value = 0.5f; },
                    [](Scene& s) { s.shapes[1].alpha.texture = 0; },
                    [](Scene& s) { s.shapes[2].flip_normal = true; },
                    [](Scene& s) { s.world_shapes.pop_back(); },
                    [](Scene& s) { s.objects[0].shapes.clear(); },
                    [](Scene& s) { s.objects.push_back({}); },
                    [](Scene& s) { s.instances[0].world_from_object = {}; },
                    [](Scene& s) { s.instances.push_back(s.instances[0]); },
                    [](Scene& s) { s.instances[0].motion = 0; },
                    [](Scene& s) {
                        s.motions.emplace_back(Transform(), Transform::translate({1, 0, 0}));
                    },
                    [](Scene& s) {
                        s.motions.emplace_back(Transform(), Transform::translate({2, 0, 0}));
                    }});
}

TEST(SceneDigest, CurvesCount) {
    expect_changes(&SceneDigest::geometry, {[](Scene& s) { s.curves[0].kind = Curves::Kind::cylinder; },
                                            [](Scene& s) { s.curves[0].control_points[0][3].z = 1; },
                                            [](Scene& s) { s.curves[0].widths[0][1] = 2; },
                                            [](Scene& s) { s.curves[0].normals.emplace_back(); },
                                            [](Scene& s) { s.curves.clear(); }});
    expect_changes(&SceneDigest::geometry, {[](Scene& s) { s.bilinear_meshes[0].positions[1].y = 2; },
                                            [](Scene& s) { s.bilinear_meshes[0].normals.emplace_back(); },
                                            [](Scene& s) { s.bilinear_meshes[0].uvs.emplace_back(); },
                                            [](Scene& s) { s.bilinear_meshes[0].indices[0] = 1; },
                                            [](Scene& s) { s.shapes[0].geometry = BilinearMeshIndex{0}; },
                                            [](Scene& s) { s.bilinear_meshes.clear(); }});
}

TEST(SceneDigest, CylindersCount) {
    expect_changes(&SceneDigest::geometry,
                   {[](Scene& s) { std::get<Cylinder>(s.quadrics[2]).radius = 2; },
                    [](Scene& s) { std::get<Cylinder>(s.quadrics[2]).z_min = -2; },
                    [](Scene& s) { std::get<Cylinder>(s.quadrics[2]).z_max = 2; },
                    [](Scene& s) { std::get<Cylinder>(s.quadrics[2]).phi_max = 2; },
                    [](Scene& s) {
                        std::get<Cylinder>(s.quadrics[2]).world_from_object = Transform::scale({1, 1, 2});
                    }});
}

TEST(SceneDigest, TheCameraCounts) {
    expect_changes(
        &SceneDigest::camera,
        {[](Scene& s) {
             s.camera.world_from_camera = Transform::translate({1e-9, 0, 0});
         },
         [](Scene& s) { std::get<PerspectiveCamera>(s.camera.model).fov = 45; },
         [](Scene& s) { std::get<PerspectiveCamera>(s.camera.model).lens_radius = 1; },
         [](Scene& s) { std::get<PerspectiveCamera>(s.camera.model).frame_aspect_ratio = 1; },
         [](Scene& s) { std::get<PerspectiveCamera>(s.camera.model).screen_window = ScreenWindow{}; },
         [](Scene& s) {
             s.camera.motion.emplace(Transform(), Transform::translate({1, 0, 0}));
         },
         [](Scene& s) { s.camera.shutter_open = 0.5f; }, [](Scene& s) { s.camera.shutter_close = 0.5f; },
         [](Scene& s) { s.camera.model = OrthographicCamera{}; },
         [](Scene& s) { s.camera.model = SphericalCamera{}; },
         [](Scene& s) { s.camera.model = SphericalCamera{SphericalCamera::Mapping::equirectangular}; },
         [](Scene& s) { s.camera.model = RealisticCamera{}; },
         [](Scene& s) {
             s.camera.model = RealisticCamera{.surfaces = {{1, 2, 3, 4}}};
         },
         [](Scene& s) {
             s.camera.model = RealisticCamera{.surfaces = {{1, 2, 3, 5}}};
         },
         [](Scene& s) { s.camera.model = RealisticCamera{.surfaces = {}, .focus_distance = 3}; },
         [](Scene& s) { s.camera.model = RealisticCamera{.surfaces = {}, .film_diagonal = 3}; },
         [](Scene& s) {
             s.camera.model = RealisticCamera{.surfaces = {}, .aperture = AperturePicture{1, 2, {1, 2}}};
         },
         [](Scene& s) {
             s.camera.model = RealisticCamera{.surfaces = {}, .aperture = AperturePicture{2, 1, {1, 2}}};
         },
         [](Scene& s) {
             s.camera.model = RealisticCamera{.surfaces = {}, .aperture = AperturePicture{1, 2, {2, 1}}};
         }});
}

TEST(SceneDigest, HeadersOfImagesDoNotCount) {
    Scene scene = scene_of_all_kinds();
    const SceneDigest before = digest_of(scene);
    scene.images[0].attributes()["software"] = std::string("an editor");
    scene.environments[0].attributes()["exposure"] = 2.0f;
    EXPECT_EQ(digest_of(scene), before);
}

TEST(SceneDigest, AMeshIsNotTwoHalves) {
    Scene one, two;
    one.meshes.resize(1);
    one.meshes[0].positions.resize(4000);
    two.meshes.resize(2);
    two.meshes[0].positions.resize(1000);
    two.meshes[1].positions.resize(3000);
    EXPECT_NE(digest_of(one), digest_of(two));
    two.meshes[0].positions.swap(two.meshes[1].positions);
    EXPECT_NE(digest_of(one), digest_of(two));
}

} // namespace
} // namespace montelux
