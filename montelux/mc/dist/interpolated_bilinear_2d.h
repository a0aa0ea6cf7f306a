// Tabulated densities on the unit square, bilinear between knots, interpolated in two parameters.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "montelux/mc/math/vec.h"
#include "montelux/mc/math/vector_bytes.h"

namespace montelux {

// The values between which an interpolation in two parameters takes the mean: 1, 2 or 4 entries of a table.
struct InterpolationWeights {
    std::array<std::size_t, 4> entry{};
    std::array<float, 4> weight{};
    std::size_t count = 0;
};
// Bilinear between the knots (first[i], second[j]), whose entry is i * second.size() + j; constant outside. Knots
// increase, and there is at least one of each.
InterpolationWeights interpolation_weights(const std::vector<float>& first, const std::vector<float>& second,
                                           float at_first, float at_second);

// One density for each entry of such a table, on columns x rows equidistant knots of the unit square. The density of
// an InterpolationWeights is the weighted mean of the entries' densities, each of which integrates to 1. Equal to what
// Dupuy and Jakob 2018, "An Adaptive Parameterization for Efficient Material Acquisition and Rendering", call a warp:
// u.y picks the place between the rows by the marginal density, u.x the one along them.
class InterpolatedBilinear2D {
  public:
    // values[(entry * rows + row) * columns + column]. An entry of zeros becomes the uniform density. Throws Error
    // when their number does not fit, rows or columns are fewer than 2, or a value is negative or not finite.
    InterpolatedBilinear2D(std::size_t entries, std::uint32_t columns, std::uint32_t rows,
                           std::vector<float> values);

    struct Sample {
        Vec2f p; // the sampled point; of invert(): the u that gives it
        float pdf = 0;
    };
    Sample sample(const InterpolationWeights& at, Vec2f u) const;
    Sample invert(const InterpolationWeights& at, Vec2f p) const;
    float pdf(const InterpolationWeights& at, Vec2f p) const;

    // Memory of the tables.
    std::size_t bytes() const { return vector_bytes(values_, row_cdf_, marginal_); }

  private:
    struct Cell {
        std::uint32_t index;
        float fraction;
    };
    // Fills the tables of integrals of an entry; returns that over the square.
    double integrate(std::size_t entry);
    // Of a coordinate in [0, 1], between n knots.
    static Cell cell(float x, std::uint32_t n);

    // The weighted mean of a table's values at a place; `stride` is their number for each entry.
    static float mean(const std::vector<float>& table, const InterpolationWeights& at, std::size_t stride,
                      std::size_t place) {
        float sum = 0;
        for (std::size_t k = 0; k < at.count; ++k) sum += at.weight[k] * table[at.entry[k] * stride + place];
        return sum;
    }
    // At column i, between row j and the next.
    float along(const std::vector<float>& table, const InterpolationWeights& at, std::uint32_t i,
                std::uint32_t j, float y) const {
        const std::size_t stride = std::size_t{columns_} * rows_, place = std::size_t{j} * columns_ + i;
        return (1 - y) * mean(table, at, stride, place) + y * mean(table, at, stride, place + columns_);
    }

    std::uint32_t columns_, rows_;
    std::vector<float> values_;   // the densities
    std::vector<float> row_cdf_;  // the integral over x from 0 to a knot, in each row of knots
    std::vector<float> marginal_; // the integral over y from 0 to a row of knots
};

} // namespace montelux
