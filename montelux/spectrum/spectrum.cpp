#include "montelux/spectrum/spectrum.h"

namespace montelux {

SpectrumTable Spectrum::tabulate(float factor) const {
    return SpectrumTable::from([&](float lambda) { return factor * (*this)(lambda); });
}

double inner_product(const Spectrum& a, const Spectrum& b) {
    double sum = 0;
    for (int i = 0; i < visible_samples; ++i) {
        float lambda = lambda_min + static_cast<float>(i);
        sum += static_cast<double>(a(lambda)) * static_cast<double>(b(lambda));
    }
    return sum;
}

Vec3d to_xyz(const Spectrum& s) { return integrate_xyz(s); }

double to_photometric(const Spectrum& s) {
    if (const auto* light = std::get_if<RgbIlluminantSpectrum>(&s.kind()))
        return integrate_luminance(light->illuminant());
    return integrate_luminance(s);
}

} // namespace montelux
