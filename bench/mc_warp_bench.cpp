// Cost per sample of warps, tabulated densities, weights and moments.
#include <array>
#include <benchmark/benchmark.h>
#include <cmath>
#include <cstdint>
#include <vector>

#include "montelux/mc/dist/alias_table.h"
#include "montelux/mc/dist/discrete.h"
#include "montelux/mc/dist/families.h"
#include "montelux/mc/dist/inversion.h"
#include "montelux/mc/dist/piecewise_1d.h"
#include "montelux/mc/dist/piecewise_2d.h"
#include "montelux/mc/integrate/integrate.h"
#include "montelux/mc/integrate/mis.h"
#include "montelux/mc/integrate/techniques/importance.h"
#include "montelux/mc/random/philox_stream.h"
#include "montelux/mc/stats/moments.h"
#include "montelux/mc/warp/equal_area_square.h"
#include "montelux/mc/warp/hemisphere.h"
#include "montelux/mc/warp/sphere.h"
#include "montelux/mc/warp/spherical_rectangle.h"
#include "montelux/mc/warp/spherical_triangle.h"
#include "montelux/mc/warp/triangle.h"

namespace montelux {
namespace {

// Uniform numbers made beforehand, so that the generator is not what is timed.
const std::vector<Vec2f>& uniforms() {
    static const std::vector<Vec2f> numbers = [] {
        PhiloxStream stream(1);
        std::vector<Vec2f> u(4096);
        for (Vec2f& v : u) v = stream.next_2d();
        return u;
    }();
    return numbers;
}

template <typename Body>
void for_each_uniform(benchmark::State& state, Body body) {
    const auto& u = uniforms();
    std::size_t i = 0;
    for (auto _ : state) {
        auto result = body(u[i++ & 4095]);
        benchmark::DoNotOptimize(result);
    }
    state.SetItemsProcessed(state.iterations());
}

#define MONTELUX_BENCH_WARP(name, expression)                                                                \
    void name(benchmark::State& state) {                                                                     \
        for_each_uniform(state, [](Vec2f u) { return expression; });                                         \
    }                                                                                                        \
    BENCHMARK(name)

MONTELUX_BENCH_WARP(disk_polar, sample_uniform_disk_polar(u));
MONTELUX_BENCH_WARP(disk_concentric, sample_uniform_disk_concentric(u));
MONTELUX_BENCH_WARP(sphere, sample_uniform_sphere(u));
MONTELUX_BENCH_WARP(cosine_hemisphere, sample_cosine_hemisphere(u));
MONTELUX_BENCH_WARP(triangle_square_root, sample_uniform_triangle(u));
MONTELUX_BENCH_WARP(triangle_low_distortion, sample_uniform_triangle_low_distortion(u));
MONTELUX_BENCH_WARP(equal_area_to_sphere, equal_area_square_to_sphere(u));
MONTELUX_BENCH_WARP(equal_area_round_trip, equal_area_sphere_to_square(equal_area_square_to_sphere(u)));
MONTELUX_BENCH_WARP(power_heuristic_of_two, power_heuristic(1, u.x, 1, u.y));

void spherical_triangle(benchmark::State& state) {
    auto t = SphericalTriangle::from_directions({1, 0, 0}, {0, 1, 0}, {0, 0.2, 1}).value();
    for_each_uniform(state, [&](Vec2f u) { return t.sample(u); });
}
BENCHMARK(spherical_triangle);

void spherical_triangle_with_setup(benchmark::State& state) {
    for_each_uniform(state, [&](Vec2f u) {
        auto t = SphericalTriangle::from_directions({1, static_cast<double>(u.x), 0}, {0, 1, 0}, {0, 0.2, 1});
        return t->sample(u);
    });
}
BENCHMARK(spherical_triangle_with_setup);

void spherical_rectangle_with_setup(benchmark::State& state) {
    for_each_uniform(state, [&](Vec2f u) {
        auto r = SphericalRectangle::from_corner({static_cast<double>(u.x), 0, 0}, {-1, -1, 1}, {2, 0, 0},
                                                 {0, 2, 0});
        return r->sample(u);
    });
}
BENCHMARK(spherical_rectangle_with_setup);

std::vector<double> skewed_weights(std::size_t n) {
    std::vector<double> w(n);
    PhiloxStream stream(2);
    for (double& v : w) v = std::pow(stream.next_double(), 8);
    return w;
}

void discrete_bisection(benchmark::State& state) {
    DiscreteDistribution d(skewed_weights(static_cast<std::size_t>(state.range(0))));
    for_each_uniform(state, [&](Vec2f u) { return d.sample(u.x); });
}
BENCHMARK(discrete_bisection)->Range(8, 1 << 15);

void discrete_walk(benchmark::State& state) {
    DiscreteDistribution d(skewed_weights(static_cast<std::size_t>(state.range(0))));
    for_each_uniform(state, [&](Vec2f u) { return d.sample_by_walking(u.x); });
}
BENCHMARK(discrete_walk)->Range(8, 512);

void discrete_alias(benchmark::State& state) {
    auto w = skewed_weights(static_cast<std::size_t>(state.range(0)));
    AliasTable d{std::span<const double>(w)};
    for_each_uniform(state, [&](Vec2f u) { return d.sample(u.x); });
}
BENCHMARK(discrete_alias)->Range(8, 1 << 15);

void environment_map(benchmark::State& state) {
    auto n = static_cast<std::uint32_t>(state.range(0));
    auto w = skewed_weights(std::size_t{n} * n);
    PiecewiseConstant2D d(std::span<const double>(w), n, n);
    for_each_uniform(state, [&](Vec2f u) { return d.sample(u); });
}
BENCHMARK(environment_map)->RangeMultiplier(4)->Range(64, 4096);

void environment_map_pdf(benchmark::State& state) {
    auto n = static_cast<std::uint32_t>(state.range(0));
    auto w = skewed_weights(std::size_t{n} * n);
    PiecewiseConstant2D d(std::span<const double>(w), n, n);
    for_each_uniform(state, [&](Vec2f u) { return d.pdf(u); });
}
BENCHMARK(environment_map_pdf)->RangeMultiplier(4)->Range(64, 4096);

void numerical_inversion(benchmark::State& state) {
    NumericalInversion d([](double x) { return std::exp(-x * x); }, -3, 3);
    for_each_uniform(state, [&](Vec2f u) { return d.quantile(static_cast<double>(u.x)); });
}
BENCHMARK(numerical_inversion);

void moments_of_a_pixel(benchmark::State& state) {
    Moments3 m;
    for_each_uniform(state, [&](Vec2f u) {
        m.add(Vec3f{u.x, u.y, u.x});
        return m.mean(1);
    });
}
BENCHMARK(moments_of_a_pixel);

void importance_sampled_integral(benchmark::State& state) {
    for (auto _ : state) {
        IntegrationResult r =
            integrate([](double x) { return std::sin(x); }, Domain::interval(0, pi / 2),
                      Importance{LinearDistribution(0, pi / 2), ImportancePoints::random, false},
                      {.evaluations = 1 << 16});
        benchmark::DoNotOptimize(r);
    }
    state.SetItemsProcessed(state.iterations() * (1 << 16));
}
BENCHMARK(importance_sampled_integral)->UseRealTime();

} // namespace
} // namespace montelux
