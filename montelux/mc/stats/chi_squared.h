// Chi-squared tests of samplers against the densities they report, with adapters for intervals, rectangles
// and the sphere.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <random>
#include <span>
#include <type_traits>
#include <vector>

#include "montelux/mc/math/constants.h"
#include "montelux/mc/math/vec.h"
#include "montelux/mc/stats/test_result.h"

namespace montelux {

// Pearson's test of counts against expectations. Cells that expect fewer than `pool_below` are pooled,
// smallest first, until each pool expects that many. Counts in cells that expect nothing (less than 1e-9
// of the total) are forgiven up to 1e-4 of the total, for rounding at the edge of a support; beyond
// that p = 0. The expectations must add up to the number of counts.
TestResult chi_squared_test(std::span<const double> observed, std::span<const double> expected,
                            double pool_below = 5);

struct ChiSquaredOptions {
    int samples = 200000;
    int cells_x = 20; // along x, or cos(theta)
    int cells_y = 40; // along y, or phi; unused for intervals
    std::uint64_t seed = 1;
    double pool_below = 5;
    // Spherical tests: cells cover this range of cos(theta), so that they can resolve a narrow lobe
    // around +z. Samples outside it are one more cell, which expects what the density leaves over.
    double cos_theta_min = -1, cos_theta_max = 1;
};

// Counts of a sampler and integrals of its density over cells_x x cells_y equal cells of a rectangle,
// and the samples that failed or fell outside, which expect 1 - (integral of the density).
class CellCounts {
  public:
    CellCounts(Vec2d lower, Vec2d upper, int cells_x, int cells_y);

    void add(Vec2d p);
    void add_failure() { ++failures_; }
    // Adaptive Gauss-Legendre quadrature of the density over every cell, to well below the noise of the
    // counts. The density is per unit area of the rectangle.
    TestResult test(const std::function<double(Vec2d)>& pdf, double pool_below) const;

  private:
    Vec2d lower_, upper_;
    int nx_, ny_;
    std::vector<double> observed_;
    std::int64_t total_ = 0, failures_ = 0;
};

// Uniform numbers for tests, the same on every platform.
class TestUniforms {
  public:
    explicit TestUniforms(std::uint64_t seed) : engine_(seed) {}
    double next() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
    float next_float() { return static_cast<float>(engine_() >> 40) * 0x1p-24f; }
    Vec2d next_2d() {
        double x = next(), y = next();
        return {x, y};
    }
    Vec2f next_2f() {
        float x = next_float(), y = next_float();
        return {x, y};
    }

  private:
    std::mt19937_64 engine_;
};

namespace detail {

template <typename T>
std::optional<T> as_optional(const T& v) {
    return v;
}
template <typename T>
std::optional<T> as_optional(const std::optional<T>& v) {
    return v;
}
// Samplers of two dimensions take (Vec2f u, float uc), (Vec2f u) or (Vec2d u).
template <typename Sample>
auto draw_2d(const Sample& sample, TestUniforms& uniforms) {
    if constexpr (std::is_invocable_v<const Sample&, Vec2f, float>) {
        Vec2f u = uniforms.next_2f();
        float uc = uniforms.next_float();
        return as_optional(sample(u, uc));
    } else if constexpr (std::is_invocable_v<const Sample&, Vec2f>) {
        Vec2f u = uniforms.next_2f();
        return as_optional(sample(u));
    } else {
        Vec2d u = uniforms.next_2d();
        return as_optional(sample(u));
    }
}

} // namespace detail

// sample(double u) -> x, or an optional x; pdf(double x) per unit length.
template <typename Sample, typename Pdf>
TestResult interval_chi_squared_test(const Sample& sample, const Pdf& pdf, double lower, double upper,
                                     const ChiSquaredOptions& options = {}) {
    TestUniforms uniforms(options.seed);
    CellCounts counts({lower, 0}, {upper, 1}, options.cells_x, 1);
    for (int i = 0; i < options.samples; ++i) {
        auto x = detail::as_optional(sample(uniforms.next()));
        if (x)
            counts.add({static_cast<double>(*x), 0.5});
        else
            counts.add_failure();
    }
    return counts.test([&](Vec2d p) { return static_cast<double>(pdf(p.x)); }, options.pool_below);
}

// sample(u) -> Vec2, or an optional one; pdf(Vec2d) per unit area.
template <typename Sample, typename Pdf>
TestResult rectangle_chi_squared_test(const Sample& sample, const Pdf& pdf, Vec2d lower, Vec2d upper,
                                      const ChiSquaredOptions& options = {}) {
    TestUniforms uniforms(options.seed);
    CellCounts counts(lower, upper, options.cells_x, options.cells_y);
    for (int i = 0; i < options.samples; ++i) {
        auto p = detail::draw_2d(sample, uniforms);
        if (p)
            counts.add({static_cast<double>(p->x), static_cast<double>(p->y)});
        else
            counts.add_failure();
    }
    return counts.test([&](Vec2d p) { return static_cast<double>(pdf(p)); }, options.pool_below);
}

// sample(Vec2f u, float uc) or sample(u) -> unit Vec3, or an optional one; pdf(Vec3f w) per steradian. A
// density that integrates to less than 1 must fail as often as it lacks. Cells are equal in
// (cos(theta), phi) about +z. A test of a BSDF reads:
//   auto r = spherical_chi_squared_test([&](Vec2f u, float uc) { return sample_direction(wo, u, uc); },
//                                       [&](Vec3f wi) { return pdf(wo, wi); });
//   EXPECT_TRUE(r.passes(1e-6)) << r.description;
template <typename Sample, typename Pdf>
TestResult spherical_chi_squared_test(const Sample& sample, const Pdf& pdf,
                                      const ChiSquaredOptions& options = {}) {
    TestUniforms uniforms(options.seed);
    CellCounts counts({options.cos_theta_min, 0}, {options.cos_theta_max, 2 * pi}, options.cells_x,
                      options.cells_y);
    for (int i = 0; i < options.samples; ++i) {
        auto w = detail::draw_2d(sample, uniforms);
        if (!w) {
            counts.add_failure();
            continue;
        }
        double phi = std::atan2(static_cast<double>(w->y), static_cast<double>(w->x));
        counts.add({std::clamp(static_cast<double>(w->z), -1.0, 1.0), phi < 0 ? phi + 2 * pi : phi});
    }
    return counts.test(
        [&](Vec2d p) {
            double r = std::sqrt(std::max(0.0, (1 - p.x) * (1 + p.x)));
            Vec3f w(static_cast<float>(r * std::cos(p.y)), static_cast<float>(r * std::sin(p.y)),
                    static_cast<float>(p.x));
            return static_cast<double>(pdf(w));
        },
        options.pool_below);
}

} // namespace montelux
