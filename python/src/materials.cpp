#include "python/src/bindings.h"
#include "python/src/names.h"
#include "python/src/scene_values.h"
#include "python/src/shapes.h"
#include <string>

#include "montelux/scene/material/material_model.h"
#include "montelux/scene/setting_names.h"

namespace montelux::python {
namespace {

constexpr const char* spectrum_type = "typing.Any";
constexpr Names<MicrofacetDistribution, 3> normal_distributions{"distribution", normal_distribution_names};

// The n-th parameter of a material, of type F.
template <typename F>
struct ParameterAt {
    std::size_t n;

    template <typename M>
    F& operator()(M& material) const {
        F* found = nullptr;
        std::size_t i = 0;
        visit_parameters(material, [&]<typename Field>(const ParameterInfo&, Field& field) {
            if constexpr (std::is_same_v<Field, F>)
                if (i == n) found = &field;
            ++i;
        });
        return *found;
    }
    template <typename M>
    const F& operator()(const M& material) const {
        return (*this)(const_cast<M&>(material));
    }
};

// The attributes of one parameter of the material M.
template <typename M>
struct Attributes {
    nb::class_<Ref<M>>& c;

    void add(const ParameterInfo& info, ParameterAt<SpectrumParameter> at) const {
        const RgbMeaning meaning = info.meaning;
        attribute<M>(
            c, info.python_name().c_str(), spectrum_type,
            [at](const M& m, const Ref<M>& r) { return spectrum_or_texture(at(m), r); },
            [at, meaning](M& m, nb::handle v, Ref<M>& r, const std::string& what) {
                at(m) = spectrum_parameter_of(v, meaning, r, what);
            },
            info.doc);
    }
    void add(const ParameterInfo& info, ParameterAt<FloatParameter> at) const {
        add_number(info.python_name(), at, info.least, info.most, info.doc);
    }
    void add(const ParameterInfo& info, ParameterAt<SceneSpectrum> at) const {
        attribute<M>(
            c, info.python_name().c_str(), spectrum_type,
            [at](const M& m, const Ref<M>& r) { return nb::cast(spectrum_of(at(m), r.spectra())); },
            [at](M& m, nb::handle v, Ref<M>& r, const std::string& what) {
                at(m) = r.add_spectrum(spectrum_of(v, RgbMeaning::unbounded, what));
            },
            "Index of refraction: a number above zero, a Spectrum, or a name such as 'glass-BK7'.");
    }
    void add(const ParameterInfo& info, ParameterAt<float> at) const {
        const double least = info.least, most = info.most;
        attribute<M>(
            c, info.python_name().c_str(), "float",
            [at](const M& m, const auto&) { return nb::float_(static_cast<double>(at(m))); },
            [=](M& m, nb::handle v, auto&, const std::string& what) {
                const double x = number_of(v, what);
                require_range(x, least, most, v, what);
                at(m) = static_cast<float>(x);
            },
            info.doc);
    }
    void add(const ParameterInfo& info, ParameterAt<int> at) const {
        const auto least = static_cast<std::int64_t>(info.least);
        attribute<M>(
            c, info.python_name().c_str(), "int", [at](const M& m, const auto&) { return nb::int_(at(m)); },
            [=](M& m, nb::handle v, auto&, const std::string& what) {
                at(m) = static_cast<int>(whole_number_of(v, least, 1 << 20, what));
            },
            info.doc);
    }

    void add(const ParameterInfo& info, ParameterAt<bool> at) const {
        attribute<M>(
            c, info.python_name().c_str(), "bool", [at](const M& m, const auto&) { return nb::bool_(at(m)); },
            [at](M& m, nb::handle v, auto&, const std::string& what) { at(m) = boolean_of(v, what); },
            info.doc);
    }

    // `roughness` sets both directions at once.
    void add(const ParameterInfo& info, ParameterAt<RoughnessParameter> at) const {
        const std::string name = info.python_name();
        const auto u = [at](auto& m) -> auto& { return at(m).u; };
        const auto v = [at](auto& m) -> auto& { return at(m).v; };
        add_number(name + "_u", u, info.least, info.most, "GGX roughness along u; 0 is a mirror.");
        add_number(name + "_v", v, info.least, info.most, "GGX roughness along v.");
        attribute<M>(
            c, name.c_str(), "typing.Any",
            [u](const M& m, const Ref<M>& r) { return number_or_texture(u(m), scene_of_textures(r)); },
            [at](M& m, nb::handle given, Ref<M>& r, const std::string& what) {
                const FloatParameter p = float_parameter_of(given, r, what);
                if (p.is_constant() && !not_negative(static_cast<double>(p.value)))
                    throw Error(what, std::string(nb::repr(given).c_str()) +
                                          " was given; expected a number that is not negative");
                at(m).u = at(m).v = p;
            },
            "GGX roughness along u and v together (a number or a texture); reads the one along u.");
        const std::string remap =
            ParameterInfo{.prefix = info.prefix, .name = "remap_roughness"}.python_name();
        attribute<M>(
            c, remap.c_str(), "bool", [at](const M& m, const auto&) { return nb::bool_(at(m).remap); },
            [at](M& m, nb::handle given, auto&, const std::string& what) {
                at(m).remap = boolean_of(given, what);
            },
            "Whether alpha is the root of the roughness; else it is the roughness itself.");
    }

    // eta and k, or the reflectance: the unused ones read as None.
    void add(const ParameterInfo& info, ParameterAt<MetalParameter> at) const {
        const auto optical = [&](const std::string& name, SpectrumParameter MetalParameter::*member,
                                 bool from_reflectance, const char* doc) {
            attribute<M>(
                c, name.c_str(), spectrum_type,
                [=](const M& m, const Ref<M>& r) -> nb::object {
                    if (at(m).from_reflectance != from_reflectance) return nb::none();
                    return spectrum_or_texture(at(m).*member, r);
                },
                [=](M& m, nb::handle v, Ref<M>& r, const std::string& what) {
                    const RgbMeaning meaning = from_reflectance ? RgbMeaning::albedo : RgbMeaning::unbounded;
                    at(m).*member = spectrum_parameter_of(v, meaning, r, what);
                    at(m).from_reflectance = from_reflectance;
                },
                doc);
        };
        const auto named = [&](std::string_view name) {
            return ParameterInfo{.prefix = info.prefix, .name = name}.python_name();
        };
        optical(
            named("eta"), &MetalParameter::eta, false,
            "Real part of the index of refraction, such as 'metal-Au-eta'; None where a reflectance is set.");
        optical(named("k"), &MetalParameter::k, false, "Imaginary part, such as 'metal-Au-k'.");
        optical("reflectance", &MetalParameter::reflectance, true,
                "Reflectance at normal incidence, in the place of eta and k; None where these are set.");
    }

    void add(const ParameterInfo& info, ParameterAt<NormalMapParameter> at) const {
        attribute<M>(
            c, info.python_name().c_str(), "NormalMap | None",
            [at](const M& m, const Ref<M>& r) -> nb::object {
                if (!at(m).is_given()) return nb::none();
                return nb::cast(NormalMapHandle{scene_of_textures(r), at(m).map});
            },
            [at](M& m, nb::handle v, Ref<M>& r, const std::string& what) {
                if (v.is_none()) {
                    at(m) = {};
                    return;
                }
                if (!nb::isinstance<NormalMapHandle>(v))
                    throw Error(what, std::string(nb::repr(v).c_str()) +
                                          " was given; expected None or what Scene.normal_map() returns");
                const auto& map = nb::cast<const NormalMapHandle&>(v);
                require_scene(r, map.scene, what);
                at(m) = {map.index};
            },
            info.doc);
    }

    void add(const ParameterInfo& info, ParameterAt<MeasuredBrdfIndex> at) const {
        attribute<M>(
            c, info.python_name().c_str(), "MeasuredBrdf | None",
            [at](const M& m, const Ref<M>& r) -> nb::object {
                if (!at(m).is_given()) return nb::none();
                return nb::cast(MeasuredBrdfHandle{scene_of_textures(r), at(m).index});
            },
            [at](M& m, nb::handle v, Ref<M>& r, const std::string& what) {
                if (!nb::isinstance<MeasuredBrdfHandle>(v))
                    throw Error(what, std::string(nb::repr(v).c_str()) +
                                          " was given; expected what Scene.measured_brdf() returns");
                const auto& brdf = nb::cast<const MeasuredBrdfHandle&>(v);
                require_scene(r, brdf.scene, what);
                at(m) = {brdf.index};
            },
            info.doc);
    }

    // Of scene files alone.
    void add(const ParameterInfo&, ParameterAt<MediumIndex>) const {}

    // What is set last counts; what does not reads as None.
    void add(const ParameterInfo&, ParameterAt<HairColorParameter> at) const {
        const auto colour = [&](const char* name, SpectrumParameter HairColorParameter::*member, int source,
                                RgbMeaning meaning, const char* doc) {
            attribute<M>(
                c, name, spectrum_type,
                [=](const M& m, const Ref<M>& r) -> nb::object {
                    if (at(m).source != source) return nb::none();
                    return spectrum_or_texture(at(m).*member, r);
                },
                [=](M& m, nb::handle v, Ref<M>& r, const std::string& what) {
                    at(m).*member = spectrum_parameter_of(v, meaning, r, what);
                    at(m).source = source;
                },
                doc);
        };
        const auto melanin = [&](const char* name, FloatParameter HairColorParameter::*member,
                                 const char* doc) {
            attribute<M>(
                c, name, "typing.Any",
                [=](const M& m, const Ref<M>& r) -> nb::object {
                    if (at(m).source != HairColorParameter::melanins) return nb::none();
                    return number_or_texture(at(m).*member, scene_of_textures(r));
                },
                [=](M& m, nb::handle v, Ref<M>& r, const std::string& what) {
                    const FloatParameter p = float_parameter_of(v, r, what);
                    if (p.is_constant())
                        require_range(static_cast<double>(p.value), 0, std::numeric_limits<double>::max(), v,
                                      what);
                    at(m).*member = p;
                    at(m).source = HairColorParameter::melanins;
                },
                doc);
        };
        colour("sigma_a", &HairColorParameter::sigma_a, HairColorParameter::absorption, RgbMeaning::unbounded,
               "Absorption coefficient, per radius of the hair.");
        colour("reflectance", &HairColorParameter::reflectance, HairColorParameter::reflectances,
               RgbMeaning::albedo, "Reflectance of many hairs together, 0 to 1.");
        melanin("eumelanin", &HairColorParameter::eumelanin,
                "Concentration of the brown pigment: 0.3 is blond, 8 black.");
        melanin("pheomelanin", &HairColorParameter::pheomelanin, "Concentration of the red pigment.");
    }

    void add(const ParameterInfo& info, ParameterAt<MicrofacetDistribution> at) const {
        attribute<M>(
            c, info.python_name().c_str(), "str",
            [at](const M& m, const auto&) { return nb::str(std::string(name_of(at(m))).c_str()); },
            [at](M& m, nb::handle v, auto&, const std::string& what) {
                std::string given;
                if (!nb::try_cast(v, given))
                    throw Error(what, std::string(nb::repr(v).c_str()) +
                                          " was given; expected 'ggx', 'ggx-separable' or 'beckmann'");
                at(m) = normal_distributions.value(given);
            },
            "Microfacet normals: 'ggx', or as in Mitsuba 'ggx-separable' and 'beckmann', with independent "
            "masking "
            "and shadowing.");
    }

    void add(const ParameterInfo&, ParameterAt<MixedMaterials> at) const {
        add_part(
            "first", [at](auto& m) -> auto& { return at(m).first; }, "typing.Any",
            "The material where the amount is 0.");
        add_part(
            "second", [at](auto& m) -> auto& { return at(m).second; }, "typing.Any",
            "The material where the amount is 1.");
    }
    void add(const ParameterInfo& info, ParameterAt<MaterialOfSide> at) const {
        add_part(info.python_name(), at, "typing.Any", info.doc);
    }

  private:
    // `at` finds a MaterialIndex or MaterialOfSide in a material. One that is in no scene takes parts of one scene only.
    template <typename At>
    void add_part(const std::string& name, At at, const char* type, const char* doc) const {
        attribute<M>(
            c, name.c_str(), type,
            [at](const M& m, const Ref<M>& r) -> nb::object {
                if (!at(m).is_given()) return nb::none();
                return as_python(Slot<Material>(scene_of_textures(r), at(m).index));
            },
            [at](M& m, nb::handle v, Ref<M>& r, const std::string& what) {
                using Part = std::remove_reference_t<decltype(at(m))>;
                if (std::is_same_v<Part, MaterialOfSide> && v.is_none()) {
                    at(m) = {};
                    return;
                }
                const nb::object given = nb::borrow(v);
                if (r.scene()) {
                    at(m) = {material_index(r.scene(), given, what)};
                    return;
                }
                const Slot<Material>* slot = material_slot(given);
                if (!slot || !slot->scene())
                    throw Error(what, std::string(nb::repr(v).c_str()) +
                                          " was given; expected a material of a scene, such as "
                                          "scene.materials[0]");
                require_scene(r, slot->scene(), what);
                at(m) = {slot->first()};
            },
            doc);
    }
    static void require_range(double x, double least, double most, nb::handle v, const std::string& what) {
        if (!(x >= least && x <= most))
            throw Error(what, std::string(nb::repr(v).c_str()) + " was given; expected a number from " +
                                  nb::repr(nb::float_(least)).c_str() + " to " +
                                  nb::repr(nb::float_(most)).c_str());
    }
    // `at` finds a FloatParameter in a material.
    template <typename At>
    void add_number(const std::string& name, At at, double least, double most, const char* doc) const {
        attribute<M>(
            c, name.c_str(), "typing.Any",
            [at](const M& m, const Ref<M>& r) { return number_or_texture(at(m), scene_of_textures(r)); },
            [=](M& m, nb::handle v, Ref<M>& r, const std::string& what) {
                const FloatParameter p = float_parameter_of(v, r, what);
                if (p.is_constant()) require_range(static_cast<double>(p.value), least, most, v, what);
                at(m) = p;
            },
            doc);
    }
};

} // namespace

void bind_materials(nb::module_& m) {
    nb::list kinds;
    for_each_material_kind([&]<typename M>(std::type_identity<M>) {
        auto c = value_class<M>(m, M::name, M::doc);
        M defaults;
        std::size_t n = 0;
        visit_parameters(defaults, [&]<typename Field>(const ParameterInfo& info, Field&) {
            Attributes<M>{c}.add(info, ParameterAt<Field>{n++});
        });
        kinds.append(c);
    });
    m.attr("MATERIALS") = nb::tuple(kinds);
}

} // namespace montelux::python
