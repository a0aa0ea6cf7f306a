// Textures: values over surfaces, as trees of plain nodes in the scene's arrays.
#pragma once

#include <array>
#include <type_traits>
#include <variant>

#include "montelux/mc/math/fractal_noise.h"
#include "montelux/mc/math/overloaded.h"
#include "montelux/scene/scene_spectrum.h"
#include "montelux/scene/texture/mapping.h"

namespace montelux {

// A parameter of a material: a constant, or a texture by index.
struct FloatParameter {
    float value = 0;
    Index texture = no_index;

    bool is_constant() const { return texture == no_index; }
};
struct SpectrumParameter {
    SceneSpectrum value;
    Index texture = no_index;

    bool is_constant() const { return texture == no_index; }
};

// The meaning of an RGB colour when converted to a spectrum.
enum class RgbMeaning : std::uint8_t { albedo, unbounded, illuminant };

enum class TextureFilter : std::uint8_t { point, bilinear, trilinear, ewa };
enum class TextureWrap : std::uint8_t { repeat, black, clamp, octahedral_sphere, mirror };
// Along s and t. An octahedral sphere is one along both.
struct TextureWraps {
    TextureWrap s = TextureWrap::repeat, t = TextureWrap::repeat;

    TextureWraps(TextureWrap both) : s(both), t(both) {}
    TextureWraps(TextureWrap along_s, TextureWrap along_t) : s(along_s), t(along_t) {}
    bool operator==(const TextureWraps&) const = default;
};

// The channels of an image that a texture reads: its colours, its channel A, or one of its colours. As a number only: the
// angle from the first axis of the vector (2 R - 1, 2 G - 1), radians.
enum class ImageChannels : std::uint8_t { color, alpha, red, green, blue, angle };

// Texels are filtered first, then scaled (and 1 - x taken when `invert`), then read as a spectrum;
// a float texture uses the mean of the colour channels, or the one channel. `factor` and the colours of vertices are
// applied as the scale is, channel by channel, before the conversion to a spectrum.
struct ImageTexture {
    Index image = no_index; // into Scene::images
    ImageChannels channels = ImageChannels::color;
    TextureMapping mapping;
    TextureFilter filter = TextureFilter::bilinear;
    TextureWraps wrap = TextureWrap::repeat;
    float max_anisotropy = 8;
    float scale = 1;
    bool invert = false;
    RgbMeaning meaning = RgbMeaning::albedo; // for spectrum textures
    const RgbColorSpace* color_space = &RgbColorSpace::srgb();
    Vec3f factor{1, 1, 1};
    bool vertex_colors = false; // times those of the mesh; as a number, times the opacities
    // Of a normal map: its second axis is n x dp/du, on whichever side dp/dv is.
    bool right_handed = false;
};
// The colours of a mesh's vertices times a factor, an albedo; as a number, the opacities of its vertices times factor.x.
struct VertexColorTexture {
    Vec3f factor{1, 1, 1};
};
// 1 where `input` is at least `edge`, else 0.
struct StepTexture {
    FloatParameter input{};
    float edge = 0.5f;
};

template <typename Parameter>
struct ConstantTexture {
    Parameter value;
};
template <typename Parameter>
struct ScaleTexture {
    Parameter texture;
    FloatParameter scale;
};
// (1 - amount) first + amount second
template <typename Parameter>
struct MixTexture {
    Parameter first, second;
    FloatParameter amount;
};
// Unit cells of alternating value, in (s, t) or, with dimension 3, in texture space. In (s, t) box-filtered over the
// footprint, unless it is `sharp`.
template <typename Parameter>
struct CheckerboardTexture {
    int dimension = 2;
    TextureMapping mapping;
    std::array<Parameter, 2> values;
    bool sharp = false;
};

// Bilinear between the corners (s, t) of the unit square, and extrapolated beyond; `corners`: v00, v10, v01,
// v11, the digits being s and t.
template <typename Parameter>
struct BilerpTexture {
    TextureMapping mapping;
    std::array<Parameter, 4> corners;
};
// Polka dots in the (s, t) plane: discs in a random choice of the unit cells around integers.
template <typename Parameter>
struct DotsTexture {
    TextureMapping mapping;
    Parameter outside, inside;
};
// a first + (1 - a) second, a = |cos| of the angle between the shading normal and `direction` (unit, world).
template <typename Parameter>
struct DirectionMixTexture {
    Parameter first, second;
    Vec3f direction{0, 1, 0};
};

// Octaves of noise in texture space, without those that the footprint would alias.
// fbm: fractal_noise. wrinkled: turbulence. windy: waves, |fbm(p / 10)| fbm(p), of fixed octaves.
struct NoiseTexture {
    enum class Kind : std::uint8_t { fbm, wrinkled, windy };
    Kind kind = Kind::fbm;
    NoiseOctaves octaves;
    Transform texture_from_world;
};
// The colours of marble in layers along y that fractal noise bends; an albedo.
struct MarbleTexture {
    NoiseOctaves octaves;
    float scale = 1, variation = 0.2f;
    Transform texture_from_world;
};
template <typename Parameter>
using ProceduralTexture =
    std::conditional_t<std::is_same_v<Parameter, FloatParameter>, NoiseTexture, MarbleTexture>;

template <typename Parameter, typename... Others>
using TextureVariant =
    std::variant<ConstantTexture<Parameter>, ImageTexture, ScaleTexture<Parameter>, MixTexture<Parameter>,
                 CheckerboardTexture<Parameter>, BilerpTexture<Parameter>, DotsTexture<Parameter>,
                 DirectionMixTexture<Parameter>, ProceduralTexture<Parameter>, VertexColorTexture, Others...>;
// A step is a texture of numbers only.
template <typename Parameter>
using TextureNode =
    std::conditional_t<std::is_same_v<Parameter, FloatParameter>, TextureVariant<FloatParameter, StepTexture>,
                       TextureVariant<SpectrumParameter>>;
using FloatTexture = TextureNode<FloatParameter>;
using SpectrumTexture = TextureNode<SpectrumParameter>;
static_assert(std::is_trivially_copyable_v<FloatTexture> && std::is_trivially_copyable_v<SpectrumTexture>);

// visit(name, input) for everything that a texture refers to: parameters, or itself if it reads an image.
template <typename Texture, typename Visit>
void visit_inputs(const Texture& texture, Visit&& visit) {
    using Parameter =
        std::conditional_t<std::is_same_v<Texture, FloatTexture>, FloatParameter, SpectrumParameter>;
    std::visit(Overloaded{[&](const ConstantTexture<Parameter>& t) { visit("value", t.value); },
                          [&](const ImageTexture& t) { visit("image", t); },
                          [&](const ScaleTexture<Parameter>& t) {
                              visit("texture", t.texture);
                              visit("scale", t.scale);
                          },
                          [&](const MixTexture<Parameter>& t) {
                              visit("first", t.first);
                              visit("second", t.second);
                              visit("amount", t.amount);
                          },
                          [&](const CheckerboardTexture<Parameter>& t) {
                              visit("first value", t.values[0]);
                              visit("second value", t.values[1]);
                          },
                          [&](const BilerpTexture<Parameter>& t) {
                              for (const Parameter& corner : t.corners) visit("corner", corner);
                          },
                          [&](const DotsTexture<Parameter>& t) {
                              visit("outside", t.outside);
                              visit("inside", t.inside);
                          },
                          [&](const DirectionMixTexture<Parameter>& t) {
                              visit("first", t.first);
                              visit("second", t.second);
                          },
                          [](const ProceduralTexture<Parameter>&) {}, [](const VertexColorTexture&) {},
                          [&](const StepTexture& t) { visit("input", t.input); }},
               texture);
}

} // namespace montelux
