#include "montelux/formats/gltf/surface_material.h"

#include <optional>
#include <string>
#include <vector>

namespace montelux::gltf {
namespace {

// RGB of a factor with alpha.
Vec3f color_factor(const Value& base, const std::string& key) {
    const std::optional<Value> factors = base.find(key);
    if (!factors) return {1, 1, 1};
    const std::vector<double> f = factors->numbers(4);
    for (std::size_t i = 0; i < 4; ++i)
        if (!(f[i] >= 0 && f[i] <= 1)) (*factors)[i].error(shown_number(f[i]) + " is not between 0 and 1");
    return Vec3f(Vec3d(f[0], f[1], f[2]));
}

// Members that end in "Texture", but for one that has no effect.
void add_textures(const Value& object, std::vector<Value>& found) {
    for (const std::string& key : object.keys())
        if (key.ends_with("Texture") && key != "occlusionTexture") found.push_back(object.required(key));
}

// Every textureInfo of a material: its own, and those of its extensions.
std::vector<Value> textures_of(const Value& source) {
    std::vector<Value> found;
    add_textures(source, found);
    if (const std::optional<Value> base = source.find("pbrMetallicRoughness")) add_textures(*base, found);
    if (const std::optional<Value> extensions = source.find("extensions"))
        for (const std::string& name : extensions->keys())
            if (name.starts_with("KHR_materials_")) add_textures(extensions->required(name), found);
    return found;
}

} // namespace

UvSets uv_sets_of(const Value& source) {
    const std::vector<Value> found = textures_of(source);
    if (found.empty()) return {};
    const Value* chosen = &found.front();
    const bool emits = !source.extension("KHR_materials_unlit") && source.find("emissiveTexture");
    for (const Value& info : found)
        if (info.pointer().ends_with(emits ? "/emissiveTexture" : "/baseColorTexture") ||
            (!emits && info.pointer().ends_with("/diffuseTexture")))
            chosen = &info;
    UvSets sets{TextureLibrary::uv_set(*chosen), {}};
    for (const Value& info : found) {
        const std::uint64_t set = TextureLibrary::uv_set(info);
        if (set == sets.first || set == sets.second) continue;
        if (sets.second)
            info.warn("uses TEXCOORD_" + std::to_string(set) +
                      ", the third set of the material; it gets TEXCOORD_" + std::to_string(sets.first));
        else
            sets.second = set;
    }
    return sets;
}

namespace {

// The parameters of one material; a factor in [0, 1] times a channel of a texture, by their keys.
class SurfaceReader {
  public:
    SurfaceReader(const Value& source, const Value& base, TextureLibrary& textures, SceneBuilder& builder)
        : source_(source), base_(base), textures_(textures), builder_(builder) {}

    PrincipledMaterial read(bool vertices) {
        if (const std::optional<Value> glossy = source_.extension(specular_glossiness))
            read_specular_glossiness(*glossy, vertices);
        else
            read_metallic_roughness(vertices);
        if (const std::optional<Value> normals = source_.find("normalTexture"))
            m_.detail.normal_map = textures_.normal_map(*normals);
        with("KHR_materials_ior", [&](const Value& e) {
            m_.ior = {static_cast<float>(e.number("ior", 1.5, 0))};
            if (m_.ior.value > 0 && m_.ior.value < 1)
                e.required("ior").error("an index of refraction below 1");
        });
        with("KHR_materials_specular", [&](const Value& e) {
            m_.specular = number(e, "specular", 1, ImageChannels::alpha);
            m_.specular_color = color(e, "specularColor", {1, 1, 1}, RgbMeaning::unbounded);
        });
        with("KHR_materials_clearcoat", [&](const Value& e) {
            m_.clearcoat = number(e, "clearcoat", 0, ImageChannels::red);
            m_.clearcoat_roughness = number(e, "clearcoatRoughness", 0, ImageChannels::green);
            if (const std::optional<Value> normals = e.find("clearcoatNormalTexture"))
                m_.clearcoat_normal_map = textures_.normal_map(*normals);
        });
        with("KHR_materials_sheen", [&](const Value& e) {
            m_.sheen_color = color(e, "sheenColor", {0, 0, 0}, RgbMeaning::albedo);
            m_.sheen_roughness = number(e, "sheenRoughness", 0, ImageChannels::alpha);
        });
        with("KHR_materials_anisotropy", [&](const Value& e) { read_anisotropy(e); });
        with("KHR_materials_iridescence", [&](const Value& e) { read_iridescence(e); });
        read_transmission();
        return m_;
    }

  private:
    template <typename Read>
    void with(std::string_view extension, const Read& read) {
        if (const std::optional<Value> found = source_.extension(extension)) read(*found);
    }
    static float unit(const Value& at, const std::string& key, double otherwise) {
        return static_cast<float>(at.number(key, otherwise, 0, 1));
    }
    // `name`Factor and `name`Texture.
    FloatParameter number(const Value& at, const std::string& name, double otherwise, ImageChannels channel) {
        return textures_.number(at.find(name + "Texture"), unit(at, name + "Factor", otherwise), channel);
    }
    // The same of a colour, of any size.
    SpectrumParameter color(const Value& at, const std::string& name, Vec3f otherwise, RgbMeaning meaning) {
        return textures_.color(at.find(name + "Texture"), at.color(name + "Factor", otherwise), meaning);
    }
    FloatParameter add(const FloatTexture& node) {
        std::vector<FloatTexture>& all = builder_.scene().float_textures;
        all.push_back(node);
        return {0, static_cast<Index>(all.size() - 1)};
    }

    void read_metallic_roughness(bool vertices) {
        m_.base_color = textures_.color(base_.find("baseColorTexture"),
                                        color_factor(base_, "baseColorFactor"), RgbMeaning::albedo, vertices);
        const std::optional<Value> map = base_.find("metallicRoughnessTexture");
        m_.metallic = textures_.number(map, unit(base_, "metallicFactor", 1), ImageChannels::blue);
        m_.roughness = textures_.number(map, unit(base_, "roughnessFactor", 1), ImageChannels::green);
    }

    // A dielectric of infinite index, whose reflectance along the normal is the specular colour; roughness is 1 -
    // glossiness (KHR_materials_ior, "Conversion from specular-glossiness").
    void read_specular_glossiness(const Value& e, bool vertices) {
        m_.base_color = textures_.color(e.find("diffuseTexture"), color_factor(e, "diffuseFactor"),
                                        RgbMeaning::albedo, vertices);
        m_.metallic = {0};
        m_.ior = {0};
        const std::optional<Value> map = e.find("specularGlossinessTexture");
        m_.specular_color = textures_.color(map, e.color("specularFactor", {1, 1, 1}), RgbMeaning::albedo);
        const float glossiness = unit(e, "glossinessFactor", 1);
        m_.roughness = {1 - glossiness};
        if (map)
            m_.roughness = add(MixTexture<FloatParameter>{
                {1}, {1 - glossiness}, textures_.number(map, 1, ImageChannels::alpha)});
    }

    // R and G of the texture are the direction, B the strength.
    void read_anisotropy(const Value& e) {
        const std::optional<Value> map = e.find("anisotropyTexture");
        m_.anisotropy = textures_.number(map, unit(e, "anisotropyStrength", 0), ImageChannels::blue);
        const auto rotation = static_cast<float>(e.number("anisotropyRotation", 0));
        m_.anisotropy_rotation = {rotation};
        if (!map) return;
        const FloatParameter angle = textures_.number(map, 1, ImageChannels::angle);
        // Their sum, as twice their mean.
        m_.anisotropy_rotation = rotation == 0
                                     ? angle
                                     : add(ScaleTexture<FloatParameter>{
                                           add(MixTexture<FloatParameter>{{rotation}, angle, {0.5f}}), {2}});
    }

    void read_iridescence(const Value& e) {
        m_.iridescence = number(e, "iridescence", 0, ImageChannels::red);
        m_.iridescence_ior = {static_cast<float>(e.number("iridescenceIor", 1.3, 1))};
        const auto thinnest = static_cast<float>(e.number("iridescenceThicknessMinimum", 100, 0)),
                   thickest = static_cast<float>(e.number("iridescenceThicknessMaximum", 400, 0));
        m_.iridescence_thickness = {thickest};
        if (const std::optional<Value> map = e.find("iridescenceThicknessTexture"))
            m_.iridescence_thickness = add(MixTexture<FloatParameter>{
                {thinnest}, {thickest}, textures_.number(map, 1, ImageChannels::green)});
    }

    // Without a thickness the surface is a sheet.
    void read_transmission() {
        bool transmits = false;
        with("KHR_materials_transmission", [&](const Value& e) {
            transmits = true;
            m_.transmission = number(e, "transmission", 0, ImageChannels::red);
        });
        with("KHR_materials_diffuse_transmission", [&](const Value& e) {
            transmits = true;
            m_.diffuse_transmission = number(e, "diffuseTransmission", 0, ImageChannels::alpha);
            m_.diffuse_transmission_color =
                color(e, "diffuseTransmissionColor", {1, 1, 1}, RgbMeaning::albedo);
        });
        with("KHR_materials_dispersion",
             [&](const Value& e) { m_.dispersion = {static_cast<float>(e.number("dispersion", 0, 0))}; });
        const std::optional<Value> volume = source_.extension("KHR_materials_volume");
        const bool thick = volume && volume->number("thicknessFactor", 0, 0) > 0;
        m_.thin_walled = transmits && !thick;
    }

    const Value& source_;
    const Value& base_;
    TextureLibrary& textures_;
    SceneBuilder& builder_;
    PrincipledMaterial m_;
};

} // namespace

Material make_surface_material(const Value& source, const Value& base, TextureLibrary& textures,
                               SceneBuilder& builder, bool vertices) {
    return SurfaceReader(source, base, textures, builder).read(vertices);
}

} // namespace montelux::gltf
