// PathIntegrator by states and steps: any driver and any stream give the same path, one by one or in lanes.
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

// Every path in batches of many sizes against the same path by itself; `lit`: at least so many carry light.
void expect_same_in_batches(const World& world, const IntegratorSettings& settings, SamplerKind kind,
                            int lit) {
    const PathIntegrator integrator(settings, world.camera);
    std::vector<PathStart<SampleStream>> starts;
    std::vector<FilmContribution> one_by_one;
    RayTracer tracer(world.accelerator);
    for (std::uint64_t index = 0; index < 8; ++index)
        for (int y = 0; y < edge; ++y)
            for (int x = 0; x < edge; ++x) {
                SampleStream stream({.kind = kind, .seed = 3, .spp = 16}, static_cast<std::uint32_t>(x),
                                    static_cast<std::uint32_t>(y), index);
                const CameraSample camera = world.camera_sample(x, y, stream);
                starts.push_back({camera, stream});
                one_by_one.push_back(integrator.estimate(world.tables.view(), tracer, camera, stream));
            }
    for (const std::size_t size : {std::size_t{1}, std::size_t{7}, std::size_t{256}, starts.size()}) {
        RayTracer batch_tracer(world.accelerator);
        const std::vector<FilmContribution> batches =
            in_batches(world, integrator, starts, size, batch_tracer);
        EXPECT_EQ(batch_tracer.statistics.rays(), tracer.statistics.rays());
        for (std::size_t i = 0; i < batches.size(); ++i) {
            ASSERT_TRUE(same_bits(batches[i], one_by_one[i])) << "batches of " << size << ", path " << i;
            if (size == 1) lit -= !is_black(batches[i].radiance);
        }
    }
    EXPECT_LE(lit, 0);
}

TEST(PathIntegrator, PathsInBatchesAreTheSameToTheLastBit) {
    const World world(scene_of(Strategy::mis));
    IntegratorSettings settings = world.description.integrator;
    ASSERT_NO_FATAL_FAILURE(expect_same_in_batches(world, settings, SamplerKind::independent, 500));
    for (Strategy strategy : {Strategy::uniform, Strategy::bsdf, Strategy::light, Strategy::mis,
                              Strategy::mis_bsdf, Strategy::mis_light}) {
        SCOPED_TRACE(static_cast<int>(strategy));
        settings.strategy = strategy;
        ASSERT_NO_FATAL_FAILURE(expect_same_in_batches(world, settings, SamplerKind::sobol, 500));
    }
}

// Triangles at random: with normals that turn against them, without area, emitting, in a mesh of its own for
// each, beside more lights than are chosen by one number.
SceneDescription odd_triangles(double scale) {
    SceneBuilder b = mixed_scene(scale, edge, edge);
    SampleStream random({.kind = SamplerKind::independent, .seed = 8}, 0, 0, 0);
    const auto any_vector = [&] {
        const Vec2f u = random.next_2d();
        return Vec3f(2 * u.x - 1, 2 * u.y - 1, 2 * random.next_1d() - 1);
    };
    for (int i = 0; i < 120; ++i) {
        TriangleMesh mesh;
        const Vec3f middle = any_vector();
        for (Index k = 0; k < 3; ++k) {
            const Vec3f corner = middle + (i % 8 == 0 ? static_cast<float>(k) : 0.4f) * any_vector();
            mesh.positions.push_back(static_cast<float>(scale) * corner);
            if (i % 2 == 0) mesh.normals.push_back(i % 12 == 0 ? Vec3f{} : any_vector());
            mesh.indices.push_back(k);
        }
        if (i % 10 == 0) mesh.positions[2] = mesh.positions[1];
        const float reflectance = random.next_1d();
        b.add_mesh(mesh, b.add(DiffuseMaterial{{SceneSpectrum(reflectance)}}), i % 3 == 0 ? 2.0f : 0.0f);
    }
    SceneDescription d = b.description;
    d.integrator.max_depth = 4;
    return d;
}

TEST(PathIntegrator, OddTrianglesInBatchesAreTheSameToTheLastBit) {
    for (const double scale : {1.0, 1e-6, 1e6}) {
        SCOPED_TRACE(scale);
        const World world(odd_triangles(scale));
        ASSERT_NO_FATAL_FAILURE(
            expect_same_in_batches(world, world.description.integrator, SamplerKind::independent, 500));
    }
}

// Diffuse surfaces that are not plain triangles of the world: textured ones, quadrics, mirrored instances with an
// emission that does not shine, and one with bumps, in groups with plain ones.
SceneDescription diffuse_of_all_kinds() {
    SceneBuilder b = mixed_scene(1, edge, edge);
    Image squares(8, 8, {"R", "G", "B"});
    for (int i = 0; i < 64; ++i)
        for (int c = 0; c < 3; ++c)
            squares.set(i % 8, i / 8, c, 0.1f + 0.08f * static_cast<float>((i * 5 + c) % 11));
    ImageTexture picture;
    picture.image = static_cast<Index>(b.scene.images.size());
    b.scene.images.push_back(squares);
    DiffuseMaterial textured{gray(0)}, bumpy{gray(0.6f)};
    textured.reflectance.texture = static_cast<Index>(b.scene.spectrum_textures.size());
    b.scene.spectrum_textures.push_back(picture);
    bumpy.detail.displacement.texture = static_cast<Index>(b.scene.float_textures.size());
    b.scene.float_textures.push_back(picture);
    const Index materials[] = {b.add(textured), b.add(bumpy), b.add(DiffuseMaterial{gray(0.7f)})};

    for (int i = 0; i < 12; ++i) {
        const Transform t = Transform::translate({-0.8 + 0.15 * i, -0.6, -0.9 + 0.12 * (i % 5)}) *
                            Transform::rotate(35.0 * i, {1, 0.2 * i, 0.5}) *
                            Transform::scale({0.2, 0.2, 0.2});
        const Index material = materials[i % 3];
        if (i % 4 == 0) {
            b.add_quadric(Sphere{.world_from_object = t}, material, i == 8 ? 1.0f : 0.0f, i == 4);
            continue;
        }
        const Index shape = b.add_mesh(square(t), material, i % 8 == 3 || i == 5 ? 2.0f : 0.0f);
        if (i % 4 == 1) continue;
        b.scene.world_shapes.pop_back();
        b.scene.objects.push_back({{shape}});
        b.scene.instances.push_back({static_cast<Index>(b.scene.objects.size() - 1),
                                     Transform::translate({0.1 * i - 0.5, 0, 0.1}) *
                                         Transform::scale({1, i % 4 == 2 ? 1.0 : -1.0, 1})});
    }
    SceneDescription d = b.description;
    d.integrator.max_depth = 6;
    return d;
}

TEST(PathIntegrator, DiffuseSurfacesOfAllKindsInBatchesAreTheSameToTheLastBit) {
    const World world(diffuse_of_all_kinds());
    for (const SamplerKind kind : {SamplerKind::independent, SamplerKind::sobol})
        ASSERT_NO_FATAL_FAILURE(expect_same_in_batches(world, world.description.integrator, kind, 500));
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
    double largest = 0;
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
                ASSERT_TRUE(same_bits(sampled, fresh));
                largest = std::max(largest, double(fresh.radiance[0]));
            }
    EXPECT_GT(largest, 0);
}

} // namespace
} // namespace montelux::testing
