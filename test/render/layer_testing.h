// Scenes for the tests of layers, and the values of their pictures.
#pragma once

#include "test/render/mixed_scene.h"
#include <cmath>
#include <memory>
#include <utility>

#include "montelux/image/image.h"

namespace montelux::testing {

inline LayerSet every_layer() {
    LayerSet set;
    for (std::size_t i = 0; i < layer_names().size(); ++i) set.add(static_cast<Layer>(i));
    return set;
}

// Surfaces of all kinds, instances that move, a moving camera.
inline SceneBuilder layered_scene(int size = 16) {
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

inline SceneBuilder foggy_scene(int size = 12) {
    SceneBuilder b = mixed_scene(1, size, size);
    b.scene.media.emplace_back(HomogeneousMedium{});
    auto& fog = std::get<HomogeneousMedium>(b.scene.media.back());
    fog.sigma_a = {0.1f};
    fog.sigma_s = {0.2f};
    fog.le = {0.05f};
    b.scene.camera.medium = 0;
    return b;
}

// A square at z = 0 of half the side of the view, seen along -z from height 4 by a camera that moves to the right.
inline SceneBuilder square_below() {
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

inline RenderState render_state(const SceneDescription& description,
                                std::shared_ptr<const PreparedScene> prepared = nullptr) {
    RenderState state(description);
    Renderer(description, {}, 0, std::move(prepared)).render(state);
    return state;
}

inline float value_of(const Image& image, int x, int y, const char* channel) {
    return image.value(x, y, *image.find_channel(channel));
}

} // namespace montelux::testing
