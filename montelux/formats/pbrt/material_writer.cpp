#include <algorithm>
#include <array>
#include <set>
#include <type_traits>
#include <vector>

#include "montelux/formats/measured_brdf_file.h"
#include "montelux/formats/pbrt/coverage.h"
#include "montelux/formats/pbrt/scene_writer.h"
#include "montelux/scene/material/material_model.h"
#include "montelux/scene/scene_names.h"
#include "montelux/scene/setting_names.h"

namespace montelux::pbrt {

// Writes the parameters that a material lists, but for those that the reader sets by itself.
class MaterialParameters {
  public:
    MaterialParameters(SceneWriter& writer, DirectiveText& directive, std::string what)
        : w_(writer), d_(directive), what_(std::move(what)) {}

    template <typename M>
    void write_all(const M& material) {
        const M standard{};
        std::vector<const void*> defaults; // in the order of the list
        visit_parameters(standard,
                         [&](const ParameterInfo&, const auto& field) { defaults.push_back(&field); });
        std::size_t i = 0;
        visit_parameters(material, [&]<typename Field>(const ParameterInfo& info, const Field& field) {
            if constexpr (std::is_same_v<Field, MediumIndex>) {
                if constexpr (requires { material.eta; }) w_.subsurface(d_, field.index, material.eta);
            } else {
                write(info, field, *static_cast<const Field*>(defaults[i]));
            }
            ++i;
        });
    }

  private:
    void write(const ParameterInfo& info, const SpectrumParameter& p, const SpectrumParameter& standard) {
        w_.parameter(d_, info.pbrt_name(), p, standard.value.constant, info.meaning);
    }
    void write(const ParameterInfo& info, const FloatParameter& p, const FloatParameter& standard) {
        w_.parameter(d_, info.pbrt_name(), p, standard.value);
    }
    void write(const ParameterInfo& info, float x, float standard) {
        if (x != standard) d_.number(info.pbrt_name(), x);
    }
    void write(const ParameterInfo& info, bool b, bool standard) {
        if (b != standard) d_.boolean(info.pbrt_name(), b);
    }
    void write(const ParameterInfo& info, int n, int standard) {
        if (n != standard) d_.integer(info.pbrt_name(), n);
    }
    // An index of refraction: a number or a spectrum.
    void write(const ParameterInfo& info, SceneSpectrum eta, SceneSpectrum standard) {
        if (!eta.is_constant())
            w_.spectrum(d_, info.pbrt_name(), eta, RgbMeaning::unbounded, what_);
        else if (eta.constant != standard.constant)
            d_.number(info.pbrt_name(), eta.constant);
    }
    void write(const ParameterInfo& info, const RoughnessParameter& p, const RoughnessParameter& standard) {
        const std::string prefix = info.prefix.empty() ? std::string() : std::string(info.prefix) + '.';
        w_.parameter(d_, prefix + "uroughness", p.u, 0);
        w_.parameter(d_, prefix + "vroughness", p.v, 0);
        if (remap_.has_value() && *remap_ != p.remap)
            w_.warn(what_,
                    "both of its roughnesses share 'remaproughness' in pbrt; that of the first is written");
        if (!remap_.has_value() && p.remap != standard.remap) d_.boolean("remaproughness", p.remap);
        remap_ = p.remap;
    }
    // The reader's own metal is another than that of the struct.
    void write(const ParameterInfo& info, const MetalParameter& m, const MetalParameter&) {
        const std::string prefix = info.prefix.empty() ? std::string() : std::string(info.prefix) + '.';
        constexpr float none = -1; // no value of these parameters
        if (m.from_reflectance)
            return w_.parameter(d_, "reflectance", m.reflectance, none, RgbMeaning::albedo);
        w_.parameter(d_, prefix + "eta", m.eta, none, RgbMeaning::unbounded);
        w_.parameter(d_, prefix + "k", m.k, none, RgbMeaning::unbounded);
    }
    void write(const ParameterInfo& info, const NormalMapParameter& p, const NormalMapParameter&) {
        if (!p.is_given()) return;
        if (w_.is_plain_normal_map(p.map))
            d_.string(info.pbrt_name(), w_.image_file(w_.scene_.normal_maps[p.map].image));
        else
            d_.texture(info.pbrt_name(), w_.normal_map_texture(p.map));
    }
    void write(const ParameterInfo& info, const MeasuredBrdfIndex& b, const MeasuredBrdfIndex&) {
        d_.string(info.pbrt_name(), w_.measured_file(b.index));
    }
    void write(const ParameterInfo& info, const MixedMaterials& m, const MixedMaterials&) {
        const std::array<std::string_view, 2> names = {w_.material_names_[m.first.index],
                                                       w_.material_names_[m.second.index]};
        d_.strings("string", info.pbrt_name(), names);
    }
    void write(const ParameterInfo& info, const MaterialOfSide& side, const MaterialOfSide&) {
        if (side.is_given()) d_.string(info.pbrt_name(), w_.material_names_[side.index]);
    }
    void write(const ParameterInfo& info, MicrofacetDistribution d, MicrofacetDistribution standard) {
        if (d != standard) d_.string(info.pbrt_name(), name_of(d));
    }
    void write(const ParameterInfo&, const HairColorParameter& c, const HairColorParameter&) {
        constexpr float none = -1;
        switch (c.source) {
        case HairColorParameter::absorption:
            return w_.parameter(d_, "sigma_a", c.sigma_a, none, RgbMeaning::unbounded);
        case HairColorParameter::reflectances:
            return w_.parameter(d_, "reflectance", c.reflectance, none, RgbMeaning::albedo);
        default:
            w_.parameter(d_, "eumelanin", c.eumelanin, none);
            w_.parameter(d_, "pheomelanin", c.pheomelanin, 0);
        }
    }

    SceneWriter& w_;
    DirectiveText& d_;
    std::string what_;
    std::optional<bool> remap_{};
};

std::string SceneWriter::measured_file(Index brdf) {
    std::string& reference = measured_files_[brdf];
    if (!reference.empty()) return reference;
    const std::string name = "surface-" + std::to_string(brdf) + ".bsdf";
    AtomicFile file(files_.add(name));
    write_measured_brdf(file, scene_.measured_brdfs[brdf]);
    file.commit();
    return reference = files_.reference(name);
}

void SceneWriter::subsurface(DirectiveText& d, Index index, float eta) {
    const std::string what = "medium " + std::to_string(index);
    const auto* body =
        index < scene_.media.size() ? std::get_if<HomogeneousMedium>(&scene_.media[index]) : nullptr;
    if (body == nullptr || !std::holds_alternative<HenyeyGreenstein>(body->phase) || body->le_scale != 1 ||
        !body->le.is_constant() || body->le.constant != 0) {
        warn(what, "the interior of 'subsurface' is not one that pbrt has; its default is written");
        return;
    }
    const float g = std::get<HenyeyGreenstein>(body->phase).g;
    if (g != 0) d.number("g", g);
    const BodySurface& s = body->surface;
    if (s.kind == BodySurface::Kind::coefficients) {
        parameter(d, "sigma_a", s.first, -1, RgbMeaning::unbounded);
        parameter(d, "sigma_s", s.second, -1, RgbMeaning::unbounded);
    } else if (s.kind == BodySurface::Kind::reflectance) {
        parameter(d, "reflectance", s.first, -1, RgbMeaning::albedo);
        parameter(d, "mfp", s.second, 1, RgbMeaning::unbounded);
        if (s.eta != eta) warn(what, "it has another index of refraction than its surface; that is written");
    } else {
        spectrum(d, "sigma_a", body->sigma_a, RgbMeaning::unbounded, what);
        spectrum(d, "sigma_s", body->sigma_s, RgbMeaning::unbounded, what);
    }
    const float scale = s.is_given() ? s.scale : body->scale;
    if (scale != 1) d.number("scale", scale);
}

void SceneWriter::material(Index i) {
    std::visit(
        [&]<typename M>(const M& m) {
            DirectiveText d("MakeNamedMaterial " + quoted_text(material_names_[i]));
            d.string("type", material_type(M::name));
            MaterialParameters(*this, d, "material " + std::to_string(i)).write_all(m);
            put_block(d.text());
        },
        scene_.materials[i]);
}

void SceneWriter::materials() {
    std::set<std::string> taken;
    for (Index i = 0; i < scene_.materials.size(); ++i) {
        std::string name = material_name(scene_, i);
        for (int k = 2; !taken.insert(name).second; ++k)
            name = material_name(scene_, i) + "-" + std::to_string(k);
        material_names_.push_back(name);
    }
    for (Index i = 0; i < scene_.materials.size(); ++i) material(i);
}

} // namespace montelux::pbrt
