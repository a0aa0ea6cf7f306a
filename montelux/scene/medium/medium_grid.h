// Grids of values in the unit cube, interpolated trilinearly.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "montelux/mc/math/vec.h"
#include "montelux/spectrum/rgb_spectra.h"

namespace montelux {

// What lies beyond the unit cube of a grid: the samples of its border, the grid again, or its mirror image.
enum class GridWrap : std::uint8_t { clamp, repeat, mirror };

// Index of the sample that sample i of a row stands for, where the row has n. Far away or NaN it is any of them.
inline std::size_t wrapped(float i, float n, GridWrap wrap) {
    if (wrap == GridWrap::repeat) i -= n * std::floor(i / n);
    if (wrap == GridWrap::mirror) {
        i -= 2 * n * std::floor(i / (2 * n));
        if (i >= n) i = 2 * n - 1 - i;
    }
    return static_cast<std::size_t>(std::min(std::max(0.0f, i), n - 1));
}

// Sample (x, y, z) is values[(z ny + y) nx + x] and lies at ((x + 1/2) / nx, (y + 1/2) / ny, (z + 1/2) / nz).
// Outside the samples the value is 0, as in pbrt-v4: it falls to half at the faces of the cube.
template <typename T>
struct Grid3 {
    std::array<int, 3> size{0, 0, 0};
    std::vector<T> values;

    std::size_t count() const { return std::size_t(size[0]) * std::size_t(size[1]) * std::size_t(size[2]); }

    // The sum of weight * value(sample) over the samples around p. `value` gives what T converts to, V.
    template <typename V, typename Value>
    V interpolate(Point3f p, const Value& value) const {
        std::array<int, 3> cell{};
        std::array<float, 3> fraction{};
        for (int a = 0; a < 3; ++a) {
            const auto n = static_cast<float>(size[static_cast<std::size_t>(a)]);
            // Far outside is as good as just outside; NaN as well.
            const float x = std::min(std::max(p[a] * n - 0.5f, -2.0f), n + 1);
            const float floor = std::floor(x);
            cell[static_cast<std::size_t>(a)] = static_cast<int>(floor);
            fraction[static_cast<std::size_t>(a)] = x - floor;
        }
        V sum{};
        for (int z = 0; z < 2; ++z) {
            const int k = cell[2] + z;
            if (k < 0 || k >= size[2]) continue;
            for (int y = 0; y < 2; ++y) {
                const int j = cell[1] + y;
                if (j < 0 || j >= size[1]) continue;
                const float weight =
                    (z == 0 ? 1 - fraction[2] : fraction[2]) * (y == 0 ? 1 - fraction[1] : fraction[1]);
                const std::size_t row =
                    (std::size_t(k) * std::size_t(size[1]) + std::size_t(j)) * std::size_t(size[0]);
                for (int x = 0; x < 2; ++x) {
                    const int i = cell[0] + x;
                    if (i < 0 || i >= size[0]) continue;
                    sum += value(values[row + std::size_t(i)]) *
                           (weight * (x == 0 ? 1 - fraction[0] : fraction[0]));
                }
            }
        }
        return sum;
    }

    // Interpolates where samples go on beyond the cube.
    template <typename V, typename Value>
    V interpolate_wrapped(Point3f p, GridWrap wrap, const Value& value) const {
        std::array<std::array<std::size_t, 2>, 3> at{};
        std::array<float, 3> fraction{};
        for (std::size_t a = 0; a < 3; ++a) {
            const auto n = static_cast<float>(size[a]);
            float x = p[static_cast<int>(a)] * n - 0.5f;
            if (wrap == GridWrap::clamp) x = std::min(std::max(x, 0.0f), n - 1);
            const float floor = std::floor(x);
            at[a] = {wrapped(floor, n, wrap), wrapped(floor + 1, n, wrap)};
            fraction[a] = x - floor;
        }
        V sum{};
        for (std::size_t z = 0; z < 2; ++z)
            for (std::size_t y = 0; y < 2; ++y)
                for (std::size_t x = 0; x < 2; ++x) {
                    const auto share = [&](std::size_t a, std::size_t upper) {
                        return upper == 0 ? 1 - fraction[a] : fraction[a];
                    };
                    sum += value(values[(at[2][z] * std::size_t(size[1]) + at[1][y]) * std::size_t(size[0]) +
                                        at[0][x]]) *
                           (share(0, x) * share(1, y) * share(2, z));
                }
        return sum;
    }

    // The sample in whose cell p lies.
    const T& nearest(Point3f p, GridWrap wrap) const {
        std::array<std::size_t, 3> at{};
        for (std::size_t a = 0; a < 3; ++a) {
            const auto n = static_cast<float>(size[a]);
            at[a] = wrapped(std::floor(p[static_cast<int>(a)] * n), n, wrap);
        }
        return values[(at[2] * std::size_t(size[1]) + at[1]) * std::size_t(size[0]) + at[0]];
    }

    // The largest of bound(sample) over the samples that these functions may take for points of a box.
    template <typename Bound>
    float largest(Point3f lower, Point3f upper, const Bound& bound, GridWrap wrap = GridWrap::clamp) const {
        std::array<int, 3> first{}, last{};
        for (int a = 0; a < 3; ++a) {
            const auto at = static_cast<std::size_t>(a);
            const auto n = static_cast<float>(size[at]);
            // Points may lie outside the box by rounding.
            constexpr float margin = 1e-3f;
            const auto sample = [&](float x) {
                return static_cast<int>(std::min(std::max(std::floor(x), -1.0f), n - 1));
            };
            first[at] = std::max(sample(lower[a] * n - 0.5f - margin), 0);
            last[at] = std::min(sample(upper[a] * n - 0.5f + margin) + 1, size[at] - 1);
            const bool beyond = lower[a] * n < 0.5f + margin || upper[a] * n > n - 0.5f - margin;
            if (wrap != GridWrap::clamp && beyond) { // anything may stand there
                first[at] = 0;
                last[at] = size[at] - 1;
            }
        }
        float result = 0;
        for (int z = first[2]; z <= last[2]; ++z)
            for (int y = first[1]; y <= last[1]; ++y)
                for (int x = first[0]; x <= last[0]; ++x)
                    result = std::max(result,
                                      bound(values[(std::size_t(z) * std::size_t(size[1]) + std::size_t(y)) *
                                                       std::size_t(size[0]) +
                                                   std::size_t(x)]));
        return result;
    }
};

// Densities, temperatures.
struct ScalarGrid : Grid3<float> {
    float operator()(Point3f p) const {
        return interpolate<float>(p, [](float v) { return v; });
    }
};
// Coefficients and, times an illuminant, emission.
struct ColorGrid : Grid3<ScaledPolynomial> {
    // What the samples were made from, for files that are written; without effect on pictures.
    std::vector<Vec3f> colors{};
    const RgbColorSpace* space = nullptr;

    SampledSpectrum operator()(Point3f p, const SampledWavelengths& lambda) const {
        return interpolate<SampledSpectrum>(p, [&](const ScaledPolynomial& s) { return s.sample(lambda); });
    }
};

} // namespace montelux
