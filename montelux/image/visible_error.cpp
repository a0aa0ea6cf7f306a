#include "montelux/image/visible_error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>

#include "montelux/image/metrics.h"

namespace montelux {

bool error_is_visible(double luminance, double error, const ToneCurve& curve) {
    const auto code = [&](double light) {
        return 255 * double(curve(static_cast<float>(std::max(light, 0.0))));
    };
    return !std::isfinite(error) || 0.5 * (code(luminance + error) - code(luminance - error)) >= 1;
}

std::optional<double> visible_error_share(const Image& image, const ToneCurve& curve) {
    if (image.color_channels().empty()) return std::nullopt;
    const MeasuredPicture picture = measured_picture("", image);
    const std::size_t channels = picture.channels.size();
    if (!picture.has_error() || (channels != 1 && channels != 3)) return std::nullopt;
    constexpr std::array<double, 3> luminance{0.2126, 0.7152, 0.0722}; // IEC 61966-2-1
    std::uint64_t visible = 0, all = 0;
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) {
            double value = 0, error = 0; // errors of channels are strongly correlated: they add up
            for (std::size_t c = 0; c < channels; ++c) {
                const double weight = channels == 1 ? 1 : luminance[c];
                value += weight * picture.value(x, y, static_cast<int>(c));
                error += weight * picture.standard_error(x, y, static_cast<int>(c));
            }
            visible += error_is_visible(value, error, curve) ? 1 : 0;
            ++all;
        }
    return all > 0 ? static_cast<double>(visible) / static_cast<double>(all) : 0.0;
}

} // namespace montelux
