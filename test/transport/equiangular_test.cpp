// Lamps in fog: light that is looked for along rays.
#include "test/transport/volume_testing.h"

#include "montelux/mc/math/quadrature.h"

namespace montelux::testing {
namespace {

constexpr float lamp_z = 2.5f, lamp_beside = 0.3f;

// Densities of a grid between 0 and 1, so that null collisions are frequent.
const std::vector<float> uneven{0.9f, 0.1f, 0.4f, 1, 0.05f, 0.7f, 0, 0.6f};

// Chromatic fog in a box around the ray. Densities fall to 0 at the faces; they are constant between the outermost
// samples, up to z = 60 and beyond, if all samples are alike.
GridMedium grid_fog(VolumeScene& b, std::vector<float> densities, float density) {
    GridMedium fog = b.grid_medium(b.add_grid(2, 2, 2, std::move(densities)));
    fog.box.p0 = {-200, -200, -120};
    fog.box.p1 = {200, 200, 240};
    fog.sigma_a = b.spectrum(0.02f, 0.1f);
    fog.sigma_s = b.spectrum(0.05f, 0.4f);
    fog.scale = density;
    fog.phase = HenyeyGreenstein{0.4f};
    return fog;
}

enum class Fog { homogeneous, grid };

// Chromatic fog everywhere, with a lamp beside the ray. `wall`: a black one behind the lamp, at z = 4.
VolumeScene lamp_in_fog(bool wall, float density = 1, Fog fog = Fog::homogeneous) {
    VolumeScene b;
    if (fog == Fog::grid)
        b.scene.camera.medium = b.add_medium(grid_fog(b, std::vector<float>(8, 1.0f), density));
    else
        b.scene.camera.medium = b.add_medium(HomogeneousMedium{.sigma_a = b.spectrum(0.02f, 0.1f),
                                                               .sigma_s = b.spectrum(0.05f, 0.4f),
                                                               .scale = density,
                                                               .phase = HenyeyGreenstein{0.4f}});
    if (wall)
        b.add_mesh(square(Transform::translate({0, 0, 4}) * Transform::scale({1e3, 1e3, 1})),
                   b.add(DiffuseMaterial{gray(0)}));
    b.description.integrator.max_depth = 1;
    return b;
}
const Ray through_fog{{0, 0, 0}, {0, 0, 1}};

// By quadrature over the angle at the lamp: the integral over z of sigma_s p e^(-sigma_t (z + r)) I(w) / r^2, where I is
// the intensity in the direction from the lamp.
template <typename Intensity>
double single_scattering(double sigma_a, double sigma_s, double length, const Intensity& intensity) {
    const double first = std::atan(double(-lamp_z / lamp_beside)),
                 last = std::atan((length - double(lamp_z)) / double(lamp_beside));
    const std::vector<QuadratureNode> rule = gauss_legendre_rule(24);
    double sum = 0;
    constexpr int pieces = 64;
    for (int i = 0; i < pieces; ++i)
        for (const QuadratureNode& node : rule) {
            const double angle = first + (last - first) * (i + node.x) / pieces;
            const double z = double(lamp_z) + double(lamp_beside) * std::tan(angle);
            const double r = double(lamp_beside) / std::cos(angle);
            const Vec3f to_lamp = normalize(Vec3f(lamp_beside, 0, lamp_z - static_cast<float>(z)));
            const double phase = double(HenyeyGreenstein{0.4f}.pdf({0, 0, -1}, to_lamp));
            // dz = r^2 / beside d(angle)
            sum += node.weight * (last - first) / pieces * sigma_s * phase *
                   std::exp(-(sigma_a + sigma_s) * (z + r)) * intensity(-to_lamp) / double(lamp_beside);
        }
    return sum;
}

TEST(Equiangular, SingleScatteringOfAPointLight) {
    for (const auto& [fog, wall] :
         {std::pair{Fog::homogeneous, false}, {Fog::homogeneous, true}, {Fog::grid, true}})
        for (const bool equiangular : {false, true})
            for (const Strategy strategy : {Strategy::light, Strategy::mis})
                for (const Heuristic heuristic : {Heuristic::power, Heuristic::balance}) {
                    VolumeScene b = lamp_in_fog(wall, 1, fog);
                    b.scene.lights.push_back(PointLight{SceneSpectrum(3.0f), 1, {lamp_beside, 0, lamp_z}});
                    b.description.integrator.strategy = strategy;
                    b.description.integrator.heuristic = heuristic;
                    b.description.integrator.equiangular = equiangular;
                    expect_radiance(
                        volume_radiance(b.description, through_fog, 40000),
                        [&](float l) {
                            return single_scattering(double(line(0.02f, 0.1f)(l)),
                                                     double(line(0.05f, 0.4f)(l)), wall ? 4 : 60,
                                                     [](Vec3f) { return 3.0; });
                        },
                        std::string("point light") + (wall ? ", wall" : "") +
                            (fog == Fog::grid ? ", grid" : "") + (equiangular ? ", equiangular" : ""),
                        2e-4);
                }
}

// The beam crosses the ray; most points of the ray are dark.
TEST(Equiangular, SingleScatteringOfABeam) {
    VolumeScene b = lamp_in_fog(true);
    const SpotLight spot{SceneSpectrum(3.0f),           1,     {lamp_beside, 0, lamp_z},
                         normalize(Vec3f(-1, 0, 0.5f)), 0.99f, 0.96f};
    b.scene.lights.push_back(spot);
    b.add_sky(0.0f);
    expect_radiance(
        volume_radiance(b.description, through_fog, 40000),
        [&](float l) {
            return single_scattering(double(line(0.02f, 0.1f)(l)), double(line(0.05f, 0.4f)(l)), 4,
                                     [&](Vec3f w) { return 3.0 * double(spot.falloff(w)); });
        },
        "spot light", 5e-4);
}

// A black screen that moves between lamp and ray, or away.
TEST(Equiangular, ShadowsAreThoseOfTheTimeOfTheRay) {
    const auto radiance = [](const Transform& start, const Transform& end, float time) {
        VolumeScene b = lamp_in_fog(true);
        b.scene.lights.push_back(PointLight{SceneSpectrum(3.0f), 1, {lamp_beside, 0, lamp_z}});
        const Transform upright = Transform::rotate(90, {0, 1, 0}) * Transform::scale({10, 10, 1});
        const Index screen = b.add_mesh(square(upright), b.add(DiffuseMaterial{gray(0)}));
        b.scene.world_shapes.pop_back();
        b.scene.objects.push_back({.shapes = {screen}});
        b.scene.motions.emplace_back(start, end);
        b.scene.instances.push_back({0, start, 0});
        Ray ray = through_fog;
        ray.time = time;
        return volume_radiance(b.description, ray, 2000).total.mean();
    };
    const Transform between = Transform::translate({0.5 * double(lamp_beside), 0, 0}),
                    aside = Transform::translate({0, 30, 0});
    const double lit = radiance(aside, aside, 0);
    EXPECT_GT(lit, 0);
    EXPECT_EQ(radiance(between, between, 0), 0);
    EXPECT_NEAR(radiance(between, aside, 1), lit, 1e-6 * lit);
    EXPECT_EQ(radiance(aside, between, 1), 0);
}

// Scattering hits these lamps, too: three strategies share the light, by similar parts since the lamps are large.
enum class Lamp { sphere, mesh, in_other_fog, in_grid, in_uneven_fog };
constexpr Lamp lamps[] = {Lamp::sphere, Lamp::mesh, Lamp::in_other_fog, Lamp::in_grid, Lamp::in_uneven_fog};

std::string name_of(Lamp lamp) { return "lamp " + std::to_string(static_cast<int>(lamp)); }

VolumeScene large_lamp_in_fog(Lamp lamp) {
    VolumeScene b = lamp_in_fog(true, 3);
    if (lamp == Lamp::in_uneven_fog) {
        GridMedium fog = grid_fog(b, uneven, 6);
        fog.box.p0 = {-3, -2, 1.5f}; // the ray begins before it
        fog.box.p1 = {3, 2, 4};
        b.scene.media[0] = fog;
    }
    std::visit([](auto& m) { m.phase = HenyeyGreenstein{0.6f}; }, b.scene.media[0]);
    const Transform place = Transform::translate({1.15, 0, 2.3});
    const Index black = b.add(DiffuseMaterial{gray(0)});
    // The ray passes these by.
    if (lamp == Lamp::in_other_fog || lamp == Lamp::in_grid) {
        Medium medium = HomogeneousMedium{.sigma_a = b.spectrum(1, 0.5f), .sigma_s = b.spectrum(3, 2)};
        if (lamp == Lamp::in_grid) {
            GridMedium grid = b.grid_medium(b.add_grid(2, 2, 2, {3, 0.5f, 1, 4, 2, 0.2f, 5, 1}));
            grid.box.p0 = {0, -1.2f, 1.1f};
            grid.box.p1 = {2.3f, 1.2f, 3.5f};
            grid.sigma_a = b.spectrum(0.3f, 0.2f);
            grid.sigma_s = b.spectrum(1.5f, 1);
            medium = grid;
        }
        b.bound(b.add_quadric(Sphere{.world_from_object = place * Transform::scale({1.05, 1.05, 1.05})},
                              b.interface()),
                b.add_medium(medium), 0);
    }
    const Transform size = Transform::scale({0.8, 0.8, 0.8});
    if (lamp == Lamp::mesh)
        b.add_mesh(square(place * Transform::rotate(-90, {0, 1, 0}) * size), black, 8);
    else
        b.add_quadric(Sphere{.world_from_object = place * size}, black, 8);
    return b;
}
Ray ray_beside(Lamp lamp) { return {{0, 0, lamp == Lamp::in_uneven_fog ? -1.5f : 1.2f}, {0, 0, 1}}; }

TEST(Equiangular, SingleScatteringOfLampsThatRaysHit) {
    for (const Lamp lamp : lamps) {
        VolumeScene b = large_lamp_in_fog(lamp);
        const auto mean = [&](Strategy strategy, Heuristic heuristic, bool equiangular) {
            b.description.integrator.strategy = strategy;
            b.description.integrator.heuristic = heuristic;
            b.description.integrator.equiangular = equiangular;
            return volume_radiance(b.description, ray_beside(lamp), 100000).total;
        };
        const RunningMoments without = mean(Strategy::mis, Heuristic::balance, false);
        for (const auto& [strategy, heuristic] : {std::pair{Strategy::bsdf, Heuristic::power},
                                                  {Strategy::mis, Heuristic::balance},
                                                  {Strategy::mis, Heuristic::power},
                                                  {Strategy::light, Heuristic::power}})
            expect_same_mean(without, mean(strategy, heuristic, true),
                             name_of(lamp) + ", strategy " + std::to_string(static_cast<int>(strategy)));
    }
}

// Thin fog: a free flight rarely ends near the lamp.
TEST(Equiangular, ThinFogHasLessNoise) {
    for (const Fog fog : {Fog::homogeneous, Fog::grid}) {
        VolumeScene b = lamp_in_fog(true, 0.01f, fog);
        b.scene.lights.push_back(PointLight{SceneSpectrum(3.0f), 1, {lamp_beside, 0, lamp_z}});
        const RunningMoments with = volume_radiance(b.description, through_fog, 20000).total;
        b.description.integrator.equiangular = false;
        const RunningMoments without = volume_radiance(b.description, through_fog, 20000).total;
        EXPECT_NEAR(with.mean(), without.mean(), 5 * std::sqrt(without.variance_of_mean()));
        EXPECT_LT(with.variance(), without.variance() / 100);
    }
}

// Lamps that rays hit, of triangles and as a sphere, seen through an interface between two fogs and by a diffuse wall;
// a sky and a lamp too far away to be looked for along rays; several scattering events. `fog`: the inner one.
VolumeScene hall_of_lamps(Fog fog = Fog::homogeneous) {
    VolumeScene b;
    const Index outer = b.add_medium(HomogeneousMedium{.sigma_a = b.spectrum(0.02f, 0.1f),
                                                       .sigma_s = b.spectrum(0.05f, 0.3f),
                                                       .phase = HenyeyGreenstein{0.5f}});
    const Index inner = b.add_medium(
        HomogeneousMedium{.sigma_a = b.spectrum(0.2f, 0.02f), .sigma_s = b.spectrum(1.2f, 0.3f)});
    if (fog == Fog::grid) {
        GridMedium grid = b.grid_medium(b.add_grid(2, 2, 2, uneven));
        grid.sigma_a = b.spectrum(0.4f, 0.04f);
        grid.sigma_s = b.spectrum(2.4f, 0.6f);
        b.scene.media[inner] = grid;
    }
    b.scene.camera.medium = outer;
    const Index black = b.add(DiffuseMaterial{gray(0)});
    const auto lamp = [&](Index shape, Index medium) { b.bound(shape, medium, medium); };
    lamp(b.add_mesh(square(Transform::translate({0, 0, 2.5}) * Transform::rotate(180, {1, 0, 0}) *
                           Transform::scale({0.3, 0.3, 0.3})),
                    black, 8),
         outer);
    lamp(b.add_quadric(Sphere{.world_from_object = Transform::translate({0.5, -0.5, -0.3}) *
                                                   Transform::scale({0.15, 0.15, 0.15})},
                       black, 20),
         outer);
    b.bound(b.add_quadric(Sphere{.world_from_object = Transform::translate({-0.5, 0.2, 0.1}) *
                                                      Transform::scale({0.7, 0.7, 0.7})},
                          b.interface()),
            inner, outer);
    b.add_mesh(square(Transform::translate({0, 0, -1.2}) * Transform::scale({3, 3, 1})),
               b.add(DiffuseMaterial{gray(0.6f)}));
    b.add_sky(0.003f);
    b.scene.lights.push_back(PointLight{SceneSpectrum(1.0f), 1, {0, 30, 10}});
    b.look({0.3, -4, 0.6}, {0, 0, 0}, 35);
    b.description.integrator.max_depth = 12;
    return b;
}

RunningMoments hall_mean(VolumeScene& b, Strategy strategy, Heuristic heuristic, bool equiangular,
                         std::uint64_t seed, int samples = 60000) {
    b.description.integrator.strategy = strategy;
    b.description.integrator.heuristic = heuristic;
    b.description.integrator.equiangular = equiangular;
    return camera_mean<VolumePathIntegrator>(b.description, samples, seed);
}

TEST(Equiangular, StrategiesAgree) {
    VolumeScene b = hall_of_lamps();
    const RunningMoments mis = hall_mean(b, Strategy::mis, Heuristic::power, true, 1);
    expect_same_mean(mis, hall_mean(b, Strategy::mis, Heuristic::power, false, 2), "without");
    expect_same_mean(mis, hall_mean(b, Strategy::mis, Heuristic::balance, true, 3), "balance");
    expect_same_mean(mis, hall_mean(b, Strategy::light, Heuristic::power, true, 4), "light");
    expect_same_mean(mis, hall_mean(b, Strategy::light, Heuristic::balance, true, 5), "light, balance");
    expect_same_mean(mis, hall_mean(b, Strategy::bsdf, Heuristic::power, true, 6, 240000), "bsdf");
    EXPECT_NEAR(hall_mean(b, Strategy::mis_bsdf, Heuristic::power, true, 1).mean() +
                    hall_mean(b, Strategy::mis_light, Heuristic::power, true, 1).mean(),
                mis.mean(), 1e-3 * mis.mean());
    VolumeScene grid = hall_of_lamps(Fog::grid);
    expect_same_mean(hall_mean(grid, Strategy::mis, Heuristic::power, true, 1),
                     hall_mean(grid, Strategy::mis, Heuristic::power, false, 2), "grid, without");
}

// Light sampled at a surface after a scattering event in the medium: no point of the ray to that event finds it.
TEST(Equiangular, SurfacesLitAfterScatteringKeepTheirLight) {
    VolumeScene b;
    b.scene.camera.medium =
        b.add_medium(HomogeneousMedium{.sigma_a = 0.05f, .sigma_s = 0.2f, .phase = HenyeyGreenstein{0.6f}});
    b.add_mesh(square(Transform::scale({1.5, 1.5, 1})), b.add(DiffuseMaterial{gray(0.6f)}));
    b.add_mesh(square(Transform::translate({0.3, -0.2, 1.6}) * Transform::rotate(180, {1, 0, 0}) *
                      Transform::scale({0.3, 0.3, 1})),
               b.add(DiffuseMaterial{gray(0)}), 8);
    b.look({0.2, -4, 2.2}, {0, 0, 0.3}, 40);
    b.description.integrator.max_depth = 2;
    for (const Strategy strategy : {Strategy::mis, Strategy::light})
        expect_same_mean(hall_mean(b, strategy, Heuristic::power, true, 1),
                         hall_mean(b, strategy, Heuristic::power, false, 2, 120000), "surface");
}

// What the densities of the strategies say about one another: with the balance heuristic a sample of strategy S
// contributes f / (p_S + p_T + ...), so E_S[c p_T] = E_T[c p_S]; divided by a sum of densities both stay bounded. Each
// is the difference of a path's two sides, and 0 on average.
struct SharesOfPath {
    double light_and_segment = 0;   // light sampling at a vertex, and SegmentLight on the ray to it
    double scattering_and_both = 0; // scattering, and these two together
};

SharesOfPath shares_of(const PathRecord& record, const SampledWavelengths& lambda) {
    SharesOfPath shares;
    const auto value = [&](const SampledSpectrum& c) { return double(average(safe_div(c, lambda.pdf))); };
    const auto sampled = [&](const DirectLight& light, double sign) {
        if (light.weight <= 0 || light.delta) return;
        const double c = value(light.contribution), own = double(light.light_pdf),
                     other = double(light.other_pdf), scattering = double(light.bsdf_pdf);
        shares.light_and_segment += sign * c * other / (own + other);
        shares.scattering_and_both -= c * scattering / (own + other + scattering);
    };
    for (const PathVertex& v : record.vertices) {
        for (const FoundLight& light : v.found)
            if (light.shared)
                shares.scattering_and_both +=
                    value(light.contribution) * double(light.light_pdf / (light.light_pdf + light.bsdf_pdf));
        if (v.direct) sampled(*v.direct, 1);
    }
    for (const RayLight& light : record.on_rays) sampled(light.light, -1);
    return shares;
}

template <typename Camera>
void expect_shares(VolumeScene& b, int samples, const std::string& what, const Camera& camera_ray) {
    b.description.integrator.strategy = Strategy::mis;
    b.description.integrator.heuristic = Heuristic::balance;
    const VolumeWorld world(b.description);
    const VolumePathIntegrator integrator(world.description.integrator, world.camera);
    RayTracer tracer(world.accelerator);
    RunningMoments light_and_segment, scattering_and_both;
    for (int i = 0; i < samples; ++i) {
        SampleStream stream({.seed = 7}, 0, 0, static_cast<std::uint64_t>(i));
        const auto lambda = SampledWavelengths::sample_visible(stream.next_1d());
        const Ray ray = camera_ray(world, stream);
        PathRecord record;
        const FilmContribution c =
            integrator.estimate(world.tables.view(), tracer, {ray, lambda}, stream, &record);
        const SharesOfPath shares = shares_of(record, c.lambda);
        light_and_segment.add(shares.light_and_segment);
        scattering_and_both.add(shares.scattering_and_both);
    }
    for (const auto& [m, name] :
         {std::pair{light_and_segment, "light and segment"}, {scattering_and_both, "scattering and both"}}) {
        EXPECT_GT(m.variance(), 0) << what << ", " << name;
        EXPECT_NEAR(m.mean(), 0, 5 * std::sqrt(m.variance_of_mean())) << what << ", " << name;
    }
}

TEST(Equiangular, DensitiesOfTheStrategiesAgree) {
    for (const Lamp lamp : lamps) {
        VolumeScene b = large_lamp_in_fog(lamp);
        expect_shares(b, lamp == Lamp::in_grid || lamp == Lamp::in_uneven_fog ? 400000 : 100000,
                      name_of(lamp), [&](const VolumeWorld&, SampleStream&) { return ray_beside(lamp); });
    }
    for (const Fog fog : {Fog::homogeneous, Fog::grid}) {
        VolumeScene hall = hall_of_lamps(fog);
        expect_shares(hall, 60000, fog == Fog::grid ? "hall, grid" : "hall",
                      [](const VolumeWorld& world, SampleStream& stream) {
                          return world.camera.generate_ray(stream.next_2d() * 16, {});
                      });
    }
}

TEST(Equiangular, RecordsSumToTheRadiance) {
    const VolumeScene b = hall_of_lamps();
    const VolumeWorld world(b.description);
    const VolumePathIntegrator integrator(world.description.integrator, world.camera);
    RayTracer tracer(world.accelerator);
    std::size_t on_rays = 0;
    for (std::uint64_t i = 0; i < 1600; ++i) {
        SampleStream stream({.seed = 2}, 3, 4, i), again = stream;
        const CameraSample camera{world.camera.generate_ray(stream.next_2d() * 16, {}),
                                  SampledWavelengths::sample_visible(stream.next_1d())};
        again = stream;
        PathRecord record;
        const SampledSpectrum radiance =
            integrator.estimate(world.tables.view(), tracer, camera, stream, &record).radiance;
        EXPECT_EQ(radiance, integrator.estimate(world.tables.view(), tracer, camera, again).radiance);
        SampledSpectrum sum = record.emission;
        for (const PathVertex& v : record.vertices) {
            for (const FoundLight& light : v.found) sum += light.contribution;
            if (v.direct) sum += v.direct->contribution;
        }
        for (const RayLight& light : record.on_rays) sum += light.light.contribution;
        on_rays += record.on_rays.size();
        for (int k = 0; k < 4; ++k) EXPECT_NEAR(sum[k], radiance[k], 1e-4f * (1 + sum[k]));
    }
    EXPECT_GT(on_rays, 100u);
}

} // namespace
} // namespace montelux::testing
