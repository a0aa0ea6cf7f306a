// Buckets of wavelengths in each pixel of a spectral film: mean radiance, with standard errors.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <string>

#include "montelux/scene/film/film_settings.h"
#include "montelux/spectrum/cie.h"
#include "montelux/spectrum/sampled_spectrum.h"

namespace montelux {

// Equal intervals from lambda_min to lambda_max.
class BucketLayout {
  public:
    explicit BucketLayout(const SpectralSettings& s)
        : begin_(s.lambda_min), width_((s.lambda_max - s.lambda_min) / static_cast<float>(s.buckets)),
          count_(s.buckets) {}

    int count() const { return count_; }
    float width() const { return width_; } // nm
    float center(int i) const { return begin_ + (static_cast<float>(i) + 0.5f) * width_; }
    // -1 outside.
    int of(float lambda) const {
        const float place = (lambda - begin_) / width_;
        // The upper end of the range belongs to the last one.
        if (!(place >= 0 && place <= static_cast<float>(count_))) return -1;
        return std::min(static_cast<int>(place), count_ - 1);
    }

  private:
    float begin_, width_;
    int count_;
};

// What a sample adds to the buckets of its wavelengths.
struct SpectralSample {
    std::array<std::int16_t, 4> bucket{-1, -1, -1, -1};
    std::array<float, 4> value{};
};

// Unbiased for the mean of radiance over each bucket, times cie_y_integral: lights have units of luminance
// (to_photometric), so that white light of luminance 1 has values around 1. `factor`: filter weight, clamp, camera.
inline SpectralSample spectral_sample(const BucketLayout& layout, SampledSpectrum radiance,
                                      const SampledWavelengths& w, float factor) {
    SpectralSample s;
    const SampledSpectrum weighted = safe_div(radiance, w.pdf);
    const float scale = factor * static_cast<float>(cie_y_integral) / (4 * layout.width());
    for (int i = 0; i < 4; ++i) {
        s.bucket[static_cast<std::size_t>(i)] = static_cast<std::int16_t>(layout.of(w.lambda[i]));
        s.value[static_cast<std::size_t>(i)] = weighted[i] * scale;
    }
    return s;
}

// Moments over the replicates of the pixel (Welford 1962), whose number is the pixel's.
struct BucketMoments {
    double open = 0; // sum over the samples of the open replicate
    double mean = 0, m2 = 0;

    // `count`: replicates including this one, of `samples`.
    void end_replicate(std::uint32_t samples, std::uint64_t count) {
        const double value = open / samples, delta = value - mean;
        mean += delta / static_cast<double>(count);
        m2 += delta * (value - mean);
        open = 0;
    }
    // Infinite below two replicates.
    double standard_error(std::uint64_t count) const {
        if (count < 2) return std::numeric_limits<double>::infinity();
        const auto n = static_cast<double>(count);
        return std::sqrt(m2 / ((n - 1) * n));
    }
};

inline void add_sample(std::span<BucketMoments> buckets, const SpectralSample& s) {
    for (std::size_t i = 0; i < 4; ++i)
        if (s.bucket[i] >= 0)
            buckets[static_cast<std::size_t>(s.bucket[i])].open += static_cast<double>(s.value[i]);
}

// Names of the layers after Fichet, Pacanowski, Wilkie 2021, "An OpenEXR Layout for Spectral Images": S0.550,000nm,
// with a comma as decimal point.
std::string spectral_layer(float lambda);

class Film;
class Image;
// Adds, for each bucket of a spectral film, its mean S0.<centre>nm and its error stderr.S0.<centre>nm, and the
// attributes of the layout.
void append_spectral_layers(Image& image, const Film& film);

} // namespace montelux
