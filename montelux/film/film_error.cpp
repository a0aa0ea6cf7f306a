#include "montelux/film/film_error.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "montelux/film/film.h"
#include "montelux/mc/math/compensated.h"

namespace montelux {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

double mean_luminance(const Film& film) {
    CompensatedSum luminance;
    for (const Pixel& p : film.pixels())
        for (int c = 0; c < 3; ++c) luminance.add(luminance_weight[c] * p.replicates().mean(c));
    return luminance.value() / static_cast<double>(film.pixels().size());
}
// Replaces a quotient by a luminance that may be zero.
double relative_to(double luminance, double error) {
    if (luminance > 0) return error / luminance;
    return error > 0 ? infinity : 0;
}

} // namespace

double luminance_error(const Pixel& pixel) {
    double error = 0;
    for (int c = 0; c < 3; ++c) error += luminance_weight[c] * pixel.replicates().standard_error(c);
    return error;
}

FilmError error_of(const Film& film) {
    CompensatedSum variance, samples;
    for (const Pixel& p : film.pixels()) {
        const double error = luminance_error(p);
        variance.add(error * error);
        samples.add(p.samples());
    }
    const auto n = static_cast<double>(film.pixels().size());
    // With infinite terms (pixels of a single replicate) the compensation of the sum is NaN.
    const double total = std::isnan(variance.value()) ? infinity : variance.value();
    FilmError e;
    e.mean_luminance = mean_luminance(film);
    e.mean_samples = samples.value() / n;
    e.relative = relative_to(e.mean_luminance, std::sqrt(total / n));
    return e;
}

// Satterthwaite 1946, "An Approximate Distribution of Estimates of Variance Components", Biometrics Bulletin
// 2(6), equation 17.
double error_freedom(const Film& film) {
    CompensatedSum variances, squares;
    for (const Pixel& p : film.pixels()) {
        const double variance = std::pow(luminance_error(p), 2);
        if (!std::isfinite(variance)) return 0;
        if (!(variance > 0)) continue;
        variances.add(variance);
        squares.add(variance * variance / (static_cast<double>(p.replicates().count()) - 1));
    }
    return squares.value() > 0 ? variances.value() * variances.value() / squares.value() : infinity;
}

double clamped_luminance(const Film& film) {
    CompensatedSum sum;
    for (const Pixel& p : film.pixels()) sum.add(p.clamped());
    return sum.value() / static_cast<double>(film.pixels().size());
}

double error_quantile(const Film& film, double quantile) {
    std::vector<double> errors;
    errors.reserve(film.pixels().size());
    for (const Pixel& p : film.pixels()) errors.push_back(luminance_error(p));
    const auto at =
        static_cast<std::size_t>(std::clamp(std::ceil(quantile * static_cast<double>(errors.size())) - 1, 0.0,
                                            static_cast<double>(errors.size() - 1)));
    std::nth_element(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(at), errors.end());
    return relative_to(mean_luminance(film), errors[at]);
}

OutlierReport outliers_of(const Film& film) {
    std::vector<double> errors;
    errors.reserve(film.pixels().size());
    for (const Pixel& p : film.pixels()) errors.push_back(luminance_error(p));
    return outliers_of(errors, pixel_warnings(film));
}

OutlierReport outliers_of(std::span<const double> errors, std::span<const PixelWarning> warnings) {
    OutlierReport report;
    report.pixels = warnings.size();
    std::vector<double> squares;
    double total = 0, heavy = 0;
    for (std::size_t i = 0; i < warnings.size(); ++i) {
        const double error = errors[i];
        report.unknown += warnings[i] == PixelWarning::unknown;
        if (!std::isfinite(error)) continue;
        squares.push_back(error * error);
        total += error * error;
        report.outshone += warnings[i] == PixelWarning::neighbours;
        if (warnings[i] != PixelWarning::bright_replicate) continue;
        ++report.heavy_tailed;
        heavy += error * error;
    }
    if (!(total > 0)) return report;
    report.heavy_error_share = heavy / total;
    std::sort(squares.begin(), squares.end(), std::greater<>());
    double sum = 0;
    for (double s : squares) {
        if (sum >= 0.5 * total) break;
        sum += s;
        ++report.pixels_of_half;
    }
    report.share_of_half = static_cast<double>(report.pixels_of_half) / static_cast<double>(report.pixels);
    return report;
}

} // namespace montelux
