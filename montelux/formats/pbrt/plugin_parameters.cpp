#include "montelux/formats/pbrt/plugin_parameters.h"

#include <algorithm>

namespace montelux::pbrt {
namespace {

constexpr std::string_view shape_parameters[] = {"N",           "P",
                                                 "S",           "alpha",
                                                 "basis",       "colors",
                                                 "degree",      "displacement",
                                                 "edgelength",  "emissionfilename",
                                                 "faceIndices", "filename",
                                                 "height",      "indices",
                                                 "innerradius", "levels",
                                                 "name",        "opacities",
                                                 "phimax",      "radius",
                                                 "scheme",      "splitdepth",
                                                 "type",        "uv",
                                                 "uv2",         "vertexcolors",
                                                 "width",       "width0",
                                                 "width1",      "zmax",
                                                 "zmin"};

constexpr std::string_view light_parameters[] = {
    "I",     "L",     "azimuth",      "conedeltaangle", "coneangle",   "elevation", "filename",
    "fov",   "from",  "groundalbedo", "group",          "illuminance", "layout",    "portal",
    "power", "scale", "sun",          "sundisc",        "to",          "turbidity", "twosided"};

constexpr std::string_view material_parameters[] = {"albedo",
                                                    "alpha",
                                                    "amount",
                                                    "anisotropic",
                                                    "anisotropy",
                                                    "anisotropyrotation",
                                                    "back",
                                                    "basecolor",
                                                    "beta_m",
                                                    "beta_n",
                                                    "clearcoat",
                                                    "clearcoatgloss",
                                                    "clearcoatnormalmap",
                                                    "clearcoatroughness",
                                                    "color",
                                                    "conductor.eta",
                                                    "conductor.k",
                                                    "conductor.roughness",
                                                    "conductor.uroughness",
                                                    "conductor.vroughness",
                                                    "diffusetransmission",
                                                    "diffusetransmissioncolor",
                                                    "dispersion",
                                                    "displacement",
                                                    "distribution",
                                                    "eta",
                                                    "eumelanin",
                                                    "filename",
                                                    "flatness",
                                                    "front",
                                                    "g",
                                                    "interface.eta",
                                                    "interface.roughness",
                                                    "interface.uroughness",
                                                    "interface.vroughness",
                                                    "internalreflectance",
                                                    "ior",
                                                    "iridescence",
                                                    "iridescenceior",
                                                    "iridescencethickness",
                                                    "k",
                                                    "materials",
                                                    "maxdepth",
                                                    "metallic",
                                                    "mfp",
                                                    "name",
                                                    "nonlinear",
                                                    "normalmap",
                                                    "nsamples",
                                                    "pheomelanin",
                                                    "reflectance",
                                                    "remaproughness",
                                                    "roughness",
                                                    "scale",
                                                    "sheen",
                                                    "sheencolor",
                                                    "sheenroughness",
                                                    "sheentint",
                                                    "shadowed",
                                                    "sigma_a",
                                                    "sigma_s",
                                                    "specular",
                                                    "specularcolor",
                                                    "specularreflectance",
                                                    "speculartint",
                                                    "speculartransmission",
                                                    "speculartransmittance",
                                                    "thickness",
                                                    "thinwalled",
                                                    "transmission",
                                                    "transmittance",
                                                    "type",
                                                    "uroughness",
                                                    "vroughness"};

constexpr std::string_view medium_parameters[] = {"Le",
                                                  "LeScale",
                                                  "Lescale",
                                                  "alpha",
                                                  "density",
                                                  "filename",
                                                  "frequency",
                                                  "g",
                                                  "gridname",
                                                  "nx",
                                                  "ny",
                                                  "nz",
                                                  "p0",
                                                  "p1",
                                                  "preset",
                                                  "scale",
                                                  "sigma_a",
                                                  "sigma_s",
                                                  "temperature",
                                                  "temperaturecutoff",
                                                  "temperaturename",
                                                  "temperatureoffset",
                                                  "temperaturescale",
                                                  "type",
                                                  "wispiness"};

constexpr std::string_view texture_parameters[] = {
    "amount",    "channel", "dimension", "dir",     "edge",          "encoding", "factor",  "filename",
    "filter",    "inside",  "invert",    "mapping", "maxanisotropy", "octaves",  "outside", "righthanded",
    "roughness", "scale",   "seconduv",  "sharp",   "swrap",         "tex",      "tex1",    "tex2",
    "twrap",     "udelta",  "uscale",    "v00",     "v01",           "v1",       "v10",     "v11",
    "v2",        "value",   "variation", "vdelta",  "vertexcolors",  "vscale",   "wrap"};

} // namespace

std::span<const std::string_view> parameter_names(PluginKind kind) {
    switch (kind) {
    case PluginKind::shape:
        return shape_parameters;
    case PluginKind::light:
        return light_parameters;
    case PluginKind::material:
        return material_parameters;
    case PluginKind::medium:
        return medium_parameters;
    case PluginKind::texture:
        return texture_parameters;
    }
    return {};
}

bool has_parameter(PluginKind kind, std::string_view name) {
    std::span<const std::string_view> names = parameter_names(kind);
    return std::find(names.begin(), names.end(), name) != names.end();
}

} // namespace montelux::pbrt
