#include "montelux/formats/gltf/materials.h"

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "montelux/formats/gltf/surface_material.h"
#include "montelux/mc/math/nearest_name.h"

namespace montelux::gltf {
namespace {

// Of a file without materials, and of primitives without one: the defaults of all values.
const nlohmann::json& no_json() {
    static const nlohmann::json empty = nlohmann::json::object();
    return empty;
}

std::optional<std::uint64_t> find_variant(const Value& root, const std::optional<std::string>& name) {
    if (!name) return std::nullopt;
    const std::vector<std::string> names = variant_names(root);
    std::string list;
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (names[i] == *name) return i;
        list += (i == 0 ? "" : ", ") + in_quotes(names[i]);
    }
    const std::vector<std::string_view> views(names.begin(), names.end());
    root.error("there is no variant " + in_quotes(*name) + did_you_mean(*name, views) +
               (names.empty() ? "; the file has none" : "; expected " + list));
}

FloatParameter alpha_of(const Value& source, const Value& base, TextureLibrary& textures,
                        SceneBuilder& builder, const VertexColorKinds& vertices) {
    const std::string mode = source.text("alphaMode", "OPAQUE");
    constexpr auto modes = std::to_array<std::string_view>({"OPAQUE", "MASK", "BLEND"});
    if (std::ranges::find(modes, std::string_view(mode)) == modes.end())
        source.required("alphaMode").error("unknown mode " + in_quotes(mode) + did_you_mean(mode, modes));
    if (mode == "OPAQUE") return {1};
    const std::optional<Value> glossy = source.extension(specular_glossiness);
    const Value& colors = glossy ? *glossy : base;
    const std::string name = glossy ? "diffuse" : "baseColor";
    const std::optional<Value> factors = colors.find(name + "Factor");
    const auto factor = factors ? static_cast<float>(factors->numbers(4)[3]) : 1.0f;
    const FloatParameter alpha =
        textures.number(colors.find(name + "Texture"), factor, ImageChannels::alpha, vertices.opacities);
    if (mode == "BLEND") return alpha;
    const auto cutoff = static_cast<float>(source.number("alphaCutoff", 0.5, 0));
    if (alpha.is_constant()) return {alpha.value >= cutoff ? 1.0f : 0.0f};
    std::vector<FloatTexture>& all = builder.scene().float_textures;
    all.emplace_back(StepTexture{alpha, cutoff});
    return {0, static_cast<Index>(all.size() - 1)};
}

// Emission as large as linear RGB says: 1 is 1 cd/m^2.
std::optional<Emission> emission_of(const std::optional<Value>& texture, Vec3f rgb, bool two_sided,
                                    TextureLibrary& textures, SceneBuilder& builder) {
    if (rgb == Vec3f{0, 0, 0}) return std::nullopt;
    Emission e;
    const RgbColorSpace& srgb = RgbColorSpace::srgb();
    const Spectrum spectrum =
        texture ? Spectrum(srgb.illuminant()) : Spectrum(RgbIlluminantSpectrum(srgb, rgb));
    e.spectrum = builder.add_spectrum(spectrum);
    e.scale = photometric_scale(spectrum);
    e.two_sided = two_sided;
    if (texture) e.picture = textures.emission(*texture, rgb);
    return e;
}

// KHR_materials_volume: absorption by Beer's law, of which `attenuationColor` is left after `attenuationDistance`.
Index medium_of(const Value& source, SceneBuilder& builder) {
    const std::optional<Value> volume = source.extension("KHR_materials_volume");
    if (!volume || !(volume->number("thicknessFactor", 0, 0) > 0)) return no_index;
    const Vec3f color = volume->color("attenuationColor", {1, 1, 1});
    const std::optional<Value> distance = volume->find("attenuationDistance");
    if (!distance || color == Vec3f{1, 1, 1}) return no_index;
    const auto d = static_cast<float>(distance->number(0));
    if (!(d > 0)) distance->error("0 is no distance");
    constexpr float darkest = 1e-6f; // black would be an infinite coefficient
    const auto absorption = [&](float c) {
        if (c > 1) volume->required("attenuationColor").error("a component above 1");
        return -std::log(std::max(c, darkest));
    };
    HomogeneousMedium medium;
    medium.sigma_a = builder.add_spectrum(RgbUnboundedSpectrum(
        RgbColorSpace::srgb(), {absorption(color.x), absorption(color.y), absorption(color.z)}));
    medium.sigma_s = 0.0f;
    medium.scale = 1 / d;
    builder.scene().media.emplace_back(medium);
    return static_cast<Index>(builder.scene().media.size() - 1);
}

} // namespace

std::vector<std::string> variant_names(const Value& root) {
    std::vector<std::string> names;
    if (const std::optional<Value> all = root.extension("KHR_materials_variants"))
        for (const Value& variant : all->elements("variants")) names.push_back(variant.text("name", ""));
    return names;
}

MaterialLibrary::MaterialLibrary(Document& document, SceneBuilder& builder,
                                 const std::optional<std::string>& variant, bool pictures)
    : document_(document), builder_(builder), textures_(document, builder, pictures),
      variant_(find_variant(document.root(), variant)) {}

std::optional<Value> MaterialLibrary::material_of(const Value& primitive) const {
    if (variant_)
        if (const std::optional<Value> variants = primitive.extension("KHR_materials_variants"))
            for (const Value& mapping : variants->elements("mappings"))
                for (const Value& variant : mapping.elements("variants"))
                    if (variant.whole() == *variant_) return mapping.required("material");
    return primitive.find("material");
}

const SurfaceLook& MaterialLibrary::of(const Value& primitive) {
    constexpr std::uint64_t default_material = ~std::uint64_t{0};
    const std::optional<Value> index = material_of(primitive);
    const VertexColorKinds vertices = vertex_colors_of(document_, primitive);
    const auto [known, is_new] = made_.try_emplace({index ? index->whole() : default_material, vertices});
    if (is_new)
        known->second = make(
            index ? std::optional(document_.refer(*index, "materials", "material")) : std::nullopt, vertices);
    return known->second;
}

SurfaceLook MaterialLibrary::make(const std::optional<Value>& given, const VertexColorKinds& vertices) {
    const Value source = given ? *given : Value(no_json(), "", document_.diagnostics());
    const Value base =
        source.find("pbrMetallicRoughness").value_or(Value(no_json(), "", document_.diagnostics()));
    const bool two_sided = source.boolean("doubleSided", false);
    SurfaceLook look;
    look.uv_sets = uv_sets_of(source);
    textures_.use(look.uv_sets);
    look.alpha = alpha_of(source, base, textures_, builder_, vertices);
    Material material;
    if (source.extension("KHR_materials_unlit")) {
        // What it shows is what it emits.
        if (vertices.colors) source.warn("KHR_materials_unlit: the colours of vertices are ignored");
        const std::optional<Value> factors = base.find("baseColorFactor");
        Vec3f rgb{1, 1, 1};
        if (factors) {
            const std::vector<double> f = factors->numbers(4);
            rgb = max(Vec3f(Vec3d(f[0], f[1], f[2])), Vec3f{0, 0, 0});
        }
        look.emission = emission_of(base.find("baseColorTexture"), rgb, two_sided, textures_, builder_);
        material = DiffuseMaterial{.reflectance = {0.0f}};
    } else {
        const std::optional<Value> strength = source.extension("KHR_materials_emissive_strength");
        const auto factor = static_cast<float>(strength ? strength->number("emissiveStrength", 1, 0) : 1);
        look.emission =
            emission_of(source.find("emissiveTexture"), source.color("emissiveFactor", {0, 0, 0}) * factor,
                        two_sided, textures_, builder_);
        look.medium_inside = medium_of(source, builder_);
        material = make_surface_material(source, base, textures_, builder_, vertices.colors);
    }
    Scene& scene = builder_.scene();
    look.material = static_cast<Index>(scene.materials.size());
    scene.materials.push_back(material);
    if (const std::string name = source.text("name", ""); !name.empty()) {
        scene.material_names.resize(scene.materials.size());
        scene.material_names.back() = name;
    }
    return look;
}

} // namespace montelux::gltf
