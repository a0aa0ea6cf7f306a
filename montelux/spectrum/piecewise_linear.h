// Spectra given by values at chosen wavelengths, joined by straight lines.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "montelux/spectrum/wavelengths.h"

namespace montelux {

// What a spectrum is beyond its first and last wavelength.
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
        if (!(lambda >= knots_.front().lambda && lambda <= knots_.back().lambda)) return 0;
        int cell = std::clamp(static_cast<int>(lambda - lambda_min), 0, cell_count - 1);
        return lookup(lambda, first_in_cell_[cell]);
    }
    SampledSpectrum sample(const SampledWavelengths& w) const {
        return {(*this)(w.lambda[0]), (*this)(w.lambda[1]), (*this)(w.lambda[2]), (*this)(w.lambda[3])};
    }
    // Largest value within the visible range.
    float max_value() const;
    // Multiplies every value.
    void scale(float factor);
    // First and last wavelength with a value (nm).
    float first_lambda() const { return knots_.front().lambda; }
    float last_lambda() const { return knots_.back().lambda; }

  private:
    struct Knot {
        float lambda, value, slope; // the slope up to the next knot
    };
    // Cells of 1 nm from 360 nm on; for each, the last knot at or before its start (or knot 0).
    static constexpr int cell_count = visible_samples;

    float lookup(float lambda, std::uint32_t k) const {
        // Outside the visible range the search starts at an end of it.
        while (k > 0 && knots_[k].lambda > lambda) --k;
        while (k + 1 < knots_.size() && knots_[k + 1].lambda <= lambda) ++k;
        return knots_[k].value + (lambda - knots_[k].lambda) * knots_[k].slope;
    }

    std::vector<Knot> knots_;
    std::array<std::uint32_t, cell_count> first_in_cell_{};
};

} // namespace montelux
