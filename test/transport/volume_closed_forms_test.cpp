// Media whose radiance is known from algebra, at each wavelength of the path.
#include "test/transport/volume_testing.h"

#include "montelux/mc/math/quadrature.h"
#include "montelux/scene/medium/semi_infinite_albedo.h"

namespace montelux::testing {
namespace {

const Ray straight{{0.1f, 0.2f, -3}, {0, 0, 1}};

// A coefficient that is linear in the wavelength.
struct Line {
    float at_360, at_830;
    double operator()(float lambda) const { return double(line(at_360, at_830)(lambda)); }
};

TEST(VolumeClosedForms, TransmittanceOfASlab) {
    const Line a{0.3f, 0.1f}, s{0.2f, 1.5f};
    VolumeScene b;
    b.add_slab(b.add_medium(HomogeneousMedium{
                   .sigma_a = b.spectrum(0.3f, 0.1f), .sigma_s = b.spectrum(0.2f, 1.5f), .scale = 2}),
               1.25);
    b.add_sky();
    b.description.integrator.max_depth = 0; // what was not scattered
    for (const Vec3f d : {Vec3f(0, 0, 1), normalize(Vec3f(0.5f, -0.3f, 1))})
        expect_radiance(
            volume_radiance(b.description, {straight.o, d}, 40000),
            [&](float l) { return std::exp(-2 * (a(l) + s(l)) * 1.25 / double(d.z)); }, "slab");
}

// Where nothing scatters there is no noise.
TEST(VolumeClosedForms, AbsorbingSlabIsExact) {
    const Line a{0.3f, 1.1f};
    VolumeScene b;
    b.add_slab(b.add_medium(HomogeneousMedium{.sigma_a = b.spectrum(0.3f, 1.1f), .sigma_s = 0.0f}), 2);
    b.add_sky();
    const SpectralMean mean = volume_radiance(b.description, straight, 8);
    for (const RunningMoments& m : mean.moments) EXPECT_LT(m.variance(), 1e-12);
    expect_radiance(
        mean, [&](float l) { return std::exp(-a(l) * 2); }, "absorbing slab");
}

TEST(VolumeClosedForms, EmissionOfASlab) {
    const Line a{0.3f, 1.1f};
    for (const float scattering : {0.0f, 0.7f}) {
        VolumeScene b;
        b.add_slab(b.add_medium(HomogeneousMedium{.sigma_a = b.spectrum(0.3f, 1.1f),
                                                  .sigma_s = scattering,
                                                  .le = b.spectrum(1, 3),
                                                  .le_scale = 2}),
                   1.5);
        b.description.integrator.max_depth = 0;
        expect_radiance(
            volume_radiance(b.description, straight, 100000),
            [&](float l) {
                const double sigma_t = a(l) + double(scattering);
                return 2 * Line{1, 3}(l)*a(l) / sigma_t * (1 - std::exp(-sigma_t * 1.5));
            },
            "emission");
    }
}

// A thin gas: the digits of 1 - e^-x must not be lost.
TEST(VolumeClosedForms, EmissionOfAThinGas) {
    VolumeScene b;
    b.add_slab(b.add_medium(HomogeneousMedium{.sigma_a = 1e-6f, .sigma_s = 0.0f, .le = 1.0f}), 1);
    expect_radiance(
        volume_radiance(b.description, straight, 8), [](float) { return 1e-6; }, "thin gas");
}

// Three panes before an absorbing slab before a fourth. A path without events passes them all; with one, a pane may
// mirror it back.
TEST(VolumeClosedForms, PassagesNeedNotCount) {
    const double fresnel = 0.04, mirrored = 2 * fresnel / (1 + fresnel), t = 1 - mirrored,
                 absorbed = std::exp(-0.5);
    VolumeScene b;
    b.add_slab(b.add_medium(HomogeneousMedium{.sigma_a = 0.25f, .sigma_s = 0.0f}), 2);
    const Index pane = b.add(ThinDielectricMaterial{.eta = 1.5f});
    for (const double z : {-2.0, -1.5, -1.0, 3.0})
        b.add_mesh(square(Transform::translate({0, 0, z}) * Transform::scale({1e3, 1e3, 1})), pane);
    b.add_sky();
    b.description.integrator.count_passages = false;
    b.description.integrator.max_depth = 0;
    const double through = std::pow(t, 4) * absorbed;
    expect_radiance(
        volume_radiance(b.description, straight, 40000), [&](float) { return through; }, "no event");
    b.description.integrator.max_depth = 1;
    const double back =
        mirrored * (1 + std::pow(t, 2) + std::pow(t, 4) + std::pow(t, 6) * absorbed * absorbed);
    expect_radiance(
        volume_radiance(b.description, straight, 40000), [&](float) { return through + back; }, "one event");
    b.description.integrator.count_passages = true;
    expect_radiance(
        volume_radiance(b.description, straight, 40000), [&](float) { return mirrored; }, "all count");
}

// L = sigma_s p E (1 - e^(-sigma_t d (1 + 1/mu))) / (sigma_t (1 + 1/mu)), mu the cosine of the incident light.
TEST(VolumeClosedForms, SingleScatteringOfASlab) {
    const double mu = 0.8, d = 1.3;
    const Line s{0.4f, 2};
    for (const float g : {0.0f, 0.6f}) {
        VolumeScene b;
        b.add_slab(b.add_medium(HomogeneousMedium{
                       .sigma_a = 0.3f, .sigma_s = b.spectrum(0.4f, 2), .phase = HenyeyGreenstein{g}}),
                   d);
        const Vec3f to_light(0.6f, 0, -0.8f);
        b.scene.lights.push_back(DistantLight{SceneSpectrum(5.0f), 1, to_light});
        b.description.integrator.max_depth = 1;
        const double phase = double(HenyeyGreenstein{g}.pdf({0, 0, -1}, to_light));
        expect_radiance(
            volume_radiance(b.description, straight, 100000),
            [&](float l) {
                const double sigma_t = 0.3 + s(l), x = sigma_t * (1 + 1 / mu);
                return s(l) * phase * 5 * (1 - std::exp(-x * d)) / x;
            },
            "single scattering, g = " + std::to_string(g));
    }
}

// Chandrasekhar 1960, "Radiative Transfer", chapter V: H of isotropic scattering with albedo w solves
// 1 / H(mu) = sqrt(1 - w) + (w / 2) integral over x in [0, 1] of x H(x) / (mu + x).
class ChandrasekharH {
  public:
    explicit ChandrasekharH(double albedo)
        : albedo_(albedo), rule_(gauss_legendre_rule(64)), h_(rule_.size(), 1) {
        for (int i = 0; i < 200; ++i) {
            std::vector<double> next;
            for (const QuadratureNode& node : rule_) next.push_back((*this)(node.x));
            for (std::size_t k = 0; k < h_.size(); ++k) h_[k] = 0.5 * (h_[k] + next[k]); // it would oscillate
        }
    }
    double operator()(double mu) const {
        double sum = 0;
        for (std::size_t i = 0; i < rule_.size(); ++i)
            sum += rule_[i].weight * rule_[i].x * h_[i] / (mu + rule_[i].x);
        return 1 / (std::sqrt(1 - albedo_) + 0.5 * albedo_ * sum);
    }

  private:
    double albedo_;
    std::vector<QuadratureNode> rule_;
    std::vector<double> h_;
};

// Under uniform radiance 1 a half-space shows its plane albedo, 1 - sqrt(1 - w) H(mu).
TEST(VolumeClosedForms, AlbedoOfAHalfSpace) {
    EXPECT_NEAR(ChandrasekharH(1)(1), 2.9078, 1e-3); // Chandrasekhar's table XI
    const Line s{0.5f, 6};
    for (const Strategy strategy : volume_strategies) {
        VolumeScene b;
        const Index medium = b.add_medium(HomogeneousMedium{.sigma_a = 0.5f, .sigma_s = b.spectrum(0.5f, 6)});
        b.bound(b.add_mesh(square(Transform::scale({1e3, 1e3, 1})), b.interface()), no_index, medium);
        b.add_sky();
        b.description.integrator.strategy = strategy;
        for (const float mu : {0.3f, 1.0f}) {
            const Vec3f d(std::sqrt(1 - mu * mu), 0, mu);
            expect_radiance(
                volume_radiance(b.description, {Point3f(0, 0, 0) - d * 2, d}, 40000),
                [&](float l) {
                    const double albedo = s(l) / (0.5 + s(l));
                    return 1 - std::sqrt(1 - albedo) * ChandrasekharH(albedo)(double(mu));
                },
                "strategy " + std::to_string(int(strategy)));
        }
    }
}

// Diffuse Fresnel reflectance from outside, by quadrature.
double diffuse_fresnel(float eta) {
    double sum = 0;
    for (const QuadratureNode& node : gauss_legendre_rule(64))
        sum += 2 * node.weight * node.x * double(fresnel_dielectric(static_cast<float>(node.x), eta));
    return sum;
}
// Of a half-space under diffuse light, without a boundary.
double diffuse_albedo(double single) {
    const ChandrasekharH h(single);
    double moment = 0;
    for (const QuadratureNode& node : gauss_legendre_rule(32)) moment += node.weight * node.x * h(node.x);
    return 1 - 2 * std::sqrt(1 - single) * moment;
}

TEST(VolumeClosedForms, DiffuseFresnelReflectance) {
    for (const float eta : {1.0f, 1.0005f, 1.01f, 1.33f, 1.5f, 2.5f}) {
        EXPECT_NEAR(double(diffuse_fresnel_reflectance(eta)), diffuse_fresnel(eta), 2e-3) << eta;
        if (eta > 1.1f) {
            EXPECT_NEAR(double(diffuse_fresnel_reflectance(eta)), diffuse_fresnel(eta), 1e-4) << eta;
        }
    }
}

TEST(VolumeClosedForms, SingleScatteringAlbedoOfAReflectance) {
    for (const float eta : {1.0f, 1.33f, 1.7f})
        for (const float reflectance : {0.0f, 0.01f, 0.3f, 0.8f, 0.97f, 1.0f}) {
            const float single = single_scattering_albedo(reflectance, eta);
            const double r = 1 - (1 - diffuse_fresnel(eta)) / double(eta * eta),
                         inside = diffuse_albedo(double(single));
            EXPECT_NEAR((1 - r) * inside / (1 - r * inside), double(reflectance), 5e-4)
                << eta << ' ' << single;
        }
}

// A path that may scatter once enters, walks and leaves a translucent half-space: F + (1 - F) A, where of the light that
// has entered A = (1 - r) R / (1 - r R) leaves.
TEST(VolumeClosedForms, TranslucentHalfSpace) {
    const Line s{0.5f, 6};
    const float eta = 1.4f;
    const double r = 1 - (1 - diffuse_fresnel(eta)) / double(eta * eta);
    for (const Strategy strategy : {Strategy::bsdf, Strategy::light, Strategy::mis}) {
        VolumeScene b;
        const Index medium = b.add_medium(
            HomogeneousMedium{.sigma_a = 0.1f, .sigma_s = b.spectrum(0.5f, 6), .phase = {}, .is_body = true});
        // The body is below the normal, at z > 0.
        b.bound(b.add_mesh(square(Transform::scale({1e3, 1e3, 1}) * Transform::rotate(180, {1, 0, 0})),
                           b.add(SubsurfaceMaterial{.eta = eta})),
                medium);
        b.add_sky();
        b.description.integrator.strategy = strategy;
        b.description.integrator.max_depth = 1;
        for (const float mu : {0.3f, 1.0f}) {
            const Vec3f d(std::sqrt(1 - mu * mu), 0, mu);
            expect_radiance(
                volume_radiance(b.description, {Point3f(0, 0, 0) - d * 2, d}, 40000),
                [&](float l) {
                    const double inside = diffuse_albedo(s(l) / (0.1 + s(l)));
                    const auto f = double(fresnel_dielectric(mu, eta));
                    return f + (1 - f) * (1 - r) * inside / (1 - r * inside);
                },
                "strategy " + std::to_string(int(strategy)), 2e-4);
        }
    }
}

// Nothing is lost in a white body with a smooth surface.
TEST(VolumeClosedForms, FurnaceOfATranslucentBody) {
    for (const Strategy strategy : {Strategy::bsdf, Strategy::light, Strategy::mis}) {
        VolumeScene b;
        const Index medium = b.add_medium(HomogeneousMedium{.sigma_a = 0.0f,
                                                            .sigma_s = b.spectrum(0.5f, 4),
                                                            .phase = HenyeyGreenstein{0.5f},
                                                            .is_body = true});
        b.add_cube(medium);
        for (Shape& shape : b.scene.shapes) shape.material = b.add(SubsurfaceMaterial{.eta = 1.5f});
        b.add_sky();
        b.description.integrator.strategy = strategy;
        b.description.integrator.max_depth = 100;
        expect_radiance(
            volume_radiance(b.description, straight, 20000), [](float) { return 1.0; },
            "strategy " + std::to_string(int(strategy)));
    }
}

// What only scatters cannot be seen against uniform light.
TEST(VolumeClosedForms, FurnaceOfEveryMedium) {
    for (const int kind : {0, 1, 2, 3})
        for (const Strategy strategy : volume_strategies) {
            // Uniform directions make heavy tails of a phase function that is not uniform.
            const float g = strategy == Strategy::uniform ? 0.0f : 0.4f;
            VolumeScene b;
            Medium medium;
            const SceneSpectrum s = b.spectrum(0.5f, 4);
            std::vector<float> wild;
            for (int i = 0; i < 5 * 4 * 3; ++i) wild.push_back(static_cast<float>(i * i * 7 % 11));
            if (kind == 0) {
                medium = HomogeneousMedium{.sigma_a = 0.0f, .sigma_s = s, .phase = HenyeyGreenstein{-g}};
            } else if (kind == 1) {
                GridMedium m = b.grid_medium(b.add_grid(5, 4, 3, wild));
                m.sigma_a = 0.0f;
                m.sigma_s = s;
                m.phase = Draine{g, 5 * g};
                m.scale = 0.2f;
                medium = m;
            } else if (kind == 2) {
                ColorGrid& colors = b.scene.color_grids.emplace_back();
                colors.size = {5, 4, 3};
                for (const float v : wild)
                    colors.values.push_back(
                        RgbUnboundedSpectrum(RgbColorSpace::srgb(), Vec3f(0.1f * v, 0.4f, 1 - 0.08f * v)));
                ColorGrid& none = b.scene.color_grids.emplace_back();
                none.size = {1, 1, 1};
                none.values.emplace_back();
                medium = RgbGridMedium{.box = b.grid_medium(0).box, .sigma_a = 1, .sigma_s = 0, .scale = 3};
            } else {
                CloudMedium m;
                m.box = b.grid_medium(0).box;
                m.sigma_a = 0.0f;
                m.sigma_s = s;
                m.density = 2;
                medium = m;
            }
            b.add_cube(b.add_medium(medium));
            b.add_sky();
            b.description.integrator.strategy = strategy;
            for (const bool inside : {false, true}) {
                const Ray ray{inside ? Point3f(0.1f, 0.6f, -0.2f) : Point3f(0.3f, 0.2f, -3),
                              normalize(Vec3f(0.1f, 0.05f, 1))};
                b.scene.camera.medium = inside ? 0 : no_index;
                expect_radiance(
                    volume_radiance(b.description, ray, 12000), [](float) { return 1.0; },
                    "medium " + std::to_string(kind) + ", strategy " + std::to_string(int(strategy)) +
                        (inside ? ", inside" : ""),
                    1e-4);
            }
        }
}

// Dispersive glass ends the other wavelengths after a chromatic medium weighted them.
TEST(VolumeClosedForms, FurnaceOfDispersiveGlassInAChromaticMedium) {
    VolumeScene b;
    b.add_cube(b.add_medium(HomogeneousMedium{.sigma_a = 0.0f, .sigma_s = b.spectrum(0.2f, 5)}));
    RoughnessParameter smooth{FloatParameter{0}, FloatParameter{0}, false};
    const Transform small = Transform::scale({0.4, 0.4, 0.4});
    b.bound(b.add_quadric(Sphere{.world_from_object = small},
                          b.add(DielectricMaterial{b.spectrum(1.7f, 1.4f), smooth})),
            no_index, 0);
    b.add_sky();
    for (const Strategy strategy : volume_strategies) {
        b.description.integrator.strategy = strategy;
        expect_radiance(
            volume_radiance(b.description, {{0.1f, 0.2f, -3}, {0, 0, 1}}, 40000), [](float) { return 1.0; },
            "strategy " + std::to_string(int(strategy)), 1e-4);
    }
}

// Media one inside the other, entered from a camera inside the inner one, through coinciding walls or not.
TEST(VolumeClosedForms, NestedMedia) {
    VolumeScene b;
    const Index outer = b.add_medium(HomogeneousMedium{.sigma_a = 0.5f, .sigma_s = 0.0f});
    const Index inner = b.add_medium(HomogeneousMedium{.sigma_a = 0.1f, .sigma_s = 0.2f});
    b.add_cube(outer);
    b.bound(b.add_quadric(Sphere{.world_from_object = Transform::scale({0.5, 0.5, 0.5})}, b.interface()),
            inner, outer);
    // A surface within one medium changes nothing.
    b.bound(b.add_mesh(square(Transform::translate({0, 0, 0.75})), b.interface()), no_index, no_index);
    b.add_sky();
    b.description.integrator.max_depth = 0;
    b.scene.camera.medium = inner;
    expect_radiance(
        volume_radiance(b.description, {{0, 0, 0.1f}, {0, 0, 1}}, 10000),
        [](float) { return std::exp(-0.3 * 0.4 - 0.5 * 0.5); }, "from inside");
    b.scene.camera.medium = no_index;
    expect_radiance(
        volume_radiance(b.description, {{0, 0, -3}, {0, 0, 1}}, 10000),
        [](float) { return std::exp(-0.3 - 0.5); }, "from outside");
}

} // namespace
} // namespace montelux::testing
