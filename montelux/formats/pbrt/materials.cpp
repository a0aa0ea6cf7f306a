#include "montelux/formats/pbrt/materials.h"

#include <algorithm>
#include <array>

#include "montelux/mc/math/nearest_name.h"

namespace montelux::pbrt {
namespace {

constexpr std::array<std::string_view, 6> supported_materials = {
    "diffuse", "conductor", "dielectric", "thindielectric", "coateddiffuse", "coatedconductor"};
constexpr std::array<std::string_view, 12> known = {"diffuse",
                                                    "conductor",
                                                    "dielectric",
                                                    "thindielectric",
                                                    "coateddiffuse",
                                                    "coatedconductor",
                                                    "diffusetransmission",
                                                    "hair",
                                                    "interface",
                                                    "measured",
                                                    "mix",
                                                    "subsurface"};

class MaterialMaker {
  public:
    MaterialMaker(const MaterialDeclaration& d, TextureLibrary& textures, SpectrumReader& spectra,
                  Diagnostics& diagnostics)
        : r_(d.parameters, "material " + in_quotes(d.type), d.at, diagnostics), textures_(textures),
          spectra_(spectra) {}

    Material make(std::string_view type) {
        Material material = select(type);
        r_.ignored("type");
        if (r_.ignored("displacement")) warn_of_bumps("displacement");
        if (r_.ignored("normalmap")) warn_of_bumps("normalmap");
        r_.finish();
        return material;
    }

  private:
    Material select(std::string_view type) {
        if (type == "diffuse") return DiffuseMaterial{reflectance("reflectance", 0.5f)};
        if (type == "conductor") return conductor("");
        if (type == "dielectric") return DielectricMaterial{eta("eta"), roughness("")};
        if (type == "thindielectric") return ThinDielectricMaterial{eta("eta")};
        if (type == "coateddiffuse")
            return CoatedDiffuseMaterial{reflectance("reflectance", 0.5f), coating("")};
        if (type == "coatedconductor") {
            CoatedConductorMaterial coated;
            coated.coating = coating("interface.");
            coated.conductor = conductor("conductor.");
            return coated;
        }
        r_.error("material " + in_quotes(type) + " is not supported yet");
    }

    void warn_of_bumps(std::string_view name) {
        r_.diagnostics().warn_once(r_.plugin() + std::string(name), r_.at(name),
                                   "parameter " + in_quotes(name) +
                                       " is not supported yet: the surface is rendered without it, and the "
                                       "picture differs");
    }

    SpectrumParameter reflectance(std::string_view name, float otherwise) {
        return textures_.spectrum_or(r_, name, RgbMeaning::albedo, otherwise);
    }

    // `prefix` + "uroughness" and "vroughness", each "roughness" where it is missing.
    RoughnessParameter roughness(const std::string& prefix) {
        RoughnessParameter p;
        FloatParameter both = textures_.float_or(r_, name(prefix + "roughness"), 0);
        p.u = textures_.find_float(r_, name(prefix + "uroughness")).value_or(both);
        p.v = textures_.find_float(r_, name(prefix + "vroughness")).value_or(both);
        p.remap = r_.boolean("remaproughness", true);
        return p;
    }

    // A number or a spectrum; 1.5 when it is missing.
    Spectrum eta(std::string_view parameter) {
        const Parameter* p = r_.any(parameter, {ParameterType::floating, ParameterType::spectrum,
                                                ParameterType::rgb, ParameterType::blackbody});
        if (!p) return Spectrum(1.5f);
        if (p->type != ParameterType::floating) return spectra_.read(*p, RgbMeaning::unbounded);
        if (p->numbers.size() != 1 || !(p->numbers[0] > 0))
            r_.error(parameter, "parameter " + in_quotes(parameter) +
                                    " is no index of refraction; expected 1 "
                                    "positive number");
        return Spectrum(p->numbers[0]);
    }

    // In a coated conductor eta and k have a prefix and the reflectance has none.
    ConductorMaterial conductor(const std::string& prefix) {
        ConductorMaterial m;
        auto eta_given = textures_.find_spectrum(r_, name(prefix + "eta"), RgbMeaning::unbounded);
        auto k_given = textures_.find_spectrum(r_, name(prefix + "k"), RgbMeaning::unbounded);
        auto reflectance_given = textures_.find_spectrum(r_, "reflectance", RgbMeaning::albedo);
        if (reflectance_given && (eta_given || k_given))
            r_.error("reflectance", "'reflectance' together with 'eta' or 'k'; expected one or the other");
        if (reflectance_given) {
            m.from_reflectance = true;
            m.reflectance = *reflectance_given;
        } else {
            m.eta = eta_given ? *eta_given : SpectrumParameter{SpectrumReader::named("metal-Cu-eta")};
            m.k = k_given ? *k_given : SpectrumParameter{SpectrumReader::named("metal-Cu-k")};
        }
        m.roughness = roughness(prefix);
        return m;
    }

    CoatingParameters coating(const std::string& prefix) {
        CoatingParameters c;
        c.roughness = roughness(prefix);
        c.eta = eta(name(prefix + "eta"));
        c.thickness = textures_.float_or(r_, "thickness", 0.01f);
        c.albedo = textures_.spectrum_or(r_, "albedo", RgbMeaning::albedo, 0);
        c.g = textures_.float_or(r_, "g", 0);
        c.max_depth = r_.integer("maxdepth", 10);
        c.sample_count = r_.integer("nsamples", 1);
        if (c.max_depth < 1) r_.error("maxdepth", "parameter 'maxdepth' is below 1");
        if (c.sample_count < 1) r_.error("nsamples", "parameter 'nsamples' is below 1");
        return c;
    }

    // Keeps a composed parameter name alive: the reader remembers views of the names it was asked for.
    std::string_view name(std::string composed) { return names_.emplace_back(std::move(composed)); }

    std::deque<std::string> names_;
    ParameterReader r_;
    TextureLibrary& textures_;
    SpectrumReader& spectra_;
};

} // namespace

bool is_supported_material(const MaterialDeclaration& d, Diagnostics& diagnostics) {
    if (std::find(supported_materials.begin(), supported_materials.end(), d.type) !=
        supported_materials.end())
        return true;
    if (d.type.empty() || d.type == "none") return false;
    if (std::find(known.begin(), known.end(), d.type) == known.end())
        diagnostics.error(d.at, "unknown material " + in_quotes(d.type) + did_you_mean(d.type, known));
    return false;
}

Material make_material(const MaterialDeclaration& d, TextureLibrary& textures, SpectrumReader& spectra,
                       Diagnostics& diagnostics) {
    if (!is_supported_material(d, diagnostics))
        diagnostics.error(d.at, "material " + in_quotes(d.type) + " is not supported yet");
    return MaterialMaker(d, textures, spectra, diagnostics).make(d.type);
}

} // namespace montelux::pbrt
