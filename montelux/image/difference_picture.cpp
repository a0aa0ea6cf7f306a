#include "montelux/image/difference_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "montelux/mc/math/compensated.h"
#include "montelux/mc/math/error.h"

namespace montelux {

namespace {

using Rgb8 = std::array<std::uint8_t, 3>;

// t in [-1, 1]: blue, white, red, straight lines between encoded values.
Rgb8 signed_color(double t) {
    static constexpr std::array<double, 3> cold{20, 70, 200}, middle{255, 255, 255}, warm{200, 30, 30};
    const auto& end = t < 0 ? cold : warm;
    double weight = std::min(std::abs(t), 1.0);
    Rgb8 out{};
    for (int c = 0; c < 3; ++c)
        out[c] = static_cast<std::uint8_t>(std::lround(middle[c] + weight * (end[c] - middle[c])));
    return out;
}

} // namespace

DifferencePicture difference_picture(const MeasuredPicture& a, const MeasuredPicture& b,
                                     DifferenceMeasure measure, double full_scale) {
    int width = a.image->width(), height = a.image->height(), channels = static_cast<int>(a.channels.size());
    if (b.image->width() != width || b.image->height() != height || b.channels.size() != a.channels.size())
        throw Error("difference picture", "the pictures differ in size or channels");
    if (!(full_scale >= 0)) throw Error("difference picture", "the full scale must not be negative");
    bool z = measure == DifferenceMeasure::z_score;
    if (z && !a.has_error() && !b.has_error())
        throw Error("difference picture", "z-scores need the standard errors of at least one picture");

    std::vector<double> difference(a.image->pixel_count()), denominator(difference.size());
    CompensatedSum brightness;
    std::size_t finite = 0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            std::size_t i = static_cast<std::size_t>(y) * width + x;
            for (int c = 0; c < channels; ++c) {
                difference[i] += a.value(x, y, c) - b.value(x, y, c);
                if (!z) denominator[i] += std::abs(b.value(x, y, c));
                for (const MeasuredPicture* p : {&a, &b})
                    if (z && p->has_error()) {
                        double s = p->standard_error(x, y, c);
                        denominator[i] += s * s;
                    }
            }
            if (!std::isfinite(denominator[i])) continue;
            brightness.add(denominator[i]);
            ++finite;
        }
    double floor = z || finite == 0 ? 0 : 1e-3 * brightness.value() / static_cast<double>(finite);
    std::vector<double> magnitudes;
    for (std::size_t i = 0; i < difference.size(); ++i) {
        double d = z ? std::sqrt(denominator[i]) : denominator[i] + floor;
        // A zero difference needs no error.
        if (difference[i] != 0) difference[i] /= d;
        if (std::isfinite(difference[i])) magnitudes.push_back(std::abs(difference[i]));
    }
    if (full_scale == 0 && !magnitudes.empty()) {
        auto at = magnitudes.begin() +
                  static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(magnitudes.size() - 1));
        std::nth_element(magnitudes.begin(), at, magnitudes.end());
        full_scale = *at;
        // A few different pixels in a picture of equal ones: show them.
        if (full_scale == 0) full_scale = *std::max_element(magnitudes.begin(), magnitudes.end());
    }
    if (full_scale == 0) full_scale = 1;

    DifferencePicture out{Image(width, height, {"R", "G", "B"}, PixelFormat::u8, ColorEncoding::srgb()),
                          full_scale};
    for (std::size_t i = 0; i < difference.size(); ++i) {
        Rgb8 color =
            std::isfinite(difference[i]) ? signed_color(difference[i] / full_scale) : Rgb8{255, 0, 255};
        std::copy(color.begin(), color.end(), out.picture.u8().begin() + 3 * static_cast<std::ptrdiff_t>(i));
    }
    return out;
}

} // namespace montelux
