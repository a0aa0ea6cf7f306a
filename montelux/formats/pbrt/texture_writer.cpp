#include <array>
#include <string>
#include <type_traits>

#include "montelux/formats/pbrt/scene_writer.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/math/overloaded.h"

namespace montelux::pbrt {
void SceneWriter::parameter(DirectiveText& d, std::string_view name, const FloatParameter& p, float otherwise,
                            RgbMeaning) {
    if (!p.is_constant())
        d.texture(name, float_texture(p.texture));
    else if (p.value != otherwise)
        d.number(name, p.value);
}

void SceneWriter::parameter(DirectiveText& d, std::string_view name, const SpectrumParameter& p,
                            float otherwise, RgbMeaning meaning) {
    if (!p.is_constant())
        d.texture(name, spectrum_texture(p.texture, meaning));
    else if (!p.value.is_constant() || p.value.constant != otherwise)
        spectrum(d, name, p.value, meaning, "parameter '" + std::string(name) + "'");
}

void SceneWriter::mapping(DirectiveText& d, std::string& transform, const TextureMapping& m) {
    using Kind = TextureMapping::Kind;
    if (m.kind != Kind::uv && m.kind != Kind::affine)
        transform = transform_text(m.texture_from_world.inverse());
    if (m.kind == Kind::uv) {
        if (m.su != 1) d.number("uscale", m.su);
        if (m.sv != 1) d.number("vscale", m.sv);
    } else if (m.kind == Kind::planar || m.kind == Kind::affine) {
        d.string("mapping", m.kind == Kind::planar ? "planar" : "affine");
        d.vector("vector3", "v1", m.vs);
        d.vector("vector3", "v2", m.vt);
    } else {
        d.string("mapping", m.kind == Kind::spherical ? "spherical" : "cylindrical");
        return;
    }
    if (m.second_uv) d.boolean("seconduv", true);
    if (m.du != 0) d.number("udelta", m.du);
    if (m.dv != 0) d.number("vdelta", m.dv);
}

void SceneWriter::image_texture(DirectiveText& d, std::string& transform, const ImageTexture& t,
                                bool is_float) {
    constexpr std::array filters = {"point", "bilinear", "trilinear", "ewa"};
    constexpr std::array wraps = {"repeat", "black", "clamp", "octahedralsphere", "mirror"};
    constexpr std::array channels = {"color", "alpha", "red", "green", "blue", "angle"};
    d.string("filename", image_file(t.image));
    if (const auto encoding = encoding_of(t.image)) d.string("encoding", *encoding);
    mapping(d, transform, t.mapping);
    if (t.filter != TextureFilter::bilinear) d.string("filter", filters[static_cast<std::size_t>(t.filter)]);
    if (t.wrap.s != t.wrap.t) {
        d.string("swrap", wraps[static_cast<std::size_t>(t.wrap.s)]);
        d.string("twrap", wraps[static_cast<std::size_t>(t.wrap.t)]);
    } else if (t.wrap != TextureWrap::repeat) {
        d.string("wrap", wraps[static_cast<std::size_t>(t.wrap.s)]);
    }
    if (t.max_anisotropy != 8) d.number("maxanisotropy", t.max_anisotropy);
    if (t.scale != 1) d.number("scale", t.scale);
    if (t.invert) d.boolean("invert", true);
    if (t.factor != Vec3f{1, 1, 1}) d.vector("rgb", "factor", t.factor);
    if (t.vertex_colors) d.boolean("vertexcolors", true);
    if (t.right_handed) d.boolean("righthanded", true);
    if (t.color_space != &RgbColorSpace::srgb())
        warn("image " + std::to_string(t.image),
             "its colours are read as sRGB; pbrt takes the space from the file");
    if (!is_float) return;
    // pbrt takes alpha for the value where a coloured picture is transparent anywhere.
    const Image& picture = scene_.images[t.image];
    const auto alpha = picture.find_channel("A");
    bool transparent = false;
    if (alpha && picture.color_channels().size() == 3)
        for (int y = 0; y < picture.height() && !transparent; ++y)
            for (int x = 0; x < picture.width() && !transparent; ++x)
                transparent = picture.value(x, y, *alpha) != 1;
    if (t.channels != (transparent ? ImageChannels::alpha : ImageChannels::color))
        d.string("channel", channels[static_cast<std::size_t>(t.channels)]);
}

template <typename Parameter>
void SceneWriter::texture(const TextureNode<Parameter>& node, const std::string& name, RgbMeaning meaning) {
    constexpr bool is_float = std::is_same_v<Parameter, FloatParameter>;
    std::string transform;
    const auto directive = [&](const char* plugin) {
        return DirectiveText("Texture " + quoted_text(name) + (is_float ? " \"float\" " : " \"spectrum\" ") +
                             quoted_text(plugin));
    };
    DirectiveText d("");
    std::visit(Overloaded{[&](const ConstantTexture<Parameter>& t) {
                              d = directive("constant");
                              parameter(d, "value", t.value, 1, meaning);
                          },
                          [&](const ImageTexture& t) {
                              d = directive("imagemap");
                              image_texture(d, transform, t, is_float);
                          },
                          [&](const ScaleTexture<Parameter>& t) {
                              d = directive("scale");
                              parameter(d, "tex", t.texture, 1, meaning);
                              parameter(d, "scale", t.scale, 1);
                          },
                          [&](const MixTexture<Parameter>& t) {
                              d = directive("mix");
                              parameter(d, "tex1", t.first, 0, meaning);
                              parameter(d, "tex2", t.second, 1, meaning);
                              parameter(d, "amount", t.amount, 0.5f);
                          },
                          [&](const CheckerboardTexture<Parameter>& t) {
                              d = directive("checkerboard");
                              if (t.dimension == 3) {
                                  d.integer("dimension", 3);
                                  transform = transform_text(t.mapping.texture_from_world.inverse());
                              } else {
                                  mapping(d, transform, t.mapping);
                              }
                              parameter(d, "tex1", t.values[0], 1, meaning);
                              parameter(d, "tex2", t.values[1], 0, meaning);
                              if (t.sharp) d.boolean("sharp", true);
                          },
                          [&](const BilerpTexture<Parameter>& t) {
                              d = directive("bilerp");
                              mapping(d, transform, t.mapping);
                              constexpr std::array names = {"v00", "v10", "v01", "v11"};
                              for (std::size_t i = 0; i < 4; ++i)
                                  parameter(d, names[i], t.corners[i], i < 2 ? 0.0f : 1.0f, meaning);
                          },
                          [&](const DotsTexture<Parameter>& t) {
                              d = directive("dots");
                              mapping(d, transform, t.mapping);
                              parameter(d, "inside", t.inside, 1, meaning);
                              parameter(d, "outside", t.outside, 0, meaning);
                          },
                          [&](const DirectionMixTexture<Parameter>& t) {
                              d = directive("directionmix");
                              parameter(d, "tex1", t.first, 0, meaning);
                              parameter(d, "tex2", t.second, 1, meaning);
                              d.vector("vector3", "dir", direction_giving(t.direction, [](Vec3f v) {
                                           return Vec3f(Vec3d(v) / length(Vec3d(v)));
                                       }));
                          },
                          [&](const NoiseTexture& t) {
                              using Kind = NoiseTexture::Kind;
                              d = directive(t.kind == Kind::fbm     ? "fbm"
                                            : t.kind == Kind::windy ? "windy"
                                                                    : "wrinkled");
                              if (t.kind != Kind::windy) {
                                  d.integer("octaves", t.octaves.octaves);
                                  d.number("roughness", t.octaves.roughness);
                              }
                              transform = transform_text(t.texture_from_world.inverse());
                          },
                          [&](const MarbleTexture& t) {
                              d = directive("marble");
                              d.integer("octaves", t.octaves.octaves);
                              d.number("roughness", t.octaves.roughness);
                              d.number("scale", t.scale);
                              d.number("variation", t.variation);
                              transform = transform_text(t.texture_from_world.inverse());
                          },
                          [&](const VertexColorTexture& t) {
                              d = directive("vertexcolor");
                              if (t.factor != Vec3f{1, 1, 1}) d.vector("rgb", "factor", t.factor);
                          },
                          [&](const StepTexture& t) {
                              d = directive("step");
                              parameter(d, "tex", t.input, 1);
                              if (t.edge != 0.5f) d.number("edge", t.edge);
                          }},
               node);
    put_block(transform + d.text());
}

std::string SceneWriter::float_texture(Index i) {
    const std::string name = "float-" + std::to_string(i);
    if (float_textures_.insert(i).second)
        texture<FloatParameter>(scene_.float_textures[i], name, RgbMeaning::albedo);
    return name;
}

bool SceneWriter::is_plain_normal_map(Index i) const {
    const ImageTexture& t = scene_.normal_maps[i];
    const TextureMapping& m = t.mapping;
    const ImageTexture plain;
    return m.kind == TextureMapping::Kind::uv && m.su == 1 && m.sv == 1 && m.du == 0 && m.dv == 0 &&
           !m.second_uv && t.wrap == plain.wrap && t.filter == plain.filter &&
           t.max_anisotropy == plain.max_anisotropy && t.factor == plain.factor && !t.right_handed &&
           encoding_of(t.image).value_or("linear") == "linear";
}

std::string SceneWriter::normal_map_texture(Index i) {
    const std::string name = "normals-" + std::to_string(i);
    if (normal_maps_.insert(i).second)
        texture<SpectrumParameter>(scene_.normal_maps[i], name, RgbMeaning::unbounded);
    return name;
}

std::string SceneWriter::spectrum_texture(Index i, RgbMeaning meaning) {
    const std::string name = "spectrum-" + std::to_string(i);
    if (spectrum_textures_.insert(i).second)
        texture<SpectrumParameter>(scene_.spectrum_textures[i], name, meaning);
    return name;
}

} // namespace montelux::pbrt
