#include "montelux/spectrum/illuminants.h"

#include "montelux/spectrum/blackbody.h"
#include "montelux/spectrum/measured_data.h"

namespace montelux {

namespace {

// Chromaticity x of daylight (CIE 015:2018, equations 4.9 and 4.10).
double daylight_x(double t) {
    if (t <= 7000) return ((-4.6070e9 / t + 2.9678e6) / t + 0.09911e3) / t + 0.244063;
    return ((-2.0064e9 / t + 1.9018e6) / t + 0.24748e3) / t + 0.237040;
}

double round_to_thousandths(double v) { return std::round(v * 1000) / 1000; }

} // namespace

SpectrumTable daylight(float temperature, bool round_components) {
    return daylight_of_correlated_temperature(static_cast<double>(temperature) * 1.4388 / 1.4380,
                                              round_components);
}

SpectrumTable daylight_of_correlated_temperature(double t, bool round_components) {
    if (t < 4000) return SpectrumTable::from(BlackbodySpectrum(static_cast<float>(t)));
    double x = daylight_x(std::min(t, 25000.0));
    double y = (-3.000 * x + 2.870) * x - 0.275;
    double m = 0.0241 + 0.2562 * x - 0.7341 * y;
    double m1 = (-1.3515 - 1.7703 * x + 5.9114 * y) / m;
    double m2 = (0.0300 - 31.4424 * x + 30.0717 * y) / m;
    if (round_components) {
        m1 = round_to_thousandths(m1);
        m2 = round_to_thousandths(m2);
    }
    auto component = [&](int i) {
        return static_cast<double>(measured::d_series_s0[i]) +
               m1 * static_cast<double>(measured::d_series_s1[i]) +
               m2 * static_cast<double>(measured::d_series_s2[i]);
    };
    // The components are defined at steps of 10 nm and joined by straight lines.
    return SpectrumTable::from([&](float lambda) {
        double position = (static_cast<double>(lambda) - 360) / 10;
        int i = std::clamp(static_cast<int>(position), 0, 46);
        double f = position - i;
        return static_cast<float>(0.01 * ((1 - f) * component(i) + f * component(i + 1)));
    });
}

SpectrumTable illuminant_d65() {
    return SpectrumTable::from([](float lambda) {
        const measured::EvenSamples& d65 = measured::illuminant_d65;
        float position = (lambda - d65.first) / d65.step;
        int i = std::clamp(static_cast<int>(position), 0, static_cast<int>(d65.values.size()) - 2);
        float f = position - static_cast<float>(i);
        return (1 - f) * d65.values[i] + f * d65.values[i + 1];
    });
}

SpectrumTable illuminant_aces_d60() { return daylight_of_correlated_temperature(6000, true); }

double illuminant_a(double lambda) {
    constexpr double c2_over_t = 1.435e7 / 2848; // nm
    double ratio = 560 / lambda;
    return 100 * ratio * ratio * ratio * ratio * ratio * std::expm1(c2_over_t / 560) /
           std::expm1(c2_over_t / lambda);
}

} // namespace montelux
