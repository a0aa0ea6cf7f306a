#include "montelux/image/exposure.h"

#include <algorithm>
#include <cmath>

#include "montelux/mc/math/compensated.h"

namespace montelux {
namespace {

float luminance(Vec3f v) { return 0.2126f * v.x + 0.7152f * v.y + 0.0722f * v.z; }

// Calls visit(rgb) for each pixel; grey is (Y, Y, Y).
template <typename F>
void for_each_color(const Image& image, F visit) {
    const std::vector<int> colors = image.color_channels();
    if (colors.empty()) return;
    const int g = colors[colors.size() / 2];
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x)
            visit(Vec3f{image.linear(x, y, colors.front()), image.linear(x, y, g),
                        image.linear(x, y, colors.back())});
}

} // namespace

float automatic_exposure(const Image& image, float key) {
    CompensatedSum sum;
    std::size_t count = 0;
    for_each_color(image, [&](Vec3f rgb) {
        const float l = luminance(rgb);
        if (!(l > 0) || !std::isfinite(l)) return;
        sum.add(std::log2(static_cast<double>(l)));
        ++count;
    });
    if (count == 0) return 0;
    const double stops = std::log2(double{key}) - sum.value() / static_cast<double>(count);
    return std::clamp(static_cast<float>(stops), least_exposure, most_exposure);
}

ToneShares tone_shares(const Image& image, const ToneCurve& curve) {
    std::size_t all = 0, black = 0, white = 0, with_light = 0, dim = 0;
    for_each_color(image, [&](Vec3f rgb) {
        const float luma = luminance(curve(rgb));
        const bool is_black = luma <= 0.01f, has_light = luminance(rgb) > 0;
        ++all;
        black += is_black;
        white += luma >= 0.99f;
        with_light += has_light;
        dim += is_black && has_light;
    });
    ToneShares shares;
    if (all == 0) return shares;
    shares.black = static_cast<double>(black) / static_cast<double>(all);
    shares.white = static_cast<double>(white) / static_cast<double>(all);
    shares.any_light = with_light > 0;
    if (with_light > 0) shares.dim = static_cast<double>(dim) / static_cast<double>(with_light);
    return shares;
}

float suitable_exposure(const Image& image, ToneKind kind) {
    if (image.format() == PixelFormat::u8 || image.format() == PixelFormat::u16) return 0;
    const ToneShares shares = tone_shares(image, {0, kind});
    return shares.dim > blank_share || shares.white > blank_share ? automatic_exposure(image) : 0;
}

} // namespace montelux
