#include "montelux/image/tone_curve.h"

#include <algorithm>
#include <cmath>

#include "montelux/mc/math/compensated.h"
#include "montelux/mc/math/error.h"

namespace montelux {

float ToneCurve::operator()(float light) const {
    float scaled = light * std::exp2(exposure);
    if (!(scaled > 0)) return 0;
    return scaled >= 1 ? 1 : linear_to_srgb(scaled);
}

float automatic_exposure(const Image& image, float key) {
    auto colors = image.color_channels();
    CompensatedSum sum;
    std::size_t count = 0;
    if (!colors.empty())
        for (int y = 0; y < image.height(); ++y)
            for (int x = 0; x < image.width(); ++x) {
                float l = image.linear(x, y, colors[0]);
                if (colors.size() == 3)
                    l = 0.2126f * l + 0.7152f * image.linear(x, y, colors[1]) +
                        0.0722f * image.linear(x, y, colors[2]);
                if (!(l > 0) || !std::isfinite(l)) continue;
                sum.add(std::log2(static_cast<double>(l)));
                ++count;
            }
    if (count == 0) return 0;
    return std::log2(key) - static_cast<float>(sum.value() / static_cast<double>(count));
}

Image apply_tone_curve(const Image& image, const ToneCurve& curve, int bits) {
    if (bits != 8 && bits != 16)
        throw Error("tone curve", "a picture can have 8 or 16 bits, not " + std::to_string(bits));
    auto colors = image.color_channels();
    if (colors.empty()) throw Error("tone curve", "the image has neither the channels R, G, B nor Y");
    std::vector<std::string> names;
    names.reserve(colors.size() + 1);
    for (int c : colors) names.push_back(image.channel_names()[c]);
    std::vector<int> sources = colors;
    if (auto alpha = image.find_channel("A")) {
        names.push_back("A");
        sources.push_back(*alpha);
    }
    Image out(image.width(), image.height(), names, bits == 8 ? PixelFormat::u8 : PixelFormat::u16,
              ColorEncoding::srgb());
    float scale = std::exp2(curve.exposure);
    std::size_t i = 0;
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x)
            for (std::size_t c = 0; c < sources.size(); ++c, ++i) {
                float v = image.linear(x, y, sources[c]);
                bool alpha = c >= colors.size();
                if (bits == 8 && !alpha) {
                    out.u8()[i] = linear_to_srgb8(v * scale);
                    continue;
                }
                float encoded = alpha ? (v > 0 ? std::min(v, 1.0f) : 0.0f) : curve(v);
                if (bits == 8)
                    out.u8()[i] = static_cast<std::uint8_t>(std::lround(encoded * 255));
                else
                    out.u16()[i] = static_cast<std::uint16_t>(std::lround(encoded * 65535));
            }
    return out;
}

} // namespace montelux
