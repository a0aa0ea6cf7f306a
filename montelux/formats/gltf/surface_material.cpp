#include "montelux/formats/gltf/surface_material.h"

#include <optional>
#include <string>
#include <vector>

namespace montelux::gltf {
namespace {

Vec3f base_color_factor(const Value& base) {
    const std::optional<Value> factors = base.find("baseColorFactor");
    if (!factors) return {1, 1, 1};
    const std::vector<double> f = factors->numbers(4);
    for (std::size_t i = 0; i < 4; ++i)
        if (!(f[i] >= 0 && f[i] <= 1)) (*factors)[i].error(shown_number(f[i]) + " is not between 0 and 1");
    return Vec3f(Vec3d(f[0], f[1], f[2]));
}

// Members that end in "Texture".
void add_textures(const Value& object, std::vector<Value>& found) {
    for (const std::string& key : object.keys())
        if (key.ends_with("Texture")) found.push_back(object.required(key));
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

std::uint64_t uv_set_of(const Value& source) {
    const std::vector<Value> found = textures_of(source);
    if (found.empty()) return 0;
    const Value* chosen = &found.front();
    for (const Value& info : found)
        if (info.pointer().ends_with("/baseColorTexture")) chosen = &info;
    const std::uint64_t set = TextureLibrary::uv_set(*chosen);
    for (const Value& info : found)
        if (TextureLibrary::uv_set(info) != set)
            info.warn("uses TEXCOORD_" + std::to_string(TextureLibrary::uv_set(info)) +
                      "; the material's textures all use TEXCOORD_" + std::to_string(set));
    return set;
}

Material make_surface_material(const Value& source, const Value& base, TextureLibrary& textures,
                               SceneBuilder&, bool vertices) {
    source.diagnostics().warn_once("diffuse", source.pointer(),
                                   "materials are diffuse: their metal and roughness are not read yet");
    DiffuseMaterial m;
    m.reflectance =
        textures.color(base.find("baseColorTexture"), base_color_factor(base), RgbMeaning::albedo, vertices);
    if (const std::optional<Value> map = source.find("normalTexture"))
        m.detail.normal_map = textures.normal_map(*map);
    return m;
}

} // namespace montelux::gltf
