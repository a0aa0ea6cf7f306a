// Light of a black body, and Planck's law.
#pragma once

#include "montelux/spectrum/wavelengths.h"

namespace montelux {

// Radiation constants from the exact SI values of h, c and k (CODATA 2018).
inline constexpr double planck_h = 6.62607015e-34;                                           // J s
inline constexpr double speed_of_light = 299792458.0;                                        // m/s
inline constexpr double boltzmann_k = 1.380649e-23;                                          // J/K
inline constexpr double second_radiation_constant = planck_h * speed_of_light / boltzmann_k; // m K
// Wien's displacement constant: the spectrum peaks at wien_displacement / T.
inline constexpr double wien_displacement = 2.897771955e-3; // m K

// Planck's law: spectral radiance in W/(m^2 sr nm) at a wavelength in nm and a temperature in K; 0 for
// temperatures that are not positive.
inline double planck_radiance(double lambda, double temperature) {
    if (!(temperature > 0)) return 0;
    double metres = lambda * 1e-9;
    double x = second_radiation_constant / (metres * temperature);
    double per_metre = 2 * planck_h * speed_of_light * speed_of_light /
                       (metres * metres * metres * metres * metres * std::expm1(x));
    return per_metre * 1e-9;
}

// A black body's spectrum relative to its peak, wherever the peak lies: the largest value is 1.
class BlackbodySpectrum {
  public:
    BlackbodySpectrum() = default;
    // Kelvin, positive and finite.
    explicit BlackbodySpectrum(float temperature)
        : temperature_(temperature),
          c2_(static_cast<float>(second_radiation_constant * 1e9 / static_cast<double>(temperature))),
          inverse_peak_(static_cast<float>(static_cast<double>(temperature) / (wien_displacement * 1e9))) {}

    // (lambda_peak / lambda)^5 expm1(x_peak) / expm1(x), x = c2 / (lambda T).
    SampledSpectrum sample(const SampledWavelengths& w) const {
        Float4 r = 1.0f / (w.lambda * inverse_peak_);
        Float4 r2 = r * r;
        return SampledSpectrum(peak_expm1 * r2 * r2 * r / (exp(c2_ / w.lambda) - 1.0f));
    }
    float operator()(float lambda) const {
        if (!(lambda > 0)) return 0;
        double r = 1.0 / (static_cast<double>(lambda) * static_cast<double>(inverse_peak_));
        double x = static_cast<double>(c2_) / static_cast<double>(lambda);
        return static_cast<float>(static_cast<double>(peak_expm1) * r * r * r * r * r / std::expm1(x));
    }
    float max_value() const { return 1; }
    float temperature() const { return temperature_; }

  private:
    static constexpr float peak_expm1 = 142.324922f; // expm1(c2 / wien_displacement)

    float temperature_ = 0;
    float c2_ = 0;           // c2 / T, nm
    float inverse_peak_ = 0; // 1 / lambda_peak, 1/nm
};

} // namespace montelux
