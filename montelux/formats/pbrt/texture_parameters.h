// The parameters of pbrt's textures that stand alone: encodings, spaces, wraps, channels, noise.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <type_traits>

#include "montelux/formats/pbrt/textures.h"

namespace montelux::pbrt {

// "sRGB", "linear" or "gamma" with a number; empty for others.
std::optional<ColorEncoding> parse_encoding(const std::string& name);
// An Error if the transformation is beyond single precision.
Transform texture_space(ParameterReader& r, const TextureDeclaration& d);
// 'dir' in the world, of unit length.
Vec3f mix_direction(ParameterReader& r, const TextureDeclaration& d);
NoiseOctaves noise_octaves(ParameterReader& r);
// Empty without the parameter.
std::optional<Vec3f> color_factor(ParameterReader& r);
TextureWrap wrap_named(std::string_view name);
// Of images: the channels that are read; empty where the picture decides, as in pbrt-v4.
std::optional<ImageChannels> channels_asked(ParameterReader& r);
// pbrt-v4 takes alpha for the value of a float texture in this case only.
bool has_transparency(const Image& picture);

// "fbm", "wrinkled", "windy" or "marble", whose type fits that of the texture.
template <typename Texture>
Texture procedural_texture(ParameterReader& r, const TextureDeclaration& d) {
    Texture t;
    t.texture_from_world = texture_space(r, d);
    if (d.plugin != "windy") t.octaves = noise_octaves(r);
    if constexpr (std::is_same_v<Texture, MarbleTexture>) {
        t.scale = r.number("scale", 1);
        t.variation = r.number("variation", 0.2f);
    } else {
        t.kind = d.plugin == "fbm"     ? NoiseTexture::Kind::fbm
                 : d.plugin == "windy" ? NoiseTexture::Kind::windy
                                       : NoiseTexture::Kind::wrinkled;
    }
    return t;
}

} // namespace montelux::pbrt
