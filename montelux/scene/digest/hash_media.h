// The values of media, of their grids and of interfaces between them.
#pragma once

#include "montelux/scene/digest/hash_textures.h"
#include "montelux/scene/digest/scene_hasher.h"
#include "montelux/scene/medium/medium.h"
#include "montelux/scene/shape/shape.h"

namespace montelux {

inline void hash_values(SceneHasher& h, const MediumInterface& m) {
    const auto& [inside, outside] = m;
    h.all(inside, outside);
}
inline void hash_values(SceneHasher& h, const HenyeyGreenstein& p) {
    const auto& [g] = p;
    h.all(g);
}
inline void hash_values(SceneHasher& h, const Draine& p) {
    const auto& [g, alpha] = p;
    h.all(g, alpha);
}
inline void hash_values(SceneHasher& h, const MediumBox& b) {
    const auto& [p0, p1, world_from_medium] = b;
    h.all(p0, p1, world_from_medium);
}
template <typename T>
void hash_values(SceneHasher& h, const Grid3<T>& g) {
    const auto& [size, values] = g;
    h.all(size, values);
}
inline void hash_values(SceneHasher& h, const ScalarGrid& g) { h.all(static_cast<const Grid3<float>&>(g)); }
inline void hash_values(SceneHasher& h, const ColorGrid& g) {
    h.all(static_cast<const Grid3<ScaledPolynomial>&>(g));
}
inline void hash_values(SceneHasher& h, const HomogeneousMedium& m) {
    const auto& [sigma_a, sigma_s, scale, le, le_scale, phase, is_body, surface] = m;
    h.all(sigma_a, sigma_s, scale, le, le_scale, phase);
    if (is_body) h.all(is_body);
    if (!surface.is_given()) return;
    const auto& [kind, first, second, surface_scale, eta, g] = surface;
    h.all(kind, first, second, surface_scale, eta, g);
}
inline void hash_values(SceneHasher& h, const GridMedium& m) {
    const auto& [box, density, sigma_a, sigma_s, scale, le, le_scale, le_grid, temperature, offset,
                 temperature_scale, phase] = m;
    h.all(box, density, sigma_a, sigma_s, scale, le, le_scale, le_grid, temperature, offset,
          temperature_scale, phase);
}
inline void hash_values(SceneHasher& h, const RgbGridMedium& m) {
    const auto& [box, sigma_a, sigma_s, scale, le, illuminant, le_scale, phase] = m;
    h.all(box, sigma_a, sigma_s, scale, le, illuminant, le_scale, phase);
}
inline void hash_values(SceneHasher& h, const SparseGrid& g) {
    const auto& [node_count, nodes, blocks, values, constants] = g;
    h.all(node_count, nodes, blocks, values, constants);
}
inline void hash_values(SceneHasher& h, const SparseGridMedium& m) {
    const auto& [box, density, sigma_a, sigma_s, scale, temperature, temperature_space, le_scale, offset,
                 temperature_scale, phase] = m;
    h.all(box, density, sigma_a, sigma_s, scale, temperature, temperature_space, le_scale, offset,
          temperature_scale, phase);
}
inline void hash_values(SceneHasher& h, const MediumField& f) {
    const auto& [value, scalars, colors, nearest, wrap, unit_from_world] = f;
    const auto& [rows, offset] = unit_from_world;
    h.all(value, scalars, colors, nearest, wrap, rows, offset);
}
inline void hash_values(SceneHasher& h, const FieldMedium& m) {
    const auto& [box, bounded, extinction, albedo, scale, phase] = m;
    h.all(box, bounded, extinction, albedo, scale, phase);
}
inline void hash_values(SceneHasher& h, const CloudMedium& m) {
    const auto& [box, sigma_a, sigma_s, density, wispiness, frequency, phase] = m;
    h.all(box, sigma_a, sigma_s, density, wispiness, frequency, phase);
}

} // namespace montelux
