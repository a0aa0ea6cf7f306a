// The studio: framing, lights, ground and background.
#include "test/temporary_folder.h"
#include <cmath>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "montelux/formats/load_scene.h"
#include "montelux/formats/pbrt/load_pbrt.h"
#include "montelux/formats/studio.h"
#include "montelux/image/image_write.h"
#include "montelux/mc/math/constants.h"
#include "montelux/mc/math/error.h"
#include "montelux/scene/camera/camera.h"
#include "montelux/scene/light/light_tables.h"
#include "montelux/scene/scene_digest.h"

namespace montelux {
namespace {

struct Margins {
    double left = 1, right = 1, top = 1, bottom = 1; // of half the picture
};
// Of the corners of the bounds; negative where one lies outside.
Margins margins(const Bounds3& bounds, const CameraSettings& camera, double fov, double aspect) {
    Margins m;
    const double t = std::tan(0.5 * fov * pi / 180);
    const double tx = t * std::max(1.0, aspect), ty = t * std::max(1.0, 1 / aspect);
    for (int i = 0; i < 8; ++i) {
        const Vec3d p = camera.world_from_camera.inverse_point(bounds.corner(i));
        EXPECT_GT(p.z, 0);
        const double x = p.x / (p.z * tx), y = p.y / (p.z * ty);
        m.left = std::min(m.left, 1 + x);
        m.right = std::min(m.right, 1 - x);
        m.bottom = std::min(m.bottom, 1 + y);
        m.top = std::min(m.top, 1 - y);
    }
    return m;
}

Bounds3 box(Vec3d lower, Vec3d upper) {
    Bounds3 b;
    b.add(lower);
    b.add(upper);
    return b;
}

TEST(Framing, AllCornersAreInThePicture) {
    const Bounds3 boxes[] = {box({0, 0, 0}, {1, 1, 1}),
                             box({-5, 0, -0.2}, {5, 1, 0.2}),     // long
                             box({-0.1, 0, -0.1}, {0.1, 9, 0.1}), // tall
                             box({-3, 0, -3}, {3, 0, 3}),         // a plane
                             box({0, 0, 1}, {0, 4, 1}),           // a line
                             box({7, 8, 9}, {7, 8, 9}),           // a point
                             box({1e-7, 0, 0}, {2e-7, 1e-7, 1e-7}),
                             box({-1e8, -2e8, 3e8}, {5e8, 1e8, 4e8})};
    for (const Vec3d up : {Vec3d{0, 1, 0}, Vec3d{0, 0, 1}, Vec3d{1, 0, 0}, Vec3d{0, -1, 0}})
        for (const bool mirrored : {false, true})
            for (const Bounds3& bounds : boxes)
                for (const double aspect : {0.25, 1.0, 4.0 / 3, 5.0})
                    for (const double elevation : {-90.0, -20.0, 0.0, 18.0, 60.0, 90.0})
                        for (const double azimuth : {0.0, 35.0, -120.0, 720.0}) {
                            const OrbitFrame frame = OrbitFrame::of(up, mirrored);
                            const CameraSettings camera =
                                framing_camera(bounds, frame, {azimuth, elevation}, studio_fov, aspect);
                            const Margins m = margins(bounds, camera, studio_fov, aspect);
                            // 16 % of each half are kept free.
                            const double least = std::min({m.left, m.right, m.top, m.bottom});
                            ASSERT_GT(least, 0.155)
                                << up.x << up.y << up.z << ' ' << aspect << ' ' << elevation;
                            EXPECT_EQ(camera.world_from_camera.swaps_handedness(), !mirrored);
                        }
}

// The bounding cylinder touches its margin, so nothing is smaller than it needs to be.
TEST(Framing, ThePictureIsFull) {
    const OrbitFrame frame = OrbitFrame::of({0, 1, 0});
    // A tall box is bounded by its height, a plate seen from above by its diagonal.
    const Bounds3 tall = box({-0.05, 0, -0.05}, {0.05, 1, 0.05});
    const Margins m = margins(tall, framing_camera(tall, frame, {0, 0}, 40, 1), 40, 1);
    EXPECT_NEAR(m.top, 0.16, 0.02);
    EXPECT_NEAR(m.bottom, 0.16, 0.02);
    EXPECT_NEAR(m.left, m.right, 1e-9);
    // The distance is the same from all sides, and DIST multiplies it.
    const double d = framing_distance(tall, frame, 18, 40, 1);
    for (const double azimuth : {0.0, 10.0, 200.0})
        for (const double times : {1.0, 2.5}) {
            const CameraSettings c = framing_camera(tall, frame, {azimuth, 18, times}, 40, 1);
            EXPECT_NEAR(c.world_from_camera.inverse_point(tall.center()).z, times * d, 1e-9);
        }
}

TEST(Framing, AzimuthsAreOfTheViewer) {
    const Bounds3 bounds = box({-1, 0, -1}, {1, 2, 1});
    const auto eye = [&](Vec3d up, Orbit orbit) {
        return framing_camera(bounds, OrbitFrame::of(up), orbit, 30, 1).world_from_camera.point(Vec3d{});
    };
    EXPECT_GT(eye({0, 1, 0}, {0, 0}).z, 3);  // in front
    EXPECT_GT(eye({0, 1, 0}, {90, 0}).x, 3); // on the right
    EXPECT_GT(eye({0, 1, 0}, {0, 80}).y, 3); // above
    EXPECT_LT(eye({0, 0, 1}, {0, 0}).y, -3);
    EXPECT_GT(eye({0, 0, 1}, {90, 0}).x, 3);
    EXPECT_GT(eye({0, 0, 1}, {0, 80}).z, 3);
    // What is on the right of the model, seen from its front, is on the right of the picture.
    for (const Vec3d up : {Vec3d{0, 1, 0}, Vec3d{0, 0, 1}}) {
        const CameraSettings camera = framing_camera(bounds, OrbitFrame::of(up), {0, 10}, 30, 1);
        EXPECT_GT(camera.world_from_camera.inverse_point(Vec3d{1, 1, 0}).x, 0.5);
        EXPECT_GT(camera.world_from_camera.inverse_point(bounds.center() + up).y, 0.5);
    }
}

class Studio : public ::testing::Test {
  protected:
    SceneDescription model() {
        return load_scene(folder_.write("a.obj", "v 0 0 0\nv 2 0 0\nv 0 3 0\nv 0 0 1\nf 1 2 3\nf 1 3 4\n"),
                          warnings_);
    }
    SceneDescription pbrt(const std::string& world) {
        return parse_pbrt("LookAt 0 -9 2  0 0 0  0 0 1 Camera \"perspective\" WorldBegin " + world, "a.pbrt",
                          ".", warnings_);
    }
    StudioParts add(SceneDescription& d, const StudioSettings& settings = {}) {
        return add_studio(d, settings, disk_, warnings_, &files_read_);
    }
    std::string studio_error(SceneDescription d, const StudioSettings& settings) {
        try {
            add(d, settings);
        } catch (const Error& e) {
            return e.what();
        }
        return {};
    }

    TemporaryFolder folder_;
    DiskFiles disk_;
    Warnings warnings_;
    std::vector<std::filesystem::path> files_read_;
};

// A turn by an angle is an orbit from an azimuth that is larger by as much; in left-handed worlds, too.
TEST_F(Studio, TurntablesAreOrbits) {
    for (const bool is_model : {true, false}) {
        const auto unframed = [&] { return is_model ? model() : pbrt("Translate 1 2 3 Shape \"sphere\""); };
        const TurnAxis axis = turn_axis_of(unframed());
        const auto from = [&](double azimuth) {
            SceneDescription d = unframed();
            add(d, {.orbit = Orbit{azimuth, 20, 1.5}});
            return d.scene.camera;
        };
        const CameraSettings turned = turned_camera(from(10), axis, 75), expected = from(85);
        for (const Vec3d& p : {Vec3d(0, 0, 0), Vec3d(1, 0, 0), Vec3d(0, 1, 0), Vec3d(0, 0, 1)})
            EXPECT_LT(length(turned.world_from_camera.point(p) - expected.world_from_camera.point(p)), 1e-9);
    }
}

// Mitsuba's scenes have the axis up that their camera has; without a camera it is y.
TEST_F(Studio, OrbitsOfMitsubaScenesStandAsTheirCameras) {
    const auto scene = [&](const std::string& sensor) {
        return load_scene(
            folder_.write("a.xml", "<scene version=\"3.0.0\">" + sensor +
                                       "<emitter type=\"constant\"/><shape type=\"sphere\"/></scene>"),
            warnings_);
    };
    const auto looking = [](const std::string& from, const std::string& up) {
        return "<sensor type=\"perspective\"><transform name=\"to_world\"><lookat origin=\"" + from +
               "\" target=\"0, 0, 0.5\" up=\"" + up + "\"/></transform></sensor>";
    };
    const auto from_above = [&](SceneDescription d) {
        add(d, {.orbit = Orbit{0, 80}});
        return d.scene.camera.world_from_camera.point(Vec3d());
    };
    const SceneDescription upright = scene(looking("2, -5, 2.6", "0, 0, 1"));
    EXPECT_GT(from_above(upright).z, 3);
    EXPECT_NEAR(turn_axis_of(upright).direction.z, 1, 1e-9);
    EXPECT_GT(from_above(scene(looking("2, 2.6, 5", "0, 1, 0"))).y, 3);
    EXPECT_LT(from_above(scene(looking("5, 1, 2", "0, -1, 0"))).y, -3);
    EXPECT_GT(from_above(scene("")).y, 3);
}

TEST_F(Studio, MovingCamerasTurnWithTheirPath) {
    SceneDescription d = model();
    add(d);
    const Transform start = d.scene.camera.world_from_camera,
                    end = start * Transform::translate({1, 0, 0}) * Transform::rotate(40, {0, 1, 0});
    d.scene.camera.motion.emplace(start, end);
    const TurnAxis axis{{1, 0, 2}, {0, 1, 0}};
    const CameraSettings turned = turned_camera(d.scene.camera, axis, 90);
    const Vec3d before = d.scene.camera.motion->at(0.5f).point(Vec3d()),
                after = turned.motion->at(0.5f).point(Vec3d());
    EXPECT_LT(length(after - Vec3d(1 + (before.z - 2), before.y, 2 - (before.x - 1))), 1e-5);
}

// The frames of an animation share one camera and one ground.
TEST_F(Studio, GivenBoundsAreFramed) {
    SceneDescription d = model();
    Bounds3 bounds;
    bounds.add({-5, -5, -5});
    bounds.add({5, 9, 5});
    add(d, {.bounds = bounds});
    EXPECT_NEAR(world_bounds(d.scene.quadrics.at(0)).upper.y, -5, 0.01);
    const Margins m = margins(bounds, d.scene.camera, studio_fov, 4.0 / 3);
    EXPECT_GT(std::min({m.left, m.right, m.top, m.bottom}), 0.15);
}

TEST_F(Studio, ModelsGetAllOfIt) {
    SceneDescription d = model();
    EXPECT_FALSE(d.has_camera);
    EXPECT_TRUE(d.scene.lights.empty());
    const Bounds3 bounds = bounds_of(d.scene);
    const StudioParts added = add(d);
    EXPECT_TRUE(added.camera && added.lights);
    ASSERT_EQ(d.scene.lights.size(), 1u);
    EXPECT_EQ(name_of(d.scene.lights[0]), "environment map");
    ASSERT_EQ(d.scene.quadrics.size(), 1u);
    EXPECT_TRUE(d.integrator.background.has_value());
    EXPECT_TRUE(warnings_.messages().empty());
    // The ground lies below all of the model, just so.
    const double height = world_bounds(d.scene.quadrics[0]).upper.y;
    EXPECT_LT(height, bounds.lower.y);
    EXPECT_GT(height, bounds.lower.y - 0.01);
    const Margins m = margins(bounds, d.scene.camera, studio_fov, 4.0 / 3);
    EXPECT_GT(std::min({m.left, m.right, m.top, m.bottom}), 0.15);
    EXPECT_NO_THROW(digest_of(d.scene));
}

TEST_F(Studio, ScenesOfPbrtAreLeftAlone) {
    for (const char* world : {"Shape \"sphere\"", "LightSource \"infinite\" Shape \"sphere\""}) {
        SceneDescription d = pbrt(world);
        const SceneDigest before = digest_of(d.scene);
        const StudioParts added = add(d);
        EXPECT_FALSE(added.camera || added.lights);
        EXPECT_EQ(digest_of(d.scene), before);
        EXPECT_FALSE(d.integrator.background);
    }
}

TEST_F(Studio, OptionsChangeOnlyTheirPart) {
    SceneDescription d = pbrt("LightSource \"point\" Shape \"sphere\"");
    add(d, {.orbit = Orbit{0, 0}});
    EXPECT_EQ(d.scene.lights.size(), 1u);
    EXPECT_EQ(d.scene.shapes.size(), 1u);
    // z is up, as the camera has it, and the world of this scene is pbrt's, left-handed.
    const Vec3d eye = d.scene.camera.world_from_camera.point(Vec3d{});
    EXPECT_LT(eye.y, -3);
    EXPECT_NEAR(eye.z, 0, 1e-9);
    EXPECT_FALSE(d.scene.camera.world_from_camera.swaps_handedness());

    d = pbrt("LightSource \"point\" Shape \"sphere\"");
    add(d, {.ground = true});
    EXPECT_EQ(d.scene.shapes.size(), 2u);
    EXPECT_NEAR(world_bounds(d.scene.quadrics[1]).upper.z, -1, 1e-3);
    EXPECT_EQ(d.scene.shape_names.back(), "ground");

    d = model();
    add(d, {.ground = false, .background = StudioSettings::Background{false, {0.25f, 0.5f, 1}}});
    EXPECT_EQ(d.scene.shapes.size(), 1u);
    EXPECT_EQ(*d.integrator.background, (Vec3f{0.25f, 0.5f, 1}));
    EXPECT_FALSE(d.film.layers.set.has(Layer::alpha));
    d = model();
    add(d, {.background = StudioSettings::Background{.transparent = true, .color = {}}});
    EXPECT_TRUE(d.film.layers.set.has(Layer::alpha));
    EXPECT_EQ(*d.integrator.background, Vec3f{});
}

TEST_F(Studio, EnvironmentsReplaceInfiniteLights) {
    Image map(4, 2, {"R", "G", "B"});
    for (float& v : map.f32()) v = 1;
    write_image(folder_ / "map.exr", map);
    const std::string file = (folder_ / "map.exr").string();
    const std::string world = "LightSource \"infinite\" LightSource \"point\" "
                              "AttributeBegin AreaLightSource \"diffuse\" Shape \"sphere\" AttributeEnd "
                              "LightSource \"distant\" LightSource \"infinite\" \"string group\" \"g\"";
    SceneDescription d = pbrt(world);
    ASSERT_EQ(d.scene.lights.size(), 5u);
    add(d, {.environment = file});
    ASSERT_EQ(d.scene.lights.size(), 4u);
    EXPECT_EQ(name_of(d.scene.lights[0]), "point light");
    EXPECT_EQ(name_of(d.scene.lights[1]), "area light");
    EXPECT_EQ(d.scene.shapes[0].light, 1u);
    EXPECT_EQ(name_of(d.scene.lights[3]), "environment map");
    EXPECT_FALSE(d.integrator.background);
    EXPECT_EQ(files_read_, std::vector<std::filesystem::path>{file});

    d = pbrt(world);
    add(d, {.environment = "none"});
    EXPECT_EQ(d.scene.lights.size(), 3u);
    d = model();
    EXPECT_FALSE(add(d, {.environment = file}).lights);
    EXPECT_EQ(d.scene.lights.size(), 1u);
    EXPECT_EQ(d.scene.shapes.size(), 2u);
}

// An orbit sets only the position and direction of the camera.
TEST_F(Studio, OrbitsKeepTheMediumAndTheShutterOfTheCamera) {
    SceneDescription d = parse_pbrt(R"(MakeNamedMedium "smoke" "string type" "homogeneous"
MakeNamedMedium "fog" "string type" "homogeneous" MediumInterface "" "fog"
Camera "perspective" "float shutteropen" 0.25 "float shutterclose" 0.75
WorldBegin MediumInterface "smoke" "fog" Shape "sphere")",
                                    "a.pbrt", ".", warnings_);
    const CameraSettings before = d.scene.camera;
    ASSERT_NE(before.medium, no_index);
    add(d, {.orbit = Orbit{30, 10}});
    EXPECT_GT(
        length(d.scene.camera.world_from_camera.point(Vec3d{}) - before.world_from_camera.point(Vec3d{})), 1);
    EXPECT_EQ(d.scene.camera.medium, before.medium);
    EXPECT_EQ(d.scene.camera.shutter_open, 0.25f);
    EXPECT_EQ(d.scene.camera.shutter_close, 0.75f);
}

// The middle of a map is what a camera in front of the model sees behind it, and its left part is on the left.
TEST_F(Studio, EnvironmentsStandUpright) {
    Image map(64, 32, {"R", "G", "B"});
    for (float& v : map.f32()) v = 0.01f;
    write_image(folder_ / "map.exr", map);
    SceneDescription d = model();
    add(d, {.environment = (folder_ / "map.exr").string(), .orbit = Orbit{0, 0}});
    const auto& light = std::get<ImageInfiniteLight>(d.scene.lights[0]);
    const EnvironmentGrid grid(light.layout, 64, 32);
    const auto seen = [&](Vec2f texel) {
        return d.scene.camera.world_from_camera.inverse_vector(
            light.world_from_light.vector(Vec3d(grid.direction(texel))));
    };
    EXPECT_GT(seen({32, 16}).z, 0.99);
    EXPECT_LT(seen({16, 16}).x, -0.99);
    EXPECT_GT(seen({48, 16}).x, 0.99);
    EXPECT_GT(seen({32, 0.5f}).y, 0.99);
}

// glTF says what is up, so a camera that looks straight down turns no map.
TEST_F(Studio, EnvironmentsOfModelsDoNotFollowTheirCameras) {
    write_image(folder_ / "map.exr", Image(64, 32, {"R", "G", "B"}));
    const StudioSettings settings{.environment = (folder_ / "map.exr").string()};
    const auto place = [&](const SceneDescription& d) {
        return std::get<ImageInfiniteLight>(d.scene.lights[0]).world_from_light;
    };
    SceneDescription without = model(), with = model();
    with.has_camera = true;
    with.scene.camera.world_from_camera = *Transform::look_at({0, 9, 0}, {0, 0, 0}, {0, 0, -1});
    add(without, settings);
    add(with, settings);
    for (const Vec3d axis : {Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}})
        EXPECT_EQ(place(with).vector(axis), place(without).vector(axis));
}

TEST_F(Studio, MistakesAreSentences) {
    const std::string bad = folder_.write("bad.exr", "no picture").string();
    Image map(4, 3, {"R", "G", "B"});
    write_image(folder_ / "odd.exr", map);
    EXPECT_NE(studio_error(model(), {.environment = bad}).find(bad), std::string::npos);
    EXPECT_NE(studio_error(model(), {.environment = (folder_ / "odd.exr").string()}).find("4 x 3 pixels"),
              std::string::npos);
    EXPECT_NE(studio_error(model(), {.environment = (folder_ / "missing.hdr").string()}), "");
    EXPECT_EQ(studio_error(pbrt(""), {.ground = true}),
              "studio: the scene has no shape to put the camera or the ground at");
}

} // namespace
} // namespace montelux
