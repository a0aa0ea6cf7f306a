// Layers that are switched on change no bit of the mean; their parts sum to it; geometry has known answers.
#include "test/render/mixed_scene.h"
#include "test/temporary_folder.h"
#include <bit>
#include <cmath>
#include <gtest/gtest.h>
#include <map>
#include <numeric>

#include "montelux/image/cryptomatte.h"
#include "montelux/mc/math/error.h"
#include "montelux/render/checkpoint.h"
#include "montelux/render/layer_sampler.h"
#include "montelux/render/render_session.h"
#include "montelux/render/sample_record.h"

namespace montelux::testing {
namespace {

LayerSet every_layer() {
    LayerSet set;
    for (std::size_t i = 0; i < layer_names().size(); ++i) set.add(static_cast<Layer>(i));
    return set;
}

// Surfaces of all kinds, instances that move, a moving camera.
SceneBuilder layered_scene(int size = 16) {
    SceneBuilder b = mixed_scene(1, size, size);
    CallMessages messages("scene of a test");
    montelux::SceneBuilder builder(b.scene, messages);
    builder.begin_object("tile");
    builder.add_shape(square(Transform::scale({0.2, 0.2, 0.2})), {.material = 0});
    builder.end_object();
    builder.add_instance("tile", Transform::translate({-0.2, -0.5, 0.2}) * Transform::rotate(60, {1, 0, 0}));
    builder.add_instance("tile", Transform::translate({0.4, -0.5, 0.4}),
                         Transform::translate({0.6, -0.6, 0.3}));
    builder.finish();
    const Transform start = b.scene.camera.world_from_camera;
    b.scene.camera.motion.emplace(start, Transform::translate({0.1, 0, 0.05}) * start);
    return b;
}

SceneBuilder foggy_scene(int size = 12) {
    SceneBuilder b = mixed_scene(1, size, size);
    b.scene.media.emplace_back(HomogeneousMedium{});
    auto& fog = std::get<HomogeneousMedium>(b.scene.media.back());
    fog.sigma_a = {0.1f};
    fog.sigma_s = {0.2f};
    fog.le = {0.05f};
    b.scene.camera.medium = 0;
    return b;
}

RenderState render_state(const SceneDescription& description) {
    RenderState state(description);
    Renderer(description).render(state);
    return state;
}

int differing_pixels(const Film& a, const Film& b) {
    int count = 0;
    for (std::size_t i = 0; i < a.pixels().size(); ++i) count += !same_pixel(a.pixels()[i], b.pixels()[i]);
    return count;
}

TEST(Layers, ChangeNoBitOfTheMean) {
    for (const SceneBuilder& scene : {layered_scene(), foggy_scene()}) {
        SceneBuilder b = scene;
        b.description.sampler = {.kind = SamplerKind::sobol, .spp = 40};
        const RenderState plain = render_state(b.description);
        b.description.film.layers.set = every_layer();
        const RenderState layered = render_state(b.description);
        EXPECT_EQ(differing_pixels(plain.film, layered.film), 0);
        EXPECT_EQ(plain.report.rays.rays(), layered.report.rays.rays());
    }
}

// Paths that are traced in batches and lanes give the numbers of single ones.
TEST(Layers, AreThoseOfSinglePathsBitForBit) {
    for (const SceneBuilder& scene : {layered_scene(), foggy_scene()})
        for (const Strategy strategy : {Strategy::mis, Strategy::bsdf, Strategy::light}) {
            SceneBuilder b = scene;
            b.description.sampler = {.kind = SamplerKind::independent, .spp = 8};
            b.description.integrator.strategy = strategy;
            b.description.film.filter = MitchellFilter{};
            b.description.film.max_component_value = 2;
            b.description.film.layers.set = every_layer();
            const Renderer renderer(b.description);
            RenderState state(b.description);
            renderer.render(state);
            const FilmLayers& layers = state.film.layers();
            const PixelBounds& bounds = state.film.bounds();
            int different = 0;
            std::size_t i = 0;
            for (int y = bounds.y0; y < bounds.y1; ++y)
                for (int x = bounds.x0; x < bounds.x1; ++x, ++i) {
                    std::vector<double> sums(layers.sums());
                    for (std::uint32_t k = 0; k < 8; ++k) {
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

// Largest relative difference between the mean and the sum of layers.
double distance_from_mean(const Image& image, const std::vector<std::string>& layers) {
    double largest = 0;
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x)
            for (const char* c : {"R", "G", "B"}) {
                double sum = 0, size = 0;
                for (const std::string& layer : layers) {
                    const double v = image.value(x, y, *image.find_channel(layer + "." + c));
                    sum += v;
                    size += std::abs(v);
                }
                const double mean = image.value(x, y, *image.find_channel(c));
                largest = std::max(largest, std::abs(sum - mean) / std::max({std::abs(mean), size, 1e-6}));
            }
    return largest;
}

TEST(Layers, DirectAndIndirectAndLightGroupsSumToTheMean) {
    for (const SceneBuilder& scene : {layered_scene(), foggy_scene()})
        for (const Strategy strategy : {Strategy::mis, Strategy::uniform, Strategy::mis_light})
            for (const LightGrouping grouping : {LightGrouping::light, LightGrouping::kind}) {
                SceneBuilder b = scene;
                // The last replicate is shorter than the others.
                b.description.sampler = {.kind = SamplerKind::sobol, .spp = 44};
                b.description.integrator.strategy = strategy;
                b.description.film.filter = MitchellFilter{};
                b.description.film.max_component_value = 1.5f;
                b.description.film.layers.set = {Layer::direct, Layer::indirect, Layer::light_groups};
                b.description.film.layers.light_grouping = grouping;
                const RenderState state = render_state(b.description);
                const Image image = state.film.develop();
                EXPECT_LT(distance_from_mean(image, {"direct", "indirect"}), 1e-5);
                std::vector<std::string> groups;
                for (const std::string& group : state.film.layers().light_groups())
                    groups.push_back("light." + group);
                EXPECT_EQ(groups.size(), (grouping == LightGrouping::light ? 3u : 2u) + b.scene.media.size());
                EXPECT_LT(distance_from_mean(image, groups), 1e-5);
                if (strategy != Strategy::mis) continue;
                // None of them is the whole.
                for (const std::string& group : groups)
                    EXPECT_GT(distance_from_mean(image, {group}), 0.1) << group;
                EXPECT_GT(distance_from_mean(image, {"direct"}), 0.1);
            }
}

// Its light belongs to no lamp.
TEST(Layers, AmbientOcclusionHasThem) {
    SceneBuilder b = mixed_scene(1, 12, 12);
    b.description.sampler = {.kind = SamplerKind::independent, .spp = 16};
    b.description.film.layers.set = {Layer::direct, Layer::indirect, Layer::position, Layer::alpha,
                                     Layer::shape};
    const Image paths = render_state(b.description).film.develop();
    b.description.integrator.occlusion = OcclusionSettings{};
    const Image image = render_state(b.description).film.develop();
    EXPECT_LT(distance_from_mean(image, {"direct", "indirect"}), 1e-5);
    const auto at = [](const Image& picture, int x, int y, const char* channel) {
        return picture.value(x, y, *picture.find_channel(channel));
    };
    float largest = 0;
    for (int y = 0; y < 12; ++y)
        for (int x = 0; x < 12; ++x) {
            largest = std::max(largest, at(image, x, y, "direct.G"));
            EXPECT_EQ(at(image, x, y, "indirect.G"), 0);
            // The camera rays are the same.
            for (const char* channel : {"P.X", "P.Y", "P.Z", "A", "CryptoShape00.R", "CryptoShape00.G"})
                EXPECT_EQ(at(image, x, y, channel), at(paths, x, y, channel)) << channel;
        }
    EXPECT_GT(largest, 0.1f);
    b.description.film.layers.set.add(Layer::light_groups);
    EXPECT_THROW(Renderer{b.description}, Error);
}

// Light after at most one scattering event is what a path of one event finds, by the same random numbers.
TEST(Layers, DirectIsThePictureOfOneScatteringEvent) {
    SceneBuilder b = layered_scene();
    b.description.sampler = {.kind = SamplerKind::independent, .spp = 16};
    b.description.film.layers.set = {Layer::direct};
    const Image all = render_state(b.description).film.develop();
    b.description.integrator.max_depth = 1;
    const Image one = render_state(b.description).film.develop();
    for (int y = 0; y < all.height(); ++y)
        for (int x = 0; x < all.width(); ++x)
            for (int c = 0; c < 3; ++c) {
                const float expected = one.value(x, y, c);
                EXPECT_NEAR(all.value(x, y, *all.find_channel(std::string("direct.") + "RGB"[c])), expected,
                            1e-5f * std::max(1.0f, std::abs(expected)));
            }
}

// Each group is the picture that its lights alone make.
TEST(Layers, LightGroupsAreThePicturesOfTheirLights) {
    SceneBuilder b = mixed_scene(1, 12, 12);
    b.description.sampler = {.kind = SamplerKind::independent, .spp = 400};
    b.description.film.layers.set = {Layer::light_groups};
    b.scene.light_groups = {"lamps", "lamps", "sky"};
    const RenderState state = render_state(b.description);
    const Image image = state.film.develop();
    SceneBuilder sky_only = mixed_scene(1, 12, 12);
    sky_only.description.sampler = {.kind = SamplerKind::independent, .spp = 400};
    sky_only.description.sampler.seed = 5;
    for (std::size_t i = 0; i < 2; ++i) std::get<AreaLight>(sky_only.scene.lights[i]).scale = 0;
    const Film alone = render(sky_only.description);
    double sum = 0;
    for (int y = 0; y < 12; ++y)
        for (int x = 0; x < 12; ++x) sum += image.value(x, y, *image.find_channel("light.sky.G"));
    const PictureMean expected = picture_mean(alone);
    // The error of the group is at most that of the whole picture.
    const double error = std::hypot(expected.standard_error, picture_mean(state.film).standard_error);
    EXPECT_NEAR(sum / 144, expected.mean, 5 * error);
    EXPECT_GT(expected.mean, 10 * error);
}

float value_of(const Image& image, int x, int y, const char* channel) {
    return image.value(x, y, *image.find_channel(channel));
}

// A square at z = 0 of half the side of the view, seen along -z from height 4 by a camera that moves to the right.
SceneBuilder square_below() {
    SceneBuilder b;
    b.description.film.width = b.description.film.height = 16;
    b.description.film.crop = {0, 0, 16, 16};
    b.description.sampler.spp = 64;
    TriangleMesh mesh = square(Transform());
    mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    b.add_mesh(mesh, b.add(DiffuseMaterial{gray(0.5f)}));
    b.add_uniform_light(1);
    b.look({0, 0, 4}, {0, 0, 0}, static_cast<float>(2 * std::atan(0.5) * 180 / pi));
    b.description.film.layers.set = {Layer::position,     Layer::uv,       Layer::geometric_normal,
                                     Layer::depth_slopes, Layer::motion,   Layer::alpha,
                                     Layer::shape,        Layer::material, Layer::depth};
    return b;
}

TEST(Layers, GeometryHasKnownValues) {
    SceneBuilder b = square_below();
    const Transform start = b.scene.camera.world_from_camera;
    // Pixels are 4/16 wide at the square: two pixels of motion.
    b.scene.camera.motion.emplace(start, start * Transform::translate({0.5, 0, 0}));
    b.scene.camera.shutter_close = 0.5f; // the first half of it
    const Image image = render_state(b.description).film.develop();
    for (int y = 5; y < 11; ++y)
        for (int x = 5; x < 11; ++x) {
            EXPECT_FLOAT_EQ(value_of(image, x, y, "A"), 1);
            EXPECT_FLOAT_EQ(value_of(image, x, y, "Ng.Z"), 1);
            EXPECT_NEAR(value_of(image, x, y, "P.Z"), 0, 1e-6);
            // Camera coordinates grow to the right, world x in the opposite direction or not: by the matrix.
            const Vec3d middle = start.point(Vec3d{(x + 0.5 - 8) / 4 + 0.125, (8 - y - 0.5) / 4, 4});
            EXPECT_NEAR(value_of(image, x, y, "P.X"), middle.x, 0.06);
            EXPECT_NEAR(value_of(image, x, y, "P.Y"), middle.y, 0.05);
            EXPECT_NEAR(value_of(image, x, y, "uv.U"), (value_of(image, x, y, "P.X") + 1) / 2, 1e-5);
            EXPECT_NEAR(value_of(image, x, y, "uv.V"), (value_of(image, x, y, "P.Y") + 1) / 2, 1e-5);
            EXPECT_NEAR(value_of(image, x, y, "motion.X"), -1, 1e-4);
            EXPECT_NEAR(value_of(image, x, y, "motion.Y"), 0, 1e-4);
            EXPECT_NEAR(value_of(image, x, y, "dzdx"), 0, 1e-5);
        }
    EXPECT_EQ(value_of(image, 0, 0, "A"), 0);
    EXPECT_EQ(value_of(image, 0, 0, "P.X"), 0);
    EXPECT_EQ(value_of(image, 0, 0, "CryptoShape00.R"), 0);
}

TEST(Layers, CoordinatesMayBeThoseOfTheCamera) {
    SceneBuilder b = square_below();
    // Turned about x: z grows by tan(30 degrees) per unit of y in the middle of the picture.
    b.scene.meshes[0] = square(Transform::rotate(30, {1, 0, 0}));
    b.description.film.layers.in_camera_space = true;
    b.description.film.layers.set.add(Layer::normal);
    const Image image = render_state(b.description).film.develop();
    const Transform camera_from_world = b.scene.camera.world_from_camera.inverse();
    const Vec3d n = camera_from_world.vector(Vec3d{0, -0.5, std::sqrt(0.75)});
    for (const char* layer : {"Ng.", "N."})
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(value_of(image, 8, 8, (layer + std::string(1, "XYZ"[c])).c_str()), n[c], 1e-5)
                << layer << c;
    EXPECT_NEAR(value_of(image, 8, 8, "P.Z"), 4, 0.2);
    // z = 4 / (1 + k t) along rays of slope t, which is 1/16 per row, upwards.
    const double k = n.y / n.z, t = -0.5 / 16, slope = k / 4 / std::pow(1 + k * t, 2);
    EXPECT_NEAR(value_of(image, 8, 8, "dzdy"), slope, 0.02 * std::abs(slope));
    EXPECT_NEAR(value_of(image, 8, 8, "dzdx"), 0, 1e-4);
}

// A moving instance, at all times of its samples.
TEST(Layers, MotionFollowsInstances) {
    SceneBuilder b = square_below();
    CallMessages messages("scene of a test");
    montelux::SceneBuilder builder(b.scene, messages);
    builder.begin_object("card");
    builder.add_shape(square(Transform::scale({3, 3, 1})), {.material = 0});
    builder.end_object();
    // One unit to the right in the camera's eyes and half a unit down, at distance 2: a pixel is 1/8 wide.
    const Transform& camera = b.scene.camera.world_from_camera;
    const Vec3d step = camera.vector(Vec3d{1, -0.5, 0});
    builder.add_instance("card", Transform::translate({0, 0, 2}),
                         Transform::translate(Vec3d{0, 0, 2} + step));
    builder.finish();
    const Image image = render_state(b.description).film.develop();
    for (int i = 2; i < 14; ++i) {
        EXPECT_NEAR(value_of(image, i, 8, "motion.X"), 8, 1e-3);
        EXPECT_NEAR(value_of(image, i, 8, "motion.Y"), 4, 1e-3);
    }
}

// A card that grows to twice its size: its points move away from the middle, whichever the time they are seen at.
TEST(Layers, MotionFollowsMeshesThatDeform) {
    for (const bool in_instance : {false, true}) {
        SceneBuilder b = square_below();
        CallMessages messages("scene of a test");
        montelux::SceneBuilder builder(b.scene, messages);
        const Transform place = Transform::translate({0, 0, 2});
        TriangleMesh card = square(in_instance ? Transform() : place);
        card.end_positions = card.positions;
        for (Point3f& p : card.positions) p = {1.5f * p.x, 1.5f * p.y, p.z};
        for (Point3f& p : card.end_positions) p = {3 * p.x, 3 * p.y, p.z};
        if (in_instance) builder.begin_object("card");
        builder.add_shape(std::move(card), {.material = 0});
        builder.end_object();
        // By 8 pixels to the right while it grows: a pixel is 1/8 wide.
        const Vec3d step = b.scene.camera.world_from_camera.vector(Vec3d{1, 0, 0});
        if (in_instance) builder.add_instance("card", place, Transform::translate(step) * place);
        builder.finish();
        b.description.film.layers.in_camera_space = true;
        b.description.sampler.spp = 1;
        const Film film = render_state(b.description).film;
        const Image image = film.develop();
        const Renderer renderer(b.description);
        for (int x = 2; x < 14; ++x) {
            const SampleRecord r = renderer.replay(x, 8, 0);
            // The camera is 2 above it. A point at distance d from the middle of the card was at d / (1 + t).
            const double d = value_of(image, x, 8, "P.X") - (in_instance ? double(r.time) : 0);
            const double grown = d / (1 + double(r.time));
            EXPECT_NEAR(value_of(image, x, 8, "motion.X"), 8 * (grown + (in_instance ? 1 : 0)), 2e-3)
                << x << " " << in_instance;
        }
    }
}

// Projection is the inverse of the camera's rays.
TEST(Layers, ProjectionInvertsTheCamera) {
    const auto expect_inverse = [](const CameraModel& model, double tolerance) {
        CameraSettings settings;
        settings.model = model;
        settings.world_from_camera = Transform::translate({1, 2, 3}) * Transform::rotate(40, {1, 2, 0});
        const Camera camera(settings, 32, 24);
        for (float y = 1.25f; y < 24; y += 3.5f)
            for (float x = 1.75f; x < 32; x += 4.5f) {
                const CameraRay ray = camera.generate_ray({x, y}, {0.5f, 0.5f});
                const auto film =
                    camera.project(camera.camera_from_world(0).point(Vec3d(ray.o) + Vec3d(ray.d) * 7));
                ASSERT_TRUE(film);
                EXPECT_NEAR(film->x, x, tolerance);
                EXPECT_NEAR(film->y, y, tolerance);
            }
    };
    expect_inverse(PerspectiveCamera{.fov = 70}, 1e-4);
    expect_inverse(PerspectiveCamera{.fov = 70, .screen_window = ScreenWindow{-0.2f, 1, -1, 0.5f}}, 1e-4);
    expect_inverse(OrthographicCamera{}, 1e-4);
    expect_inverse(SphericalCamera{SphericalCamera::Mapping::equirectangular}, 1e-3);
    expect_inverse(SphericalCamera{SphericalCamera::Mapping::equal_area}, 1e-3);
    CameraSettings sphere;
    sphere.model = SphericalCamera{SphericalCamera::Mapping::equirectangular};
    const Camera around(sphere, 100, 50);
    EXPECT_NEAR(around.film_step({98, 10}, {3, 12}).x, 5, 1e-4);
    EXPECT_FALSE(Camera({}, 8, 8).project({0, 0, -1}));
}

// The coverages of a matte sum to alpha, and each is the area that its shape covers.
TEST(Layers, MattesDecodeToCoverage) {
    SceneBuilder b = square_below();
    b.description.sampler = {.kind = SamplerKind::sobol, .spp = 256};
    b.description.film.filter = BoxFilter{};
    // A card above the square's right half covers pixel columns from 8 + 1/3 on.
    b.add_mesh(square(Transform::translate({1 + 1.0 / 12, 0, 0.0}) * Transform::translate({0, 0, 1e-3})),
               b.add(DiffuseMaterial{gray(0.2f)}));
    // It is an instance, which has the name of its object.
    b.scene.world_shapes = {0};
    b.scene.objects.push_back({.shapes = {1}, .name = "card"});
    b.scene.instances.push_back({0, Transform()});
    b.scene.shape_names = {"floor", "shape of the card"};
    b.scene.material_names = {"", "paint"};
    const Transform camera_from_world = b.scene.camera.world_from_camera.inverse();
    const bool mirrored = camera_from_world.vector(Vec3d{1, 0, 0}).x < 0;
    RenderSession session(std::make_shared<const SceneDescription>(b.description), {});
    session.render();
    const Image image = *session.finish().image;
    const auto coverage = [&](const char* matte, std::string_view name, int x, int y) {
        double sum = 0;
        const std::vector<std::string> channels = cryptomatte_channels(matte);
        for (std::size_t c = 0; c < channels.size(); c += 2)
            if (std::bit_cast<std::uint32_t>(image.value(x, y, *image.find_channel(channels[c]))) ==
                cryptomatte_id(name))
                sum += image.value(x, y, *image.find_channel(channels[c + 1]));
        return sum;
    };
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x) {
            const double floor = coverage("CryptoShape", "floor", x, y),
                         card = coverage("CryptoShape", "card:0", x, y);
            EXPECT_NEAR(floor + card, value_of(image, x, y, "A"), 1e-6);
            EXPECT_NEAR(coverage("CryptoMaterial", "paint", x, y), card, 1e-6);
            EXPECT_NEAR(coverage("CryptoMaterial", "material-0", x, y), floor, 1e-6);
        }
    const int column = mirrored ? 7 : 8;
    EXPECT_NEAR(coverage("CryptoShape", "floor", column, 8), 1.0 / 3, 0.02);
    EXPECT_NEAR(coverage("CryptoShape", "card:0", column, 8), 2.0 / 3, 0.02);
    EXPECT_EQ(coverage("CryptoShape", "floor", mirrored ? 8 : 7, 8), 1);
    const std::string key = "cryptomatte/";
    int manifests = 0;
    for (const auto& [name, value] : image.attributes())
        if (name.starts_with(key) && name.ends_with("/manifest")) {
            ++manifests;
            const std::string& text = std::get<std::string>(value);
            EXPECT_TRUE(text.find("\"card:0\"") != text.npos || text.find("\"paint\"") != text.npos) << text;
        }
    EXPECT_EQ(manifests, 2);
}

// Transparency of a medium that only absorbs, over nothing.
TEST(Layers, AlphaIsTheShareOfLightThatIsStopped) {
    SceneBuilder b;
    b.add_uniform_light(1);
    b.scene.media.emplace_back(HomogeneousMedium{});
    auto& smoke = std::get<HomogeneousMedium>(b.scene.media.back());
    smoke.sigma_a = {0.5f};
    smoke.sigma_s = {0};
    Index glass = b.add(InterfaceMaterial{});
    b.add_quadric(Sphere{.world_from_object = Transform()}, glass);
    b.scene.shapes[0].media = {0, no_index};
    b.look({0, 0, 4}, {0, 0, 0}, 1);
    b.description.film.layers.set = {Layer::alpha};
    const Image image = render_state(b.description).film.develop();
    EXPECT_NEAR(value_of(image, 4, 4, "A"), 1 - std::exp(-1.0), 1e-3); // 2 units of it
}

TEST(Layers, AreSavedInCheckpointsAndOtherLayersAreRefused) {
    TemporaryFolder folder;
    const std::filesystem::path path = folder / "render.state";
    SceneBuilder b = layered_scene();
    b.description.sampler = {.kind = SamplerKind::sobol, .spp = 64};
    b.description.film.layers.set = every_layer();
    const RenderState whole = render_state(b.description);
    RenderState state(b.description);
    const Renderer renderer(b.description);
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
    Renderer(description).render(restored.state);
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
    save_checkpoint(path, Renderer(b.description), whole);
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
