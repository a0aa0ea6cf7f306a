// Shapes that emit and move, and the still ones that stand where they are at a time.
#pragma once

#include "test/accel/accel_testing.h"
#include "test/scene/emission_testing.h"
#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "montelux/scene/light/emissive_shape.h"

namespace montelux::testing::moving {

inline constexpr float times[] = {0, 0.21f, 0.5f, 0.77f, 1};
inline const SampledWavelengths lambda = SampledWavelengths::sample_visible(0.3f);

// A shape of radiance 2 on the side of its normal.
struct Emitter {
    std::string name;
    Geometry geometry; // in its own space; a mesh may deform
    Transform start{}, end{};
    bool two_sided = false;
    float power = 0;
    bool flip = false;
    bool picture = false, holes = false; // a picture of 8 x 8 texels; a checkerboard of 6 x 6 fields

    ShapeSettings settings(const Emission& emission, bool flipped) const {
        return {.material = 0,
                .alpha = holes ? FloatParameter{1, 0} : FloatParameter{1},
                .flip_normal = flipped,
                .emission = &emission};
    }
    Emission emission() const {
        return {.spectrum = 1.0f,
                .scale = 2,
                .two_sided = two_sided,
                .power = power,
                .picture = picture ? 0 : no_index};
    }
    Scene moving() const {
        return made([&](montelux::SceneBuilder& b, const Emission& e) {
            b.add_moving_shape(geometry, settings(e, flip), start, end);
        });
    }
    // Directly in the world, as it is at that time.
    Scene still(float time) const {
        const Transform t = start == end ? start : Motion(start, end).at(time);
        return made([&](montelux::SceneBuilder& b, const Emission& e) {
            Geometry there = geometry;
            bool flipped = flip;
            if (auto* mesh = std::get_if<TriangleMesh>(&there)) {
                for (Index v = 0; v < mesh->positions.size(); ++v) {
                    mesh->positions[v] = mesh->position(v, time);
                    if (!mesh->normals.empty()) mesh->normals[v] = mesh->normal(v, time);
                }
                mesh->end_positions.clear();
                mesh->end_normals.clear();
                transform_mesh(*mesh, t);
                flipped = flip != t.swaps_handedness();
            } else if (auto* patches = std::get_if<BilinearMesh>(&there)) {
                transform_mesh(*patches, t);
                flipped = flip != t.swaps_handedness();
            } else {
                there = placed(std::get<Quadric>(there), t);
            }
            b.add_shape(std::move(there), settings(e, flipped));
        });
    }

    // What a picture and holes refer to.
    static void prepare(Scene& scene) {
        Image map(8, 8, {"R", "G", "B"});
        for (int i = 0; i < 192; ++i)
            map.f32()[static_cast<std::size_t>(i)] = 0.2f + static_cast<float>(i * 7 % 11);
        scene.environments.push_back(map);
        TextureMapping six;
        six.su = six.sv = 6;
        scene.float_textures.push_back(
            CheckerboardTexture<FloatParameter>{2, six, {FloatParameter{1}, FloatParameter{0}}});
    }

  private:
    Scene made(const std::function<void(montelux::SceneBuilder&, const Emission&)>& add) const {
        Scene scene;
        scene.materials.resize(1);
        prepare(scene);
        CallMessages messages("a test");
        montelux::SceneBuilder builder(scene, messages);
        add(builder, emission());
        builder.finish();
        return scene;
    }
};

inline Geometry sheet(bool deforms, bool normals) {
    TriangleMesh m = emission::two_triangles();
    if (normals) m.normals.assign(m.positions.size(), {0.2f, 0.1f, -1});
    if (!deforms) return m;
    m.end_positions = {{-1, -2, 1}, {1, 1.5f, 0.5f}, {1, -1, 2}, {3, 1, 1}};
    if (normals) m.end_normals.assign(m.positions.size(), {-0.1f, 0.3f, -1});
    return m;
}

inline Geometry curved_patch() {
    BilinearMesh m;
    m.positions = {{-1, -1, 0}, {1, -1, 0.5f}, {-1, 1, 0.3f}, {1.2f, 1, -0.4f}};
    m.indices = {0, 1, 2, 3};
    return m;
}

inline std::vector<Emitter> emitters() {
    const Transform a = Transform::translate({1, 0, 1}) * Transform::rotate(20, {1, 0.3, 0}),
                    b = Transform::translate({-1, 2, 0}) * Transform::rotate(70, {1, 2, 0}),
                    lengthened = b * Transform::scale({1.7, 0.6, 1.2}),
                    mirrored_a = a * Transform::scale({-1, 1, 1}),
                    mirrored_b = b * Transform::scale({-0.5, 1, 2}),
                    tiny = a * Transform::scale({0.05, 0.05, 0.05}),
                    large = b * Transform::scale({2.5, 2.5, 2.5});
    const Quadric disk = Disk{.radius = 0.7f, .world_from_object = Transform::rotate(30, {0, 1, 0})},
                  ball = Sphere{.radius = 0.6f, .z_min = -0.6f, .z_max = 0.6f, .world_from_object = {}},
                  bowl = Sphere{.z_min = -0.5f, .z_max = 0.9f, .phi_max = 4, .world_from_object = {}},
                  ellipsoid = Sphere{.world_from_object = Transform::scale({1, 0.6, 0.8})},
                  tube = Cylinder{
                      .radius = 0.5f, .z_min = -1, .z_max = 2, .phi_max = 4, .world_from_object = {}};
    return {
        {"mesh", sheet(false, false), a, b},
        {"mesh with normals", sheet(false, true), a, lengthened},
        {"mesh of two sides, flipped", sheet(false, false), a, lengthened, true, 0, true},
        {"mesh with normals, flipped", sheet(false, true), a, lengthened, false, 0, true},
        {"mirrored mesh", sheet(false, false), mirrored_a, mirrored_b},
        {"mirrored mesh with normals", sheet(false, true), mirrored_a, mirrored_b},
        {"mesh that grows", sheet(false, false), tiny, large},
        {"mesh of a given power that grows", sheet(false, false), tiny, large, false, 3},
        {"mesh that deforms", sheet(true, false), {}, {}},
        {"mesh with normals that deforms", sheet(true, true), b, b},
        {"mesh of a given power that deforms", sheet(true, false), {}, {}, true, 3},
        {"mesh that moves and deforms", sheet(true, false), mirrored_a, mirrored_b},
        {"patch", curved_patch(), a, b},
        {"patch of a given power that grows", curved_patch(), tiny, large, false, 3},
        {"mirrored patch", curved_patch(), mirrored_a, b * Transform::scale({-1, 1, 1})},
        {"disk", disk, a, b},
        {"disk, flipped", disk, a, lengthened, false, 0, true},
        {"mirrored disk", disk, mirrored_a, mirrored_b},
        {"sphere", ball, a, b},
        {"sphere that grows", ball, tiny, large},
        {"mirrored sphere", ball, mirrored_a, mirrored_b},
        {"sphere that is lengthened", ball, a, lengthened},
        {"part of a sphere", bowl, mirrored_a, mirrored_b, true},
        {"ellipsoid", ellipsoid, a, lengthened},
        {"part of a cylinder", tube, a, mirrored_b * Transform::scale({-1, 1, 1})},
        {"disk that does not move", disk, b, b},
        {"mesh with a picture", sheet(false, false), mirrored_a, mirrored_b, false, 0, false, true},
        {"disk with a picture", disk, a, lengthened, true, 0, false, true},
        {"sphere with a picture", ball, tiny, large, false, 0, false, true},
        {"mesh with holes that moves and deforms", sheet(true, false), a, lengthened, false, 0, false, false,
         true},
        {"sphere with holes", ball, a, lengthened, false, 0, false, false, true},
    };
}

inline bool near(float a, float b, float relative) {
    return std::abs(a - b) <= relative * std::max(std::abs(a), std::abs(b));
}

} // namespace montelux::testing::moving
