#include "montelux/formats/pbrt/textures.h"

#include <cmath>
#include <type_traits>
#include <utility>

#include "montelux/formats/pbrt/coverage.h"
#include "montelux/formats/pbrt/texture_parameters.h"
#include "montelux/image/image_read.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/math/nearest_name.h"
#include "montelux/scene/build/float_range.h"

namespace montelux::pbrt {
namespace {

// Limit of the depth of texture trees: look-ups are recursive.
constexpr std::size_t most_nested = 64;
// Limit of texture evaluations per look-up: a texture that two parameters refer to is evaluated twice, which
// doubles with each level.
constexpr std::size_t most_evaluations = 4096;

std::string label(const TextureDeclaration& d) { return "texture " + in_quotes(d.plugin); }

} // namespace

void TextureLibrary::declare(std::string_view type, const std::string& name, TextureDeclaration declaration) {
    if (type != "float" && type != "spectrum")
        diagnostics_.error(declaration.at, "texture " + in_quotes(name) + " has type " + in_quotes(type) +
                                               "; expected 'float' or 'spectrum'");
    if (!is_plugin("Texture", declaration.plugin))
        diagnostics_.error(declaration.at, "unknown texture " + in_quotes(declaration.plugin) +
                                               plugin_suggestion("Texture", declaration.plugin));
    const bool only_float = declaration.plugin == "fbm" || declaration.plugin == "windy" ||
                            declaration.plugin == "wrinkled" || declaration.plugin == "step";
    if (only_float || declaration.plugin == "marble")
        if (const std::string_view only = only_float ? "float" : "spectrum"; type != only)
            diagnostics_.error(declaration.at, "texture " + in_quotes(declaration.plugin) + " has type " +
                                                   in_quotes(type) + "; expected " + in_quotes(only));
    Table& table = type == "float" ? float_ : spectrum_;
    Location at = declaration.at;
    std::size_t order = float_.size() + spectrum_.size() + 1;
    if (!table.emplace(name, Entry{std::move(declaration), order}).second)
        diagnostics_.error(at, std::string(type) + " texture " + in_quotes(name) + " is defined twice");
}

TextureLibrary::Entry& TextureLibrary::look_up(const Parameter& p, Table& table, const Table& other,
                                               const char* type) {
    if (p.strings.size() != 1)
        diagnostics_.error(p.at, "parameter " + in_quotes(p.name) + " has " +
                                     std::to_string(p.strings.size()) +
                                     " values; expected 1 name of a texture");
    const std::string& name = p.strings[0];
    auto found = table.find(name);
    if (found == table.end()) {
        if (other.contains(name))
            diagnostics_.error(p.at, "texture " + in_quotes(name) + " is not a " + type +
                                         " texture, which parameter " + in_quotes(p.name) + " needs");
        std::vector<std::string_view> names;
        for (const auto& entry : table) names.push_back(entry.first);
        if (names.size() > 10000) names.clear();
        diagnostics_.error(p.at, std::string("there is no ") + type + " texture " + in_quotes(name) +
                                     did_you_mean(name, names));
    }
    if (resolving_ > 0 && found->second.order >= resolving_order_)
        diagnostics_.error(p.at,
                           "texture " + in_quotes(name) + " is not defined before the texture that uses it");
    return found->second;
}

std::optional<FloatParameter> TextureLibrary::find_float(ParameterReader& r, std::string_view name) {
    const Parameter* p = r.any(name, {ParameterType::texture, ParameterType::floating});
    if (!p) return std::nullopt;
    if (p->type == ParameterType::texture)
        return FloatParameter{0, resolve_float(look_up(*p, float_, spectrum_, "float"))};
    return FloatParameter{r.number_of(*p)};
}

std::optional<SpectrumParameter> TextureLibrary::find_spectrum(ParameterReader& r, std::string_view name,
                                                               RgbMeaning meaning) {
    const Parameter* p = r.any(name, {ParameterType::texture, ParameterType::rgb, ParameterType::spectrum,
                                      ParameterType::blackbody});
    if (!p) return std::nullopt;
    if (p->type == ParameterType::texture)
        return SpectrumParameter{{}, resolve_spectrum(look_up(*p, spectrum_, float_, "spectrum"), meaning)};
    return SpectrumParameter{builder_.add_spectrum(spectra_.read(*p, meaning))};
}

Index TextureLibrary::resolve_float(Entry& entry) {
    if (entry.nodes[0] == no_index) {
        FloatTexture node = make_node<FloatParameter>(entry, RgbMeaning::unbounded);
        builder_.scene().float_textures.push_back(std::move(node));
        entry.nodes[0] = static_cast<Index>(builder_.scene().float_textures.size() - 1);
    }
    evaluations_ += entry.evaluations;
    return entry.nodes[0];
}

Index TextureLibrary::resolve_spectrum(Entry& entry, RgbMeaning meaning) {
    Index& index = entry.nodes[static_cast<std::size_t>(meaning)];
    if (index == no_index) {
        SpectrumTexture node = make_node<SpectrumParameter>(entry, meaning);
        builder_.scene().spectrum_textures.push_back(std::move(node));
        index = static_cast<Index>(builder_.scene().spectrum_textures.size() - 1);
    }
    evaluations_ += entry.evaluations;
    return index;
}

template <typename Parameter>
Parameter TextureLibrary::input(ParameterReader& r, std::string_view name, RgbMeaning meaning,
                                float otherwise) {
    if constexpr (std::is_same_v<Parameter, FloatParameter>)
        return float_or(r, name, otherwise);
    else
        return spectrum_or(r, name, meaning, otherwise);
}

template <typename Parameter>
TextureNode<Parameter> TextureLibrary::make_node(Entry& entry, RgbMeaning meaning) {
    const TextureDeclaration& d = entry.declaration;
    if (d.plugin == "ptex") diagnostics_.error(d.at, label(d) + " is not supported yet");
    if (resolving_ >= most_nested)
        diagnostics_.error(d.at, "textures refer to one another more than " + std::to_string(most_nested) +
                                     " levels deep");
    std::size_t outer = std::exchange(resolving_order_, entry.order);
    std::size_t outer_evaluations = std::exchange(evaluations_, 1);
    ++resolving_;
    ParameterReader r(d.parameters, label(d), d.at, diagnostics_);
    TextureNode<Parameter> node;
    if (d.plugin == "constant") {
        node = ConstantTexture<Parameter>{input<Parameter>(r, "value", meaning, 1)};
    } else if (d.plugin == "imagemap") {
        ImageTexture t = image_texture(r, d, meaning);
        if constexpr (std::is_same_v<Parameter, FloatParameter>) {
            const bool transparent = has_transparency(builder_.scene().images[t.image]);
            t.channels =
                channels_asked(r).value_or(transparent ? ImageChannels::alpha : ImageChannels::color);
        }
        node = std::move(t);
    } else if (d.plugin == "vertexcolor") {
        node = VertexColorTexture{color_factor(r).value_or(Vec3f(1, 1, 1))};
    } else if (d.plugin == "scale") {
        Parameter texture = input<Parameter>(r, "tex", meaning, 1);
        node = ScaleTexture<Parameter>{std::move(texture), float_or(r, "scale", 1)};
    } else if (d.plugin == "mix") {
        Parameter first = input<Parameter>(r, "tex1", meaning, 0);
        Parameter second = input<Parameter>(r, "tex2", meaning, 1);
        node = MixTexture<Parameter>{std::move(first), std::move(second), float_or(r, "amount", 0.5f)};
    } else if (d.plugin == "bilerp") {
        BilerpTexture<Parameter> t{mapping(r, d), {}};
        constexpr std::array<std::string_view, 4> names = {"v00", "v10", "v01", "v11"};
        for (std::size_t i = 0; i < names.size(); ++i)
            t.corners[i] = input<Parameter>(r, names[i], meaning, i < 2 ? 0.0f : 1.0f);
        node = t;
    } else if (d.plugin == "dots") {
        const TextureMapping m = mapping(r, d);
        Parameter inside = input<Parameter>(r, "inside", meaning, 1);
        node = DotsTexture<Parameter>{m, input<Parameter>(r, "outside", meaning, 0), inside};
    } else if (d.plugin == "directionmix") {
        Parameter first = input<Parameter>(r, "tex1", meaning, 0);
        Parameter second = input<Parameter>(r, "tex2", meaning, 1);
        node = DirectionMixTexture<Parameter>{first, second, mix_direction(r, d)};
    } else if (d.plugin == "step") {
        if constexpr (std::is_same_v<Parameter, FloatParameter>)
            node = StepTexture{float_or(r, "tex", 1), r.number("edge", 0.5f)};
    } else if (d.plugin != "checkerboard") {
        node = procedural_texture<ProceduralTexture<Parameter>>(r, d);
    } else {
        CheckerboardTexture<Parameter> c;
        c.dimension = r.integer("dimension", 2);
        if (c.dimension != 2 && c.dimension != 3)
            r.error("dimension",
                    "parameter 'dimension' is " + std::to_string(c.dimension) + "; expected 2 or 3");
        if (c.dimension == 2)
            c.mapping = mapping(r, d);
        else
            c.mapping.texture_from_world = texture_space(r, d);
        c.values[0] = input<Parameter>(r, "tex1", meaning, 1);
        c.values[1] = input<Parameter>(r, "tex2", meaning, 0);
        c.sharp = r.boolean("sharp", false);
        node = std::move(c);
    }
    r.finish();
    --resolving_;
    resolving_order_ = outer;
    entry.evaluations = std::exchange(evaluations_, outer_evaluations);
    if (entry.evaluations > most_evaluations)
        diagnostics_.error(d.at, "one look-up of this texture would evaluate more than " +
                                     std::to_string(most_evaluations) +
                                     " textures: it refers to others too often");
    return node;
}

TextureMapping TextureLibrary::mapping(ParameterReader& r, const TextureDeclaration& d) {
    TextureMapping m;
    std::string_view kind = r.choice("mapping", {"uv", "spherical", "cylindrical", "planar", "affine"}, "uv");
    if (kind != "uv" && kind != "affine") m.texture_from_world = texture_space(r, d);
    if (kind == "uv" || kind == "affine") m.second_uv = r.boolean("seconduv", false);
    if (kind == "uv") {
        m.su = r.number("uscale", 1);
        m.sv = r.number("vscale", 1);
    } else if (kind == "planar" || kind == "affine") {
        m.kind = kind == "planar" ? TextureMapping::Kind::planar : TextureMapping::Kind::affine;
        m.vs = r.vector3("v1").value_or(Vec3f(1, 0, 0));
        m.vt = r.vector3("v2").value_or(Vec3f(0, 1, 0));
    } else {
        m.kind = kind == "spherical" ? TextureMapping::Kind::spherical : TextureMapping::Kind::cylindrical;
        return m;
    }
    m.du = r.number("udelta", 0);
    m.dv = r.number("vdelta", 0);
    return m;
}

ImageTexture TextureLibrary::image_texture(ParameterReader& r, const TextureDeclaration& d,
                                           RgbMeaning meaning) {
    ImageTexture t;
    t.meaning = meaning;
    t.mapping = mapping(r, d);
    std::string_view filter =
        r.choice("filter", {"bilinear", "point", "trilinear", "ewa", "EWA"}, "bilinear");
    t.filter = filter == "bilinear"    ? TextureFilter::bilinear
               : filter == "point"     ? TextureFilter::point
               : filter == "trilinear" ? TextureFilter::trilinear
                                       : TextureFilter::ewa;
    const std::string_view wrap =
        r.choice("wrap", {"repeat", "black", "clamp", "octahedralsphere", "mirror"}, "repeat");
    t.wrap = wrap_named(wrap);
    if (wrap != "octahedralsphere")
        t.wrap = {wrap_named(r.choice("swrap", {"repeat", "black", "clamp", "mirror"}, wrap)),
                  wrap_named(r.choice("twrap", {"repeat", "black", "clamp", "mirror"}, wrap))};
    t.max_anisotropy = r.number("maxanisotropy", 8);
    if (!(t.max_anisotropy >= 1)) r.error("maxanisotropy", "parameter 'maxanisotropy' is below 1");
    t.scale = r.number("scale", 1);
    t.invert = r.boolean("invert", false);
    t.factor = color_factor(r).value_or(t.factor);
    t.vertex_colors = r.boolean("vertexcolors", false);
    t.right_handed = r.boolean("righthanded", false);
    std::optional<std::string> file = r.string("filename");
    if (!file) r.error("texture 'imagemap' needs a parameter 'filename'");
    t.image = image(*file, r.string("encoding"), r.at("filename"));
    return t;
}

Index TextureLibrary::image(const std::string& file, const std::optional<std::string>& encoding,
                            Location at) {
    std::optional<ColorEncoding> asked;
    if (encoding) {
        asked = parse_encoding(*encoding);
        if (!asked)
            diagnostics_.error(at, "encoding " + in_quotes(*encoding) +
                                       " is unknown; expected 'sRGB', 'linear' or 'gamma' with a number");
    }
    std::filesystem::path path = files_.find(file, at);
    std::string key = path.string() + '\0' + encoding.value_or("");
    if (auto known = images_.find(key); known != images_.end()) return known->second;
    std::vector<std::uint8_t> bytes = files_.read(path, at);
    try {
        Image picture = read_image(bytes, path.string());
        const bool integers = picture.format() == PixelFormat::u8 || picture.format() == PixelFormat::u16;
        if (asked && integers) picture.set_encoding(*asked);
        return images_[key] = builder_.add_image(std::move(picture), path.string(), at);
    } catch (const LocatedError&) {
        throw;
    } catch (const Error& e) {
        diagnostics_.error(at, e.what());
    }
}

Index TextureLibrary::normal_map(const std::string& file, Location at) {
    const Index picture = image(file, "linear", at);
    if (builder_.scene().images[picture].color_channels().size() != 3)
        diagnostics_.error(at, "normal map " + in_quotes(file) + " has no channels R, G and B");
    const auto [known, is_new] =
        normal_maps_.emplace(picture, static_cast<Index>(builder_.scene().normal_maps.size()));
    if (is_new) builder_.scene().normal_maps.push_back({.image = picture, .mapping = {}});
    return known->second;
}

Index TextureLibrary::normal_map(const Parameter& texture) {
    Entry& entry = look_up(texture, spectrum_, float_, "spectrum");
    if (entry.normal_map != no_index) return entry.normal_map;
    if (entry.declaration.plugin != "imagemap")
        diagnostics_.error(texture.at, "a map of normals is a texture of the kind 'imagemap'");
    const auto node = make_node<SpectrumParameter>(entry, RgbMeaning::unbounded);
    std::vector<ImageTexture>& all = builder_.scene().normal_maps;
    all.push_back(std::get<ImageTexture>(node));
    const Image& picture = builder_.scene().images[all.back().image];
    if (picture.color_channels().size() != 3)
        diagnostics_.error(texture.at, "the picture of normals has no channels R, G and B");
    if (all.back().scale != 1 || all.back().invert || all.back().vertex_colors)
        diagnostics_.error(texture.at, "a map of normals has no scale, no inversion and no vertex colours");
    return entry.normal_map = static_cast<Index>(all.size() - 1);
}

void TextureLibrary::warn_of_unused() {
    for (const Table* table : {&float_, &spectrum_})
        for (const auto& [name, entry] : *table)
            if (entry.normal_map == no_index &&
                std::all_of(entry.nodes.begin(), entry.nodes.end(), [](Index i) { return i == no_index; }))
                diagnostics_.warn(entry.declaration.at,
                                  "texture " + in_quotes(name) + " is not used and was not read");
}

} // namespace montelux::pbrt
