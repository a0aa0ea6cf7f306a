// Functions derived from a material's list of parameters.
#pragma once

#include <concepts>
#include <type_traits>

#include "montelux/scene/material/material.h"
#include "montelux/spectrum/named_spectra.h"

namespace montelux {

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

// A material with the defaults of scene files, among them measured spectra. `add` puts a Spectrum into the
// scene and returns its SceneSpectrum.
template <typename M, typename AddSpectrum>
M default_material(const AddSpectrum& add) {
    M material;
    visit_parameters(material, [&]<typename Field>(const ParameterInfo&, Field& field) {
        if constexpr (std::is_same_v<Field, MetalParameter>) {
            field.eta.value = add(*find_named_spectrum(Field::default_eta));
            field.k.value = add(*find_named_spectrum(Field::default_k));
        }
    });
    return material;
}

// visit(name, field) for every simple field of a material (parameter.h, visit_leaves).
template <typename M, typename Visit>
requires std::same_as<std::remove_const_t<M>, Material>
void visit_fields(M& material, Visit&& visit) {
    std::visit(
        [&](auto& m) {
            visit_parameters(
                m, [&](const ParameterInfo& info, auto& field) { visit_leaves(info.name, field, visit); });
        },
        material);
}

// visit(index) for each of the materials that it chooses among: those of a mix, the sides that are not black.
template <typename Visit>
void visit_parts(const Material& material, Visit&& visit) {
    visit_fields(material, [&]<typename Field>(std::string_view, const Field& field) {
        if constexpr (std::is_same_v<Field, MaterialIndex> || std::is_same_v<Field, MaterialOfSide>)
            if (field.is_given()) visit(field.index);
    });
}

// The following say nothing of a material's parts.
// Whether making the BSDF, or its frame, looks up a texture.
bool is_textured(const Material& material);
// Whether the BSDF needs texture coordinates, for textures or itself.
bool uses_coordinates(const Material& material);
// The same as is_textured without surface detail.
bool has_textured_bsdf(const Material& material);
// Whether the BSDF's lobes depend on the direction of the tangents.
bool is_anisotropic(const Material& material);

} // namespace montelux
