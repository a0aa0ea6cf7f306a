#include "montelux/formats/mitsuba/coverage.h"

#include <algorithm>
#include <array>

namespace montelux::mitsuba {
namespace {

using enum Support;

constexpr std::string_view polarized = "the polarization of light is not rendered";
constexpr std::string_view by_path = "rendered with the integrator 'path'";
constexpr std::string_view own_sampler = "Sobol' points take its place";
constexpr std::string_view no_clipping = "the clipping planes have no effect";
constexpr std::string_view hidden = "hide_emitters hides the environment alone";

constexpr auto all_plugins = std::to_array<PluginCoverage>({
    {"shape", "obj"},
    {"shape", "ply"},
    {"shape", "serialized"},
    {"shape", "sphere"},
    {"shape", "rectangle"},
    {"shape", "disk"},
    {"shape", "cube"},
    {"shape", "cylinder"},
    {"shape", "bsplinecurve", in_part, "ribbons that face each ray, shaded as tubes"},
    {"shape", "linearcurve", in_part, "as bsplinecurve, without round joints and ends"},
    {"shape", "shapegroup"},
    {"shape", "instance"},
    {"shape", "merge"},
    {"shape", "sdfgrid", none},
    {"shape", "ellipsoids", none},
    {"shape", "ellipsoidsmesh", none},
    {"bsdf", "diffuse"},
    {"bsdf", "dielectric"},
    {"bsdf", "thindielectric"},
    {"bsdf", "roughdielectric"},
    {"bsdf", "conductor"},
    {"bsdf", "roughconductor"},
    {"bsdf", "hair"},
    {"bsdf", "measured"},
    {"bsdf", "plastic"},
    {"bsdf", "roughplastic"},
    {"bsdf", "bumpmap", in_part, "not within another"},
    {"bsdf", "normalmap", in_part, "not within another"},
    {"bsdf", "blendbsdf"},
    {"bsdf", "mask"},
    {"bsdf", "twosided"},
    {"bsdf", "null"},
    {"bsdf", "principled"},
    {"bsdf", "principledthin"},
    {"bsdf", "polarizer", none, polarized},
    {"bsdf", "retarder", none, polarized},
    {"bsdf", "circular", none, polarized},
    {"bsdf", "measured_polarized", none, polarized},
    {"bsdf", "pplastic", none, polarized},
    {"emitter", "area"},
    {"emitter", "point"},
    {"emitter", "constant"},
    {"emitter", "envmap"},
    {"emitter", "spot"},
    {"emitter", "projector", in_part, "colours and pictures"},
    {"emitter", "directional"},
    {"emitter", "directionalarea", none, "paths from the camera cannot meet its light"},
    {"emitter", "sunsky", otherwise, "our own model of the sky"},
    {"emitter", "timed_sunsky", none},
    {"sensor", "perspective", in_part, no_clipping},
    {"sensor", "thinlens", in_part, no_clipping},
    {"sensor", "orthographic", in_part, no_clipping},
    {"sensor", "radiancemeter", none},
    {"sensor", "irradiancemeter", none},
    {"sensor", "distant", none},
    {"sensor", "batch", none},
    {"film", "hdrfilm"},
    {"film", "specfilm", otherwise, "the picture is RGB"},
    {"rfilter", "box"},
    {"rfilter", "tent"},
    {"rfilter", "gaussian"},
    {"rfilter", "mitchell"},
    {"rfilter", "catmullrom"},
    {"rfilter", "lanczos"},
    {"sampler", "independent"},
    {"sampler", "stratified"},
    {"sampler", "multijitter", otherwise, own_sampler},
    {"sampler", "orthogonal", otherwise, own_sampler},
    {"sampler", "ldsampler", otherwise, own_sampler},
    {"integrator", "path", in_part, hidden},
    {"integrator", "direct", in_part, hidden},
    {"integrator", "volpath", in_part, hidden},
    {"integrator", "volpathmis", in_part, hidden},
    {"integrator", "depth", otherwise, by_path},
    {"integrator", "aov", otherwise, "the integrator within; --layers chooses the layers"},
    {"integrator", "moment", otherwise, "the integrator within; every pixel has its standard error"},
    {"integrator", "ptracer", otherwise, by_path},
    {"integrator", "stokes", none, polarized},
    {"texture", "bitmap"},
    {"texture", "checkerboard"},
    {"texture", "mesh_attribute", in_part, "'vertex_color' as a reflectance"},
    {"texture", "volume", none},
    {"texture", "uniform"},
    {"texture", "regular"},
    {"texture", "irregular"},
    {"texture", "srgb"},
    {"texture", "d65"},
    {"texture", "blackbody"},
    {"texture", "rawconstant"},
    {"medium", "homogeneous"},
    {"medium", "heterogeneous"},
    {"phase", "isotropic"},
    {"phase", "hg"},
    {"phase", "rayleigh"},
    {"phase", "sggx", none},
    {"phase", "tabphase", none},
    {"phase", "blendphase", none},
    {"volume", "constvolume"},
    {"volume", "gridvolume", in_part, "files of 1 or 3 channels"},
});

} // namespace

std::span<const PluginCoverage> plugin_coverage() { return all_plugins; }

std::vector<std::string_view> plugin_names(std::string_view kind) {
    std::vector<std::string_view> names;
    for (const PluginCoverage& p : all_plugins)
        if (p.kind == kind) names.push_back(p.plugin);
    return names;
}

const PluginCoverage* find_plugin(std::string_view kind, std::string_view plugin) {
    const auto found = std::ranges::find_if(
        all_plugins, [&](const PluginCoverage& p) { return p.kind == kind && p.plugin == plugin; });
    return found == all_plugins.end() ? nullptr : &*found;
}

} // namespace montelux::mitsuba
