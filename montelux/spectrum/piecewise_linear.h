// Spectra given by values at chosen wavelengths, joined by straight lines.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "montelux/spectrum/wavelengths.h"

namespace montelux {

// Value of a spectrum beyond its first and last wavelength.
enum class SpectrumEnds { zero, constant };

// A lookup takes the same time for any number of knots.
class PiecewiseLinear {
  public:
    // `lambda` (nm) must be finite and strictly ascending, `values` finite and as many, at least one; throws
    // Error otherwise. A single knot is 0 everywhere else with SpectrumEnds::zero.
    PiecewiseLinear(std::span<const float> lambda, std::span<const float> values,
                    SpectrumEnds ends = SpectrumEnds::zero);
    // Pairs of wavelength and value.
    static PiecewiseLinear from_pairs(std::span<const float> pairs, SpectrumEnds ends = SpectrumEnds::zero);

    float operator()(float lambda) const {
        std::uint32_t k = first_in_cell_[visible_cell(lambda)];
        while (knots_[k].lambda > lambda) --k;
        return value_after(k, lambda);
    }
    SampledSpectrum sample(const SampledWavelengths& w) const {
        auto at = [&](float lambda) { return value_after(first_in_cell_[visible_cell(lambda)], lambda); };
        return {at(w.lambda[0]), at(w.lambda[1]), at(w.lambda[2]), at(w.lambda[3])};
    }
    // Largest value within the visible range.
    float max_value() const;
    // Multiplies every value.
    void scale(float factor);

    struct Knot {
        float lambda, value, slope; // the slope up to the next knot
    };
    // Ascending, with those before and behind the given ones.
    std::span<const Knot> knots() const { return knots_; }

  private:
    static constexpr int cell_count = visible_samples;
    // Cells of 1 nm from 360 nm on; wavelengths outside the visible range belong to the nearest, NaN to the
    // first.
    static int visible_cell(float lambda) {
        return static_cast<int>(std::min(std::max(0.0f, lambda - lambda_min), cell_count - 1.0f));
    }
    // `k` is a knot at or before lambda; returns the last such knot.
    float value_after(std::uint32_t k, float lambda) const {
        while (knots_[k + 1].lambda <= lambda) ++k;
        return knots_[k].value + (lambda - knots_[k].lambda) * knots_[k].slope;
    }

    // A knot of value 0 precedes the given ones; one of value 0 and one at infinity follow, so that a search
    // needs no bounds.
    std::vector<Knot> knots_;
    // For each cell, the last knot at or before its start.
    std::array<std::uint32_t, cell_count> first_in_cell_{};
};

} // namespace montelux
