// A scene that is hard for path tracing: a lamp behind a wall with a slit.
#pragma once

#include "test/render/scene_testing.h"

namespace montelux::testing {

// A closed box; a wall across it leaves a slit, behind which a lamp shines. What the camera sees is lit through it.
inline SceneBuilder hidden_lamp(int size) {
    SceneBuilder b;
    b.description.film.width = b.description.film.height = size;
    b.description.film.crop = {0, 0, size, size};
    b.description.integrator.max_depth = 12;
    const Index grey = b.add(DiffuseMaterial{gray(0.7f)}), black = b.add(DiffuseMaterial{gray(0)});
    const auto wall = [&](const Transform& t, Index material, float emission = 0) {
        b.add_mesh(square(t), material, emission);
    };
    const Transform wide = Transform::scale({2, 1, 1});
    wall(Transform::translate({0, 0, -1}) * wide, grey);
    wall(Transform::translate({0, 0, 1}) * Transform::rotate(180, {1, 0, 0}) * wide, grey);
    wall(Transform::translate({0, 1, 0}) * Transform::rotate(90, {1, 0, 0}) * wide, grey);
    wall(Transform::translate({0, -1, 0}) * Transform::rotate(-90, {1, 0, 0}) * wide, grey);
    wall(Transform::translate({-2, 0, 0}) * Transform::rotate(90, {0, 1, 0}), grey);
    wall(Transform::translate({2, 0, 0}) * Transform::rotate(-90, {0, 1, 0}), grey);
    // Across the box at x = 0.8, but for a slit beside y = 1.
    wall(Transform::translate({0.8, -0.1, 0}) * Transform::rotate(90, {0, 1, 0}) *
             Transform::scale({1, 0.9, 1}),
         grey);
    wall(Transform::translate({1.95, -0.6, 0}) * Transform::rotate(-90, {0, 1, 0}) *
             Transform::scale({0.2, 0.2, 1}),
         black, 100);
    b.look({0.6, -0.9, 0.4}, {-2, 0.2, -0.5}, 60);
    return b;
}

} // namespace montelux::testing
