// MajorantWalk: the pieces of a ray on which a medium's extinction has a constant bound.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "montelux/scene/shape/ray.h"
#include "montelux/spectrum/sampled_spectrum.h"

namespace montelux {

// Bounds of a density in the cells of the unit cube: resolution^3 of them, x fastest.
struct MajorantGrid {
    int resolution = 0;
    std::vector<float> values;

    float operator()(int x, int y, int z) const {
        return values[(static_cast<std::size_t>(z) * static_cast<std::size_t>(resolution) +
                       static_cast<std::size_t>(y)) *
                          static_cast<std::size_t>(resolution) +
                      static_cast<std::size_t>(x)];
    }
};

// Extinction is at most `majorant` for t in [t0, t1] along the ray.
struct MajorantSegment {
    float t0 = 0, t1 = 0;
    SampledSpectrum majorant;
};

// The part [t0, t1] of a ray within the unit cube; empty if t0 >= t1.
struct CubeInterval {
    float t0 = 0, t1 = 0;

    bool empty() const { return !(t0 < t1); }
};
inline CubeInterval intersect_unit_cube(const Ray& ray) {
    CubeInterval r{0, ray.t_max};
    for (int a = 0; a < 3; ++a) {
        if (ray.d[a] == 0) {
            if (!(ray.o[a] >= 0 && ray.o[a] <= 1)) return {};
            continue;
        }
        const float inverse = 1 / ray.d[a];
        const float at_zero = -ray.o[a] * inverse, at_one = (1 - ray.o[a]) * inverse;
        r.t0 = std::max(r.t0, std::min(at_zero, at_one));
        r.t1 = std::min(r.t1, std::max(at_zero, at_one));
    }
    return r;
}

// Segments in order of t; between and beyond them there is no medium.
class MajorantWalk {
  public:
    // No segment.
    MajorantWalk() = default;
    // One segment.
    MajorantWalk(float t0, float t1, SampledSpectrum majorant) : t_(t0), end_(t1), scale_(majorant) {}
    // The cells of a grid that the ray passes, which must outlive the walk; their values times `scale`. The ray
    // is given in the space where the grid fills the unit cube. Amanatides and Woo 1987, "A Fast Voxel
    // Traversal Algorithm for Ray Tracing".
    MajorantWalk(const Ray& ray, const MajorantGrid& grid, SampledSpectrum scale)
        : scale_(scale), grid_(&grid) {
        const CubeInterval inside = intersect_unit_cube(ray);
        t_ = inside.t0;
        end_ = inside.t1;
        if (inside.empty()) return;
        const auto n = static_cast<float>(grid.resolution);
        for (int a = 0; a < 3; ++a) {
            const auto at = static_cast<std::size_t>(a);
            const float x = (ray.o[a] + t_ * ray.d[a]) * n;
            cell_[at] = std::clamp(static_cast<int>(x), 0, grid.resolution - 1);
            const float d = ray.d[a] * n;
            if (d == 0) {
                next_[at] = step_t_[at] = std::numeric_limits<float>::infinity();
                continue;
            }
            const bool up = d > 0;
            next_[at] = t_ + (static_cast<float>(cell_[at] + (up ? 1 : 0)) - x) / d;
            step_t_[at] = std::abs(1 / d);
            step_[at] = up ? 1 : -1;
            limit_[at] = up ? grid.resolution : -1;
        }
    }

    // False after the last segment.
    bool next(MajorantSegment& segment) {
        if (!(t_ < end_)) return false;
        segment.t0 = t_;
        if (grid_ == nullptr) {
            segment.t1 = t_ = end_;
            segment.majorant = scale_;
            return true;
        }
        const std::size_t axis =
            next_[0] < next_[1] ? (next_[0] < next_[2] ? 0u : 2u) : (next_[1] < next_[2] ? 1u : 2u);
        segment.majorant = scale_ * (*grid_)(cell_[0], cell_[1], cell_[2]);
        // Rounding may put a crossing before the last one.
        segment.t1 = std::clamp(next_[axis], t_, end_);
        t_ = segment.t1;
        cell_[axis] += step_[axis];
        next_[axis] += step_t_[axis];
        if (cell_[axis] == limit_[axis]) segment.t1 = t_ = end_; // rounding may leave a rest
        return true;
    }

  private:
    float t_ = 0, end_ = 0;
    SampledSpectrum scale_;
    const MajorantGrid* grid_ = nullptr;
    std::array<int, 3> cell_{}, step_{}, limit_{};
    std::array<float, 3> next_{}, step_t_{};
};

} // namespace montelux
