#include "montelux/scene/texture/mipmap.h"

#include <algorithm>
#include <cmath>

#include "montelux/mc/math/error.h"

namespace montelux {

namespace {

int wrapped(int i, int n, TextureWrap wrap) {
    if (i >= 0 && i < n) return i;
    if (wrap == TextureWrap::clamp) return std::clamp(i, 0, n - 1);
    if (wrap == TextureWrap::repeat) {
        int r = i % n;
        return r < 0 ? r + n : r;
    }
    return -1;
}

// Beyond an edge of an octahedral map, texels continue from the same edge, mirrored.
void wrap_octahedral(int& x, int& y, int width, int height) {
    if (x < 0) {
        x = -x - 1;
        y = height - 1 - y;
    } else if (x >= width) {
        x = 2 * width - 1 - x;
        y = height - 1 - y;
    }
    if (y < 0) {
        x = width - 1 - x;
        y = -y - 1;
    } else if (y >= height) {
        x = width - 1 - x;
        y = 2 * height - 1 - y;
    }
    x = std::clamp(x, 0, width - 1);
    y = std::clamp(y, 0, height - 1);
}

int part(int i, int size, int parts) { return static_cast<int>(std::int64_t{i} * size / parts); }

Image decoded_alpha(const Image& image) {
    Image alpha(image.width(), image.height(), {"Y"});
    const int channel = image.find_channel("A").value();
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x)
            alpha.set(x, y, 0, image.encoding().to_linear(image.value(x, y, channel)));
    return alpha;
}

} // namespace

MipMap::MipMap(const Image& image, ImageChannels channels) : image_(&image) {
    std::vector<int> color = image.color_channels();
    if (color.empty() || channels == ImageChannels::alpha) color = {0};
    for (std::size_t i = 0; i < 3; ++i)
        channels_[i] = color.size() == 3 ? color[i] : (i == 0 ? color[0] : -1);
    if (channels == ImageChannels::alpha) {
        converted_ = decoded_alpha(image);
    } else if (image.format() == PixelFormat::u8) {
        for (std::size_t i = 0; i < 256; ++i) decode8_[i] = static_cast<float>(i) / 255;
        if (image.encoding().kind() != ColorEncoding::Kind::linear) decode8_ = image.encoding().table8();
    } else if (image.encoding().kind() != ColorEncoding::Kind::linear || image.format() == PixelFormat::u16) {
        converted_ = image.to_linear_f32();
    }

    const int components = is_color() ? 3 : 1;
    std::vector<std::string> names =
        is_color() ? std::vector<std::string>{"R", "G", "B"} : std::vector<std::string>{"Y"};
    int w = image.width(), h = image.height();
    while (w > 1 || h > 1) {
        int cw = std::max(1, w / 2), ch = std::max(1, h / 2);
        Image coarse(cw, ch, names);
        const bool from_base = levels_.empty();
        const Image& finer = from_base ? base() : levels_.back();
        for (int y = 0; y < ch; ++y)
            for (int x = 0; x < cw; ++x) {
                // The last cell of an odd size takes three texels.
                const int x0 = part(x, w, cw), x1 = part(x + 1, w, cw), y0 = part(y, h, ch),
                          y1 = part(y + 1, h, ch);
                for (int c = 0; c < components; ++c) {
                    float sum = 0;
                    for (int yy = y0; yy < y1; ++yy)
                        for (int xx = x0; xx < x1; ++xx)
                            sum += from_base ? finer.linear(xx, yy, channels_[static_cast<std::size_t>(c)])
                                             : finer.value(xx, yy, c);
                    coarse.set(x, y, c, sum / static_cast<float>((x1 - x0) * (y1 - y0)));
                }
            }
        levels_.push_back(std::move(coarse));
        w = cw;
        h = ch;
    }
}

Vec3f MipMap::texel(int l, int x, int y, TextureWrap wrap) const {
    const Image& image = level(l);
    if (wrap == TextureWrap::octahedral_sphere) {
        wrap_octahedral(x, y, image.width(), image.height());
    } else {
        x = wrapped(x, image.width(), wrap);
        y = wrapped(y, image.height(), wrap);
        if (x < 0 || y < 0) return {0, 0, 0};
    }
    std::size_t i = image.index(x, y);
    if (l > 0) {
        const float* v = &image.f32()[i];
        return is_color() ? Vec3f{v[0], v[1], v[2]} : Vec3f{v[0], v[0], v[0]};
    }
    auto decode = [&](int channel) {
        std::size_t k = i + static_cast<std::size_t>(channel);
        return image.format() == PixelFormat::u8 ? decode8_[image.u8()[k]] : image.value_at(k);
    };
    float first = decode(channels_[0]);
    if (!is_color()) return {first, first, first};
    return {first, decode(channels_[1]), decode(channels_[2])};
}

Vec3f MipMap::bilinear(int l, Point2f st, TextureWrap wrap) const {
    float x = st.x * static_cast<float>(level(l).width()) - 0.5f;
    float y = st.y * static_cast<float>(level(l).height()) - 0.5f;
    float fx = std::floor(x), fy = std::floor(y);
    int xi = static_cast<int>(fx), yi = static_cast<int>(fy);
    float dx = x - fx, dy = y - fy;
    const Image& image = level(l);
    if (l == 0 && image.format() == PixelFormat::u8 && xi >= 0 && yi >= 0 && xi + 1 < image.width() &&
        yi + 1 < image.height()) {
        // The common case: inside an 8-bit image.
        const std::uint8_t* row0 = &image.u8()[image.index(xi, yi)];
        const std::uint8_t* row1 = row0 + image.index(0, 1);
        const int next = image.channels();
        auto channel = [&](int c) {
            float top = (1 - dx) * decode8_[row0[c]] + dx * decode8_[row0[next + c]];
            float bottom = (1 - dx) * decode8_[row1[c]] + dx * decode8_[row1[next + c]];
            return (1 - dy) * top + dy * bottom;
        };
        float first = channel(channels_[0]);
        if (!is_color()) return {first, first, first};
        return {first, channel(channels_[1]), channel(channels_[2])};
    }
    return (1 - dx) * (1 - dy) * texel(l, xi, yi, wrap) + dx * (1 - dy) * texel(l, xi + 1, yi, wrap) +
           (1 - dx) * dy * texel(l, xi, yi + 1, wrap) + dx * dy * texel(l, xi + 1, yi + 1, wrap);
}

float MipMap::level_of(float width) const {
    return std::log2(std::max(width * static_cast<float>(std::max(base().width(), base().height())), 1e-8f));
}

Vec3f MipMap::trilinear(Point2f st, float width, TextureWrap wrap) const {
    float l = level_of(width);
    if (l <= 0) return bilinear(0, st, wrap);
    if (l >= static_cast<float>(level_count() - 1)) return texel(level_count() - 1, 0, 0, wrap);
    int i = static_cast<int>(l);
    float t = l - static_cast<float>(i);
    return (1 - t) * bilinear(i, st, wrap) + t * bilinear(i + 1, st, wrap);
}

// Heckbert 1989, "Fundamentals of Texture Mapping and Image Warping": an ellipse with Gaussian weights.
Vec3f MipMap::ewa(Point2f st, Vec2f dst0, Vec2f dst1, TextureWrap wrap, float max_anisotropy) const {
    if (length_squared(dst0) < length_squared(dst1)) std::swap(dst0, dst1);
    float major = length(dst0), minor = length(dst1);
    if (minor * max_anisotropy < major && minor > 0) {
        float scale = major / (minor * max_anisotropy);
        dst1 *= scale;
        minor *= scale;
    }
    if (!(minor > 0)) return bilinear(0, st, wrap);
    float l = std::max(0.0f, level_of(minor));
    int i = static_cast<int>(std::min(l, static_cast<float>(level_count())));
    float t = l - static_cast<float>(i);
    return (1 - t) * ewa_level(i, st, dst0, dst1, wrap) + t * ewa_level(i + 1, st, dst0, dst1, wrap);
}

Vec3f MipMap::ewa_level(int l, Point2f st, Vec2f dst0, Vec2f dst1, TextureWrap wrap) const {
    if (l >= level_count()) return texel(level_count() - 1, 0, 0, wrap);
    auto w = static_cast<float>(level(l).width()), h = static_cast<float>(level(l).height());
    float x = st.x * w - 0.5f, y = st.y * h - 0.5f;
    dst0 = {dst0.x * w, dst0.y * h};
    dst1 = {dst1.x * w, dst1.y * h};
    // The ellipse a s^2 + b s t + c t^2 < 1, widened by the reconstruction filter of one texel.
    float a = dst0.y * dst0.y + dst1.y * dst1.y + 1;
    float b = -2 * (dst0.x * dst0.y + dst1.x * dst1.y);
    float c = dst0.x * dst0.x + dst1.x * dst1.x + 1;
    float inv_f = 1 / (a * c - 0.25f * b * b);
    a *= inv_f;
    b *= inv_f;
    c *= inv_f;
    float det = 4 * a * c - b * b;
    float rx = 2 * std::sqrt(c / det), ry = 2 * std::sqrt(a / det);
    Vec3f sum;
    float weights = 0;
    constexpr float falloff = 2; // the Gaussian exp(-2 r^2), lowered to zero at the rim
    const float rim = std::exp(-falloff);
    for (int yi = static_cast<int>(std::ceil(y - ry)); yi <= static_cast<int>(std::floor(y + ry)); ++yi)
        for (int xi = static_cast<int>(std::ceil(x - rx)); xi <= static_cast<int>(std::floor(x + rx)); ++xi) {
            float s = static_cast<float>(xi) - x, t = static_cast<float>(yi) - y;
            float r2 = a * s * s + b * s * t + c * t * t;
            if (r2 >= 1) continue;
            float weight = std::exp(-falloff * r2) - rim;
            sum += weight * texel(l, xi, yi, wrap);
            weights += weight;
        }
    return weights > 0 ? sum / weights : bilinear(l, st, wrap);
}

Vec3f MipMap::lookup(Point2f st, Vec2f dst0, Vec2f dst1, TextureFilter filter, TextureWrap wrap,
                     float max_anisotropy) const {
    if (!std::isfinite(st.x) || !std::isfinite(st.y) || std::abs(st.x) > 1e6f || std::abs(st.y) > 1e6f)
        return texel(level_count() - 1, 0, 0, TextureWrap::clamp);
    st.y = 1 - st.y; // images are stored top row first
    dst0.y = -dst0.y;
    dst1.y = -dst1.y;
    if (filter == TextureFilter::ewa) return ewa(st, dst0, dst1, wrap, max_anisotropy);
    float width = 2 * std::max(std::max(std::abs(dst0.x), std::abs(dst0.y)),
                               std::max(std::abs(dst1.x), std::abs(dst1.y)));
    if (filter == TextureFilter::trilinear) return trilinear(st, width, wrap);
    int l = std::clamp(static_cast<int>(std::floor(level_of(width))), 0, level_count() - 1);
    if (filter == TextureFilter::bilinear) return bilinear(l, st, wrap);
    const Image& image = level(l);
    return texel(l, static_cast<int>(std::floor(st.x * static_cast<float>(image.width()))),
                 static_cast<int>(std::floor(st.y * static_cast<float>(image.height()))), wrap);
}

} // namespace montelux
