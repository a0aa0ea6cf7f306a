// Translucent bodies whose coefficients vary over the surface: those of the entry point count.
#include "test/render/scene_testing.h"
#include <gtest/gtest.h>

#include "montelux/scene/medium/semi_infinite_albedo.h"

namespace montelux::testing {
namespace {

// A wide flat body below z = 0 under uniform light, its texture coordinate u along x. The camera sees x < 0 in the left
// half of the picture. Paths end where they leave the body.
SceneDescription slab(const BodySurface& surface, SceneSpectrum sigma_a, SceneSpectrum sigma_s,
                      const SceneBuilder& base) {
    SceneBuilder b = base;
    b.add_uniform_light(1);
    b.scene.media.push_back(
        HomogeneousMedium{.sigma_a = sigma_a, .sigma_s = sigma_s, .is_body = true, .surface = surface});
    TriangleMesh mesh = square(Transform::scale({1e3, 1e3, 1}));
    mesh.uvs = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    const Index shape = b.add_mesh(std::move(mesh), b.add(SubsurfaceMaterial{.eta = 1.4f, .interior = {0}}));
    b.scene.shapes[shape].media.inside = 0;
    b.look({0, 0, 2}, {0, 0, 0}, 60);
    b.description.integrator.max_depth = 1;
    return b.description;
}

// Two constant values, for negative and positive u.
SpectrumParameter halves(SceneBuilder& b, SceneSpectrum left, SceneSpectrum right) {
    CheckerboardTexture<SpectrumParameter> t;
    t.mapping.su = 0.5f; // one cell on each side
    t.mapping.sv = 0;
    t.mapping.dv = 0.5f;
    t.values = {SpectrumParameter{right}, SpectrumParameter{left}};
    b.scene.spectrum_textures.push_back(t);
    return {{}, static_cast<Index>(b.scene.spectrum_textures.size() - 1)};
}

// x < 0 is the left half of the picture if +x is on the right there.
bool same_half(const Film& a, const Film& b, bool left) {
    for (int y = 0; y < 8; ++y)
        for (int x = left ? 0 : 5; x < (left ? 3 : 8); ++x)
            if (!same_pixel(a.pixel(x, y), b.pixel(x, y))) return false;
    return true;
}

TEST(BodySurface, CoefficientsAreThoseOfTheEntryPoint) {
    SceneBuilder b;
    BodySurface surface{.kind = BodySurface::Kind::coefficients,
                        .first = halves(b, 0.2f, 1.0f),
                        .second = halves(b, 3.0f, 1.0f)};
    const Film textured = render(slab(surface, 0, 0, b)), one = render(slab({}, 0.2f, 3.0f, b)),
               other = render(slab({}, 1.0f, 1.0f, b));
    // Walks below the boundary between the two cross it, and keep what they have entered with.
    const bool mirrored = !same_half(textured, one, true);
    EXPECT_TRUE(same_half(textured, one, !mirrored));
    EXPECT_TRUE(same_half(textured, other, mirrored));
    EXPECT_FALSE(same_half(textured, other, !mirrored));
}

// A constant reflectance comes back: the mean radiance of a wide body under uniform light is the Fresnel reflection plus
// the transmitted share times the reflectance.
TEST(BodySurface, ReflectanceComesBack) {
    for (const float g : {0.0f, 0.6f}) {
        SceneBuilder b;
        BodySurface surface{.kind = BodySurface::Kind::reflectance,
                            .first = halves(b, 0.6f, 0.6f),
                            .second = {0.5f},
                            .scale = 2,
                            .eta = 1.4f,
                            .g = g};
        SceneDescription d = slab(surface, 0, 0, b);
        std::get<HomogeneousMedium>(d.scene.media[0]).phase = HenyeyGreenstein{g};
        d.sampler.spp = 512;
        d.film.width = d.film.height = 2;
        d.film.crop = {0, 0, 2, 2};
        std::get<PerspectiveCamera>(d.scene.camera.model).fov = 1;
        const PictureMean m = picture_mean(render(d));
        const double f = double(fresnel_dielectric(1, 1.4f)), truth = f + (1 - f) * 0.6;
        // Similarity is exact for no phase function but the isotropic one.
        EXPECT_NEAR(m.mean, truth, 5.5 * m.standard_error + (g == 0 ? 2e-3 : 0.03)) << g;
    }
}

TEST(BodySurface, AlbedoOfAReflectance) {
    for (const float g : {0.0f, -0.3f, 0.7f})
        for (const float r : {0.0f, 0.3f, 0.9f, 1.0f}) {
            const float a = body_albedo(r, 1.3f, g), reduced = single_scattering_albedo(r, 1.3f);
            EXPECT_NEAR(a * (1 - g) / (a * (1 - g) + 1 - a), reduced, 1e-5) << g << ' ' << r;
        }
}

} // namespace
} // namespace montelux::testing
