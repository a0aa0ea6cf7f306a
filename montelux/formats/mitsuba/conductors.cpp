// "conductor" and "roughconductor".
#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "montelux/formats/mitsuba/basic_materials.h"
#include "montelux/formats/mitsuba/conductor_data.h"
#include "montelux/mc/math/nearest_name.h"
#include "montelux/scene/build/quoted.h"
#include "montelux/scene/material/conductor_material.h"
#include "montelux/spectrum/named_spectra.h"
#include "montelux/spectrum/piecewise_linear.h"

namespace montelux::mitsuba {
namespace {

struct OpticalConstants {
    Spectrum eta, k;
};

OpticalConstants constants_of(const ConductorData& data) {
    std::vector<float> lambda, eta, k;
    for (std::size_t i = 0; i + 2 < data.samples.size(); i += 3) {
        lambda.push_back(data.samples[i]);
        eta.push_back(data.samples[i + 1]);
        k.push_back(data.samples[i + 2]);
    }
    return {Spectrum(PiecewiseLinear(lambda, eta, SpectrumEnds::constant)),
            Spectrum(PiecewiseLinear(lambda, k, SpectrumEnds::constant))};
}

// Most of Mitsuba's names exist with the name of the handbook as well: "W" and "W_palik".
std::optional<OpticalConstants> find_constants(std::string_view name) {
    const auto measured = [](std::string_view n) -> std::optional<OpticalConstants> {
        const auto data = conductor_data();
        const auto found = std::ranges::find(data, n, &ConductorData::name);
        if (found != data.end()) return constants_of(*found);
        const std::string named = "metal-" + std::string(n);
        auto eta = find_named_spectrum(named + "-eta");
        if (!eta) return std::nullopt;
        return OpticalConstants{std::move(*eta), *find_named_spectrum(named + "-k")};
    };
    if (std::optional<OpticalConstants> found = measured(name)) return found;
    constexpr std::string_view handbook = "_palik";
    if (!name.ends_with(handbook)) return std::nullopt;
    return measured(name.substr(0, name.size() - handbook.size()));
}

[[noreturn]] void unknown_material(Plugin& bsdf, std::string_view name) {
    std::vector<std::string_view> names{"none", "Ag", "Al", "Au", "Cu", "MgO", "TiO2"};
    for (const ConductorData& data : conductor_data()) names.push_back(data.name);
    std::string all;
    for (const std::string_view n : names) all += (all.empty() ? "" : ", ") + std::string(n);
    bsdf.error("the conductor " + in_quotes(name) + " is not known" + did_you_mean(name, names) +
               "; there are " + all);
}

MetalParameter read_metal(Plugin& bsdf, MaterialContext& context) {
    MetalParameter metal;
    const std::string name = bsdf.text("material", "none");
    if (name == "none" || bsdf.has("eta")) {
        if (name != "none") bsdf.error("'material' together with 'eta'; expected one or the other");
        metal.eta = context.textures.spectrum(bsdf, "eta", 0, SpectrumUse::unbounded);
        metal.k = context.textures.spectrum(bsdf, "k", 1, SpectrumUse::unbounded);
        return metal;
    }
    const std::optional<OpticalConstants> constants = find_constants(name);
    if (!constants) unknown_material(bsdf, name);
    metal.eta = {context.builder.add_spectrum(constants->eta)};
    metal.k = {context.builder.add_spectrum(constants->k)};
    return metal;
}

} // namespace

RoughnessParameter read_roughness(Plugin& bsdf, MaterialContext& context) {
    RoughnessParameter roughness;
    roughness.remap = false;
    if (bsdf.has("alpha_u") != bsdf.has("alpha_v"))
        bsdf.error("expected both 'alpha_u' and 'alpha_v', or neither");
    if (bsdf.has("alpha_u")) {
        if (bsdf.has("alpha")) bsdf.error("'alpha' together with 'alpha_u'; expected one or the other");
        roughness.u = context.textures.number(bsdf, "alpha_u", 0.1f);
        roughness.v = context.textures.number(bsdf, "alpha_v", 0.1f);
    } else {
        roughness.u = roughness.v = context.textures.number(bsdf, "alpha", 0.1f);
    }
    return roughness;
}

std::optional<BasicMaterial> read_conductor(Plugin& bsdf, MaterialContext& context) {
    const bool rough = bsdf.type() == "roughconductor";
    if (!rough && bsdf.type() != "conductor") return std::nullopt;
    ConductorMaterial m;
    m.metal = read_metal(bsdf, context);
    m.specular_reflectance =
        context.textures.spectrum(bsdf, "specular_reflectance", 1, SpectrumUse::reflectance);
    m.roughness.remap = false;
    if (rough) {
        m.roughness = read_roughness(bsdf, context);
        m.distribution = read_distribution(bsdf);
    }
    return BasicMaterial{m, true};
}

} // namespace montelux::mitsuba
