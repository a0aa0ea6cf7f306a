// The weights of bidirectional path tracing: densities found on the way against those computed anew from the vertices
// of the path, and the sum over all strategies.
#include "test/render/mixed_scene.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "montelux/accel/accelerator.h"
#include "montelux/mc/random/sample_stream.h"
#include "montelux/scene/light/light_sampling.h"
#include "montelux/scene/scene_tables.h"
#include "montelux/transport/bidirectional_sample.h"
#include "montelux/transport/light_end.h"

namespace montelux::testing {
namespace {

constexpr int film_width = 16;

// Point, spot and distant lights, a thin lens, dispersion and a smooth mirror besides.
SceneBuilder room_of_all(bool with_lens) {
    SceneBuilder b = mixed_scene(1, film_width, film_width);
    const auto ball = [&](Vec3d at, double radius, const Material& material) {
        const Transform t = Transform::translate(at) * Transform::scale({radius, radius, radius});
        b.add_quadric(Sphere{.world_from_object = t}, b.add(material));
    };
    const Spectrum flint(PiecewiseLinear::from_pairs(std::array{360.0f, 1.7f, 830.0f, 1.5f}));
    ball({0.6, 0.5, 0.3}, 0.25, DielectricMaterial{add_spectrum(b.scene, flint), alpha_of(0.2f)});
    ball({-0.1, -0.5, -0.75}, 0.2,
         ConductorMaterial{.metal = {.eta = gray(0.2f), .k = gray(3)}, .roughness = alpha_of(0)});
    const SceneSpectrum white = white_light(b.scene);
    b.scene.lights.push_back(PointLight{white, 2 * white_scale(), {0, -0.4f, 0.6f}});
    b.scene.lights.push_back(DistantLight{white, white_scale(), normalize(Vec3f(0.2f, -1, 0.4f))});
    if (with_lens)
        b.scene.camera.model = PerspectiveCamera{.fov = 36, .lens_radius = 0.1f, .focal_distance = 3.6f};
    b.description.integrator.method = IntegratorKind::bidirectional;
    return b;
}
// The same in coloured fog, which no infinite light gets through.
SceneBuilder foggy_room(bool with_lens) {
    SceneBuilder b = room_of_all(with_lens);
    const auto line = [&](float at_360, float at_830) {
        return add_spectrum(
            b.scene, Spectrum(PiecewiseLinear::from_pairs(std::array{360.0f, at_360, 830.0f, at_830})));
    };
    HomogeneousMedium fog{.sigma_a = line(0.3f, 0.02f), .sigma_s = line(0.3f, 1.2f)};
    fog.phase = HenyeyGreenstein{0.4f};
    b.scene.media.push_back(fog);
    b.scene.camera.medium = 0;
    return b;
}

// Recomputes what PathDensities holds from nothing but the vertices.
class Recomputed {
  public:
    Recomputed(const SceneView& scene, const Camera& camera, const FoundPath& path)
        : scene_(scene), path_(path), n_(path.s + path.t) {
        d.reset(n_);
        d.delta = path.densities.delta;
        d.light_paths = path.densities.light_paths;
        const LightEnd& end = path.end;
        const LightContext context{scene, end.light, 0};
        const SubpathVertex& v1 = vertex(1);
        const Vec3f to_light = direction_to_light();
        LightHit hit = end.hit;
        hit.wi = to_light;
        const EmissionPdf le = pdf_le(context, hit, -to_light);
        const float choice = scene.emitting_lights->probability({}, end.light, hit.part);
        const bool far = end.at_infinity();
        d.from_light[0] = choice * (end.is_delta() ? 1 : far ? le.direction : le.position);
        d.from_light[1] =
            double(far ? le.position : le.direction) * v1.cosine(to_light) / (far ? 1 : distance2(0));
        d.from_camera[0] =
            end.invisible ? 0 : double(end.of_light(pdf(1, true), -to_light, float(distance2(0))));
        for (std::size_t i = 1; i + 2 < n_; ++i) {
            d.from_light[i + 1] = per_area(i + 1, i, pdf(i, false));
            d.from_camera[i] = per_area(i, i + 1, pdf(i + 1, true));
        }
        const Vec3f from_lens = vertex(n_ - 2).s.p - path.lens;
        const float distance = length(from_lens);
        d.from_camera[n_ - 2] = double(camera.density(from_lens / distance, distance, 0)) *
                                vertex(n_ - 2).cosine(from_lens / distance);
        const ReferencePoint here = v1.reference(local(1, direction(1, 2)));
        const float li = scene.light_sampler->probability(here, end.light, hit.part);
        d.next_event =
            end.is_delta()
                ? double(li)
                : double(end.of_light(li * pdf_li(context, here, hit), -to_light, float(distance2(0))));
        if (scene.camera_medium != no_index) compute_media_factors();
    }

    PathDensities d;

  private:
    // Of the homogeneous medium around the camera: free flights along all edges but the joined one.
    void compute_media_factors() {
        SampledWavelengths lambda = vertex(1).lambda;
        for (std::size_t i = 1; i + 1 < n_; ++i)
            if (vertex(i).lambda.secondary_terminated()) lambda = vertex(i).lambda;
        const MediumPoint m =
            std::get<HomogeneousMedium>(scene_.media[0]).at(scene_, 0, lambda).coefficients({});
        d.media.assign(n_, 0);
        for (std::size_t s = 0; s < n_; ++s)
            for (int k = 0; k < (lambda.secondary_terminated() ? 1 : 4); ++k) {
                double depth = 0, scattering = 1;
                for (std::size_t i = 0; i + 1 < n_; ++i)
                    if (s != i + 1)
                        depth +=
                            double(m.sigma_a[k] + m.sigma_s[k]) * double(length(point(i) - point(i + 1)));
                for (std::size_t i = 1; i + 1 < n_; ++i)
                    if (vertex(i).phase != nullptr) scattering *= double(m.sigma_s[k]);
                d.media[s] += scattering * std::exp(-depth);
            }
    }
    const SubpathVertex& vertex(std::size_t i) const {
        return i < path_.s ? path_.light[i - 1] : path_.camera[n_ - 2 - i];
    }
    Point3f point(std::size_t i) const {
        if (i == n_ - 1) return path_.lens;
        if (i > 0) return vertex(i).s.p;
        if (const auto* light = std::get_if<PointLight>(&scene_.lights[path_.end.light]))
            return light->position;
        return path_.end.hit.p;
    }
    Vec3f direction_to_light() const {
        return path_.end.at_infinity() ? path_.end.hit.wi : normalize(point(0) - point(1));
    }
    Vec3f direction(std::size_t from, std::size_t to) const {
        return to == 0 ? direction_to_light() : normalize(point(to) - point(from));
    }
    double distance2(std::size_t i) const { return double(length_squared(point(i) - point(i + 1))); }
    Vec3f local(std::size_t i, Vec3f w) const { return vertex(i).surface.frame.to_local(w); }
    // Of vertex i scattering towards the light or away from it, per solid angle.
    float pdf(std::size_t i, bool to_light) const {
        if (d.delta[i] != 0) return 1;
        const Vec3f light = local(i, direction(i, i - 1)), lens = local(i, direction(i, i + 1));
        SampleStream stream({.seed = 1}, 0, 0, 0);
        return to_light ? vertex(i).evaluate(lens, light, TransportMode::radiance, stream).pdf
                        : vertex(i).evaluate(light, lens, TransportMode::importance, stream).pdf;
    }
    double per_area(std::size_t i, std::size_t from, float pdf) const {
        return double(pdf) * double(vertex(i).cosine(direction(from, i))) / distance2(std::min(i, from));
    }

    const SceneView& scene_;
    const FoundPath& path_;
    std::size_t n_;
};

struct Counts {
    const SceneView* scene;
    const Camera* camera;
    Heuristic heuristic;
    int paths = 0, off_weights = 0, off_densities = 0, off_sums = 0, in_media = 0;
    std::array<int, 12> of_strategy{}; // min(s, 2), min(t, 2)
    std::vector<double> scratch{};

    void count(const FoundPath& found) {
        ++of_strategy[4 * std::min<std::size_t>(found.s, 2) + std::min<std::size_t>(found.t, 2)];
        if (found.s + found.t == 2) return;
        ++paths;
        const Recomputed again(*scene, *camera, found);
        const double weight = strategy_weight(again.d, found.s, heuristic, scratch);
        double sum = 0;
        for (std::size_t s = 0; s < found.s + found.t; ++s)
            sum += strategy_weight(again.d, s, heuristic, scratch);
        off_sums += !(std::abs(sum - 1) < 1e-12);
        off_weights += !(std::abs(weight - found.weight) < 2e-3);
        const auto differ = [](double a, double b) { return !(std::abs(a - b) <= 0.02 * std::max(a, b)); };
        bool off = differ(again.d.next_event, found.densities.next_event) && found.densities.delta[1] == 0;
        for (std::size_t i = 0; i + 1 < found.s + found.t; ++i)
            off = off || differ(again.d.from_light[i], found.densities.from_light[i]) ||
                  differ(again.d.from_camera[i], found.densities.from_camera[i]);
        // They have any unit.
        for (std::size_t s = 1; s < again.d.media.size(); ++s)
            off = off || differ(again.d.media[s] / again.d.media[0],
                                found.densities.media[s] / found.densities.media[0]);
        off_densities += off;
        for (const std::span<const SubpathVertex>& side : {found.light, found.camera})
            for (const SubpathVertex& v : side) in_media += v.phase != nullptr;
    }
};

void expect_consistent(const SceneDescription& description, int samples, const std::string& what) {
    const SceneTables tables(description.scene, description.integrator.environments(),
                             description.integrator.light_sampling, description.integrator.surfaces(), true);
    const Accelerator accelerator(tables.view());
    const Camera camera(description.scene.camera, film_width, film_width);
    const BidirectionalIntegrator integrator(description.integrator, camera, 0.125f,
                                             {0, 0, film_width, film_width}, {0.5f, 0.5f},
                                             tables.view().has_media());
    Counts counts{&tables.view(), &camera, description.integrator.heuristic};
    const PathObserver observer{
        [](void* self, const FoundPath& path) { static_cast<Counts*>(self)->count(path); }, &counts};
    RayTracer tracer(accelerator);
    BidirectionalMemory memory;
    for (int i = 0; i < samples; ++i) {
        SampleStream stream({.seed = 3}, 0, 0, static_cast<std::uint64_t>(i));
        const Vec2f film = stream.next_2d() * float(film_width), lens = stream.next_2d();
        const CameraSample sample{camera.generate_ray(film, lens),
                                  SampledWavelengths::sample_visible(stream.next_1d())};
        integrator.estimate(tables.view(), tracer, sample, stream, memory, &observer);
    }
    EXPECT_GT(counts.paths, 3 * samples / 2) << what;
    // Every kind of strategy took part: s = 0, 1, more; t = 1, more.
    const int least = samples / (tables.view().has_media() ? 100 : 20);
    for (const int kind : {0 + 2, 4 + 2, 8 + 1, 8 + 2})
        EXPECT_GT(counts.of_strategy[static_cast<std::size_t>(kind)], least) << what << ' ' << kind;
    EXPECT_EQ(counts.off_sums, 0) << what;
    EXPECT_EQ(counts.in_media > counts.paths / 4, tables.view().has_media())
        << what << ' ' << counts.in_media;
    // Rounding: vertices that almost touch, and grazing angles.
    EXPECT_LT(counts.off_densities, counts.paths / 100) << what << " of " << counts.paths;
    EXPECT_LT(counts.off_weights, counts.paths / 500) << what << " of " << counts.paths;
}

TEST(Bidirectional, WeightsAreThoseOfThePathAndSumToOne) {
    for (const Heuristic heuristic : {Heuristic::balance, Heuristic::power})
        for (const bool lens : {false, true}) {
            SceneBuilder b = room_of_all(lens);
            b.description.integrator.heuristic = heuristic;
            expect_consistent(b.description, 14000, lens ? "lens" : "pinhole");
        }
}

TEST(Bidirectional, WeightsInMediaAreThoseOfThePathAndSumToOne) {
    for (const Heuristic heuristic : {Heuristic::balance, Heuristic::power})
        for (const bool lens : {false, true}) {
            SceneBuilder b = foggy_room(lens);
            b.description.integrator.heuristic = heuristic;
            expect_consistent(b.description, 7000, lens ? "lens in fog" : "pinhole in fog");
        }
}

// Three edges at two wavelengths of four: strategy s joins edge s - 1.
TEST(Bidirectional, MediaFactorsInClosedForm) {
    const std::vector<EdgeDensity> edges{
        {{2, 3, 1, 1}, {5, 7, 1, 1}}, {{11, 13, 1, 1}, {17, 19, 1, 1}}, {{23, 29, 1, 1}, {31, 37, 1, 1}}};
    std::vector<double> factors, scratch;
    media_factors(edges, true, factors, scratch);
    EXPECT_EQ(factors, (std::vector<double>{2 * 11 * 23, 5 * 11 * 23, 2 * 17 * 23, 2 * 11 * 31}));
    media_factors(edges, false, factors, scratch);
    EXPECT_EQ(factors, (std::vector<double>{
                           (2 * 11 * 23 + 3 * 13 * 29 + 2) / 4.0, (5 * 11 * 23 + 7 * 13 * 29 + 2) / 4.0,
                           (2 * 17 * 23 + 3 * 19 * 29 + 2) / 4.0, (2 * 11 * 31 + 3 * 13 * 37 + 2) / 4.0}));
}

// In closed form: a path of four vertices, without deltas and with them.
TEST(Bidirectional, WeightsInClosedForm) {
    PathDensities d;
    d.reset(4);
    d.from_light = {2, 3, 5};
    d.from_camera = {7, 11, 13};
    d.next_event = 17;
    d.light_paths = 19;
    std::vector<double> scratch;
    const std::array<double, 4> p{7 * 11 * 13, 17 * 11 * 13, 2 * 3 * 13, 2 * 3 * 5 * 19};
    const double all = p[0] + p[1] + p[2] + p[3];
    double squares = 0;
    for (const double x : p) squares += x * x;
    for (std::size_t s = 0; s < 4; ++s) {
        EXPECT_NEAR(strategy_weight(d, s, Heuristic::balance, scratch), p[s] / all, 1e-14);
        EXPECT_NEAR(strategy_weight(d, s, Heuristic::power, scratch), p[s] * p[s] / squares, 1e-14);
    }
    d.delta[1] = 1; // no strategy joins v_1
    EXPECT_EQ(strategy_weight(d, 1, Heuristic::balance, scratch), 0);
    EXPECT_EQ(strategy_weight(d, 2, Heuristic::balance, scratch), 0);
    EXPECT_NEAR(strategy_weight(d, 0, Heuristic::balance, scratch), p[0] / (p[0] + p[3]), 1e-14);
    d.delta = {0, 0, 1}; // nor v_2
    EXPECT_NEAR(strategy_weight(d, 0, Heuristic::balance, scratch), p[0] / (p[0] + p[1]), 1e-14);
    d.from_camera[0] = 0; // a light that no ray hits
    EXPECT_EQ(strategy_weight(d, 0, Heuristic::balance, scratch), 0);
    EXPECT_EQ(strategy_weight(d, 1, Heuristic::balance, scratch), 1);
}

} // namespace
} // namespace montelux::testing
