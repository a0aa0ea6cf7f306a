// Warps for Python: maps of uniform numbers to points of a density, and back, on arrays.
#pragma once

#include "python/src/bindings.h"
#include "python/src/numpy_bridge.h"
#include <cstddef>
#include <functional>
#include <string>
#include <utility>

#include "montelux/mc/math/vec.h"

namespace montelux::python {

// Numbers and points of one to three coordinates.
struct Warp {
    std::string name;
    std::size_t uniforms, coordinates;
    std::function<void(const double* u, double* x)> sample;
    std::function<double(const double* x)> pdf;
    std::function<void(const double* x, double* u)> inverse;
};

inline Vec2d two(const double* x) { return {x[0], x[1]}; }
inline Vec3d three(const double* x) { return {x[0], x[1], x[2]}; }
inline void put(double v, double* x) { x[0] = v; }
inline void put(Vec2d v, double* x) {
    x[0] = v.x;
    x[1] = v.y;
}
inline void put(Vec3d v, double* x) {
    x[0] = v.x;
    x[1] = v.y;
    x[2] = v.z;
}

template <typename Sample, typename Pdf, typename Inverse>
Warp of_numbers(std::string name, Sample sample, Pdf pdf, Inverse inverse) {
    return {std::move(name),
            1,
            1,
            [sample](const double* u, double* x) { put(sample(*u), x); },
            [pdf](const double* x) { return pdf(*x); },
            [inverse](const double* x, double* u) { put(inverse(*x), u); }};
}
template <typename Sample, typename Pdf, typename Inverse>
Warp of_plane(std::string name, Sample sample, Pdf pdf, Inverse inverse) {
    return {std::move(name),
            2,
            2,
            [sample](const double* u, double* x) { put(sample(two(u)), x); },
            [pdf](const double* x) { return pdf(two(x)); },
            [inverse](const double* x, double* u) { put(inverse(two(x)), u); }};
}
template <typename Sample, typename Pdf, typename Inverse>
Warp of_space(std::string name, Sample sample, Pdf pdf, Inverse inverse) {
    return {std::move(name),
            2,
            3,
            [sample](const double* u, double* x) { put(sample(two(u)), x); },
            [pdf](const double* x) { return pdf(three(x)); },
            [inverse](const double* x, double* u) { put(inverse(three(x)), u); }};
}

// Each adds its warps to the module, under names that begin with warp_.
void bind_ggx_warps(nb::module_& m);

} // namespace montelux::python
