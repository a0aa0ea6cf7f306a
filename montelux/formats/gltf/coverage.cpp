#include "montelux/formats/gltf/coverage.h"

#include <algorithm>
#include <vector>

#include "montelux/formats/gltf/draco.h"
#include "montelux/formats/gltf/meshopt.h"
#include "montelux/image/image_read.h"

namespace montelux::gltf {
namespace {

using enum Support;

// Of what an optional library reads.
FeatureCoverage with(bool is_there, FeatureCoverage feature, std::string_view otherwise) {
    return is_there ? feature : FeatureCoverage{feature.area, feature.feature, none, otherwise};
}

const std::vector<FeatureCoverage>& table() {
    static const std::vector<FeatureCoverage> features{
        {"file", ".gltf", full, "data URIs, and files in its folder and below"},
        {"file", ".glb"},
        with(reads_meshopt(), {"file", "EXT_meshopt_compression"},
             "Montelux was built without libmeshoptimizer"),
        {"file", "KHR_meshopt_compression", none},
        with(reads_draco(), {"file", "KHR_draco_mesh_compression"}, "Montelux was built without libdraco"),
        {"accessor", "all types", full, "normalised, sparse, with strides"},
        {"accessor", "KHR_mesh_quantization"},
        {"mesh", "triangles, strips, fans"},
        {"mesh", "points, lines", none},
        {"mesh", "NORMAL", full, "flat without it"},
        {"mesh", "TANGENT", full, "along u without it"},
        {"mesh", "TEXCOORD_n", in_part, "two sets for the textures of a material"},
        {"mesh", "COLOR_0"},
        {"mesh", "morph targets", full, "of positions, normals and tangents, at one time"},
        {"mesh", "skins", full, "at one time"},
        {"node", "matrix, translation, rotation, scale"},
        {"node", "EXT_mesh_gpu_instancing"},
        {"node", "KHR_node_visibility", full, "of meshes and lights, at rest"},
        {"node", "scenes", full, "the default one, or the first one"},
        {"node", "animations", full, "at one time: --time-of-scene; without motion blur"},
        {"camera", "perspective", full, "without znear and zfar"},
        {"camera", "orthographic", full, "without znear and zfar"},
        {"light", "KHR_lights_punctual", in_part, "'range' is ignored; cones fall off by a smoothstep"},
        {"texture", "PNG, JPEG"},
        {"texture", "samplers", in_part, "magFilter alone decides; minified textures are always filtered"},
        {"texture", "KHR_texture_transform", full, "not of emissive pictures"},
        with(reads_webp(), {"texture", "EXT_texture_webp"},
             "Montelux was built without libwebp; the fallback picture is used if there is one"),
        {"texture", "KHR_texture_basisu", none,
         "Debian 12 has no decoder; the fallback picture is used if there is one"},
        {"material", "pbrMetallicRoughness"},
        {"material", "normalTexture"},
        {"material", "occlusionTexture", none, "light transport computes it"},
        {"material", "emissiveTexture", full, "lights its surroundings; by texture coordinates in [0, 1]"},
        {"material", "alphaMode"},
        {"material", "doubleSided", in_part, "decides which sides emit; every surface is seen from both"},
        {"material", "KHR_materials_anisotropy"},
        {"material", "KHR_materials_clearcoat"},
        {"material", "KHR_materials_diffuse_transmission"},
        {"material", "KHR_materials_dispersion"},
        {"material", "KHR_materials_emissive_strength"},
        {"material", "KHR_materials_ior"},
        {"material", "KHR_materials_iridescence"},
        {"material", "KHR_materials_pbrSpecularGlossiness", full, "in place of pbrMetallicRoughness"},
        {"material", "KHR_materials_sheen"},
        {"material", "KHR_materials_specular"},
        {"material", "KHR_materials_transmission", full, "a sheet without KHR_materials_volume"},
        {"material", "KHR_materials_unlit", in_part, "an emitter, which lights its surroundings"},
        {"material", "KHR_materials_variants", full, "--variant"},
        {"material", "KHR_materials_volume", in_part, "absorption; the shape itself is the thickness"},
    };
    return features;
}

} // namespace

std::span<const FeatureCoverage> feature_coverage() { return table(); }

const FeatureCoverage* find_feature(std::string_view name) {
    const auto found = std::ranges::find(table(), name, &FeatureCoverage::feature);
    return found == table().end() ? nullptr : &*found;
}

bool is_supported_extension(std::string_view name) {
    const FeatureCoverage* const feature = find_feature(name);
    return feature != nullptr && feature->support != Support::none;
}

} // namespace montelux::gltf
