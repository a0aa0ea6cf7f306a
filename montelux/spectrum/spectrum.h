// A spectrum of any kind, as a value, for materials, lights and media.
#pragma once

#include <memory>
#include <variant>

#include "montelux/spectrum/blackbody.h"
#include "montelux/spectrum/cie.h"
#include "montelux/spectrum/piecewise_linear.h"
#include "montelux/spectrum/rgb_spectra.h"
#include "montelux/spectrum/spectrum_table.h"

namespace montelux {

struct ConstantSpectrum {
    float value = 0;

    SampledSpectrum sample(const SampledWavelengths&) const { return SampledSpectrum(value); }
    float operator()(float) const { return value; }
    float max_value() const { return value; }
};

// Data that many spectra may share; copies refer to the same data.
template <typename Data>
class SharedSpectrum {
  public:
    explicit SharedSpectrum(Data data) : data_(std::make_shared<const Data>(std::move(data))) {}

    SampledSpectrum sample(const SampledWavelengths& w) const { return data_->sample(w); }
    float operator()(float lambda) const { return (*data_)(lambda); }
    float max_value() const { return data_->max_value(); }
    const Data& data() const { return *data_; }

  private:
    std::shared_ptr<const Data> data_;
};
using TabulatedSpectrum = SharedSpectrum<SpectrumTable>;
using PiecewiseLinearSpectrum = SharedSpectrum<PiecewiseLinear>;

// Evaluating a spectrum allocates nothing. Copying one may touch a shared reference count, so samples should
// refer to spectra and not copy them.
class Spectrum {
  public:
    using Variant =
        std::variant<ConstantSpectrum, TabulatedSpectrum, PiecewiseLinearSpectrum, BlackbodySpectrum,
                     RgbAlbedoSpectrum, RgbUnboundedSpectrum, RgbIlluminantSpectrum>;

    // Black.
    Spectrum() = default;
    template <typename T>
    requires std::constructible_from<Variant, T> Spectrum(T kind) : kind_(std::move(kind)) {}
    explicit Spectrum(float value) : kind_(ConstantSpectrum{value}) {}
    explicit Spectrum(SpectrumTable table) : kind_(TabulatedSpectrum(std::move(table))) {}
    explicit Spectrum(PiecewiseLinear lines) : kind_(PiecewiseLinearSpectrum(std::move(lines))) {}

    // Values at the four wavelengths, which lie in the visible range.
    SampledSpectrum sample(const SampledWavelengths& w) const {
        return std::visit([&](const auto& s) { return s.sample(w); }, kind_);
    }
    // Value at a wavelength in nm.
    float operator()(float lambda) const {
        return std::visit([&](const auto& s) { return s(lambda); }, kind_);
    }
    // An upper bound of the values in the visible range, exact except for coloured lights.
    float max_value() const {
        return std::visit([](const auto& s) { return s.max_value(); }, kind_);
    }
    const Variant& kind() const { return kind_; }
    bool is_constant() const { return std::holds_alternative<ConstantSpectrum>(kind_); }

    // The same spectrum by its values at each nanometre, times `factor`.
    SpectrumTable tabulate(float factor = 1) const;

  private:
    Variant kind_;
};

// Integral of the product of two spectra over the visible range, by the sum over 1 nm samples (nm).
double inner_product(const Spectrum& a, const Spectrum& b);
// Tristimulus values, scaled so that the constant spectrum 1 has Y = 1.
Vec3d to_xyz(const Spectrum& s);
// Integral of s times the CIE's Y. Lights are divided by it, so that their power is given in photometric
// units; the colour of an RGB light does not count, only its illuminant, so that RGB values keep their
// meaning as multiples of the white.
double to_photometric(const Spectrum& s);

} // namespace montelux
