// Replayed samples are bit-identical to those of the render; their records add up, and name what made a
// sample bad.
#include "test/render/mixed_scene.h"
#include "test/sanitized.h"
#include <gtest/gtest.h>
#include <limits>
#include <map>
#include <memory>
#include <utility>

#include "montelux/mc/math/error.h"
#include "montelux/render/sample_record.h"
#include "montelux/scene/material/make_bsdf.h"

namespace montelux::testing {
namespace {

constexpr SamplerKind all_samplers[] = {SamplerKind::independent, SamplerKind::stratified,
                                        SamplerKind::halton,      SamplerKind::hammersley,
                                        SamplerKind::sobol,       SamplerKind::sobol_blue_noise};
constexpr Strategy all_strategies[] = {Strategy::uniform, Strategy::bsdf,     Strategy::light,
                                       Strategy::mis,     Strategy::mis_bsdf, Strategy::mis_light};

// The pixel that the replays of its samples add up to.
Pixel replayed_pixel(const Renderer& renderer, int x, int y) {
    const SamplerSettings& sampler = renderer.sampler();
    Pixel pixel;
    for (std::uint32_t i = 0; i < sampler.spp; ++i) {
        const SampleRecord r = renderer.replay(x, y, i);
        EXPECT_EQ(r.bad.has_value(), false);
        pixel.add_sample(r.contribution);
        const bool last = i + 1 == sampler.spp;
        if (sampler.kind == SamplerKind::independent || last ||
            replicate_of(sampler, i + 1) != replicate_of(sampler, i))
            pixel.end_replicate();
    }
    return pixel;
}

void expect_same_pixels(const SceneDescription& description, std::shared_ptr<const PreparedScene> prepared) {
    const Renderer renderer(description, {}, 0, std::move(prepared));
    Film film(description.film);
    renderer.render(film);
    const PixelBounds& b = film.bounds();
    for (int y = b.y0; y < b.y1; ++y)
        for (int x = b.x0; x < b.x1; ++x)
            EXPECT_TRUE(same_pixel(replayed_pixel(renderer, x, y), film.pixel(x, y))) << x << ',' << y;
}

TEST(Replay, IsTheSampleOfTheRender) {
    SceneBuilder b = mixed_scene(1, 16, 16);
    const auto prepared = prepared_scene(b.description);
    for (SamplerKind sampler : all_samplers) {
        SCOPED_TRACE(static_cast<int>(sampler));
        b.description.sampler.kind = sampler;
        b.description.sampler.spp = under_sanitizers ? 4 : 12;
        b.description.sampler.seed = 7;
        b.description.film.filter = MitchellFilter{};
        expect_same_pixels(b.description, prepared);
    }
}

TEST(Replay, IsTheSampleOfEveryStrategy) {
    SceneBuilder b = mixed_scene(1, 24, 24);
    std::map<bool, std::shared_ptr<const PreparedScene>> prepared; // with tables of the map for MIS or not
    for (Strategy strategy : all_strategies)
        for (Heuristic heuristic : {Heuristic::balance, Heuristic::power}) {
            SCOPED_TRACE(static_cast<int>(strategy));
            b.description.sampler.spp = 8;
            b.description.integrator = {.max_depth = 9, .strategy = strategy, .heuristic = heuristic};
            b.description.film.crop = {3, 5, 21, 24};
            b.description.film.max_component_value = 2;
            auto& of_strategy = prepared[strategy >= Strategy::mis];
            if (!of_strategy) of_strategy = prepared_scene(b.description);
            expect_same_pixels(b.description, of_strategy);
        }
}

float largest_of(SampledSpectrum s) { return max_value(max(s, -s)); }

// Each vertex starts with the throughput that the previous one left, and the contributions sum to the
// radiance.
TEST(Replay, TheRecordAddsUp) {
    SceneBuilder b = mixed_scene(1, 24, 24);
    std::map<bool, std::shared_ptr<const PreparedScene>> prepared; // with tables of the map for MIS or not
    for (Strategy strategy : all_strategies) {
        b.description.integrator = {.max_depth = 6, .strategy = strategy};
        b.description.sampler.spp = 4;
        auto& of_strategy = prepared[strategy >= Strategy::mis];
        if (!of_strategy) of_strategy = prepared_scene(b.description);
        const Renderer renderer(b.description, {}, 0, of_strategy);
        int ends[7] = {}, survived = 0, shared = 0, occluded = 0;
        for (int y = 0; y < 24; ++y)
            for (int x = 0; x < 24; ++x)
                for (std::uint64_t i = 0; i < 4; ++i) {
                    const SampleRecord r = renderer.replay(x, y, i);
                    const PathRecord& path = r.path;
                    ++ends[static_cast<int>(path.end)];
                    EXPECT_FALSE(origin_of_bad(path).has_value());
                    SampledSpectrum sum, throughput(1);
                    ASSERT_FALSE(path.vertices.empty());
                    for (const PathVertex& v : path.vertices) {
                        EXPECT_EQ(v.throughput, throughput);
                        throughput = v.continued;
                        for (const FoundLight& light : v.found) {
                            sum += light.contribution;
                            shared += light.shared;
                            EXPECT_LE(light.weight, 1);
                        }
                        if (v.direct) {
                            sum += v.direct->contribution;
                            occluded += v.direct->outcome == DirectLight::Outcome::occluded;
                        }
                        EXPECT_EQ(v.surface.has_value(), v.hit.shape != no_index);
                        if (v.roulette) {
                            survived += v.roulette->u < v.roulette->survival;
                        }
                        const bool last = &v == &path.vertices.back();
                        EXPECT_EQ(v.surface.has_value(), !last || path.end != PathEnd::left_scene);
                        EXPECT_TRUE(v.scattering.has_value() || last);
                    }
                    EXPECT_LE(largest_of(sum - path.radiance), 2e-6f * largest_of(path.radiance));
                    if (path.end == PathEnd::max_depth) {
                        EXPECT_EQ(path.vertices.size(), 7u);
                    }
                    EXPECT_EQ(r.rgb, r.contribution.radiance);
                }
        EXPECT_GT(ends[static_cast<int>(PathEnd::left_scene)], 0);
        EXPECT_GT(ends[static_cast<int>(PathEnd::max_depth)], 0);
        EXPECT_GT(ends[static_cast<int>(PathEnd::roulette)], 0);
        EXPECT_EQ(ends[static_cast<int>(PathEnd::bad_throughput)], 0);
        EXPECT_GT(survived, 0);
        EXPECT_GT(shared, 0);
        EXPECT_EQ(occluded > 0, strategy >= Strategy::light && strategy != Strategy::mis_bsdf);
    }
}

// Dispersion: the record contains the wavelengths that are left.
TEST(Replay, WavelengthsThatEnded) {
    SceneBuilder b;
    b.add_uniform_light(1);
    const Spectrum dispersive(PiecewiseLinear(std::vector<float>{360, 830}, std::vector<float>{1.6f, 1.4f}));
    b.add_quadric(Sphere{}, b.add(DielectricMaterial{add_spectrum(b.scene, dispersive), alpha_of(0)}));
    b.look({0, -3, 0}, {0, 0, 0}, 30);
    const SampleRecord r = Renderer(b.description).replay(4, 4, 0);
    EXPECT_FALSE(r.lambda.secondary_terminated());
    EXPECT_TRUE(r.lambda_end.secondary_terminated());
    EXPECT_EQ(r.path.vertices[0].bsdf->bsdf.index(), Bsdf(DielectricBsdf{}).index());
}

const float not_a_number = std::numeric_limits<float>::quiet_NaN(),
            infinity = std::numeric_limits<float>::infinity();

// Seen from the front: a mirror or a plain wall, then a wall behind the camera.
struct TwoWalls {
    SceneBuilder b;
    TwoWalls(const Material& front, const Material& back) {
        b.add_uniform_light(1);
        Transform to_camera = Transform::rotate(90, {1, 0, 0});
        b.add_mesh(square(to_camera), b.add(front));
        b.add_mesh(square(Transform::translate({0, -6, 0}) * Transform::scale({9, 9, 9}) * to_camera),
                   b.add(back));
        b.look({0, -3, 0}, {0, 0, 0}, 20);
        b.description.sampler.spp = 4;
    }
    TwoWalls& light(const Light& light) {
        b.scene.lights[0] = light;
        return *this;
    }
    void expect(BadSample::Kind kind, BadOrigin::Quantity quantity, std::size_t vertex) {
        Film film(b.description.film);
        const Renderer renderer(b.description);
        const RenderReport report = renderer.render(film);
        ASSERT_TRUE(report.bad.first.has_value());
        const BadSample& first = *report.bad.first;
        EXPECT_EQ(first.kind, kind);
        const SampleRecord r = renderer.replay(first.x, first.y, first.sample);
        EXPECT_EQ(r.bad, first.kind);
        EXPECT_EQ(r.contribution.radiance, Vec3f());
        const auto origin = origin_of_bad(r.path);
        ASSERT_TRUE(origin.has_value());
        EXPECT_EQ(origin->quantity, quantity);
        EXPECT_EQ(origin->vertex, vertex);
    }
};

ConductorMaterial metal(float k, float alpha) {
    return {.metal = {.eta = gray(0.2f), .k = gray(k)}, .roughness = alpha_of(alpha)};
}
const DiffuseMaterial half{gray(0.5f)};

PointLight lamp(float intensity) { return {intensity, 1, {0, -2, 0}}; }

// A rough surface shows it where it is lit, a mirror in the throughput that it leaves.
TEST(Replay, NamesTheMaterialThatIsNotANumber) {
    const Light good = lamp(1);
    TwoWalls(metal(not_a_number, 0.3f), half)
        .light(good)
        .expect(BadSample::Kind::nan, BadOrigin::Quantity::bsdf_value, 0);
    TwoWalls(metal(3, 0), metal(not_a_number, 0.3f))
        .light(good)
        .expect(BadSample::Kind::nan, BadOrigin::Quantity::bsdf_value, 1);
    TwoWalls(metal(not_a_number, 0), half)
        .light(good)
        .expect(BadSample::Kind::nan, BadOrigin::Quantity::bsdf_weight, 0);
    TwoWalls(metal(3, 0), metal(not_a_number, 0))
        .light(good)
        .expect(BadSample::Kind::nan, BadOrigin::Quantity::bsdf_weight, 1);
}

TEST(Replay, NamesTheLightThatIsBad) {
    for (auto [emission, kind] :
         {std::pair{not_a_number, BadSample::Kind::nan}, std::pair{infinity, BadSample::Kind::infinite},
          std::pair{-2.0f, BadSample::Kind::negative}}) {
        TwoWalls(half, half).light(lamp(emission)).expect(kind, BadOrigin::Quantity::direct_radiance, 0);
        TwoWalls seen(metal(3, 0), half);
        seen.b.description.integrator.strategy = Strategy::bsdf;
        seen.light(UniformInfiniteLight{emission, 1}).expect(kind, BadOrigin::Quantity::found_radiance, 2);
    }
}

TEST(Replay, RefusesSamplesThatTheRenderDoesNotTake) {
    SceneBuilder b = mixed_scene(1, 16, 12);
    b.description.film.crop = {2, 3, 9, 8};
    b.description.sampler.spp = 4;
    const Renderer renderer(b.description);
    EXPECT_NO_THROW(renderer.replay(2, 3, 0));
    EXPECT_NO_THROW(renderer.replay(8, 7, 3));
    for (auto [x, y] : {std::pair{1, 3}, {9, 3}, {2, 2}, {2, 8}, {-1, 3}, {99, 99}})
        EXPECT_THROW(renderer.replay(x, y, 0), Error) << x << ',' << y;
    EXPECT_THROW(renderer.replay(2, 3, 4), Error);
}

} // namespace
} // namespace montelux::testing
