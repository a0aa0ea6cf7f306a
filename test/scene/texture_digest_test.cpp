// Digests of textures: every value of every kind counts, and the pixels of their pictures.
#include "test/scene/scene_digest_testing.h"
#include <gtest/gtest.h>

#include "montelux/scene/scene_digest.h"

namespace montelux {
namespace {

using testing::expect_changes;

TEST(SceneDigest, TexturesCount) {
    auto image = [](Scene& s) -> ImageTexture& { return std::get<ImageTexture>(s.spectrum_textures[0]); };
    expect_changes(&SceneDigest::textures,
                   {[](Scene& s) { s.images[0].u8()[5] = 1; },
                    [](Scene& s) { s.normal_maps[0].wrap = TextureWrap::clamp; },
                    [](Scene& s) { s.normal_maps[0].right_handed = true; },
                    [](Scene& s) { s.images[0].set_encoding(ColorEncoding::linear()); },
                    [](Scene& s) { s.images[0].set_encoding(ColorEncoding::gamma(2)); },
                    [](Scene& s) { s.images[0] = s.images[0].to_linear_f32(); },
                    [](Scene& s) {
                        s.images[0] = Image(4, 1, {"R", "G", "B"}, PixelFormat::u8, ColorEncoding::srgb());
                    },
                    [=](Scene& s) { image(s).filter = TextureFilter::ewa; },
                    [=](Scene& s) { image(s).wrap = TextureWrap::clamp; },
                    [=](Scene& s) {
                        image(s).wrap = {TextureWrap::repeat, TextureWrap::mirror};
                    },
                    [=](Scene& s) {
                        image(s).factor = {1, 0.5f, 1};
                    },
                    [=](Scene& s) { image(s).vertex_colors = true; },
                    [=](Scene& s) { image(s).channels = ImageChannels::alpha; },
                    [=](Scene& s) { image(s).max_anisotropy = 2; },
                    [=](Scene& s) { image(s).scale = 2; },
                    [=](Scene& s) { image(s).invert = true; },
                    [=](Scene& s) { image(s).meaning = RgbMeaning::unbounded; },
                    [=](Scene& s) { image(s).color_space = &RgbColorSpace::rec2020(); },
                    [=](Scene& s) { image(s).mapping.kind = TextureMapping::Kind::planar; },
                    [=](Scene& s) { image(s).mapping.dv = 1; },
                    [=](Scene& s) { image(s).mapping.second_uv = true; },
                    [=](Scene& s) {
                        image(s).mapping.vt = {1, 1, 1};
                    },
                    [=](Scene& s) {
                        image(s).mapping.texture_from_world = Transform::translate({1, 0, 0});
                    },
                    [](Scene& s) { std::get<0>(s.float_textures[0]).value.value = 3; },
                    [](Scene& s) { std::get<2>(s.float_textures[1]).scale.texture = 0; },
                    [](Scene& s) { std::get<3>(s.spectrum_textures[1]).amount.value = 0; },
                    [](Scene& s) { std::get<4>(s.spectrum_textures[2]).dimension = 3; },
                    [](Scene& s) { std::get<4>(s.spectrum_textures[2]).sharp = true; },
                    [](Scene& s) { std::get<4>(s.spectrum_textures[2]).values[1].value = 0.1f; }});
    const Transform moved = Transform::translate({1, 0, 0});
    auto noise = [](Scene& s) -> NoiseTexture& { return std::get<8>(s.float_textures[2]); };
    auto marble = [](Scene& s) -> MarbleTexture& { return std::get<8>(s.spectrum_textures[6]); };
    expect_changes(&SceneDigest::textures,
                   {[](Scene& s) { std::get<5>(s.spectrum_textures[3]).corners[3].value = 0.1f; },
                    [](Scene& s) { std::get<5>(s.spectrum_textures[3]).mapping.su = 2; },
                    [](Scene& s) { std::get<6>(s.spectrum_textures[4]).outside.value = 0.1f; },
                    [](Scene& s) { std::get<6>(s.spectrum_textures[4]).inside.value = 0.1f; },
                    [](Scene& s) { std::get<6>(s.spectrum_textures[4]).mapping.su = 2; },
                    [](Scene& s) { std::get<7>(s.spectrum_textures[5]).first.value = 0.1f; },
                    [](Scene& s) { std::get<7>(s.spectrum_textures[5]).second.value = 0.1f; },
                    [](Scene& s) {
                        std::get<7>(s.spectrum_textures[5]).direction = {1, 0, 0};
                    },
                    [=](Scene& s) { noise(s).kind = NoiseTexture::Kind::windy; },
                    [=](Scene& s) { noise(s).octaves.octaves = 3; },
                    [=](Scene& s) { noise(s).octaves.roughness = 0.3f; },
                    [=](Scene& s) { noise(s).texture_from_world = moved; },
                    [=](Scene& s) { marble(s).octaves.octaves = 3; },
                    [=](Scene& s) { marble(s).octaves.roughness = 0.3f; },
                    [=](Scene& s) { marble(s).scale = 3; },
                    [=](Scene& s) { marble(s).variation = 3; },
                    [=](Scene& s) { marble(s).texture_from_world = moved; },
                    [](Scene& s) { std::get<9>(s.float_textures[3]).factor.x = 0.5f; },
                    [](Scene& s) { std::get<9>(s.spectrum_textures[7]).factor.z = 0.5f; },
                    [](Scene& s) { std::get<10>(s.float_textures[4]).edge = 0.25f; },
                    [](Scene& s) { std::get<10>(s.float_textures[4]).input.value = 0; }});
}

} // namespace
} // namespace montelux
