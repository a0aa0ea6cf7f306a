// Shapes that move: their objects, parts of objects and instances, and the errors they give.
#include "test/scene/build/located_error.h"
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "montelux/scene/build/scene_builder.h"
#include "montelux/scene/digest/hash_geometry.h"
#include "montelux/scene/scene_digest.h"
#include "montelux/scene/scene_names.h"

namespace montelux {
namespace {

using testing::located_error;

const Transform to_right = Transform::translate({1, 0, 0}), upwards = Transform::translate({0, 2, 0}),
                quarter_turn = Transform::rotate(90, {0, 0, 1});

class MovingShapes : public ::testing::Test {
  protected:
    MovingShapes() { scene_.materials.resize(1); }

    void still(std::string name = {}) {
        builder_.add_shape(Sphere{.world_from_object = {}}, {.material = 0, .alpha = {1}, .name = name});
    }
    void moving(const Transform& start, const Transform& end) {
        builder_.add_moving_shape(Sphere{.world_from_object = {}}, {.material = 0, .alpha = {1}}, start, end,
                                  {0, 4, 2});
    }

    Scene scene_;
    std::vector<std::string> warnings_;
    CallMessages messages_{"a test", &warnings_};
    SceneBuilder builder_{scene_, messages_};
};

TEST_F(MovingShapes, OfTheWorldAreObjectsOfTheirOwn) {
    still();
    moving(to_right, upwards);
    moving(to_right, to_right);
    builder_.finish();
    EXPECT_EQ(scene_.world_shapes, (std::vector<Index>{0}));
    ASSERT_EQ(scene_.instances.size(), 2u);
    ASSERT_EQ(scene_.motions.size(), 1u);
    EXPECT_EQ(scene_.motions[0].start(), to_right);
    EXPECT_EQ(scene_.motions[0].end(), upwards);
    EXPECT_EQ(scene_.instances[1].motion, no_index);
    EXPECT_EQ(scene_.instances[1].world_from_object, to_right);
    EXPECT_EQ(instance_names(scene_), (std::vector<std::string>{"shape-1", "shape-2"}));
}

// One instance for the still shapes of each use and one for each motion, all with the use's name.
TEST_F(MovingShapes, OfObjectsHaveInstancesForEachUse) {
    builder_.add_instance("cart", to_right); // which comes later
    builder_.begin_object("cart");
    still();
    moving({}, quarter_turn);
    moving({}, upwards);
    moving({}, quarter_turn); // as the first
    builder_.end_object();
    builder_.begin_object("wheel");
    moving({}, quarter_turn); // of another object
    builder_.end_object();
    builder_.add_instance("cart", Transform(), upwards);
    builder_.add_instance("wheel", to_right);
    builder_.finish();

    EXPECT_TRUE(scene_.world_shapes.empty());
    ASSERT_EQ(scene_.objects.size(), 5u);
    const std::vector<Index> shapes[] = {{0}, {1, 3}, {2}, {}, {4}};
    const Index part_of[] = {no_index, 0, 0, no_index, 3};
    for (std::size_t i = 0; i < 5; ++i) {
        EXPECT_EQ(scene_.objects[i].shapes, shapes[i]) << i;
        EXPECT_EQ(scene_.objects[i].part_of, part_of[i]) << i;
    }
    std::vector<Index> objects;
    for (const Instance& instance : scene_.instances) objects.push_back(instance.object);
    EXPECT_EQ(objects, (std::vector<Index>{0, 1, 2, 0, 1, 2, 4})); // none of the wheel without its shape
    EXPECT_EQ(instance_names(scene_), (std::vector<std::string>{"cart:0", "cart:0", "cart:0", "cart:1",
                                                                "cart:1", "cart:1", "wheel:0"}));

    EXPECT_EQ(scene_.instances[0].motion, no_index);
    ASSERT_EQ(scene_.motions.size(), 6u); // nothing unused
    for (std::size_t i = 1; i < 7; ++i) {
        ASSERT_EQ(scene_.instances[i].motion, i - 1);
        EXPECT_EQ(scene_.instances[i].world_from_object, scene_.motions[i - 1].start());
    }
    const Vec3d p{1, 0, 0};
    const auto at = [&](std::size_t i, float time) {
        return scene_.motions[scene_.instances[i].motion].at(time).point(p);
    };
    const auto expect_at = [&](std::size_t i, float time, Vec3d expected) {
        EXPECT_LT(length(at(i, time) - expected), 3e-4) << i << " " << time;
    };
    const double root = std::sqrt(0.5);
    expect_at(1, 0, {2, 0, 0});
    expect_at(1, 0.5f, {1 + root, root, 0});
    expect_at(2, 0.5f, {2, 1, 0});
    expect_at(3, 0.5f, {1, 1, 0});
    expect_at(4, 0.5f, {root, 1 + root, 0});
    expect_at(4, 1, {0, 3, 0});
    expect_at(5, 1, {1, 4, 0});
    expect_at(6, 1, {1, 1, 0});
}

// The same ends, another way.
TEST_F(MovingShapes, TheirDigestsKnowTheWay) {
    const auto digest = [](double outer, double inner) {
        Scene scene;
        scene.motions.push_back(
            Motion::product(Motion({}, Transform::translate({outer, 0, 0})),
                            Motion(Transform::scale({1, 1, 2}),
                                   Transform::translate({inner, 0, 0}) * Transform::scale({1, 1, 2}))));
        return digest_of(scene);
    };
    EXPECT_EQ(digest(1, 2), digest(2, 1)); // along lines: the same keys
    EXPECT_NE(digest(1, 2), digest(1, 3));
    const auto turned = [](double outer, double inner) {
        Scene scene;
        scene.motions.push_back(Motion::product(Motion({}, Transform::rotate(outer, {0, 0, 1})),
                                                Motion({}, Transform::rotate(inner, {0, 0, 1}))));
        EXPECT_EQ(scene.motions[0].is_product(), true);
        return digest_of(scene);
    };
    EXPECT_NE(turned(30, 10), turned(31, 10));
    const Motion product = Motion::product(Transform::scale({4, 1, 1}), Motion({}, quarter_turn));
    Scene along_product, direct;
    along_product.motions.push_back(product);
    direct.motions.emplace_back(product.start(), product.end());
    EXPECT_NE(digest_of(along_product), digest_of(direct));
}

// How finely a path is followed is a part of the scene, even where it is not a product. Lines have no other keys than
// their ends.
TEST_F(MovingShapes, TheirDigestsKnowTheKeys) {
    const auto hash = [](const auto&... values) {
        SceneHasher hasher;
        hasher.all(values...);
        return hasher.value();
    };
    const Motion line({}, upwards), turn(Transform::scale({5, 1, 1}), quarter_turn);
    EXPECT_EQ(hash(line), hash(line.start(), line.end()));
    ASSERT_GT(turn.keys().size(), 2u);
    EXPECT_EQ(hash(turn), hash(turn.start(), turn.end(), turn.keys()));
    EXPECT_EQ(hash(turn), hash(Motion::product(Transform(), turn)));
}

TEST_F(MovingShapes, ShineOutsideOfObjects) {
    const Emission emission{1.0f};
    const ShapeSettings shining{.material = 0, .alpha = {1}, .emission = &emission};
    builder_.add_moving_shape(Sphere{.world_from_object = {}}, shining, {}, to_right);
    builder_.begin_object("o");
    builder_.add_moving_shape(Sphere{.world_from_object = {}}, shining, {}, to_right);
    builder_.end_object();
    builder_.finish();
    ASSERT_EQ(scene_.lights.size(), 1u);
    EXPECT_EQ(std::get<AreaLight>(scene_.lights[0]).shape, 0u);
    EXPECT_EQ(scene_.shapes[0].light, 0u);
    EXPECT_EQ(warnings_,
              (std::vector<std::string>{"a test: area lights inside object definitions do not shine"}));
}

TEST_F(MovingShapes, MovingLightsAreAddedInTheirOwnSpace) {
    builder_.add_moving_light(PointLight{1.0f, 2, {0, 0, 1}}, to_right, quarter_turn, {}, "lamps");
    ASSERT_EQ(scene_.motions.size(), 1u);
    EXPECT_EQ(scene_.motions[0].start(), to_right);
    EXPECT_EQ(scene_.motions[0].end(), quarter_turn);
    const auto& point = std::get<PointLight>(scene_.lights.at(0));
    EXPECT_EQ(point.motion, 0u);
    EXPECT_EQ(point.position, (Point3f{0, 0, 1}));
    EXPECT_EQ(scene_.light_groups.at(0), "lamps");
    EXPECT_TRUE(moves(scene_));
    // What looks the same has no motion.
    builder_.add_moving_light(UniformInfiniteLight{1.0f, 2}, to_right, quarter_turn);
    EXPECT_EQ(scene_.motions.size(), 1u);
}

// Equal ends make the scene of a still light.
TEST_F(MovingShapes, LightsThatDoNotMoveAreStill) {
    const Light lights[] = {PointLight{1.0f, 2, {1, 2, 3}},
                            SpotLight{1.0f, 2, {1, 2, 3}, {1, 0, 0}, 0.9f, 0.8f},
                            DistantLight{1.0f, 2, {0, 1, 0}}};
    const Light there[] = {PointLight{1.0f, 2, {-2, 1, 3}},
                           SpotLight{1.0f, 2, {-2, 1, 3}, {0, 1, 0}, 0.9f, 0.8f},
                           DistantLight{1.0f, 2, {-1, 0, 0}}};
    const Transform exact_turn =
        *Transform::from_matrix({{{{0, -1, 0, 0}, {1, 0, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}}});
    Scene still;
    SceneBuilder plain(still, messages_);
    for (const Light& light : lights) builder_.add_moving_light(light, exact_turn, exact_turn);
    for (const Light& light : there) plain.add_light(light);
    EXPECT_FALSE(moves(scene_));
    EXPECT_EQ(digest_of(scene_).lights, digest_of(still).lights);
}

TEST_F(MovingShapes, LightsThatCannotMoveAreRefused) {
    const auto error = [&](const Light& light, const Transform& end) {
        return located_error([&] { builder_.add_moving_light(light, {}, end); });
    };
    const Portal portal(std::array<Point3f, 4>{{{0, 0, 0}, {0, 1, 0}, {1, 1, 0}, {1, 0, 0}}});
    scene_.environments.emplace_back(2, 2, std::vector<std::string>{"R", "G", "B"});
    EXPECT_EQ(
        error(ImageInfiniteLight{.environment = 0, .world_from_light = {}, .portal = portal}, quarter_turn),
        "a test: an environment map with a portal does not move");
    still();
    EXPECT_EQ(error(AreaLight{1.0f, 1, false, 0}, quarter_turn),
              "a test: the light of a shape moves with the shape");
    const std::string beyond =
        "a test: the light's transformation is beyond what single-precision numbers hold";
    EXPECT_EQ(error(PointLight{1.0f, 1, {1, 0, 0}}, Transform::scale({1e39, 1, 1})), beyond);
    EXPECT_EQ(error(PointLight{1.0f, 1, {1e30f, 0, 0}}, Transform::scale({1e10, 1, 1})), beyond);
    EXPECT_EQ(error(SpotLight{1.0f, 1, {}, {0, 0, 1}, 0.9f, 0.8f}, Transform::scale({1e19, 1, 1})), beyond);
    // On its way.
    EXPECT_EQ(error(PointLight{1.0f, 1, {2.5e38f, 2.5e38f, 0}}, quarter_turn), beyond);
    EXPECT_EQ(
        error(PointLight{1.0f, 1, {}}, Transform::scale({-1, 1, 1})),
        "a test: motion: one end is mirrored and the other is not; between them the object would be flat");
    EXPECT_TRUE(scene_.lights.empty());
}

TEST_F(MovingShapes, ErrorsHaveAPlace) {
    const Transform mirror = Transform::scale({-1, 1, 1}), vast = Transform::scale({1e39, 1, 1});
    builder_.begin_object("o");
    EXPECT_EQ(
        located_error([&] { moving({}, mirror); }),
        "a test: motion: one end is mirrored and the other is not; between them the object would be flat");
    EXPECT_EQ(located_error([&] { moving({}, vast); }),
              "a test: the shape's transformation is beyond what single-precision numbers hold");
    EXPECT_NE(located_error([&] { moving({}, mirror); }), ""); // again
    moving(mirror, mirror * quarter_turn);
    moving({}, Transform::translate({1e30, 0, 0}));
    builder_.end_object();
    builder_.add_instance("o", Transform::scale({1e10, 1, 1}));
    EXPECT_EQ(located_error([&] { builder_.finish(); }),
              "a test: the instance's transformation is beyond what single-precision numbers hold");
}

TEST_F(MovingShapes, AndInstancesThatAreRefusedLeaveNothing) {
    const Transform mirror = Transform::scale({-1, 1, 1}), vast = Transform::scale({1e39, 1, 1});
    const auto moving_to_infinity = [&] {
        builder_.add_moving_shape(Sphere{.world_from_object = Transform::translate({1e39, 0, 0})},
                                  {.material = 0, .alpha = {1}}, {}, upwards);
    };
    EXPECT_NE(located_error([&] { moving({}, mirror); }), "");
    EXPECT_NE(located_error([&] { moving({}, vast); }), "");
    EXPECT_NE(located_error([&] { moving(vast, {}); }), "");
    EXPECT_NE(located_error(moving_to_infinity), "");
    EXPECT_TRUE(scene_.objects.empty());
    builder_.begin_object("o");
    still();
    EXPECT_NE(located_error([&] { moving({}, mirror); }), "");
    EXPECT_NE(located_error(moving_to_infinity), "");
    builder_.end_object();
    EXPECT_NE(located_error([&] { builder_.add_instance("o", Transform(), mirror); }), "");
    EXPECT_NE(located_error([&] { builder_.add_instance("o", Transform(), vast); }), "");
    EXPECT_NE(located_error([&] { builder_.add_instance("o", vast, Transform()); }), "");
    builder_.finish();
    EXPECT_EQ(scene_.objects.size(), 1u);
    EXPECT_EQ(scene_.shapes.size(), 1u);
    EXPECT_TRUE(scene_.instances.empty());
    EXPECT_TRUE(scene_.motions.empty());
}

// A light that refers to nothing is found late.
TEST_F(MovingShapes, AndLightsThatAreRefusedLeaveNothing) {
    const Emission lost{.spectrum = {}, .picture = 7};
    const std::string no_picture =
        "a test: light 0 (area light), picture: there is no picture 7; the scene has 0";
    const ShapeSettings shining{.material = 0, .alpha = {1}, .emission = &lost, .name = "lamp"};
    const Sphere sphere{.world_from_object = {}};
    EXPECT_EQ(located_error([&] { builder_.add_shape(sphere, shining); }), no_picture);
    EXPECT_EQ(located_error([&] { builder_.add_moving_shape(sphere, shining, {}, upwards); }), no_picture);
    EXPECT_NE(located_error([&] {
                  ImageInfiniteLight sky;
                  sky.environment = 3;
                  builder_.add_moving_light(sky, {}, quarter_turn);
              }).find("there is no environment map 3"),
              std::string::npos);
    builder_.finish();
    EXPECT_EQ(digest_of(scene_), [] {
        Scene empty;
        empty.materials.resize(1);
        return digest_of(empty);
    }());
    EXPECT_TRUE(scene_.shapes.empty());
    EXPECT_TRUE(scene_.world_shapes.empty());
    EXPECT_TRUE(scene_.shape_names.empty());
    EXPECT_TRUE(scene_.quadrics.empty());
    EXPECT_TRUE(scene_.objects.empty());
    EXPECT_TRUE(scene_.instances.empty());
    EXPECT_TRUE(scene_.motions.empty());
    // The next ones get its place.
    EXPECT_EQ(builder_.add_shape(sphere, {.material = 0, .alpha = {1}}), 0u);
    EXPECT_EQ(builder_.add_moving_shape(sphere, {.material = 0, .alpha = {1}}, {}, upwards), 1u);
}

// Strings in files may contain line breaks.
TEST_F(MovingShapes, AreObjectsWithoutANameThatAFileCouldUse) {
    moving({}, upwards);
    builder_.begin_object("\n0");
    still();
    builder_.end_object();
    builder_.add_instance("\n0", to_right);
    builder_.finish();
    ASSERT_EQ(scene_.objects.size(), 2u);
    EXPECT_EQ(scene_.objects[1].name, "\n0");
    ASSERT_EQ(scene_.instances.size(), 2u);
    EXPECT_EQ(scene_.instances[1].object, 1u);
}

TEST_F(MovingShapes, ReachOnlyToWhereFloatsEnd) {
    builder_.begin_object("o");
    builder_.add_moving_shape(
        Sphere{.radius = 3e30f, .z_min = -3e30f, .z_max = 3e30f, .world_from_object = {}},
        {.material = 0, .alpha = {1}}, {}, Transform::scale({1e5, 1, 1}));
    builder_.end_object();
    builder_.add_instance("o", Transform::scale({1e5, 1, 1}));
    EXPECT_EQ(located_error([&] { builder_.finish(); }),
              "a test: the instance reaches to infinity in world space");
}

// Not far from the origin at the ends, but on the way: there a corner of the box turns to an axis.
TEST_F(MovingShapes, ReachToInfinityOnTheirWay) {
    const auto corner = [](float at) {
        TriangleMesh mesh;
        mesh.positions = {{at, at, 0}, {at, 0, 0}, {0, at, 0}};
        mesh.indices = {0, 1, 2};
        return mesh;
    };
    const auto turning = [&](float at) {
        Scene scene;
        scene.materials.resize(1);
        SceneBuilder builder(scene, messages_);
        builder.add_moving_shape(corner(at), {.material = 0, .alpha = {1}}, {}, quarter_turn);
        return located_error([&] { builder.finish(); });
    };
    EXPECT_EQ(turning(2.3e38f), "");
    EXPECT_EQ(turning(2.5e38f), "a test: the instance reaches to infinity in world space");
}

// Uses times parts: few lines of a file must not ask for all memory.
TEST_F(MovingShapes, OfManyUsesAreLimited) {
    builder_.begin_object("o");
    for (int i = 0; i < 1000; ++i) moving({}, Transform::translate({i + 1.0, 0, 0}));
    builder_.end_object();
    for (int i = 0; i < 4000; ++i) builder_.add_instance("o", to_right);
    EXPECT_EQ(located_error([&] { builder_.finish(); }),
              "a test: the instances of objects whose shapes move need more than 4 GiB; expected fewer "
              "instances, or fewer shapes that move");
    EXPECT_TRUE(scene_.instances.empty());
}

// The motion of a use has more keys than those of the parts.
TEST_F(MovingShapes, OfManyMovingUsesAreLimited) {
    builder_.begin_object("o");
    for (int i = 0; i < 1000; ++i) moving({}, Transform::translate({i + 1.0, 0, 0}));
    builder_.end_object();
    for (int i = 0; i < 320; ++i) builder_.add_instance("o", {}, Transform::rotate(180, {0, 0, 1}));
    EXPECT_NE(located_error([&] { builder_.finish(); }).find("need more than 4 GiB"), std::string::npos);
}

} // namespace
} // namespace montelux
