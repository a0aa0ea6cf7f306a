#include "python/src/bindings.h"
#include "python/src/scene_values.h"
#include <string>

#include "montelux/scene/material/material.h"
#include "montelux/spectrum/named_spectra.h"

namespace montelux::python {
namespace {

constexpr const char* spectrum_type = "typing.Any";

// A spectrum or texture that `at` finds in a material.
template <typename T, typename At>
void spectrum(nb::class_<Ref<T>>& c, const char* name, At at, RgbMeaning meaning, const char* doc) {
    attribute<T>(
        c, name, spectrum_type,
        [at](const T& t, const Ref<T>& r) {
            return spectrum_or_texture(at(const_cast<T&>(t)), r.scene() ? r.scene() : r.textures_of);
        },
        [at, meaning](T& t, nb::handle v, Ref<T>& r, const std::string& what) {
            at(t) = spectrum_parameter_of(v, meaning, r, what);
        },
        doc);
}
template <typename T, typename At>
void index_of_refraction(nb::class_<Ref<T>>& c, const char* name, At at) {
    attribute<T>(
        c, name, spectrum_type, [at](const T& t, const auto&) { return nb::cast(at(const_cast<T&>(t))); },
        [at](T& t, nb::handle v, auto&, const std::string& what) {
            at(t) = spectrum_of(v, RgbMeaning::unbounded, what);
        },
        "Index of refraction: a number above zero, a Spectrum, or a name such as 'glass-BK7'.");
}
template <typename T, typename At>
void parameter(nb::class_<Ref<T>>& c, const char* name, At at, double least, double most, const char* doc) {
    attribute<T>(
        c, name, "typing.Any",
        [at](const T& t, const Ref<T>& r) {
            return number_or_texture(at(const_cast<T&>(t)), r.scene() ? r.scene() : r.textures_of);
        },
        [=](T& t, nb::handle v, Ref<T>& r, const std::string& what) {
            const FloatParameter p = float_parameter_of(v, r, what);
            const double x = static_cast<double>(p.value);
            if (p.is_constant() && !(x >= least && x <= most))
                throw Error(what, std::string(nb::repr(v).c_str()) + " was given; expected a number from " +
                                      nb::repr(nb::float_(least)).c_str() + " to " +
                                      nb::repr(nb::float_(most)).c_str());
            at(t) = p;
        },
        doc);
}
constexpr double no_bound = std::numeric_limits<double>::max();

// `roughness` sets both directions at once.
template <typename T, typename At>
void roughness(nb::class_<Ref<T>>& c, const std::string& prefix, At at) {
    parameter(
        c, (prefix + "roughness_u").c_str(), [at](T& t) -> FloatParameter& { return at(t).u; }, 0, no_bound,
        "GGX roughness along u; 0 is a mirror.");
    parameter(
        c, (prefix + "roughness_v").c_str(), [at](T& t) -> FloatParameter& { return at(t).v; }, 0, no_bound,
        "GGX roughness along v.");
    attribute<T>(
        c, (prefix + "roughness").c_str(), "typing.Any",
        [at](const T& t, const Ref<T>& r) {
            return number_or_texture(at(const_cast<T&>(t)).u, r.scene() ? r.scene() : r.textures_of);
        },
        [at](T& t, nb::handle v, Ref<T>& r, const std::string& what) {
            const FloatParameter p = float_parameter_of(v, r, what);
            if (p.is_constant() && !not_negative(static_cast<double>(p.value)))
                throw Error(what, std::string(nb::repr(v).c_str()) +
                                      " was given; expected a number that is not negative");
            at(t).u = at(t).v = p;
        },
        "GGX roughness along u and v together (a number or a texture); reads the one along u.");
    attribute<T>(
        c, (prefix + "remap_roughness").c_str(), "bool",
        [at](const T& t, const auto&) { return nb::bool_(at(const_cast<T&>(t)).remap); },
        [at](T& t, nb::handle v, auto&, const std::string& what) { at(t).remap = boolean_of(v, what); },
        "Whether alpha is the root of the roughness; else it is the roughness itself.");
}

template <typename T, typename At>
void conductor(nb::class_<Ref<T>>& c, const std::string& prefix, At at) {
    auto optical = [&](const char* name, SpectrumParameter ConductorMaterial::*member, const char* doc) {
        attribute<T>(
            c, (prefix + name).c_str(), spectrum_type,
            [at, member](const T& t, const Ref<T>& r) -> nb::object {
                const ConductorMaterial& m = at(const_cast<T&>(t));
                if (m.from_reflectance) return nb::none();
                return spectrum_or_texture(m.*member, r.scene() ? r.scene() : r.textures_of);
            },
            [at, member](T& t, nb::handle v, Ref<T>& r, const std::string& what) {
                at(t).*member = spectrum_parameter_of(v, RgbMeaning::unbounded, r, what);
                at(t).from_reflectance = false;
            },
            doc);
    };
    optical("eta", &ConductorMaterial::eta,
            "Real part of the index of refraction, such as 'metal-Au-eta'; None where a reflectance is set.");
    optical("k", &ConductorMaterial::k, "Imaginary part, such as 'metal-Au-k'.");
    attribute<T>(
        c, "reflectance", spectrum_type,
        [at](const T& t, const Ref<T>& r) -> nb::object {
            const ConductorMaterial& m = at(const_cast<T&>(t));
            if (!m.from_reflectance) return nb::none();
            return spectrum_or_texture(m.reflectance, r.scene() ? r.scene() : r.textures_of);
        },
        [at](T& t, nb::handle v, Ref<T>& r, const std::string& what) {
            at(t).reflectance = spectrum_parameter_of(v, RgbMeaning::albedo, r, what);
            at(t).from_reflectance = true;
        },
        "Reflectance at normal incidence, in the place of eta and k; None where these are set.");
    roughness(c, prefix, [at](T& t) -> RoughnessParameter& { return at(t).roughness; });
}

template <typename T>
void coating(nb::class_<Ref<T>>& c, const std::string& prefix) {
    roughness(c, prefix, [](T& t) -> RoughnessParameter& { return t.coating.roughness; });
    index_of_refraction(c, (prefix + "eta").c_str(), [](T& t) -> Spectrum& { return t.coating.eta; });
    parameter(
        c, "thickness", [](T& t) -> FloatParameter& { return t.coating.thickness; }, 0, no_bound,
        "Thickness of the layer between interface and base.");
    spectrum(
        c, "albedo", [](T& t) -> SpectrumParameter& { return t.coating.albedo; }, RgbMeaning::albedo,
        "Single-scattering albedo of the medium in the layer; 0: none.");
    parameter(
        c, "g", [](T& t) -> FloatParameter& { return t.coating.g; }, -1, 1,
        "Mean cosine of the scattering in that medium.");
    auto count = [&](const char* name, int CoatingParameters::*member, const char* doc) {
        attribute<T>(
            c, name, "int", [member](const T& t, const auto&) { return nb::int_(t.coating.*member); },
            [member](T& t, nb::handle v, auto&, const std::string& what) {
                t.coating.*member = static_cast<int>(whole_number_of(v, 1, 1 << 20, what));
            },
            doc);
    };
    count("max_depth", &CoatingParameters::max_depth, "Interface crossings of one random walk.");
    count("sample_count", &CoatingParameters::sample_count, "Random walks of one evaluation.");
}

SpectrumParameter grey() { return {spectrum_of(nb::float_(0.5), RgbMeaning::albedo, "")}; }
CoatingParameters clear_coat() {
    CoatingParameters c;
    c.eta = Spectrum(1.5f);
    c.albedo = {Spectrum(0.0f)};
    return c;
}

} // namespace

template <>
DiffuseMaterial default_value() {
    return {grey()};
}
template <>
ConductorMaterial default_value() {
    ConductorMaterial m;
    m.eta = {*find_named_spectrum("metal-Cu-eta")};
    m.k = {*find_named_spectrum("metal-Cu-k")};
    return m;
}
template <>
DielectricMaterial default_value() {
    return {Spectrum(1.5f), {}};
}
template <>
ThinDielectricMaterial default_value() {
    return {Spectrum(1.5f)};
}
template <>
CoatedDiffuseMaterial default_value() {
    return {grey(), clear_coat()};
}
template <>
CoatedConductorMaterial default_value() {
    return {default_value<ConductorMaterial>(), clear_coat()};
}

void bind_materials(nb::module_& m) {
    auto diffuse = value_class<DiffuseMaterial>(m, "Diffuse", "Lambert's matt surface.");
    spectrum(
        diffuse, "reflectance", [](DiffuseMaterial& d) -> SpectrumParameter& { return d.reflectance; },
        RgbMeaning::albedo, "Reflectance, 0 to 1: number, R, G, B, Spectrum or texture.");
    auto metal = value_class<ConductorMaterial>(m, "Conductor", "A metal.");
    conductor(metal, "", [](ConductorMaterial& c) -> ConductorMaterial& { return c; });
    auto glass = value_class<DielectricMaterial>(m, "Dielectric", "Glass, water: refracts and reflects.");
    index_of_refraction(glass, "eta", [](DielectricMaterial& d) -> Spectrum& { return d.eta; });
    roughness(glass, "", [](DielectricMaterial& d) -> RoughnessParameter& { return d.roughness; });
    auto pane =
        value_class<ThinDielectricMaterial>(m, "ThinDielectric", "A thin pane, which does not refract.");
    index_of_refraction(pane, "eta", [](ThinDielectricMaterial& d) -> Spectrum& { return d.eta; });
    auto varnished =
        value_class<CoatedDiffuseMaterial>(m, "CoatedDiffuse", "A matt surface under a clear coat.");
    spectrum(
        varnished, "reflectance",
        [](CoatedDiffuseMaterial& d) -> SpectrumParameter& { return d.reflectance; }, RgbMeaning::albedo,
        "Reflectance of the base, 0 to 1.");
    coating(varnished, "");
    auto lacquered =
        value_class<CoatedConductorMaterial>(m, "CoatedConductor", "A metal under a clear coat.");
    conductor(lacquered, "conductor_",
              [](CoatedConductorMaterial& c) -> ConductorMaterial& { return c.conductor; });
    coating(lacquered, "interface_");
}

} // namespace montelux::python
