#include "montelux/formats/mitsuba/textures.h"

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "montelux/scene/build/quoted.h"
#include "montelux/spectrum/rgb_colorspace.h"
#include "montelux/spectrum/wavelengths.h"

namespace montelux::mitsuba {
namespace {

// Limit of texture evaluations per look-up: a texture that two parameters refer to is evaluated twice, which doubles
// with each level.
constexpr std::size_t most_evaluations = 4096;

double mean_of(const Spectrum& spectrum) {
    if (spectrum.is_constant()) return static_cast<double>(spectrum(lambda_min));
    double sum = 0;
    int count = 0;
    for (float lambda = lambda_min; lambda <= lambda_max; ++lambda, ++count)
        sum += static_cast<double>(spectrum(lambda));
    return sum / count;
}

// The texture that a property is; empty for what is the same everywhere.
std::optional<Plugin> texture_of(const Property& property, const SceneGraph& graph) {
    const auto* index = std::get_if<ObjectIndex>(&property.value);
    if (index == nullptr) return std::nullopt;
    const Plugin plugin(graph, index->value);
    return plugin.kind() == "texture" && !is_spectrum(plugin) ? std::optional(plugin) : std::nullopt;
}

} // namespace

FloatParameter TextureLibrary::number(Plugin& owner, std::string_view name, float otherwise,
                                      NumberRange range) {
    std::size_t evaluations = 0;
    return number(owner, name, otherwise, range, evaluations);
}

FloatParameter TextureLibrary::number(Plugin& owner, std::string_view name, float otherwise,
                                      NumberRange range, std::size_t& evaluations) {
    const Property* property = owner.find(name);
    if (property == nullptr) return {otherwise};
    if (const std::optional<Plugin> texture = texture_of(*property, owner.graph())) {
        const Node n = node(*texture, Use::number);
        evaluations += n.evaluations;
        return {0, n.index};
    }
    if (std::holds_alternative<double>(property->value) ||
        std::holds_alternative<std::int64_t>(property->value))
        return {
            static_cast<float>(owner.number(name, static_cast<double>(otherwise), range.least, range.most))};
    return {static_cast<float>(mean_of(spectrum_of(*property, SpectrumUse::unbounded, owner.graph())))};
}

FloatParameter TextureLibrary::number(const Plugin& texture) {
    if (is_spectrum(texture)) {
        const Property value{"value", ObjectIndex{texture.index()}, texture.at()};
        return {static_cast<float>(mean_of(spectrum_of(value, SpectrumUse::unbounded, texture.graph())))};
    }
    return {0, node(texture, Use::number).index};
}

SpectrumParameter TextureLibrary::spectrum(Plugin& owner, std::string_view name, float otherwise,
                                           SpectrumUse use) {
    std::size_t evaluations = 0;
    return spectrum(owner, name, otherwise, use, evaluations);
}

SpectrumParameter TextureLibrary::spectrum(Plugin& owner, std::string_view name, float otherwise,
                                           SpectrumUse use, std::size_t& evaluations) {
    const Property* property = owner.find(name);
    if (property == nullptr) return {builder_.add_spectrum(Spectrum(otherwise))};
    if (const std::optional<Plugin> texture = texture_of(*property, owner.graph())) {
        const Node n = node(*texture, use == SpectrumUse::reflectance ? Use::reflectance : Use::unbounded);
        evaluations += n.evaluations;
        return {{}, n.index};
    }
    return {builder_.add_spectrum(spectrum_of(*property, use, owner.graph()))};
}

FloatParameter TextureLibrary::product(const FloatParameter& a, const FloatParameter& b) {
    if (a.is_constant() && b.is_constant()) return {a.value * b.value};
    if (a.is_constant() && a.value == 1) return b;
    if (b.is_constant() && b.value == 1) return a;
    return {0, add(FloatTexture(ScaleTexture<FloatParameter>{a, b}))};
}

FloatParameter TextureLibrary::complement(const FloatParameter& a) {
    if (a.is_constant()) return {1 - a.value};
    return {0, add(FloatTexture(MixTexture<FloatParameter>{{1}, {0}, a}))};
}

Index TextureLibrary::add(const FloatTexture& texture) {
    std::vector<FloatTexture>& all = builder_.scene().float_textures;
    all.push_back(texture);
    return static_cast<Index>(all.size() - 1);
}
Index TextureLibrary::add(const SpectrumTexture& texture) {
    std::vector<SpectrumTexture>& all = builder_.scene().spectrum_textures;
    all.push_back(texture);
    return static_cast<Index>(all.size() - 1);
}

TextureLibrary::Node TextureLibrary::node(const Plugin& texture, Use use) {
    const auto key = std::pair(texture.index(), use);
    if (const auto known = nodes_.find(key); known != nodes_.end()) return known->second;
    const Node made = make(texture, use);
    if (made.evaluations > most_evaluations)
        texture.error("one look-up of this texture would evaluate more than " +
                      std::to_string(most_evaluations) + " textures: it refers to others too often");
    return nodes_[key] = made;
}

TextureLibrary::Node TextureLibrary::make(const Plugin& texture, Use use) {
    if (texture.type() == "bitmap") return {image(texture, use)};
    if (texture.type() == "checkerboard") return checkerboard(texture, use);
    if (texture.type() == "mesh_attribute") return {vertex_colors(texture, use)};
    texture.refuse();
}

// Cells have sides of 1/2 and are not filtered. Mitsuba gives color0 to the cells at the origin, but color1 where it is asked for a number.
TextureLibrary::Node TextureLibrary::checkerboard(Plugin texture, Use use) {
    const TextureMapping mapping = uv_mapping(texture, false, 2);
    Node made;
    if (use == Use::number) {
        CheckerboardTexture<FloatParameter> t{.mapping = mapping, .values = {}, .sharp = true};
        t.values[1] = number(texture, "color0", 0.4f, {}, made.evaluations);
        t.values[0] = number(texture, "color1", 0.2f, {}, made.evaluations);
        made.index = add(FloatTexture(t));
    } else {
        const SpectrumUse colors =
            use == Use::reflectance ? SpectrumUse::reflectance : SpectrumUse::unbounded;
        CheckerboardTexture<SpectrumParameter> t{.mapping = mapping, .values = {}, .sharp = true};
        t.values[0] = spectrum(texture, "color0", 0.4f, colors, made.evaluations);
        t.values[1] = spectrum(texture, "color1", 0.2f, colors, made.evaluations);
        made.index = add(SpectrumTexture(t));
    }
    texture.finish();
    return made;
}

Index TextureLibrary::image(const Plugin& bitmap, Use use) {
    ImageTexture t = pictures_.texture(bitmap);
    if (use != Use::number) {
        t.meaning = use == Use::reflectance ? RgbMeaning::albedo : RgbMeaning::unbounded;
        return add(SpectrumTexture(t));
    }
    // The mean of the channels is then the luminance.
    if (pictures_.has_colors(t)) t.factor = 3 * Vec3f(RgbColorSpace::srgb().luminance_weights());
    return add(FloatTexture(t));
}

Index TextureLibrary::vertex_colors(Plugin texture, Use use) {
    const std::string attribute = texture.text("name", "");
    if (attribute != "vertex_color" || use != Use::reflectance)
        texture.error("the attribute " + in_quotes(attribute) +
                      " is not supported; only the reflectance by 'vertex_color' is");
    const float scale = static_cast<float>(texture.number("scale", 1, 0));
    texture.finish();
    return add(SpectrumTexture(VertexColorTexture{{scale, scale, scale}}));
}

} // namespace montelux::mitsuba
