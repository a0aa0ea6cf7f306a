// PathIntegrator by states and steps: any driver and any stream give the same path.
#include "test/render/mixed_scene.h"
#include <algorithm>
#include <array>
#include <bit>
#include <gtest/gtest.h>
#include <span>
#include <vector>

#include "montelux/accel/accelerator.h"
#include "montelux/transport/integrator.h"
#include "montelux/transport/path_shading.h"

namespace montelux::testing {
namespace {

constexpr int edge = 16;

// A scene with everything that a path reads.
struct World {
    explicit World(const SceneDescription& d)
        : description(d), tables(description.scene, description.integrator.environments()),
          accelerator(tables.view()), camera(description.scene.camera, edge, edge) {}

    CameraSample camera_sample(int x, int y, SampleStream& stream) const {
        const Vec2f film = stream.next_2d();
        const float u_lambda = stream.next_1d();
        return {camera.generate_ray({static_cast<float>(x) + film.x, static_cast<float>(y) + film.y}, {}),
                SampledWavelengths::sample_visible(u_lambda)};
    }

    SceneDescription description;
    SceneTables tables;
    Accelerator accelerator;
    Camera camera;
};

SceneDescription scene_of(Strategy strategy) {
    SceneDescription d = mixed_scene(1, edge, edge).description;
    d.integrator.strategy = strategy;
    d.integrator.max_depth = 12;
    return d;
}

bool same_bits(SampledSpectrum a, SampledSpectrum b) {
    using Bits = std::array<std::uint32_t, 4>;
    return std::bit_cast<Bits>(a.values) == std::bit_cast<Bits>(b.values);
}
bool same_bits(const FilmContribution& a, const FilmContribution& b) {
    return same_bits(a.radiance, b.radiance) && same_bits(a.first.albedo, b.first.albedo) &&
           a.first.depth == b.first.depth && a.first.normal == b.first.normal &&
           a.lambda.secondary_terminated() == b.lambda.secondary_terminated();
}

// All paths in batches of some size.
std::vector<FilmContribution> in_batches(const World& world, const PathIntegrator& integrator,
                                         std::vector<PathStart<SampleStream>> starts, std::size_t size,
                                         RayTracer& tracer) {
    PathBatch memory;
    std::vector<FilmContribution> results(starts.size());
    for (std::size_t first = 0; first < starts.size(); first += size) {
        const std::size_t count = std::min(size, starts.size() - first);
        integrator.estimate(world.tables.view(), tracer, std::span(starts).subspan(first, count), memory,
                            std::span(results).subspan(first, count));
    }
    return results;
}

TEST(PathIntegrator, PathsInBatchesAreTheSameToTheLastBit) {
    for (Strategy strategy : {Strategy::uniform, Strategy::bsdf, Strategy::light, Strategy::mis}) {
        const World world(scene_of(strategy));
        const PathIntegrator integrator(world.description.integrator, world.camera);
        std::vector<PathStart<SampleStream>> starts;
        std::vector<FilmContribution> one_by_one;
        RayTracer tracer(world.accelerator);
        for (std::uint64_t index = 0; index < 16; ++index)
            for (int y = 0; y < edge; ++y)
                for (int x = 0; x < edge; ++x) {
                    SampleStream stream({.kind = SamplerKind::sobol, .seed = 3, .spp = 16},
                                        static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), index);
                    const CameraSample camera = world.camera_sample(x, y, stream);
                    starts.push_back({camera, stream});
                    one_by_one.push_back(integrator.estimate(world.tables.view(), tracer, camera, stream));
                }
        for (const std::size_t size : {std::size_t{1}, std::size_t{7}, std::size_t{256}, starts.size()}) {
            RayTracer batch_tracer(world.accelerator);
            const std::vector<FilmContribution> batches =
                in_batches(world, integrator, starts, size, batch_tracer);
            EXPECT_EQ(batch_tracer.statistics.rays(), tracer.statistics.rays());
            int lit = 0;
            for (std::size_t i = 0; i < batches.size(); ++i) {
                ASSERT_TRUE(same_bits(batches[i], one_by_one[i]))
                    << "strategy " << int(strategy) << ", batches of " << size << ", path " << i;
                lit += !is_black(batches[i].radiance);
            }
            EXPECT_GT(lit, 500) << "strategy " << int(strategy);
        }
    }
}

// A point of primary sample space: numbers that are kept, and drawn from another stream when first asked for.
class PrimarySampleStream {
  public:
    explicit PrimarySampleStream(SampleStream source) : source_(source) {}

    float next_1d() {
        return kept([&] { return source_.next_1d(); });
    }
    Vec2f next_2d() {
        if (at_ < numbers_.size()) {
            at_ += 2;
            return {static_cast<float>(numbers_[at_ - 2]), static_cast<float>(numbers_[at_ - 1])};
        }
        const Vec2f u = source_.next_2d();
        numbers_.insert(numbers_.end(), {double(u.x), double(u.y)});
        at_ += 2;
        return u;
    }
    double refined(float u) {
        if (at_ < numbers_.size()) return numbers_[at_++];
        numbers_.push_back(source_.refined(u));
        return numbers_[at_++];
    }

    void rewind() { at_ = 0; }
    std::size_t size() const { return numbers_.size(); }
    std::size_t used() const { return at_; }

  private:
    template <typename Draw>
    float kept(const Draw& draw) {
        if (at_ == numbers_.size()) numbers_.push_back(double(draw()));
        return static_cast<float>(numbers_[at_++]);
    }

    SampleStream source_;
    std::vector<double> numbers_;
    std::size_t at_ = 0;
};
static_assert(IntegratorModel<PathIntegrator, PrimarySampleStream>);

TEST(PathIntegrator, PointsOfPrimarySampleSpaceDriveIt) {
    const World world(scene_of(Strategy::mis));
    const PathIntegrator integrator(world.description.integrator, world.camera);
    RayTracer tracer(world.accelerator);
    double largest = 0, by_samples = 0, by_points = 0;
    int differ = 0, paths = 0;
    for (std::uint64_t index = 0; index < 8; ++index)
        for (int y = 0; y < edge; ++y)
            for (int x = 0; x < edge; ++x) {
                SampleStream stream({.kind = SamplerKind::independent, .seed = 4},
                                    static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), index);
                const CameraSample camera = world.camera_sample(x, y, stream);
                PrimarySampleStream point(stream);
                const auto estimate = [&](auto& s) {
                    return integrator.estimate(world.tables.view(), tracer, camera, s);
                };
                const FilmContribution sampled = estimate(stream), fresh = estimate(point);
                const std::size_t drawn = point.size();
                point.rewind();
                ASSERT_TRUE(same_bits(estimate(point), fresh)); // the point alone decides
                ASSERT_EQ(point.size(), drawn);
                ASSERT_EQ(point.used(), drawn);
                // Another instance of the templates may round otherwise, and a path in many turn another way.
                const double a = double(sampled.radiance[0]), b = double(fresh.radiance[0]);
                differ += std::abs(a - b) > 1e-3 * std::abs(a);
                largest = std::max(largest, std::abs(a));
                by_samples += a;
                by_points += b;
                ++paths;
            }
    EXPECT_LT(differ, paths / 100);
    EXPECT_NEAR(by_samples, by_points, 0.01 * by_samples);
    EXPECT_GT(largest, 0);
}

} // namespace
} // namespace montelux::testing
