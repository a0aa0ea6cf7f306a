#include "montelux/formats/pbrt/materials.h"

#include <algorithm>
#include <deque>
#include <type_traits>

#include "montelux/formats/pbrt/coverage.h"
#include "montelux/formats/pbrt/subsurface.h"
#include "montelux/scene/material/material_model.h"
#include "montelux/scene/setting_names.h"

namespace montelux::pbrt {
namespace {

// Reads the parameters that a material lists (scene/material/parameter.h); missing ones keep their defaults.
class MaterialMaker {
  public:
    MaterialMaker(const MaterialDeclaration& d, SceneBuilder& builder, TextureLibrary& textures,
                  MeasuredBrdfLibrary& brdfs, SpectrumReader& spectra, const FindMaterial& find,
                  Diagnostics& diagnostics)
        : r_(d.parameters, "material " + in_quotes(d.type), d.at, diagnostics), builder_(builder),
          textures_(textures), brdfs_(brdfs), spectra_(spectra), find_(find) {}

    Material make(std::string_view type) {
        Material material;
        for_each_material_kind([&]<typename M>(std::type_identity<M>) {
            if (material_type(M::name) != type) return;
            M m = default_material<M>([&](const Spectrum& s) { return builder_.add_spectrum(s); });
            visit_parameters(m, [&](const ParameterInfo& info, auto& field) { read(info, field); });
            if constexpr (std::is_same_v<M, MixMaterial> || std::is_same_v<M, SidedMaterial> ||
                          std::is_same_v<M, InterfaceMaterial>) {
                if (!m.detail.is_flat())
                    r_.diagnostics().warn(r_.at(), "bumps and normal map of " + in_quotes(type) +
                                                       " are ignored: it has no surface of its own");
            }
            material = m;
        });
        r_.ignored("type");
        r_.finish();
        return material;
    }

  private:
    void read(const ParameterInfo& info, SpectrumParameter& p) {
        if (auto given = textures_.find_spectrum(r_, name(info.pbrt_name()), info.meaning)) p = *given;
    }
    void read(const ParameterInfo& info, FloatParameter& p) {
        const std::string_view parameter = name(info.pbrt_name());
        const std::optional<FloatParameter> given = textures_.find_float(r_, parameter);
        if (!given) return;
        p = *given;
        check_range(info, parameter, p);
    }
    void read(const ParameterInfo& info, float& x) {
        const std::string_view parameter = name(info.pbrt_name());
        x = r_.number(parameter, x);
        check_range(info, parameter, static_cast<double>(x));
    }
    void read(const ParameterInfo& info, int& n) {
        const std::string_view parameter = name(info.pbrt_name());
        n = r_.integer(parameter, n);
        check_range(info, parameter, n);
    }

    void read(const ParameterInfo& info, bool& b) { b = r_.boolean(name(info.pbrt_name()), b); }

    void read(const ParameterInfo& info, MicrofacetDistribution& d) {
        const auto& all = normal_distribution_names;
        const std::string_view given =
            r_.choice(name(info.pbrt_name()), {all[0].first, all[1].first, all[2].first}, name_of(d));
        d = std::ranges::find(all, given, &std::pair<std::string_view, MicrofacetDistribution>::first)
                ->second;
    }

    // An index of refraction: a number or a spectrum.
    void read(const ParameterInfo& info, SceneSpectrum& eta) {
        const std::string_view parameter = name(info.pbrt_name());
        const Parameter* p = r_.any(parameter, {ParameterType::floating, ParameterType::spectrum,
                                                ParameterType::rgb, ParameterType::blackbody});
        if (!p) return;
        if (p->type == ParameterType::floating && (p->numbers.size() != 1 || !(p->numbers[0] > 0)))
            r_.error(parameter, "parameter " + in_quotes(parameter) +
                                    " is no index of refraction; expected 1 positive number");
        if (p->type == ParameterType::floating)
            eta = p->numbers[0];
        else
            eta = builder_.add_spectrum(spectra_.read(*p, RgbMeaning::unbounded));
    }

    // "uroughness" and "vroughness" with the prefix; "roughness" where one is missing.
    void read(const ParameterInfo& info, RoughnessParameter& p) {
        const std::string prefix = info.prefix.empty() ? std::string() : std::string(info.prefix) + '.';
        const auto read = [&](const char* what, const FloatParameter& otherwise) {
            const std::string_view parameter = name(prefix + what);
            const std::optional<FloatParameter> given = textures_.find_float(r_, parameter);
            if (given) check_range(info, parameter, *given);
            return given.value_or(otherwise);
        };
        const FloatParameter both = read("roughness", {});
        p.u = read("uroughness", both);
        p.v = read("vroughness", both);
        p.remap = r_.boolean("remaproughness", p.remap);
    }

    // In a coated conductor eta and k have a prefix and the reflectance has none.
    void read(const ParameterInfo& info, MetalParameter& m) {
        const std::string prefix = info.prefix.empty() ? std::string() : std::string(info.prefix) + '.';
        auto eta = textures_.find_spectrum(r_, name(prefix + "eta"), RgbMeaning::unbounded);
        auto k = textures_.find_spectrum(r_, name(prefix + "k"), RgbMeaning::unbounded);
        auto reflectance = textures_.find_spectrum(r_, "reflectance", RgbMeaning::albedo);
        if (reflectance && (eta || k))
            r_.error("reflectance", "'reflectance' together with 'eta' or 'k'; expected one or the other");
        if (eta) m.eta = *eta;
        if (k) m.k = *k;
        m.from_reflectance = reflectance.has_value();
        if (reflectance) m.reflectance = *reflectance;
    }

    void read(const ParameterInfo& info, NormalMapParameter& p) {
        const std::string_view parameter = name(info.pbrt_name());
        const Parameter* map = r_.any(parameter, {ParameterType::string, ParameterType::texture});
        if (map == nullptr) return;
        p.map = map->type == ParameterType::texture ? textures_.normal_map(*map)
                                                    : textures_.normal_map(*r_.string(parameter), map->at);
    }

    void read(const ParameterInfo& info, MeasuredBrdfIndex& b) {
        const std::string_view parameter = name(info.pbrt_name());
        const std::optional<std::string> file = r_.string(parameter);
        if (!file) r_.error(parameter, "'measured' needs a parameter 'string filename'");
        b.index = brdfs_.index(*file, r_.at(parameter));
    }

    void read(const ParameterInfo&, MediumIndex& interior) {
        std::vector<Medium>& media = builder_.scene().media;
        media.push_back(
            read_subsurface(r_, builder_, spectra_, textures_, r_.number("eta", SubsurfaceMaterial().eta)));
        interior.index = static_cast<Index>(media.size() - 1);
    }

    // The first that is given of sigma_a, the reflectance (or color) and the melanins; pbrt-v4 warns of others.
    void read(const ParameterInfo&, HairColorParameter& c) {
        const auto sigma_a = textures_.find_spectrum(r_, "sigma_a", RgbMeaning::unbounded);
        auto reflectance = textures_.find_spectrum(r_, "reflectance", RgbMeaning::albedo);
        const auto color = textures_.find_spectrum(r_, "color", RgbMeaning::albedo);
        if (!reflectance) reflectance = color;
        const auto eumelanin = textures_.find_float(r_, "eumelanin");
        const auto pheomelanin = textures_.find_float(r_, "pheomelanin");
        const bool melanin = eumelanin || pheomelanin;
        if ((sigma_a ? 1 : 0) + (reflectance ? 1 : 0) + (melanin ? 1 : 0) > 1)
            r_.diagnostics().warn(r_.at(), "'hair' has several of 'sigma_a', 'reflectance' and melanins; '" +
                                               std::string(sigma_a ? "sigma_a" : "reflectance") +
                                               "' is used");
        if (sigma_a) {
            c.sigma_a = *sigma_a;
            c.source = HairColorParameter::absorption;
        } else if (reflectance) {
            c.reflectance = *reflectance;
            c.source = HairColorParameter::reflectances;
        } else if (melanin) {
            c.eumelanin = eumelanin.value_or(FloatParameter{});
            c.pheomelanin = pheomelanin.value_or(FloatParameter{});
        }
    }

    void read(const ParameterInfo& info, MixedMaterials& m) {
        const std::string_view parameter = name(info.pbrt_name());
        const Parameter* p = r_.any(parameter, {ParameterType::string});
        if (!p || p->strings.size() != 2)
            r_.error(parameter, "'mix' needs a parameter 'string materials' with 2 names");
        m.first.index = find_(p->strings[0], p->at);
        m.second.index = find_(p->strings[1], p->at);
    }

    void read(const ParameterInfo& info, MaterialOfSide& side) {
        const std::string_view parameter = name(info.pbrt_name());
        if (std::optional<std::string> material = r_.string(parameter))
            side.index = find_(*material, r_.at(parameter));
    }

    // Values of textures are not known before they are evaluated: a material limits these itself.
    void check_range(const ParameterInfo& info, std::string_view parameter, const FloatParameter& p) {
        if (p.is_constant()) check_range(info, parameter, static_cast<double>(p.value));
    }
    void check_range(const ParameterInfo& info, std::string_view parameter, double x) {
        if (x >= info.least && x <= info.most) return;
        const bool below = x < info.least;
        r_.error(parameter, "parameter " + in_quotes(parameter) + (below ? " is below " : " is above ") +
                                std::to_string(static_cast<int>(below ? info.least : info.most)));
    }

    // Keeps a composed name alive: the reader stores views of the names.
    std::string_view name(std::string composed) { return names_.emplace_back(std::move(composed)); }

    std::deque<std::string> names_;
    ParameterReader r_;
    SceneBuilder& builder_;
    TextureLibrary& textures_;
    MeasuredBrdfLibrary& brdfs_;
    SpectrumReader& spectra_;
    const FindMaterial& find_;
};

// Names of early files for "interface".
bool is_old_interface(std::string_view type) { return type.empty() || type == "none"; }

} // namespace

Material make_material(const MaterialDeclaration& d, SceneBuilder& builder, TextureLibrary& textures,
                       MeasuredBrdfLibrary& brdfs, SpectrumReader& spectra, const FindMaterial& find,
                       Diagnostics& diagnostics) {
    if (!is_plugin("Material", d.type) && !is_old_interface(d.type))
        diagnostics.error(d.at,
                          "unknown material " + in_quotes(d.type) + plugin_suggestion("Material", d.type));
    MaterialMaker maker(d, builder, textures, brdfs, spectra, find, diagnostics);
    if (!is_old_interface(d.type)) return maker.make(d.type);
    diagnostics.warn_once("material " + in_quotes(d.type), d.at,
                          "material " + in_quotes(d.type) + " is deprecated; it is read as 'interface'");
    return maker.make("interface");
}

} // namespace montelux::pbrt
