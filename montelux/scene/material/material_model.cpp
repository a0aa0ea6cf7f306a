#include "montelux/scene/material/material_model.h"

#include <concepts>
#include <type_traits>
#include <utility>

#include "montelux/scene/material/parameter_evaluator.h"

namespace montelux {

namespace {

// A material: its name, its parameters and its BSDF.
template <typename M>
concept MaterialModel = requires(const M& m, M& changed, const ParameterEvaluator& at) {
    { M::name } -> std::convertible_to<const char*>; // in Python; pbrt's files use small letters
    { M::doc } -> std::convertible_to<const char*>;
    { m.detail } -> std::same_as<const SurfaceDetail&>;
    // Its own parameters (parameter.h), without those of `detail`.
    M::visit_parameters(m, [](const ParameterInfo&, const auto&) {});
    M::visit_parameters(changed, [](const ParameterInfo&, auto&) {});
    { m.bsdf(at) } -> std::convertible_to<Bsdf>;
};
template <typename... M>
constexpr bool all_are_material_models(std::type_identity<std::variant<M...>>) {
    return (MaterialModel<M> && ...);
}
static_assert(all_are_material_models(std::type_identity<Material>{}));

template <BsdfModel B>
constexpr bool uses_tangents(std::type_identity<B>) {
    return B::traits.uses_tangents;
}
template <typename... B>
constexpr bool uses_tangents(std::type_identity<std::variant<B...>>) {
    return (B::traits.uses_tangents || ...);
}

// For visit_leaves.
struct FindTexture {
    bool& found;

    void operator()(std::string_view, const FloatParameter& p) const { found |= !p.is_constant(); }
    void operator()(std::string_view, const SpectrumParameter& p) const { found |= !p.is_constant(); }
    void operator()(std::string_view, const NormalMapParameter& p) const { found |= p.is_given(); }
    void operator()(std::string_view, const MeasuredBrdfIndex&) const {}
    void operator()(std::string_view, const MediumIndex&) const {}
    void operator()(std::string_view, const MaterialIndex&) const {}
    void operator()(std::string_view, const MaterialOfSide&) const {}
    void operator()(std::string_view, const SceneSpectrum&) const {}
    void operator()(std::string_view, MicrofacetDistribution) const {}
    void operator()(std::string_view, float) const {}
    void operator()(std::string_view, int) const {}
    void operator()(std::string_view, bool) const {}
};

} // namespace

bool has_textured_bsdf(const Material& material) {
    bool found = false;
    std::visit(
        [&]<typename M>(const M& m) {
            M::visit_parameters(m, [&](const ParameterInfo& info, const auto& field) {
                visit_leaves(info.name, field, FindTexture{found});
            });
        },
        material);
    return found;
}

bool is_textured(const Material& material) {
    bool found = false;
    visit_fields(material, FindTexture{found});
    return found;
}

bool uses_coordinates(const Material& material) {
    return is_textured(material) || std::visit(
                                        []<typename M>(const M&) {
                                            return requires { M::uses_coordinates; };
                                        },
                                        material);
}

bool is_anisotropic(const Material& material) {
    return std::visit(
        []<typename M>(const M& m) {
            if constexpr (requires { m.is_anisotropic(); }) return m.is_anisotropic();
            using Made = decltype(m.bsdf(std::declval<const ParameterEvaluator&>()));
            if (!uses_tangents(std::type_identity<Made>{})) return false;
            // Lobes without roughness depend on the tangents for other reasons.
            bool has_roughness = false, differs = false;
            M::visit_parameters(m, [&](const ParameterInfo&, const auto& field) {
                if constexpr (requires { field.is_anisotropic(); }) {
                    has_roughness = true;
                    differs |= field.is_anisotropic();
                }
            });
            return differs || !has_roughness;
        },
        material);
}

} // namespace montelux
