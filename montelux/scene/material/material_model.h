// MaterialModel: the concept of a material, and functions derived from its list of parameters.
#pragma once

#include <concepts>
#include <type_traits>

#include "montelux/scene/bsdf/bsdf.h"
#include "montelux/scene/material/material.h"

namespace montelux {

// An Evaluator (parameter_evaluator.h) gives the values of parameters at a point.
template <typename M, typename Evaluator>
concept MaterialModel = requires(const M& m, M& changed, const Evaluator& at) {
    { M::name } -> std::convertible_to<const char*>; // in Python; pbrt's files use small letters
    { M::doc } -> std::convertible_to<const char*>;
    { m.detail } -> std::same_as<const SurfaceDetail&>;
    // Its own parameters (parameter.h), without those of `detail`.
    M::visit_parameters(m, [](const ParameterInfo&, const auto&) {});
    M::visit_parameters(changed, [](const ParameterInfo&, auto&) {});
    { m.bsdf(at) } -> std::convertible_to<Bsdf>;
};

// Calls f(std::type_identity<M>) for every material.
template <typename F>
void for_each_material_kind(F&& f) {
    [&]<typename... M>(std::type_identity<std::variant<M...>>) {
        (f(std::type_identity<M>{}), ...);
    }(std::type_identity<Material>{});
}

// visit(info, field) for every parameter of a material of type M, `detail` included.
template <typename M, typename Visit>
void visit_parameters(M& m, Visit&& visit) {
    M::visit_parameters(m, visit);
    SurfaceDetail::visit_parameters(m.detail, visit);
}

// visit(name, field) for every simple field of a material (parameter.h, visit_leaves).
template <typename Visit>
void visit_fields(const Material& material, Visit&& visit) {
    std::visit(
        [&](const auto& m) {
            visit_parameters(m, [&](const ParameterInfo& info, const auto& field) {
                visit_leaves(info.name, field, visit);
            });
        },
        material);
}

// Whether making the BSDF, or its frame, looks up a texture.
bool is_textured(const Material& material);
// The same without surface detail.
bool has_textured_bsdf(const Material& material);
// Whether the BSDF's lobes depend on the direction of the tangents.
bool is_anisotropic(const Material& material);

} // namespace montelux
