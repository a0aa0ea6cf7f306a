// Merging: light maps find their vertices, and the weights of joining and merging sum to one.
#include "test/transport/path_densities.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "montelux/accel/accelerator.h"
#include "montelux/mc/random/sample_stream.h"
#include "montelux/scene/scene_tables.h"
#include "montelux/transport/bidirectional_sample.h"

namespace montelux::testing {
namespace {

// Points on a sheet at any scale and place; every third one does not merge.
std::vector<LightPaths> scattered_points(double scale, Vec3d center, int count) {
    std::vector<LightPaths> parts(3);
    SampleStream stream({.kind = SamplerKind::independent, .seed = 5}, 0, 0, 0);
    for (int i = 0; i < count; ++i) {
        LightMapVertex v;
        const Vec2f u = stream.next_2d();
        v.p = Point3f(center + scale * Vec3d{double(u.x), double(u.y), 0.1 * double(stream.next_1d())});
        v.events = i;
        v.mergeable = i % 3 != 0;
        parts[static_cast<std::size_t>(i % 7 / 3)].vertices.push_back(v);
    }
    return parts;
}

TEST(LightMap, FindsEachVertexWithinTheRadiusOnce) {
    for (const double scale : {1e-4, 1.0, 1e5})
        for (const Vec3d& center : {Vec3d{0, 0, 0}, scale * Vec3d{-3, 7, 0.5}})
            for (const double share : {0.2e-16, 1e-16, 1.5e-16, 3e-16, 0.003, 0.05, 3.0}) {
                const double radius = share * scale;
                const LightMap map(scattered_points(scale, center, 3000), 3000, radius);
                for (int i = 0; i < 100; ++i) {
                    Point3f p(center + scale * Vec3d{0.01 * i, 0.013 * (i * 7 % 80), 0.05});
                    if (i % 2 == 1) p = map.parts()[1].vertices[static_cast<std::size_t>(i)].p;
                    std::vector<int> found, expected;
                    map.visit(p, [&](const LightMapVertex& v, const LightPaths&, float distance2) {
                        EXPECT_EQ(distance2, length_squared(v.p - p));
                        found.push_back(v.events);
                    });
                    for (const LightPaths& part : map.parts())
                        for (const LightMapVertex& v : part.vertices)
                            if (v.mergeable && length_squared(v.p - p) < float(radius * radius))
                                expected.push_back(v.events);
                    std::ranges::sort(found);
                    std::ranges::sort(expected);
                    EXPECT_EQ(found, expected) << scale << ' ' << share;
                }
            }
}

TEST(LightMap, MayBeEmpty) {
    const LightMap map({}, 10, 1);
    map.visit({}, [](const LightMapVertex&, const LightPaths&, float) { FAIL(); });
    EXPECT_NEAR(map.area_paths(), 10 * 3.14159265358979, 1e-12);
}

// A path of five vertices that merges at v_2 and v_3, in closed form.
TEST(Merging, WeightsInClosedForm) {
    PathDensities d;
    d.reset(5);
    d.from_light = {2, 3, 5, 7};
    d.from_camera = {11, 13, 17, 19};
    d.next_event = 23;
    d.light_paths = 29;
    d.merging = {0, 0, 0.5, 0.25};
    std::vector<double> scratch;
    std::vector<double> p{11. * 13 * 17 * 19,
                          23. * 13 * 17 * 19,
                          2. * 3 * 17 * 19,
                          2. * 3 * 5 * 19,
                          2. * 3 * 5 * 7 * 29,
                          0,
                          0,
                          2. * 3 * 5 * 17 * 19 * 0.5,
                          2. * 3 * 5 * 7 * 19 * 0.25};
    const auto expect = [&] {
        double all = 0, squares = 0;
        for (const double x : p) {
            all += x;
            squares += x * x;
        }
        for (std::size_t s = 0; s < p.size(); ++s) {
            EXPECT_NEAR(strategy_weight(d, s, Heuristic::balance, scratch), p[s] / all, 1e-14) << s;
            EXPECT_NEAR(strategy_weight(d, s, Heuristic::power, scratch), p[s] * p[s] / squares, 1e-14) << s;
        }
    };
    expect();
    d.delta[2] = 1; // joins and merges neither
    p[2] = p[3] = p[7] = 0;
    expect();
    d.merging[1] = 0.125;
    p[6] = 2. * 3 * 13 * 17 * 19 * 0.125;
    expect();
    d.media = {2, 3, 5, 7, 11};
    for (std::size_t s = 0; s < p.size(); ++s) p[s] *= s < 5 ? d.media[s] : d.media[0];
    expect();
}

struct LightPath {
    std::vector<SubpathVertex> vertices;
    LightEnd end;
    bool has_end = false;
};

struct Sums {
    const SceneView* scene;
    const Camera* camera;
    Heuristic heuristic;
    double area_paths;
    const std::vector<LightPath>* light_paths = nullptr; // one for each part of the map
    const LightMap* map = nullptr;
    int joined = 0, off_joined = 0, off_sums = 0, merged = 0, off_merged = 0;
    double difference = 0; // of weights of merged paths
    std::vector<double> scratch{};

    // PathDensities::merging by its definition.
    PathDensities densities(const FoundPath& path) const {
        PathDensities d = Recomputed(*scene, *camera, path).d;
        const std::size_t n = path.s + path.t;
        d.merging.assign(n - 1, 0);
        for (std::size_t i = 2; i + 1 < n; ++i) {
            const SubpathVertex& v = i < path.s ? path.light[i - 1] : path.camera[n - 2 - i];
            if (v.phase == nullptr) d.merging[i] = area_paths;
        }
        return d;
    }
    void count(const FoundPath& found) {
        if (found.s + found.t == 2) return;
        found.merged != nullptr ? count_merged(found) : count_joined(found);
    }
    void count_joined(const FoundPath& found) {
        ++joined;
        const PathDensities d = densities(found);
        double sum = 0;
        for (std::size_t s = 0; s < 2 * (found.s + found.t) - 1; ++s)
            sum += strategy_weight(d, s, heuristic, scratch);
        off_sums += !(std::abs(sum - 1) < 1e-12);
        off_joined += !(std::abs(strategy_weight(d, found.s, heuristic, scratch) - found.weight) < 2e-3);
    }
    // The two ends of the joint are almost the same point: the densities are those of the path through the camera's.
    void count_merged(const FoundPath& found) {
        const auto part = std::ranges::find_if(map->parts(), [&](const LightPaths& p) {
            return !p.vertices.empty() && &p.vertices.front() == &found.merged->at(1);
        });
        const LightPath& light = (*light_paths)[static_cast<std::size_t>(part - map->parts().begin())];
        if (!light.has_end) return;
        const FoundPath path{
            found.s,      found.t,     light.end,       std::span(light.vertices).first(found.s - 1),
            found.camera, found.lens,  found.densities, 0,
            {},           found.merged};
        const PathDensities d = densities(path);
        const double weight = strategy_weight(d, found.s + found.t + found.s, heuristic, scratch);
        ++merged;
        difference += weight - found.weight;
        off_merged += !(std::abs(weight - found.weight) < 0.03);
    }
};

CameraSample sample_of(const Camera& camera, SampleStream& stream) {
    const Vec2f film = stream.next_2d() * float(film_width), lens = stream.next_2d();
    // All share their wavelengths.
    return {camera.generate_ray(film, lens), SampledWavelengths::sample_visible(0.4f)};
}

void expect_weights(const SceneDescription& description, const std::string& what) {
    constexpr int map_paths = 3000, samples = 6000;
    const SceneTables tables(description.scene, description.integrator.environments(),
                             description.integrator.light_sampling, description.integrator.surfaces(), true);
    const SceneView& scene = tables.view();
    const Accelerator accelerator(scene);
    const Camera camera(description.scene.camera, film_width, film_width);
    BidirectionalIntegrator integrator(description.integrator, camera, 0.125f, {0, 0, film_width, film_width},
                                       {0.5f, 0.5f}, scene.has_media());
    RayTracer tracer(accelerator);
    BidirectionalMemory memory;
    std::vector<LightPaths> parts(map_paths);
    std::vector<LightPath> light_paths(map_paths);
    for (std::uint64_t i = 0; i < map_paths; ++i) {
        SampleStream stream({.seed = 4}, 0, 0, i), numbers({.seed = 5}, 0, 0, i);
        CameraSample sample = sample_of(camera, stream);
        // A sample with the same light path tells where that begins.
        MergingSample merging{numbers};
        sample.merging = &merging;
        const PathObserver observer{[](void* self, const FoundPath& path) {
                                        auto& to = *static_cast<LightPath*>(self);
                                        if (path.s < 2) return;
                                        to.end = path.end;
                                        to.has_end = true;
                                    },
                                    &light_paths[i]};
        integrator.estimate(scene, tracer, sample, stream, memory, &observer);
        const std::vector<SubpathVertex> first = memory.light;
        integrator.trace_light(scene, tracer, sample, numbers, memory, parts[i]);
        ASSERT_EQ(memory.light.size(), first.size());
        for (std::size_t j = 0; j < first.size(); ++j) ASSERT_EQ(memory.light[j].s.p, first[j].s.p);
        light_paths[i].vertices = memory.light;
    }
    // Small, but for this the weights are known: their sums do not depend on the number of paths.
    const LightMap map(std::move(parts), map_paths, 0.015);
    integrator.set_light_map(&map);
    Sums sums{&scene, &camera, description.integrator.heuristic, map.area_paths(), &light_paths, &map};
    const PathObserver observer{
        [](void* self, const FoundPath& path) { static_cast<Sums*>(self)->count(path); }, &sums};
    for (std::uint64_t i = 0; i < samples; ++i) {
        SampleStream stream({.seed = 3}, 0, 0, i), numbers({.seed = 6}, 0, 0, i);
        CameraSample sample = sample_of(camera, stream);
        MergingSample merging{numbers};
        sample.merging = &merging;
        integrator.estimate(scene, tracer, sample, stream, memory, &observer);
    }
    EXPECT_GT(sums.joined, samples) << what;
    EXPECT_EQ(sums.off_sums, 0) << what;
    EXPECT_LT(sums.off_joined, sums.joined / 500) << what << " of " << sums.joined;
    EXPECT_GT(sums.merged, scene.has_media() ? 20 : 300) << what;
    EXPECT_LT(sums.off_merged, sums.merged / 20) << what << " of " << sums.merged;
    EXPECT_LT(std::abs(sums.difference / sums.merged), 1e-3) << what;
}

TEST(Merging, WeightsAreThoseOfThePathAndSumToOne) {
    for (const Heuristic heuristic : {Heuristic::balance, Heuristic::power})
        for (const bool lens : {false, true}) {
            if (lens != (heuristic == Heuristic::power)) continue; // two of four will do
            SceneBuilder b = room_of_all(lens);
            b.description.integrator.heuristic = heuristic;
            expect_weights(b.description, lens ? "lens" : "pinhole");
        }
}

TEST(Merging, WeightsInMediaAreThoseOfThePathAndSumToOne) {
    SceneBuilder b = foggy_room(false);
    expect_weights(b.description, "fog");
}

} // namespace
} // namespace montelux::testing
