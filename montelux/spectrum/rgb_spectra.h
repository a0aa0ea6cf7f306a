// Spectra made from RGB colours: reflectances, unbounded values and lights.
#pragma once

#include "montelux/spectrum/rgb_uplift.h"

namespace montelux {

// What a spectrum was made from; no space: not from a colour.
struct RgbColor {
    const RgbColorSpace* space = nullptr;
    Vec3f rgb{};
};

// A reflectance: values in [0, 1]. Colours are clamped to [0, 1].
class RgbAlbedoSpectrum {
  public:
    RgbAlbedoSpectrum() : RgbAlbedoSpectrum(SigmoidPolynomial::constant(0)) {}
    explicit RgbAlbedoSpectrum(SigmoidPolynomial polynomial) : polynomial_(polynomial) {}
    RgbAlbedoSpectrum(const RgbColorSpace& space, Vec3f rgb)
        : polynomial_(rgb_uplift_table(space)(rgb)), color_{&space, rgb} {}

    SampledSpectrum sample(const SampledWavelengths& w) const { return polynomial_.sample(w); }
    float operator()(float lambda) const { return polynomial_(lambda); }
    float max_value() const { return polynomial_.max_value(); }
    const SigmoidPolynomial& polynomial() const { return polynomial_; }
    const RgbColor& color() const { return color_; }

  private:
    SigmoidPolynomial polynomial_;
    RgbColor color_{};
};

// A reflectance times a factor.
class ScaledPolynomial {
  public:
    ScaledPolynomial() = default;
    ScaledPolynomial(float scale, const SigmoidPolynomial& polynomial)
        : scale_(scale), polynomial_(polynomial) {}

    SampledSpectrum sample(const SampledWavelengths& w) const { return scale_ * polynomial_.sample(w); }
    float operator()(float lambda) const { return scale_ * polynomial_(lambda); }
    float max_value() const { return scale_ * polynomial_.max_value(); }
    float scale() const { return scale_; }
    const SigmoidPolynomial& polynomial() const { return polynomial_; }

  private:
    float scale_ = 0;
    SigmoidPolynomial polynomial_;
};

// Any non-negative colour: a reflectance of largest component 1/2, scaled by twice the largest component.
class RgbUnboundedSpectrum : public ScaledPolynomial {
  public:
    RgbUnboundedSpectrum() = default;
    // Negative components count as 0.
    RgbUnboundedSpectrum(const RgbColorSpace& space, Vec3f rgb)
        : RgbUnboundedSpectrum(space, rgb, 2 * std::max(max_component(rgb), 0.0f)) {}

    const RgbColor& color() const { return color_; }

  private:
    RgbUnboundedSpectrum(const RgbColorSpace& space, Vec3f rgb, float scale)
        : ScaledPolynomial(scale, rgb_uplift_table(space)(scale > 0 ? rgb / scale : Vec3f())), color_{&space,
                                                                                                      rgb} {}

    RgbColor color_{};
};

// A light of this colour: an unbounded spectrum times the colour space's illuminant.
class RgbIlluminantSpectrum {
  public:
    // `space` must outlive the spectrum.
    RgbIlluminantSpectrum(const RgbColorSpace& space, Vec3f rgb)
        : filter_(space, rgb), illuminant_(&space.illuminant()) {}

    SampledSpectrum sample(const SampledWavelengths& w) const {
        return filter_.sample(w) * illuminant_->sample(w);
    }
    float operator()(float lambda) const { return filter_(lambda) * (*illuminant_)(lambda); }
    // A close upper bound.
    float max_value() const { return filter_.max_value() * illuminant_->max_value(); }
    const RgbUnboundedSpectrum& filter() const { return filter_; }
    const SpectrumTable& illuminant() const { return *illuminant_; }

  private:
    RgbUnboundedSpectrum filter_;
    const SpectrumTable* illuminant_;
};

} // namespace montelux
