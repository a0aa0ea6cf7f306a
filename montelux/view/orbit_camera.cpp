#include "montelux/view/orbit_camera.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "montelux/scene/light/light_tables.h"
#include "montelux/scene/shape/bounds.h"

namespace montelux {

namespace {

Vec3d axis_nearest_to(Vec3d direction) {
    const std::array<double, 3> size{std::abs(direction.x), std::abs(direction.y), std::abs(direction.z)};
    const auto largest = static_cast<int>(std::ranges::max_element(size) - size.begin());
    Vec3d axis;
    axis[largest] = direction[largest] < 0 ? -1 : 1;
    return axis;
}

// By so many degrees about an axis through a point, such that what lies in the direction `from` goes towards `to`.
Transform turn_towards(double degrees, Vec3d pivot, Vec3d axis, Vec3d from, Vec3d to) {
    const double sense = dot(cross(axis, from), to) < 0 ? -1 : 1;
    return Transform::translate(pivot) * Transform::rotate(sense * degrees, axis) *
           Transform::translate(-pivot);
}

} // namespace

Vec3d orbit_pivot(const Renderer& renderer) {
    const Transform& camera = renderer.description().scene.camera.world_from_camera;
    const Vec3d eye = camera.point(Vec3d{0, 0, 0}), forward = normalize(camera.vector(Vec3d{0, 0, 1}));
    Ray ray;
    ray.o = Vec3f(eye);
    ray.d = Vec3f(forward);
    Hit hit;
    if (renderer.accelerator().intersect(ray, hit)) return eye + double(hit.t) * forward;
    const Bounds3 bounds = bounds_of(renderer.description().scene);
    const double depth = bounds.empty() ? 0 : dot(bounds.center() - eye, forward);
    return eye + (depth > 0 ? depth : 1) * forward;
}

CameraSettings orbited(const CameraSettings& camera, Vec3d pivot, const ViewOrbit& orbit) {
    const Transform& placed = camera.world_from_camera;
    const Vec3d right = normalize(placed.vector(Vec3d{1, 0, 0})),
                up = normalize(placed.vector(Vec3d{0, 1, 0})),
                back = normalize(placed.vector(Vec3d{0, 0, -1}));
    const Transform rise = turn_towards(orbit.elevation, pivot, right, back, up);
    const Transform turn = turn_towards(orbit.azimuth, pivot, axis_nearest_to(up), back, right);
    const Vec3d eye = (turn * rise).point(placed.point(Vec3d{0, 0, 0}));
    const Transform moved = Transform::translate((1 / orbit.zoom - 1) * (eye - pivot)) * turn * rise;
    CameraSettings result = camera;
    result.world_from_camera = moved * placed;
    if (camera.motion) result.motion.emplace(moved * camera.motion->start(), moved * camera.motion->end());
    return result;
}

} // namespace montelux
