// A spectrum as one value for each nanometre of the visible range.
#pragma once

#include <array>
#include <concepts>

#include "montelux/spectrum/wavelengths.h"

namespace montelux {

// Index of the 1 nm sample nearest to each wavelength, clamped to the visible range.
inline Int4 nearest_samples(Float4 lambda) {
    Float4 position = min(max(lambda - (lambda_min - 0.5f), Float4{}), broadcast(visible_samples - 1));
    return __builtin_convertvector(position, Int4);
}

// The value at a wavelength is that of the nearest sample.
class SpectrumTable {
  public:
    SpectrumTable() = default;
    // Samples f(lambda) at 360, 361, ... 830 nm.
    template <typename F>
    requires std::invocable<F, float>
    static SpectrumTable from(F&& f) {
        SpectrumTable t;
        for (int i = 0; i < visible_samples; ++i) t.values_[i] = f(lambda_min + static_cast<float>(i));
        return t;
    }

    SampledSpectrum sample(const SampledWavelengths& w) const {
        Int4 i = nearest_samples(w.lambda);
        return {values_[i[0]], values_[i[1]], values_[i[2]], values_[i[3]]};
    }
    // 0 outside the visible range.
    float operator()(float lambda) const {
        float position = lambda - (lambda_min - 0.5f);
        if (!(position >= 0 && position < static_cast<float>(visible_samples))) return 0;
        return values_[static_cast<int>(position)];
    }
    float max_value() const { return *std::max_element(values_.begin(), values_.end()); }
    const std::array<float, visible_samples>& values() const { return values_; }
    void scale(float factor) {
        for (float& v : values_) v *= factor;
    }

  private:
    std::array<float, visible_samples> values_{};
};

} // namespace montelux
