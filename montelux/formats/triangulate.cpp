#include "montelux/formats/triangulate.h"

#include <algorithm>
#include <cmath>

namespace montelux {
namespace {

// Comparisons of a point with a triangle; seconds.
constexpr std::size_t most_tests = std::size_t{1} << 31;

double cross2(Vec2d a, Vec2d b) { return a.x * b.y - a.y * b.x; }

// Twice the signed area of a triangle.
double area(Vec2d a, Vec2d b, Vec2d c) { return cross2(b - a, c - a); }

} // namespace

std::span<const Triangulator::Triangle> Triangulator::split(std::span<const Point3f> corners) {
    const auto n = static_cast<std::uint32_t>(corners.size());
    triangles_.clear();
    // Newell's normal: the sum of the triangles' normals, whatever their origin.
    Vec3d normal{};
    for (std::uint32_t i = 1; i + 1 < n; ++i)
        normal =
            normal + cross(Vec3d(corners[i]) - Vec3d(corners[0]), Vec3d(corners[i + 1]) - Vec3d(corners[0]));
    const auto fan = [&] {
        for (std::uint32_t i = 1; i + 1 < n; ++i) triangles_.push_back({0, i, i + 1});
    };
    if (n == 3) {
        fan();
        return triangles_;
    }
    // The projection along the normal's largest component keeps the order of corners, and their orientation by its
    // sign.
    const Vec3d size{std::abs(normal.x), std::abs(normal.y), std::abs(normal.z)};
    const int axis = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
    const bool reversed = !(normal[axis] >= 0);
    plane_.clear();
    for (const Point3f p : corners) {
        const Vec3d d = Vec3d(p) - Vec3d(corners[0]);
        Vec2d q{d[(axis + 1) % 3], d[(axis + 2) % 3]};
        if (reversed) q = {q.y, q.x};
        plane_.push_back(q);
    }
    bool concave = false;
    for (std::uint32_t i = 0; i < n; ++i)
        concave = concave || area(plane_[(i + n - 1) % n], plane_[i], plane_[(i + 1) % n]) < 0;
    if (!concave) {
        fan();
    } else if (n > most_clipped) {
        ++fans_;
        fan();
    } else {
        clip();
    }
    return triangles_;
}

bool Triangulator::is_ear(std::size_t previous, std::size_t ear, std::size_t next) const {
    const Vec2d a = plane_[open_[previous]], b = plane_[open_[ear]], c = plane_[open_[next]];
    if (!(area(a, b, c) > 0)) return false;
    for (std::size_t i = 0; i < open_.size(); ++i) {
        if (i == previous || i == ear || i == next) continue;
        const Vec2d p = plane_[open_[i]];
        if (area(a, b, p) >= 0 && area(b, c, p) >= 0 && area(c, a, p) >= 0) return false;
    }
    return true;
}

void Triangulator::clip() {
    open_.resize(plane_.size());
    for (std::size_t i = 0; i < open_.size(); ++i) open_[i] = static_cast<std::uint32_t>(i);
    std::size_t at = 0, failures = 0;
    while (open_.size() > 3 && failures < open_.size() && tests_ < most_tests) {
        const std::size_t n = open_.size();
        const std::size_t previous = (at + n - 1) % n, next = (at + 1) % n;
        tests_ += n;
        if (is_ear(previous, at, next)) {
            triangles_.push_back({open_[previous], open_[at], open_[next]});
            open_.erase(open_.begin() + static_cast<std::ptrdiff_t>(at));
            failures = 0;
            if (at == open_.size()) at = 0;
        } else {
            ++failures;
            at = next;
        }
    }
    if (open_.size() > 3) ++fans_;
    for (std::size_t i = 1; i + 1 < open_.size(); ++i)
        triangles_.push_back({open_[0], open_[i], open_[i + 1]});
}

} // namespace montelux
