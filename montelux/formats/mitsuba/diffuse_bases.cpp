// "diffuse", "plastic" and "roughplastic": diffuse surfaces, bare or under a clear interface.
#include <optional>

#include "montelux/formats/mitsuba/basic_materials.h"
#include "montelux/formats/mitsuba/refractive_index.h"
#include "montelux/scene/bsdf/plastic.h"
#include "montelux/scene/material/diffuse_material.h"
#include "montelux/scene/material/plastic_material.h"

namespace montelux::mitsuba {
namespace {

// Mitsuba computes the share of light that a rough interface reflects back as a sum of 64 points with equal weights
// from 0 to 1, which counts the reflectance along the normal too often. Its pictures have that value.
float internal_reflectance(const PlasticMaterial& m) {
    const PlasticTable exact(m.eta, m.alpha, m.distribution);
    const float f0 = (m.eta - 1) / (m.eta + 1);
    return (63 * exact.internal_reflectance() + f0 * f0) / 64;
}

} // namespace

std::optional<BasicMaterial> read_diffuse_base(Plugin& bsdf, MaterialContext& context) {
    TextureLibrary& textures = context.textures;
    if (bsdf.type() == "diffuse") {
        DiffuseMaterial m;
        m.reflectance = textures.spectrum(bsdf, "reflectance", 0.5f, SpectrumUse::reflectance);
        return BasicMaterial{m, true};
    }
    const bool rough = bsdf.type() == "roughplastic";
    if (!rough && bsdf.type() != "plastic") return std::nullopt;
    PlasticMaterial m;
    const double eta =
        rough ? index_of_interface(bsdf, "polypropylene") : relative_index(bsdf, "polypropylene");
    if (!(eta >= 1)) bsdf.error("'int_ior' is below 'ext_ior', which is not supported for " + bsdf.type());
    m.eta = static_cast<float>(eta);
    m.reflectance = textures.spectrum(bsdf, "diffuse_reflectance", 0.5f, SpectrumUse::reflectance);
    m.specular_reflectance = textures.spectrum(bsdf, "specular_reflectance", 1, SpectrumUse::reflectance);
    m.nonlinear = bsdf.flag("nonlinear", false);
    if (rough) {
        m.alpha = static_cast<float>(bsdf.number("alpha", 0.1, 0, 10));
        m.distribution = read_distribution(bsdf);
        m.internal_reflectance = internal_reflectance(m);
    }
    return BasicMaterial{m, true};
}

} // namespace montelux::mitsuba
