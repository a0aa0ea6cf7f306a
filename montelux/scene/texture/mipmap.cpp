#include "montelux/scene/texture/mipmap.h"

#include <algorithm>
#include <cmath>

#include "montelux/image/half.h"
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
    if (wrap == TextureWrap::mirror) {
        const int r = ((i % (2 * n)) + 2 * n) % (2 * n);
        return r < n ? r : 2 * n - 1 - r;
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

} // namespace

template <typename Layout>
Vec3f MipMap::texel(int l, int x, int y, TextureWraps wrap) const {
    const TexelLevel& t = level(l);
    if (wrap.s == TextureWrap::octahedral_sphere) {
        wrap_octahedral(x, y, t.width, t.height);
    } else {
        x = wrapped(x, t.width, wrap.s);
        y = wrapped(y, t.height, wrap.t);
        if (x < 0 || y < 0) return {0, 0, 0};
    }
    const std::size_t i = Layout::index(t, x, y);
    if (l > 0) {
        const float* v = t.at<float>(i);
        return is_color() ? Vec3f{v[0], v[1], v[2]} : Vec3f{v[0], v[0], v[0]};
    }
    auto decode = [&](int channel) {
        switch (t.format) {
        case PixelFormat::u8:
            return decode8_[t.at<std::uint8_t>(i)[channel]];
        case PixelFormat::f16:
            return half_to_float(t.at<std::uint16_t>(i)[channel]);
        default:
            return t.at<float>(i)[channel];
        }
    };
    float first = decode(channels_[0]);
    if (!is_color()) return {first, first, first};
    return {first, decode(channels_[1]), decode(channels_[2])};
}

template <typename Layout>
Vec3f MipMap::bilinear(int l, Point2f st, TextureWraps wrap) const {
    const TexelLevel& t = level(l);
    float x = st.x * static_cast<float>(t.width) - 0.5f;
    float y = st.y * static_cast<float>(t.height) - 0.5f;
    float fx = std::floor(x), fy = std::floor(y);
    int xi = static_cast<int>(fx), yi = static_cast<int>(fy);
    float dx = x - fx, dy = y - fy;
    if (l == 0 && t.format == PixelFormat::u8 && xi >= 0 && yi >= 0 && xi + 1 < t.width &&
        yi + 1 < t.height) {
        // The common case: inside an 8-bit image.
        auto at = [&](int column, int row) {
            return t.at<std::uint8_t>(Layout::index(t, xi + column, yi + row));
        };
        const std::uint8_t *t00 = at(0, 0), *t10 = at(1, 0), *t01 = at(0, 1), *t11 = at(1, 1);
        auto channel = [&](int c) {
            float top = (1 - dx) * decode8_[t00[c]] + dx * decode8_[t10[c]];
            float bottom = (1 - dx) * decode8_[t01[c]] + dx * decode8_[t11[c]];
            return (1 - dy) * top + dy * bottom;
        };
        float first = channel(channels_[0]);
        if (!is_color()) return {first, first, first};
        return {first, channel(channels_[1]), channel(channels_[2])};
    }
    return (1 - dx) * (1 - dy) * texel<Layout>(l, xi, yi, wrap) +
           dx * (1 - dy) * texel<Layout>(l, xi + 1, yi, wrap) +
           (1 - dx) * dy * texel<Layout>(l, xi, yi + 1, wrap) +
           dx * dy * texel<Layout>(l, xi + 1, yi + 1, wrap);
}

float MipMap::level_of(float width) const {
    return std::log2(std::max(width * static_cast<float>(std::max(level(0).width, level(0).height)), 1e-8f));
}

template <typename Layout>
Vec3f MipMap::trilinear(Point2f st, float width, TextureWraps wrap) const {
    float l = level_of(width);
    if (l <= 0) return bilinear<Layout>(0, st, wrap);
    if (l >= static_cast<float>(level_count() - 1)) return texel<Layout>(level_count() - 1, 0, 0, wrap);
    int i = static_cast<int>(l);
    float t = l - static_cast<float>(i);
    return (1 - t) * bilinear<Layout>(i, st, wrap) + t * bilinear<Layout>(i + 1, st, wrap);
}

// Heckbert 1989, "Fundamentals of Texture Mapping and Image Warping": an ellipse with Gaussian weights.
template <typename Layout>
Vec3f MipMap::ewa(Point2f st, Vec2f dst0, Vec2f dst1, TextureWraps wrap, float max_anisotropy) const {
    if (length_squared(dst0) < length_squared(dst1)) std::swap(dst0, dst1);
    float major = length(dst0), minor = length(dst1);
    if (minor * max_anisotropy < major && minor > 0) {
        float scale = major / (minor * max_anisotropy);
        dst1 *= scale;
        minor *= scale;
    }
    if (!(minor > 0)) return bilinear<Layout>(0, st, wrap);
    float l = std::max(0.0f, level_of(minor));
    int i = static_cast<int>(std::min(l, static_cast<float>(level_count())));
    float t = l - static_cast<float>(i);
    return (1 - t) * ewa_level<Layout>(i, st, dst0, dst1, wrap) +
           t * ewa_level<Layout>(i + 1, st, dst0, dst1, wrap);
}

template <typename Layout>
Vec3f MipMap::ewa_level(int l, Point2f st, Vec2f dst0, Vec2f dst1, TextureWraps wrap) const {
    if (l >= level_count()) return texel<Layout>(level_count() - 1, 0, 0, wrap);
    auto w = static_cast<float>(level(l).width), h = static_cast<float>(level(l).height);
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
            sum += weight * texel<Layout>(l, xi, yi, wrap);
            weights += weight;
        }
    return weights > 0 ? sum / weights : bilinear<Layout>(l, st, wrap);
}

template <typename Layout>
Vec3f MipMap::filtered(Point2f st, Vec2f dst0, Vec2f dst1, TextureFilter filter, TextureWraps wrap,
                       float max_anisotropy) const {
    if (!std::isfinite(st.x) || !std::isfinite(st.y) || std::abs(st.x) > 1e6f || std::abs(st.y) > 1e6f)
        return texel<Layout>(level_count() - 1, 0, 0, TextureWrap::clamp);
    st.y = 1 - st.y; // images are stored top row first
    dst0.y = -dst0.y;
    dst1.y = -dst1.y;
    if (filter == TextureFilter::ewa) return ewa<Layout>(st, dst0, dst1, wrap, max_anisotropy);
    float width = 2 * std::max(std::max(std::abs(dst0.x), std::abs(dst0.y)),
                               std::max(std::abs(dst1.x), std::abs(dst1.y)));
    if (filter == TextureFilter::trilinear) return trilinear<Layout>(st, width, wrap);
    int l = std::clamp(static_cast<int>(std::floor(level_of(width))), 0, level_count() - 1);
    if (filter == TextureFilter::bilinear) return bilinear<Layout>(l, st, wrap);
    return texel<Layout>(l, static_cast<int>(std::floor(st.x * static_cast<float>(level(l).width))),
                         static_cast<int>(std::floor(st.y * static_cast<float>(level(l).height))), wrap);
}

Vec3f MipMap::lookup(Point2f st, Vec2f dst0, Vec2f dst1, TextureFilter filter, TextureWraps wrap,
                     float max_anisotropy) const {
    return block_ ? filtered<TileLayout>(st, dst0, dst1, filter, wrap, max_anisotropy)
                  : filtered<RowLayout>(st, dst0, dst1, filter, wrap, max_anisotropy);
}

} // namespace montelux
