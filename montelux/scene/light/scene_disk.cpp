#include "montelux/scene/light/scene_disk.h"

#include <algorithm>

#include "montelux/mc/math/constants.h"
#include "montelux/mc/math/frame.h"
#include "montelux/mc/warp/disk.h"

namespace montelux {

// The radius is that of LightTables: estimates of power use the flux through the disk.
SceneDisk::SceneDisk(const Bounds3& bounds)
    : center_(bounds.empty() ? Vec3d() : bounds.center()), radius_(std::max(bounds.radius(), 1e-30)) {}

double SceneDisk::area() const { return pi * radius_ * radius_; }

Ray SceneDisk::sample(Vec3f w, Vec2f u) const {
    const Frame frame = Frame::from_normal(w);
    const Vec2f d = sample_uniform_disk_concentric(u);
    const Vec3d across = double(d.x) * Vec3d(frame.s) + double(d.y) * Vec3d(frame.t);
    return {Vec3f(center_ + radius_ * (across - Vec3d(w))), w};
}

Ray SceneDisk::through(Vec3d p, Vec3f w) const {
    const double back = radius_ + std::max(0.0, dot(p - center_, Vec3d(w)));
    return {Vec3f(p - back * Vec3d(w)), w};
}

} // namespace montelux
