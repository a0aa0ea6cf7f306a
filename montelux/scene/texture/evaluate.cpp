#include "montelux/scene/texture/evaluate.h"

#include <algorithm>
#include <cmath>

#include "montelux/mc/math/overloaded.h"
#include "montelux/scene/texture/procedural.h"

namespace montelux {

namespace {

// Share of the second colour of a 2-D checkerboard in the footprint around (s, t): the product of two
// box-filtered square waves.
float checkerboard_share(const TextureCoordinates& c) {
    // Mean over [x - r, x + r] of the square wave that is +1 on even unit cells and -1 on odd ones.
    auto wave = [](float x, float r) {
        auto integral = [](float v) {
            float half = v * 0.5f;
            float frac = 2 * (half - std::floor(half));
            return frac < 1 ? frac : 2 - frac;
        };
        if (r < 1e-4f) return (static_cast<long long>(std::floor(x)) & 1) == 0 ? 1.0f : -1.0f;
        return (integral(x + r) - integral(x - r)) / (2 * r);
    };
    float rs = 0.5f * std::max(std::abs(c.dstdx.x), std::abs(c.dstdy.x));
    float rt = 0.5f * std::max(std::abs(c.dstdx.y), std::abs(c.dstdy.y));
    return 0.5f - 0.5f * wave(c.st.x, rs) * wave(c.st.y, rt);
}

template <typename Parameter>
float second_share(const CheckerboardTexture<Parameter>& t, const TextureContext& context) {
    if (t.dimension == 2) {
        TextureCoordinates c = t.mapping(context);
        if (t.sharp) c.dstdx = c.dstdy = {};
        return checkerboard_share(c);
    }
    Vec3f p = t.mapping.texture_from_world.point(context.p);
    auto cell = static_cast<long long>(std::floor(p.x)) + static_cast<long long>(std::floor(p.y)) +
                static_cast<long long>(std::floor(p.z));
    return (cell & 1) == 0 ? 0.0f : 1.0f;
}

template <typename Parameter>
float second_share(const DotsTexture<Parameter>& t, const TextureContext& context) {
    return inside_dot(t.mapping(context).st) ? 1.0f : 0.0f;
}
template <typename Parameter>
float second_share(const DirectionMixTexture<Parameter>& t, const TextureContext& context) {
    return 1 - std::abs(dot(context.n, t.direction));
}

// The two values that `second_share`, or an amount, mixes.
template <typename Texture>
auto mixed_values(const Texture& t) {
    if constexpr (requires { t.values; })
        return t.values;
    else if constexpr (requires { t.inside; })
        return std::array{t.outside, t.inside};
    else
        return std::array{t.first, t.second};
}

// `vertex`: what ImageTexture::vertex_colors multiplies by.
Vec3f image_lookup(const SceneView& scene, const ImageTexture& t, const TextureContext& context,
                   Vec3f vertex) {
    TextureCoordinates c = t.mapping(context);
    Vec3f rgb =
        t.scale *
        scene.mipmap(t.image, t.channels).lookup(c.st, c.dstdx, c.dstdy, t.filter, t.wrap, t.max_anisotropy);
    rgb = multiply(rgb, t.factor);
    if (t.vertex_colors) rgb = multiply(rgb, vertex);
    if (t.invert) rgb = Vec3f{1, 1, 1} - rgb;
    return max(rgb, Vec3f{0, 0, 0});
}

float as_number(Vec3f rgb, ImageChannels channels) {
    switch (channels) {
    case ImageChannels::red:
        return rgb.x;
    case ImageChannels::green:
        return rgb.y;
    case ImageChannels::blue:
        return rgb.z;
    case ImageChannels::angle:
        return std::atan2(2 * rgb.y - 1, 2 * rgb.x - 1);
    case ImageChannels::color:
    case ImageChannels::alpha:
        break;
    }
    return (rgb.x + rgb.y + rgb.z) / 3;
}

SampledSpectrum as_spectrum(Vec3f rgb, const ImageTexture& t, const SampledWavelengths& lambda) {
    switch (t.meaning) {
    case RgbMeaning::albedo:
        return RgbAlbedoSpectrum(*t.color_space, rgb).sample(lambda);
    case RgbMeaning::unbounded:
        return RgbUnboundedSpectrum(*t.color_space, rgb).sample(lambda);
    case RgbMeaning::illuminant:
        break;
    }
    return RgbIlluminantSpectrum(*t.color_space, rgb).sample(lambda);
}

// One tree walk for both kinds of values; `value_of` evaluates a parameter, `from_image` an image, `procedural`
// what has no inputs.
template <typename Value, typename Texture, typename ValueOf, typename FromImage, typename Procedural,
          typename Amount>
Value evaluate_node(const Texture& texture, const TextureContext& context, const ValueOf& value_of,
                    const FromImage& from_image, const Procedural& procedural, const Amount& amount) {
    return std::visit(
        [&](const auto& t) -> Value {
            using T = std::decay_t<decltype(t)>;
            if constexpr (requires { t.value; }) {
                return value_of(t.value);
            } else if constexpr (std::is_same_v<T, ImageTexture>) {
                return from_image(t);
            } else if constexpr (requires { t.edge; }) {
                return amount(t.input) >= t.edge ? Value(1) : Value(0);
            } else if constexpr (requires { procedural(t); }) {
                return procedural(t);
            } else if constexpr (requires { t.corners; }) {
                const Point2f st = t.mapping(context).st;
                return (value_of(t.corners[0]) * (1 - st.x) + value_of(t.corners[1]) * st.x) * (1 - st.y) +
                       (value_of(t.corners[2]) * (1 - st.x) + value_of(t.corners[3]) * st.x) * st.y;
            } else if constexpr (requires { t.scale; }) {
                float scale = amount(t.scale);
                return scale == 0 ? Value(0) : value_of(t.texture) * scale;
            } else {
                float share;
                if constexpr (requires { t.amount; })
                    share = amount(t.amount);
                else
                    share = second_share(t, context);
                const auto [first, second] = mixed_values(t);
                if (share <= 0) return value_of(first);
                if (share >= 1) return value_of(second);
                return value_of(first) * (1 - share) + value_of(second) * share;
            }
        },
        texture);
}

} // namespace

float evaluate_texture(const SceneView& scene, const FloatTexture& texture, const TextureContext& context) {
    auto value_of = [&](const FloatParameter& p) { return evaluate(scene, p, context); };
    auto from_image = [&](const ImageTexture& t) {
        return as_number(image_lookup(scene, t, context, Vec3f{1, 1, 1} * context.vertex_opacity),
                         t.channels);
    };
    auto procedural =
        Overloaded{[&](const NoiseTexture& t) { return noise_value(t, context); },
                   [&](const VertexColorTexture& t) { return t.factor.x * context.vertex_opacity; }};
    return evaluate_node<float>(texture, context, value_of, from_image, procedural, value_of);
}

SampledSpectrum evaluate_texture(const SceneView& scene, const SpectrumTexture& texture,
                                 const TextureContext& context, const SampledWavelengths& lambda) {
    auto value_of = [&](const SpectrumParameter& p) { return evaluate(scene, p, context, lambda); };
    auto from_image = [&](const ImageTexture& t) {
        return as_spectrum(image_lookup(scene, t, context, context.vertex_color), t, lambda);
    };
    auto procedural = Overloaded{
        [&](const MarbleTexture& t) {
            return RgbAlbedoSpectrum(RgbColorSpace::srgb(), marble_color(t, context)).sample(lambda);
        },
        [&](const VertexColorTexture& t) {
            return RgbAlbedoSpectrum(RgbColorSpace::srgb(),
                                     max(multiply(t.factor, context.vertex_color), Vec3f{0, 0, 0}))
                .sample(lambda);
        }};
    auto amount = [&](const FloatParameter& p) { return evaluate(scene, p, context); };
    return evaluate_node<SampledSpectrum>(texture, context, value_of, from_image, procedural, amount);
}

} // namespace montelux
