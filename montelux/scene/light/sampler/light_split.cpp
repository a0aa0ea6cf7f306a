#include "montelux/scene/light/sampler/light_split.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "montelux/mc/math/constants.h"

namespace montelux {

namespace {

constexpr int bin_count = 12;

// Sums over lights that can be joined without trigonometry.
struct Bin {
    SplitBox box;
    float intensity = 0;
    Vec3f direction; // sum of intensity * axis, for lights that shine from one side of a plane
    Index count = 0;

    void add(const SplitLight& light, Vec3f reference_axis) {
        box.add(light.lower, light.upper);
        intensity += light.intensity;
        ++count;
        // A light around the full sphere has no direction, and one of two sides has either.
        if (light.cone.cos_theta_o <= -1) return;
        const bool turned = light.cone.two_sided && dot(light.cone.axis, reference_axis) < 0;
        direction += (turned ? -light.intensity : light.intensity) * light.cone.axis;
    }
    void add(const Bin& other) {
        box.add(other.box.lower, other.box.upper);
        intensity += other.intensity;
        direction += other.direction;
        count += other.count;
    }

    // Directions that fill a cone of half angle theta uniformly have a mean of length (1 + cos(theta)) / 2; its
    // measure is that of LightCone for theta_e = pi / 2, beyond theta = pi / 2 by a straight line.
    double cost() const {
        if (count == 0) return 0;
        const double mean = std::min(double(length(direction)) / double(intensity), 1.0);
        const double c = 2 * mean - 1, s = std::sqrt(1 - c * c);
        constexpr double half = 2 * pi + 0.5 * pi * pi;
        const double measure = c > 0 ? 2 * pi - pi * c + 0.5 * pi * pi * s : half + c * (half - 4 * pi);
        return double(intensity) * double(length_squared(box.upper - box.lower)) * measure;
    }
};

struct Plane {
    double cost = std::numeric_limits<double>::infinity();
    int axis = 0, bin = 0; // the first of the second part
    double first_cost = 0, second_cost = 0;
};

// Bins of one axis by the centres of boxes.
struct Binning {
    int axis;
    float lower, scale;

    int bin_of(const SplitLight& light) const {
        return std::clamp(static_cast<int>((light.center()[axis] - lower) * scale), 0, bin_count - 1);
    }
};

Binning binning(const SplitBox& centers, int axis) {
    return {axis, centers.lower[axis], bin_count / (centers.upper[axis] - centers.lower[axis])};
}

void try_axis(std::span<const SplitLight> lights, const Binning& binning, Vec3f reference_axis, Plane& best) {
    std::array<Bin, bin_count> bins;
    for (const SplitLight& light : lights)
        bins[static_cast<std::size_t>(binning.bin_of(light))].add(light, reference_axis);
    std::array<double, bin_count> after; // cost of this bin and those behind it
    Bin sum;
    for (std::size_t b = bin_count; b-- > 1;) {
        sum.add(bins[b]);
        after[b] = sum.cost();
    }
    sum = {};
    for (std::size_t b = 1; b < bin_count; ++b) {
        sum.add(bins[b - 1]);
        if (sum.count == 0 || sum.count == lights.size()) continue;
        const double before = sum.cost(), cost = before + after[b];
        if (cost < best.cost) best = {cost, binning.axis, static_cast<int>(b), before, after[b]};
    }
}

double cost_of(std::span<const SplitLight> lights, Vec3f reference_axis) {
    Bin all;
    for (const SplitLight& light : lights) all.add(light, reference_axis);
    return all.cost();
}

} // namespace

LightSplit split_lights(std::span<SplitLight> lights, bool halve) {
    SplitBox centers;
    for (const SplitLight& light : lights) centers.add(light.center(), light.center());
    const Vec3f extent = centers.upper - centers.lower, reference_axis = lights[0].cone.axis;
    Plane best;
    if (!halve)
        for (int axis = 0; axis < 3; ++axis)
            if (extent[axis] > 0 && std::isfinite(bin_count / extent[axis]))
                try_axis(lights, binning(centers, axis), reference_axis, best);
    if (best.bin > 0) {
        const Binning by = binning(centers, best.axis);
        const auto middle = std::partition(lights.begin(), lights.end(), [&](const SplitLight& light) {
            return by.bin_of(light) < best.bin;
        });
        return {static_cast<Index>(middle - lights.begin()), best.first_cost, best.second_cost};
    }
    // Many lights at one place, or a tree that grows too deep.
    const int axis = extent.x >= std::max(extent.y, extent.z) ? 0 : extent.y >= extent.z ? 1 : 2;
    const std::size_t half = lights.size() / 2;
    std::nth_element(
        lights.begin(), lights.begin() + static_cast<std::ptrdiff_t>(half), lights.end(),
        [&](const SplitLight& a, const SplitLight& b) { return a.center()[axis] < b.center()[axis]; });
    return {static_cast<Index>(half), cost_of(lights.first(half), reference_axis),
            cost_of(lights.subspan(half), reference_axis)};
}

} // namespace montelux
