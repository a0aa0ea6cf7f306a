// The values of textures and of their pictures.
#pragma once

#include "montelux/image/image.h"
#include "montelux/scene/digest/scene_hasher.h"
#include "montelux/scene/texture/texture.h"

namespace montelux {

template <typename Value>
void hash_parameter(SceneHasher& h, const Value& value, Index texture) {
    h.all(texture);
    if (texture == no_index) h.all(value); // ignored if there is a texture
}
inline void hash_values(SceneHasher& h, const FloatParameter& p) {
    const auto& [value, texture] = p;
    hash_parameter(h, value, texture);
}
inline void hash_values(SceneHasher& h, const SpectrumParameter& p) {
    const auto& [value, texture] = p;
    hash_parameter(h, value, texture);
}
inline void hash_values(SceneHasher& h, const TextureMapping& m) {
    const auto& [kind, su, sv, du, dv, vs, vt, texture_from_world, second_uv] = m;
    h.all(kind, su, sv, du, dv, vs, vt, texture_from_world);
    if (second_uv) h.all(second_uv);
}
inline void hash_values(SceneHasher& h, const ImageTexture& t) {
    const auto& [image, channels, mapping, filter, wrap, anisotropy, scale, invert, meaning, space, factor,
                 vertex_colors, right_handed] = t;
    h.all(image, channels, mapping, filter, wrap.s, anisotropy, scale, invert, meaning, space);
    // As far as they are not what they were before there were others.
    if (wrap.t != wrap.s) h.all(wrap.t);
    if (!(factor == Vec3f{1, 1, 1}) || vertex_colors) h.all(factor, vertex_colors);
    if (right_handed) h.all(right_handed);
}
inline void hash_values(SceneHasher& h, const VertexColorTexture& t) {
    const auto& [factor] = t;
    h.all(factor);
}
inline void hash_values(SceneHasher& h, const StepTexture& t) {
    const auto& [input, edge] = t;
    h.all(input, edge);
}
template <typename Parameter>
void hash_values(SceneHasher& h, const ConstantTexture<Parameter>& t) {
    const auto& [value] = t;
    h.all(value);
}
template <typename Parameter>
void hash_values(SceneHasher& h, const ScaleTexture<Parameter>& t) {
    const auto& [texture, scale] = t;
    h.all(texture, scale);
}
template <typename Parameter>
void hash_values(SceneHasher& h, const MixTexture<Parameter>& t) {
    const auto& [first, second, amount] = t;
    h.all(first, second, amount);
}
template <typename Parameter>
void hash_values(SceneHasher& h, const CheckerboardTexture<Parameter>& t) {
    const auto& [dimension, mapping, values, sharp] = t;
    h.all(dimension, mapping, values);
    if (sharp) h.all(sharp);
}
template <typename Parameter>
void hash_values(SceneHasher& h, const BilerpTexture<Parameter>& t) {
    const auto& [mapping, corners] = t;
    h.all(mapping, corners);
}
template <typename Parameter>
void hash_values(SceneHasher& h, const DotsTexture<Parameter>& t) {
    const auto& [mapping, outside, inside] = t;
    h.all(mapping, outside, inside);
}
template <typename Parameter>
void hash_values(SceneHasher& h, const DirectionMixTexture<Parameter>& t) {
    const auto& [first, second, direction] = t;
    h.all(first, second, direction);
}
inline void hash_values(SceneHasher& h, const NoiseOctaves& n) {
    const auto& [octaves, roughness] = n;
    h.all(octaves, roughness);
}
inline void hash_values(SceneHasher& h, const NoiseTexture& t) {
    const auto& [kind, octaves, texture_from_world] = t;
    h.all(kind, octaves, texture_from_world);
}
inline void hash_values(SceneHasher& h, const MarbleTexture& t) {
    const auto& [octaves, scale, variation, texture_from_world] = t;
    h.all(octaves, scale, variation, texture_from_world);
}
// Pixels only, without the header.
inline void hash_values(SceneHasher& h, const Image& image) {
    h.all(image.width(), image.height(), image.format(), image.encoding().kind(), image.encoding().exponent(),
          static_cast<std::uint64_t>(image.channels()));
    for (const std::string& name : image.channel_names()) h.all(std::string_view(name));
    h.all(image.u8(), image.u16(), image.f32());
    image.give_back();
}

} // namespace montelux
