// A room with every kind of surface and light, at any scale.
#pragma once

#include "test/render/scene_testing.h"

namespace montelux::testing {

inline RoughnessParameter alpha_of(float alpha) {
    return {FloatParameter{alpha}, FloatParameter{alpha}, false};
}

// A coloured box, open in front, that contains a rough conductor, a coated ball and a glass ball, with two
// area lights and an environment; `scale` is its unit of length.
inline SceneBuilder mixed_scene(double scale = 1, int width = 16, int height = 16) {
    SceneBuilder b;
    b.description.film.width = width;
    b.description.film.height = height;
    b.description.film.crop = {0, 0, width, height};
    Transform unit = Transform::scale({scale, scale, scale});
    auto wall = [&](const Transform& t, Vec3f rgb) {
        const SceneSpectrum color = add_spectrum(b.scene, RgbAlbedoSpectrum(RgbColorSpace::srgb(), rgb));
        b.add_mesh(square(unit * t), b.add(DiffuseMaterial{{color}}));
    };
    wall(Transform::translate({0, 0, -1}), {0.7f, 0.7f, 0.7f});
    wall(Transform::translate({0, 0, 1}) * Transform::rotate(180, {1, 0, 0}), {0.6f, 0.6f, 0.6f});
    wall(Transform::translate({0, 1, 0}) * Transform::rotate(90, {1, 0, 0}), {0.5f, 0.5f, 0.6f});
    wall(Transform::translate({-1, 0, 0}) * Transform::rotate(90, {0, 1, 0}), {0.6f, 0.1f, 0.1f});
    wall(Transform::translate({1, 0, 0}) * Transform::rotate(-90, {0, 1, 0}), {0.1f, 0.5f, 0.1f});

    auto ball = [&](Vec3d at, double radius, const Material& material) {
        Transform t = unit * Transform::translate(at) * Transform::scale({radius, radius, radius});
        b.add_quadric(Sphere{.world_from_object = t}, b.add(material));
    };
    ball({-0.5, 0.2, -0.65}, 0.35,
         ConductorMaterial{.metal = {.eta = gray(0.2f), .k = gray(3)}, .roughness = alpha_of(0.3f)});
    ball({0.1, 0.5, -0.7}, 0.3,
         CoatedDiffuseMaterial{
             gray(0.6f),
             CoatingParameters{.roughness = alpha_of(0.2f), .eta = 1.5f, .albedo = gray(0), .g = {0}}});
    ball({0.5, -0.1, -0.65}, 0.35, DielectricMaterial{1.5f, alpha_of(0)});

    Index black = b.add(DiffuseMaterial{gray(0)});
    b.add_mesh(square(unit * Transform::translate({0.2, 0.1, 0.95}) * Transform::rotate(180, {1, 0, 0}) *
                      Transform::scale({0.5, 0.4, 1})),
               black, 3);
    b.add_quadric(Sphere{.radius = 0.2f,
                         .z_min = -0.2f,
                         .z_max = 0.2f,
                         .world_from_object = unit * Transform::translate({-0.6, 0.5, 0.5})},
                  black, 4);
    Image map(8, 8, {"R", "G", "B"});
    for (int i = 0; i < 64; ++i)
        for (int c = 0; c < 3; ++c)
            map.set(i % 8, i / 8, c, 0.2f + 0.1f * static_cast<float>((i * 7 + c) % 5));
    b.scene.environments.push_back(map);
    b.scene.lights.push_back(
        ImageInfiniteLight{.environment = 0, .scale = white_scale(), .world_from_light = {}});
    b.look({0, -3.6 * scale, 0}, {0, 0, 0}, 36);
    return b;
}

} // namespace montelux::testing
