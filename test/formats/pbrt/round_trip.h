// Scenes that are written and read again: whether all values come back.
#pragma once

#include "test/image/image_testing.h"
#include <filesystem>
#include <gtest/gtest.h>
#include <string>

#include "montelux/formats/load_scene.h"
#include "montelux/formats/pbrt/write_pbrt.h"
#include "montelux/scene/scene_digest.h"

namespace montelux::test {

// With inverses computed from the matrices, as they are where a scene file gives a matrix.
inline Transform with_own_inverse(const Transform& t) { return *Transform::from_matrix(t.matrix()); }
// Of transformations whose inverse is what a file gives.
inline Transform with_own_matrix(const Transform& t) { return with_own_inverse(t.inverse()).inverse(); }

inline Scene with_own_inverses(Scene s) {
    const auto fix = [](Transform& t) { t = with_own_inverse(t); };
    for (Quadric& q : s.quadrics) std::visit([&](auto& shape) { fix(shape.world_from_object); }, q);
    for (Instance& i : s.instances) fix(i.world_from_object);
    for (Motion& m : s.motions)
        if (!m.is_product()) m = Motion(with_own_inverse(m.start()), with_own_inverse(m.end()));
    const auto fix_texture = [](auto& node) {
        std::visit(
            [](auto& t) {
                if constexpr (requires { t.mapping; })
                    t.mapping.texture_from_world = with_own_matrix(t.mapping.texture_from_world);
                if constexpr (requires { t.texture_from_world; })
                    t.texture_from_world = with_own_matrix(t.texture_from_world);
            },
            node);
    };
    for (FloatTexture& t : s.float_textures) fix_texture(t);
    for (SpectrumTexture& t : s.spectrum_textures) fix_texture(t);
    for (Light& l : s.lights)
        std::visit(
            [&](auto& light) {
                if constexpr (requires { light.world_from_light; }) fix(light.world_from_light);
                if constexpr (requires { light.world_from_map; }) fix(light.world_from_map);
            },
            l);
    for (Medium& m : s.media)
        std::visit(
            [&](auto& medium) {
                if constexpr (requires { medium.box; }) fix(medium.box.world_from_medium);
            },
            m);
    s.camera.world_from_camera = with_own_matrix(s.camera.world_from_camera);
    if (s.camera.motion)
        s.camera.motion.emplace(with_own_matrix(s.camera.motion->start()),
                                with_own_matrix(s.camera.motion->end()));
    return s;
}

inline void expect_same(const SceneDescription& a, const SceneDescription& b) {
    const SceneDigest before = digest_of(with_own_inverses(a.scene)),
                      after = digest_of(with_own_inverses(b.scene));
    EXPECT_EQ(before.geometry, after.geometry);
    EXPECT_EQ(before.materials, after.materials);
    EXPECT_EQ(before.textures, after.textures);
    EXPECT_EQ(before.lights, after.lights);
    EXPECT_EQ(before.camera, after.camera);
    EXPECT_EQ(a.film.width, b.film.width);
    EXPECT_EQ(a.film.height, b.film.height);
    EXPECT_EQ(a.film.crop, b.film.crop);
    EXPECT_EQ(a.film.filter.index(), b.film.filter.index());
    EXPECT_EQ(a.film.iso, b.film.iso);
    EXPECT_EQ(a.film.exposure_time, b.film.exposure_time);
    EXPECT_EQ(a.film.white_balance, b.film.white_balance);
    EXPECT_EQ(a.film.sensor, b.film.sensor);
    EXPECT_EQ(a.film.max_component_value, b.film.max_component_value);
    EXPECT_EQ(a.film.layers, b.film.layers);
    EXPECT_EQ(a.film.spectral.has_value(), b.film.spectral.has_value());
    EXPECT_EQ(a.sampler.kind, b.sampler.kind);
    EXPECT_EQ(a.sampler.seed, b.sampler.seed);
    EXPECT_EQ(a.sampler.spp, b.sampler.spp);
    EXPECT_EQ(a.integrator.max_depth, b.integrator.max_depth);
    EXPECT_EQ(a.integrator.strategy, b.integrator.strategy);
    EXPECT_EQ(a.integrator.light_sampling, b.integrator.light_sampling);
    EXPECT_EQ(a.integrator.regularize, b.integrator.regularize);
    EXPECT_EQ(a.integrator.environment_lookup, b.integrator.environment_lookup);
    EXPECT_EQ(a.integrator.microfacet_scattering, b.integrator.microfacet_scattering);
    EXPECT_EQ(a.integrator.shading_terminator, b.integrator.shading_terminator);
    EXPECT_EQ(a.integrator.background, b.integrator.background);
    EXPECT_EQ(a.integrator.occlusion.has_value(), b.integrator.occlusion.has_value());
    EXPECT_EQ(a.output_file, b.output_file);
    EXPECT_EQ(a.scene.light_groups, b.scene.light_groups);
}

// Writes, reads and compares; what the writer warns of.
inline Warnings expect_round_trip(const SceneDescription& original) {
    TemporaryFolder folder;
    Warnings of_writing, of_reading;
    write_pbrt(original, folder / "again.pbrt", of_writing);
    const SceneDescription again = load_scene(folder / "again.pbrt", of_reading);
    for (const std::string& w : of_reading.messages())
        EXPECT_TRUE(w.find("no light") != std::string::npos || w.find("is black") != std::string::npos ||
                    w.find("regularize") != std::string::npos)
            << w;
    expect_same(original, again);
    return of_writing;
}

} // namespace montelux::test
