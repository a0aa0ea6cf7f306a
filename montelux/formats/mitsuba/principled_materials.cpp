// "principled" and "principledthin".
#include <cmath>
#include <optional>

#include "montelux/formats/mitsuba/basic_materials.h"
#include "montelux/scene/material/disney_material.h"

namespace montelux::mitsuba {
namespace {

// What both have. `m` is a DisneyMaterial or a DisneyThinMaterial.
template <typename M>
void read_common(M& m, Plugin& bsdf, MaterialContext& context) {
    const auto share = [&](std::string_view name, float otherwise) {
        return context.textures.number(bsdf, name, otherwise, unit_range);
    };
    m.base_color = context.textures.spectrum(bsdf, "base_color", 0.5f, SpectrumUse::reflectance);
    m.roughness = share("roughness", 0.5f);
    m.anisotropic = share("anisotropic", 0);
    m.specular_tint = share("spec_tint", 0);
    m.sheen = share("sheen", 0);
    m.sheen_tint = share("sheen_tint", 0);
    m.flatness = share("flatness", 0);
    m.specular_transmission = share("spec_trans", 0);
    // Steer the sampling alone.
    for (const std::string_view rate :
         {"diffuse_reflectance_sampling_rate", "main_specular_sampling_rate", "clearcoat_sampling_rate",
          "specular_reflectance_sampling_rate", "specular_transmittance_sampling_rate",
          "diffuse_transmittance_sampling_rate"})
        bsdf.skip(rate);
}

// `eta`, or `specular`: 0.08 of it is the reflectance at normal incidence (Burley 2012).
float index_of_solid(Plugin& bsdf, bool transmits) {
    constexpr double least = 0.01, most = 100;
    if (bsdf.has("eta")) {
        if (bsdf.has("specular")) bsdf.error("'eta' together with 'specular'; expected one or the other");
        const double eta = bsdf.number("eta", 1.5, least, most);
        return static_cast<float>(transmits && eta == 1 ? 1.001 : eta);
    }
    double specular = bsdf.number("specular", 0.5, 0, 1);
    if (transmits && specular == 0) specular = 1e-3;
    return static_cast<float>(2 / (1 - std::sqrt(0.08 * specular)) - 1);
}

} // namespace

std::optional<BasicMaterial> read_principled(Plugin& bsdf, MaterialContext& context) {
    if (bsdf.type() == "principledthin") {
        DisneyThinMaterial m;
        read_common(m, bsdf, context);
        constexpr NumberRange index_range{0.01, 100}, of_both_sides{0, 2};
        m.eta = context.textures.number(bsdf, "eta", 1.5f, index_range);
        m.diffuse_transmission =
            context.textures.product({0.5f}, context.textures.number(bsdf, "diff_trans", 0, of_both_sides));
        return BasicMaterial{m};
    }
    if (bsdf.type() != "principled") return std::nullopt;
    DisneyMaterial m;
    read_common(m, bsdf, context);
    m.metallic = context.textures.number(bsdf, "metallic", 0, unit_range);
    m.clearcoat = context.textures.number(bsdf, "clearcoat", 0, unit_range);
    m.clearcoat_gloss = context.textures.number(bsdf, "clearcoat_gloss", 0, unit_range);
    const FloatParameter& clear = m.specular_transmission;
    const bool transmits = !clear.is_constant() || clear.value > 0;
    m.eta = index_of_solid(bsdf, transmits);
    return BasicMaterial{m, !transmits};
}

} // namespace montelux::mitsuba
