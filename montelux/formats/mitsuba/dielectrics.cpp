// "dielectric", "roughdielectric" and "thindielectric".
#include <algorithm>
#include <cctype>
#include <optional>
#include <string>

#include "montelux/formats/mitsuba/basic_materials.h"
#include "montelux/formats/mitsuba/refractive_index.h"
#include "montelux/scene/build/quoted.h"
#include "montelux/scene/material/dielectric_material.h"
#include "montelux/scene/material/thin_dielectric_material.h"

namespace montelux::mitsuba {
namespace {

template <typename M>
void read_factors(M& m, Plugin& bsdf, MaterialContext& context) {
    m.specular_reflectance =
        context.textures.spectrum(bsdf, "specular_reflectance", 1, SpectrumUse::reflectance);
    m.specular_transmittance =
        context.textures.spectrum(bsdf, "specular_transmittance", 1, SpectrumUse::reflectance);
}

} // namespace

MicrofacetDistribution read_distribution(Plugin& bsdf) {
    bsdf.skip("sample_visible"); // steers the sampling alone
    std::string name = bsdf.text("distribution", "beckmann");
    std::ranges::transform(name, name.begin(), [](unsigned char c) { return std::tolower(c); });
    if (name == "beckmann") return MicrofacetDistribution::beckmann;
    if (name == "ggx") return MicrofacetDistribution::ggx_separable;
    bsdf.graph().diagnostics.error(bsdf.find("distribution")->at,
                                   "'distribution' is " + in_quotes(bsdf.text("distribution", "")) +
                                       "; expected one of beckmann, ggx");
}

std::optional<BasicMaterial> read_dielectric(Plugin& bsdf, MaterialContext& context) {
    if (bsdf.type() == "thindielectric") {
        ThinDielectricMaterial m;
        m.eta = static_cast<float>(relative_index(bsdf, "bk7"));
        read_factors(m, bsdf, context);
        return BasicMaterial{m};
    }
    const bool rough = bsdf.type() == "roughdielectric";
    if (!rough && bsdf.type() != "dielectric") return std::nullopt;
    DielectricMaterial m;
    m.eta = static_cast<float>(rough ? index_of_interface(bsdf, "bk7") : relative_index(bsdf, "bk7"));
    read_factors(m, bsdf, context);
    m.roughness.remap = false;
    if (rough) {
        m.roughness = read_roughness(bsdf, context);
        m.distribution = read_distribution(bsdf);
    }
    return BasicMaterial{m};
}

} // namespace montelux::mitsuba
