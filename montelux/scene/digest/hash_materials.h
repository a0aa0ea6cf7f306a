// The values of materials, by their lists of parameters.
#pragma once

#include <concepts>
#include <string_view>

#include "montelux/scene/bsdf/measured_brdf.h"
#include "montelux/scene/digest/hash_textures.h"
#include "montelux/scene/digest/scene_hasher.h"
#include "montelux/scene/material/material_model.h"

namespace montelux {

// Materials are what has surface detail.
template <HashedStruct M>
requires requires(const M& m) {
    { m.detail } -> std::same_as<const SurfaceDetail&>;
}
void hash_values(SceneHasher& h, const M& material) {
    visit_parameters(material, [&](const ParameterInfo& info, const auto& field) {
        if constexpr (requires { has_no_effect(field); }) {
            if (info.added && has_no_effect(field)) return;
            if (info.added) h.all(info.name);
        }
        visit_leaves(info.name, field, [&](std::string_view, const auto& value) { h.all(value); });
    });
}

inline void hash_values(SceneHasher& h, const NormalMapParameter& p) {
    const auto& [map] = p;
    h.all(map);
}

inline void hash_values(SceneHasher& h, const MeasuredBrdfIndex& b) {
    const auto& [index] = b;
    h.all(index);
}
inline void hash_values(SceneHasher& h, const MediumIndex& m) {
    const auto& [index] = m;
    h.all(index);
}
inline void hash_values(SceneHasher& h, const BrdfTables& t) {
    const auto& [columns, rows, values] = t;
    h.all(columns, rows, values);
}
// Its distributions follow from its data.
inline void hash_values(SceneHasher& h, const MeasuredBrdf& b) {
    const auto& [theta, phi, wavelengths, ndf, sigma, visible_normals, luminance, spectra] = b.data();
    h.all(theta, phi, wavelengths, ndf, sigma, visible_normals, luminance, spectra);
}

inline void hash_values(SceneHasher& h, const MaterialIndex& r) {
    const auto& [index] = r;
    h.all(index);
}
inline void hash_values(SceneHasher& h, const MaterialOfSide& r) {
    const auto& [index] = r;
    h.all(index);
}

} // namespace montelux
