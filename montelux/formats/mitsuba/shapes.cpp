#include "montelux/formats/mitsuba/shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "montelux/formats/mitsuba/curve_files.h"
#include "montelux/formats/mitsuba/mesh_files.h"
#include "montelux/mc/math/frame.h"
#include "montelux/scene/build/float_range.h"

namespace montelux::mitsuba {
namespace {

Transform placed(Plugin& shape, const Transform& t) {
    if (!fits_float(t)) shape.error("the transformation is beyond what single-precision numbers hold");
    return t;
}

Transform scaled(Plugin& shape, Vec3d factors) {
    if (!(factors.x != 0 && factors.y != 0 && factors.z != 0))
        shape.error(shape.describe() + " has no extent");
    return Transform::scale(factors);
}

// A sphere whatever the transformation is: Mitsuba takes the radius along x and ignores scales that differ. It turns
// mirrored spheres inside out, but neither cylinders nor disks.
PlacedGeometry read_sphere(Plugin& shape, const Transform& to_world, bool flipped) {
    const double radius = shape.number("radius", 1);
    const Transform whole =
        to_world * Transform::translate(shape.vector("center", {})) * scaled(shape, {radius, radius, radius});
    std::array<Vec3d, 3> axes{whole.vector(Vec3d(1, 0, 0)), whole.vector(Vec3d(0, 1, 0)),
                              whole.vector(Vec3d(0, 0, 1))};
    const double size = length(axes[0]);
    const auto differs = [&](double value, double expected) {
        return std::abs(value - expected) > 1e-3 * size * size;
    };
    for (std::size_t i = 0; i < 3; ++i)
        if (differs(dot(axes[i], axes[i]), size * size) || differs(dot(axes[i], axes[(i + 1) % 3]), 0)) {
            shape.warn(
                "the transformation of a sphere scales unevenly; as in Mitsuba, the sphere stays one, with "
                "the radius along its x axis");
            axes = {Vec3d(size, 0, 0), Vec3d(0, size, 0), Vec3d(0, 0, size)};
            break;
        }
    const Vec3d center = whole.point(Vec3d());
    // Mitsuba's v grows from +z to -z, ours the other way.
    Matrix4 matrix;
    for (std::size_t row = 0; row < 3; ++row) {
        const int i = static_cast<int>(row);
        matrix.m[row] = {axes[0][i], axes[1][i], -axes[2][i], center[i]};
    }
    const std::optional<Transform> world_from_sphere = Transform::from_matrix(matrix);
    if (!world_from_sphere) shape.error("the sphere has no extent");
    return {Quadric(Sphere{.world_from_object = placed(shape, *world_from_sphere)}),
            flipped != whole.swaps_handedness()};
}

PlacedGeometry read_cylinder(Plugin& shape, const Transform& to_world, bool flipped) {
    const double radius = shape.number("radius", 1);
    const Vec3d p0 = shape.vector("p0", {0, 0, 0}), p1 = shape.vector("p1", {0, 0, 1});
    const double length_of_axis = length(p1 - p0);
    const Transform scale = scaled(shape, {radius, radius, length_of_axis});
    const FrameOf<double> frame = FrameOf<double>::from_normal((p1 - p0) / length_of_axis);
    Matrix4 turn;
    for (std::size_t row = 0; row < 3; ++row) {
        const int i = static_cast<int>(row);
        turn.m[row] = {frame.s[i], frame.t[i], frame.n[i], p0[i]};
    }
    const Transform whole = to_world * Transform(turn, *turn.inverse()) * scale;
    return {Quadric(Cylinder{.z_min = 0, .z_max = 1, .world_from_object = placed(shape, whole)}), flipped};
}

PlacedGeometry read_disk(Plugin& shape, const Transform& to_world, bool flipped) {
    return {Quadric(Disk{.polar = true, .world_from_object = placed(shape, to_world)}), flipped};
}

TriangleMesh unit_square() {
    TriangleMesh mesh;
    for (const Point2f uv : {Point2f(0, 0), Point2f(1, 0), Point2f(0, 1), Point2f(1, 1)}) {
        mesh.positions.emplace_back(2 * uv.x - 1, 2 * uv.y - 1, 0.0f);
        mesh.normals.emplace_back(0.0f, 0.0f, 1.0f);
        mesh.uvs.push_back(uv);
    }
    mesh.indices = {1, 2, 0, 1, 3, 2};
    return mesh;
}

// From -1 to 1 along each axis; each face has all of the texture.
TriangleMesh unit_cube() {
    struct Face {
        std::array<Point3f, 4> corners; // around the face
        Normal3f normal;
    };
    const std::array<Face, 6> faces{{
        {{{{1, -1, -1}, {1, -1, 1}, {-1, -1, 1}, {-1, -1, -1}}}, {0, -1, 0}},
        {{{{1, 1, -1}, {-1, 1, -1}, {-1, 1, 1}, {1, 1, 1}}}, {0, 1, 0}},
        {{{{1, -1, -1}, {1, 1, -1}, {1, 1, 1}, {1, -1, 1}}}, {1, 0, 0}},
        {{{{1, -1, 1}, {1, 1, 1}, {-1, 1, 1}, {-1, -1, 1}}}, {0, 0, 1}},
        {{{{-1, -1, 1}, {-1, 1, 1}, {-1, 1, -1}, {-1, -1, -1}}}, {-1, 0, 0}},
        {{{{1, 1, -1}, {1, -1, -1}, {-1, -1, -1}, {-1, 1, -1}}}, {0, 0, -1}},
    }};
    const std::array<Point2f, 4> uvs{{{0, 1}, {1, 1}, {1, 0}, {0, 0}}};
    TriangleMesh mesh;
    for (const Face& face : faces) {
        const auto first = static_cast<Index>(mesh.positions.size());
        for (std::size_t k = 0; k < 4; ++k) {
            mesh.positions.push_back(face.corners[k]);
            mesh.normals.push_back(face.normal);
            mesh.uvs.push_back(uvs[k]);
        }
        for (const Index k : {0u, 1u, 2u, 3u, 0u, 2u}) mesh.indices.push_back(first + k);
    }
    return mesh;
}

PlacedGeometry placed_mesh(TriangleMesh mesh, const Transform& to_world, bool flipped) {
    transform_mesh(mesh, to_world, flipped);
    return {std::move(mesh), flipped != to_world.swaps_handedness()};
}

} // namespace

PlacedGeometry read_geometry(Plugin& shape) {
    const Transform to_world = shape.transform("to_world");
    const std::string& type = shape.type();
    if (type == "bsplinecurve" || type == "linearcurve") return {read_curves(shape, to_world), false};
    const bool flipped = shape.flag("flip_normals", false);
    if (type == "sphere") return read_sphere(shape, to_world, flipped);
    if (type == "cylinder") return read_cylinder(shape, to_world, flipped);
    if (type == "disk") return read_disk(shape, to_world, flipped);
    if (type == "rectangle" || type == "cube") {
        TriangleMesh mesh = type == "cube" ? unit_cube() : unit_square();
        if (shape.flag("face_normals", false)) mesh.normals.clear();
        return placed_mesh(std::move(mesh), to_world, flipped);
    }
    if (type == "obj" || type == "ply" || type == "serialized")
        return placed_mesh(read_mesh_file(shape), to_world, flipped);
    shape.refuse();
}

} // namespace montelux::mitsuba
