// "measured" and "hair".
#include <optional>
#include <string>

#include "montelux/formats/measured_brdf_file.h"
#include "montelux/formats/mitsuba/basic_materials.h"
#include "montelux/formats/mitsuba/refractive_index.h"
#include "montelux/mc/math/error.h"
#include "montelux/scene/material/hair_material.h"
#include "montelux/scene/material/measured_material.h"

namespace montelux::mitsuba {
namespace {

Index measured_brdf(Plugin& bsdf, MaterialContext& context) {
    const std::filesystem::path path = bsdf.file("filename");
    const std::string key = path.lexically_normal().string();
    if (const auto known = context.measured_brdfs.find(key); known != context.measured_brdfs.end())
        return known->second;
    const SourceLocation at = bsdf.find("filename")->at;
    const std::vector<std::uint8_t> bytes = bsdf.graph().files.read(path, at);
    std::vector<MeasuredBrdf>& all = context.builder.scene().measured_brdfs;
    try {
        all.push_back(read_measured_brdf(bytes, path.string()));
    } catch (const Error& e) {
        bsdf.graph().diagnostics.error(at, e.what());
    }
    return context.measured_brdfs[key] = static_cast<Index>(all.size() - 1);
}

// The two pigments or the absorption itself, which `scale` multiplies.
HairColorParameter hair_color(Plugin& bsdf, MaterialContext& context) {
    HairColorParameter color;
    const double scale = bsdf.number("scale", 1, 0);
    if (!bsdf.has("sigma_a")) {
        color.eumelanin = {static_cast<float>(bsdf.number("eumelanin", 1.3, 0))};
        color.pheomelanin = {static_cast<float>(bsdf.number("pheomelanin", 0.2, 0))};
        return color;
    }
    if (bsdf.has("eumelanin") || bsdf.has("pheomelanin"))
        bsdf.error("'sigma_a' together with pigments; expected one or the other");
    color.source = HairColorParameter::absorption;
    color.sigma_a = context.textures.spectrum(bsdf, "sigma_a", 0, SpectrumUse::unbounded);
    if (scale != 1) {
        std::vector<SpectrumTexture>& all = context.builder.scene().spectrum_textures;
        all.emplace_back(ScaleTexture<SpectrumParameter>{color.sigma_a, {static_cast<float>(scale)}});
        color.sigma_a = {{}, static_cast<Index>(all.size() - 1)};
    }
    return color;
}

} // namespace

std::optional<BasicMaterial> read_measured(Plugin& bsdf, MaterialContext& context) {
    if (bsdf.type() == "measured") {
        MeasuredMaterial m;
        m.brdf.index = measured_brdf(bsdf, context);
        return BasicMaterial{m, true};
    }
    if (bsdf.type() != "hair") return std::nullopt;
    HairMaterial m;
    m.color = hair_color(bsdf, context);
    m.eta = {static_cast<float>(index_of_interface(bsdf, "amber"))};
    if (!(m.eta.value >= 1)) bsdf.error("'int_ior' is below 'ext_ior', which is not supported for hair");
    const auto roughness = [&](std::string_view name) {
        return FloatParameter{static_cast<float>(bsdf.number(name, 0.3, 0, 1))};
    };
    m.beta_m = roughness("longitudinal_roughness");
    m.beta_n = roughness("azimuthal_roughness");
    m.alpha = {static_cast<float>(bsdf.number("scale_tilt", 2, -90, 90))};
    return BasicMaterial{m};
}

} // namespace montelux::mitsuba
