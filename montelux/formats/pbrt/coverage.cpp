#include "montelux/formats/pbrt/coverage.h"

#include <algorithm>
#include <map>

#include "montelux/formats/nanovdb_file.h"
#include "montelux/mc/math/nearest_name.h"
#include "montelux/scene/material/material_model.h"

namespace montelux::pbrt {
namespace {

std::vector<PluginCoverage> make_coverage() {
    constexpr Support in_part = Support::in_part, otherwise = Support::otherwise, none = Support::none;
    std::vector<PluginCoverage> all;
    const auto add = [&](std::string_view directive, std::initializer_list<PluginCoverage> plugins) {
        for (PluginCoverage p : plugins) {
            p.directive = directive;
            all.push_back(std::move(p));
        }
    };
    const auto plugin = [](std::string_view name, Support support = Support::full,
                           std::string_view note = {}) {
        return PluginCoverage{{}, std::string(name), support, note};
    };
    constexpr std::string_view by_path = "rendered with the integrator 'path'";
    constexpr std::string_view own = "Montelux's own";
    constexpr std::string_view own_tracer = "the ray tracer builds its own hierarchy";

    add("Film",
        {plugin("rgb"), plugin("gbuffer", Support::full, "as 'rgb', with its layers under names of Montelux"),
         plugin("spectral")});
    add("PixelFilter",
        {plugin("box"), plugin("gaussian"), plugin("mitchell"), plugin("sinc"), plugin("triangle")});
    add("Camera", {plugin("perspective"), plugin("orthographic"), plugin("spherical"), plugin("realistic")});
    add("Sampler",
        {plugin("independent"), plugin("stratified"), plugin("halton"), plugin("sobol"),
         plugin("paddedsobol"), plugin("zsobol"), plugin("pmj02bn", otherwise, "read as 'zsobol'")});
    add("Integrator",
        {plugin("path"), plugin("volpath"), plugin("simplepath"), plugin("randomwalk"),
         plugin("simplevolpath", otherwise, by_path), plugin("bdpt"),
         plugin("mlt", Support::full, "over unidirectional paths"), plugin("sppm", otherwise, by_path),
         plugin("lightpath", otherwise, "without what mirrors and smooth glass show the camera straight"),
         plugin("ambientocclusion"), plugin("ao"), plugin("function", otherwise, by_path)});
    add("Accelerator", {plugin("bvh", otherwise, own_tracer), plugin("kdtree", otherwise, own_tracer)});
    add("ColorSpace", {plugin("srgb"), plugin("dci-p3"), plugin("rec2020"), plugin("aces2065-1")});
    add("Shape", {plugin("sphere"), plugin("disk"), plugin("cylinder"), plugin("bilinearmesh"),
                  plugin("curve"), plugin("trianglemesh"), plugin("loopsubdiv"), plugin("plymesh")});
    for_each_material_kind([&]<typename M>(std::type_identity<M>) {
        const std::string type = material_type(M::name);
        add("Material", {plugin(type)});
    });
    add("Texture",
        {plugin("constant"), plugin("imagemap"), plugin("scale"), plugin("mix"), plugin("directionmix"),
         plugin("checkerboard"), plugin("bilerp"), plugin("dots"), plugin("fbm"), plugin("marble"),
         plugin("windy"), plugin("wrinkled"), plugin("vertexcolor", Support::full, own),
         plugin("step", Support::full, own), plugin("ptex", none)});
    add("LightSource", {plugin("point"), plugin("spot"), plugin("distant"), plugin("infinite"),
                        plugin("goniometric"), plugin("projection"), plugin("sky", Support::full, own)});
    add("AreaLightSource", {plugin("diffuse")});
    add("MakeNamedMedium",
        {plugin("homogeneous"), plugin("uniformgrid"), plugin("rgbgrid"), plugin("cloud"),
         NanovdbFile::reads_blosc
             ? plugin("nanovdb")
             : plugin("nanovdb", in_part, "compression by Blosc is refused: built without it")});
    return all;
}

} // namespace

std::string material_type(std::string_view name) {
    std::string result;
    for (char c : name) result += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    return result;
}

std::span<const PluginCoverage> plugin_coverage() {
    static const std::vector<PluginCoverage> all = make_coverage();
    return all;
}

std::span<const std::string_view> plugin_names(std::string_view directive) {
    static const std::map<std::string_view, std::vector<std::string_view>> names = [] {
        std::map<std::string_view, std::vector<std::string_view>> by_directive;
        for (const PluginCoverage& p : plugin_coverage()) by_directive[p.directive].push_back(p.plugin);
        return by_directive;
    }();
    return names.at(directive);
}

std::string plugin_suggestion(std::string_view directive, std::string_view name) {
    static const std::map<std::string_view, std::vector<std::string_view>> of_version_3{
        {"Film", {"image"}},
        {"Camera", {"environment"}},
        {"Sampler", {"02sequence", "lowdiscrepancy", "maxmindist", "random"}},
        {"Integrator", {"directlighting", "whitted"}},
        {"Shape", {"cone", "heightfield", "hyperboloid", "nurbs", "paraboloid"}},
        {"Material",
         {"disney", "fourier", "glass", "kdsubsurface", "matte", "metal", "mirror", "plastic", "substrate",
          "translucent", "uber"}},
        {"Texture", {"uv"}},
        {"MakeNamedMedium", {"heterogeneous"}}};
    const auto old = of_version_3.find(directive);
    if (old != of_version_3.end() && std::ranges::find(old->second, name) != old->second.end())
        return std::string(how_to_upgrade);
    return did_you_mean(name, plugin_names(directive));
}

bool is_plugin(std::string_view directive, std::string_view name) {
    const std::span<const std::string_view> names = plugin_names(directive);
    return std::find(names.begin(), names.end(), name) != names.end();
}

} // namespace montelux::pbrt
