// What a guide learns, and directions that are drawn from it and a BSDF together.
#include "test/significance.h"
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <map>
#include <set>
#include <vector>

#include "montelux/mc/math/error.h"
#include "montelux/mc/parallel/parallel_for.h"
#include "montelux/mc/random/sample_stream.h"
#include "montelux/mc/stats/chi_squared.h"
#include "montelux/scene/bsdf/diffuse.h"
#include "montelux/scene/bsdf/thin_dielectric.h"
#include "montelux/transport/guiding/guided_scattering.h"
#include "montelux/transport/guiding/guiding_learner.h"
#include "montelux/transport/path_state.h"

namespace montelux {
namespace {

const Vec3f bright = normalize(Vec3f{1, 0, 1});

// Records on the floor z = 0 of the square [-1, 1]^2; light comes from near `bright` where x > 0, evenly elsewhere.
std::vector<std::vector<GuidingRecord>> floor_records(int count, std::uint64_t seed, float distance = 0) {
    TestUniforms u(seed);
    std::vector<std::vector<GuidingRecord>> lists(4);
    for (int i = 0; i < count; ++i) {
        GuidingRecord r;
        r.p = {2 * u.next_float() - 1, 2 * u.next_float() - 1, 0};
        r.facing = facing_of({0, 0, 1});
        const Vec3f wi = equal_area_square_to_sphere(u.next_2f());
        r.direction = equal_area_sphere_to_square(wi);
        r.pdf = r.bsdf_pdf = inv_four_pi_f;
        r.estimate = r.p.x > 0 ? (dot(wi, bright) > 0.95f ? 40.0f : 0.02f) : 1.0f;
        r.radiance = r.estimate;
        r.distance = distance;
        lists[static_cast<std::size_t>(i) % lists.size()].push_back(r);
    }
    return lists;
}

GuidingField floor_field(std::size_t region_records = 4000, float distance = 0) {
    return GuidingLearner::learn(floor_records(100000, 1, distance), {.region_records = region_records},
                                 {0, 0, 1, 1}, {1.0f});
}

TEST(GuidingField, LearnsWhereLightComesFrom) {
    const GuidingField field = floor_field();
    const Facing up = facing_of({0, 0, 1});
    const GuidingRegion* lit = field.find({0.6f, 0.1f, 0}, up);
    const GuidingRegion* even = field.find({-0.6f, 0.1f, 0}, up);
    ASSERT_NE(lit, nullptr);
    ASSERT_NE(even, nullptr);
    const Point3f p{0.6f, 0.1f, 0}, q{-0.6f, 0.1f, 0};
    EXPECT_GT(lit->pdf(p, bright), 10 * lit->pdf(p, -bright));
    EXPECT_LT(even->pdf(q, bright), 3 * inv_four_pi_f);
    EXPECT_GT(even->pdf(q, bright), inv_four_pi_f / 3);
    EXPECT_NEAR(double(even->radiance), 1, 1e-3);
    // The other side of a floor has seen no path, nor has the air.
    EXPECT_EQ(field.find({0.6f, 0.1f, 0}, facing_of({0, 0, -1})), nullptr);
    EXPECT_EQ(field.find({0.6f, 0.1f, 0}, Facing::medium), nullptr);
    EXPECT_GT(field.regions(), 10u);
    EXPECT_EQ(field.expected(0, 0), 1);
}

TEST(GuidingField, FacingsAreTheNearestAxes) {
    EXPECT_EQ(facing_of({-1, 0.2f, 0}), Facing::left);
    EXPECT_EQ(facing_of({1, 0.2f, -0.9f}), Facing::right);
    EXPECT_EQ(facing_of({0.1f, -1, 0}), Facing::down);
    EXPECT_EQ(facing_of({0.1f, 1, 0}), Facing::up);
    EXPECT_EQ(facing_of({0, 0, -1}), Facing::back);
    EXPECT_EQ(facing_of({0, 0.5f, 1}), Facing::front);
}

// As if a wall beside the floor shone, so that some regions have a sphere.
GuidingField near_field(std::size_t region_records, int count = 100000) {
    auto lists = floor_records(count, 1);
    for (auto& list : lists)
        for (GuidingRecord& r : list) {
            const Vec3f wi = equal_area_square_to_sphere(r.direction);
            r.distance = (1.2f - r.p.x) / std::max(wi.x, 0.1f);
            const Point3f seen = r.p + r.distance * wi;
            r.estimate = wi.x > 0 && std::hypot(seen.y, seen.z - 0.3f) < 0.1f ? 40.0f : 0.02f;
        }
    return GuidingLearner::learn(lists, {.region_records = region_records}, {0, 0, 1, 1}, {1.0f});
}

TEST(GuidingField, IsTheSameForAnyNumberOfThreadsAndComesBackFromBytes) {
    std::vector<std::vector<std::uint8_t>> bytes;
    for (int threads : {1, 2, 7})
        with_threads(threads, [&] {
            ByteWriter out;
            near_field(500).save(out);
            bytes.push_back(out.take());
        });
    EXPECT_EQ(bytes[0], bytes[1]);
    EXPECT_EQ(bytes[0], bytes[2]);
    ByteReader in(bytes[0]);
    ByteWriter again;
    const GuidingField loaded = GuidingField::load(in);
    loaded.save(again);
    EXPECT_TRUE(in.at_end());
    EXPECT_EQ(again.take(), bytes[0]);
    const GuidingField learned = near_field(500);
    int spheres = 0;
    for (float x = -0.95f; x < 1; x += 0.1f) {
        const Point3f p{x, 0.1f, 0};
        const Facing up = facing_of({0, 0, 1});
        EXPECT_EQ(loaded.find(p, up)->pdf(p, bright), learned.find(p, up)->pdf(p, bright));
        spheres += loaded.find(p, up)->sphere.radius > 0;
    }
    EXPECT_GT(spheres, 2);
}

TEST(GuidingField, DamagedBytesAreRefusedOrHarmless) {
    ByteWriter out;
    near_field(500, 3000).save(out);
    const std::vector<std::uint8_t> good = out.take();
    TestUniforms u(19);
    int refused = 0;
    for (int i = 0; i < 300; ++i) {
        std::vector<std::uint8_t> bytes = good;
        // Mostly in the trees of space, at the beginning.
        const double at = std::pow(u.next(), 3) * double(bytes.size());
        bytes[static_cast<std::size_t>(at)] ^= static_cast<std::uint8_t>(1 + u.next() * 255);
        if (i % 5 == 0) bytes.resize(bytes.size() / 2);
        try {
            ByteReader in(bytes);
            const GuidingField field = GuidingField::load(in);
            for (int k = 0; k < 20; ++k) {
                const Point3f p{u.next_float(), u.next_float(), 0};
                if (const GuidingRegion* region = field.find(p, facing_of({0, 0, 1})))
                    region->pdf(p, region->sample(p, u.next_2f()).wi);
            }
        } catch (const Error&) {
            ++refused;
        }
    }
    EXPECT_GT(refused, 60);
}

// Trees are saved first: for each facing its number of nodes, of 8 bytes, and the nodes, of four numbers of 4 bytes.
TEST(GuidingField, TreesNameOnlyRegionsThatExist) {
    const GuidingField field = GuidingLearner::learn(floor_records(2000, 1), {}, {0, 0, 1, 1}, {1.0f});
    ASSERT_EQ(field.regions(), 1u);
    ByteWriter out;
    field.save(out);
    std::vector<std::uint8_t> bytes = out.take();
    const std::size_t tree = 8 * static_cast<std::size_t>(facing_of({0, 0, 1})), axis = tree + 8 + 4,
                      region = axis + 4;
    ASSERT_EQ(bytes[tree], 1);
    ASSERT_EQ(bytes[axis], 3);
    const auto load = [&](std::uint8_t number) {
        bytes[region] = number;
        ByteReader in(bytes);
        (void)GuidingField::load(in);
    };
    EXPECT_NO_THROW(load(0));
    for (const std::uint8_t number : {1, 2, 255}) EXPECT_THROW(load(number), Error) << int(number);
}

TEST(GuidingField, CellsAreWhereItsRegionsAre) {
    const GuidingField field = floor_field(500);
    const Facing up = facing_of({0, 0, 1});
    const std::vector<GuidingField::Cell> cells = field.cells();
    EXPECT_EQ(cells.size(), field.regions());
    std::map<std::size_t, const GuidingRegion*> region_of_cell;
    TestUniforms u(23);
    for (int i = 0; i < 5000; ++i) {
        const Point3f p{3 * u.next_float() - 1.5f, 3 * u.next_float() - 1.5f, u.next_float() - 0.5f};
        const auto within = [&](const GuidingField::Cell& cell) {
            bool is = cell.facing == up;
            for (int axis = 0; axis < 3; ++axis)
                is = is && p[axis] >= cell.low[axis] && p[axis] < cell.high[axis];
            return is;
        };
        ASSERT_EQ(std::ranges::count_if(cells, within), 1);
        const auto cell = static_cast<std::size_t>(std::ranges::find_if(cells, within) - cells.begin());
        const auto known = region_of_cell.try_emplace(cell, field.find(p, up)).first;
        EXPECT_EQ(known->second, field.find(p, up));
    }
    std::set<const GuidingRegion*> regions;
    for (const auto& [cell, region] : region_of_cell) regions.insert(region);
    EXPECT_EQ(regions.size(), region_of_cell.size());
    EXPECT_GT(regions.size(), 50u);
}

// Many records: regions stay within their memory.
TEST(GuidingField, KeepsToItsMemory) {
    const auto records = floor_records(100000, 2);
    const GuidingField small =
        GuidingLearner::learn(records, {.region_records = 100, .most_bytes = 1 << 18}, {0, 0, 1, 1}, {1.0f});
    const GuidingField large =
        GuidingLearner::learn(records, {.region_records = 100, .most_bytes = 1 << 28}, {0, 0, 1, 1}, {1.0f});
    EXPECT_LT(small.bytes(), std::size_t{1} << 18);
    EXPECT_GT(large.bytes(), std::size_t{1} << 18);
}

// Light that can be seen is left to light samples; light that is mostly hidden from them is learned.
TEST(GuidingLearner, LearnsLightThatLightSamplesRarelyFind) {
    for (const bool visible : {false, true}) {
        auto lists = floor_records(20000, 4);
        for (auto& list : lists)
            for (GuidingRecord& r : list) {
                r.estimate = 0.01f;
                const Vec3f wi = equal_area_square_to_sphere(r.direction);
                r.left_to_light_samples = dot(wi, bright) > 0.95f ? 100.0f : 0.0f;
                r.aimed = true;
                r.visible = visible;
            }
        const GuidingField field = GuidingLearner::learn(lists, {}, {0, 0, 1, 1}, {1.0f});
        const GuidingRegion& region = *field.find({0.5f, 0.5f, 0}, facing_of({0, 0, 1}));
        if (visible)
            EXPECT_EQ(region.visible, 1);
        else
            EXPECT_LT(region.visible, 0.002f);
        EXPECT_GT(region.visible, 0);
        const float pdf = region.pdf({0.5f, 0.5f, 0}, bright);
        if (visible)
            EXPECT_LT(pdf, 3 * inv_four_pi_f);
        else
            EXPECT_GT(pdf, 10 * inv_four_pi_f);
    }
}

// A lamp at arm's length above the floor, seen from all of one region: from each of its points in another direction.
TEST(GuidingLearner, PointsOfARegionLookAtTheSamePlace) {
    const Point3f lamp{0.1f, 0, 1};
    constexpr float cosine = 0.98f; // of the cone that the lamp takes
    const auto lists = [&](bool distances) {
        auto records = floor_records(4000, 5);
        for (auto& list : records)
            for (GuidingRecord& r : list) {
                const Vec3f wi = equal_area_square_to_sphere(r.direction);
                const Vec3f to_lamp = lamp - r.p;
                const bool hits = dot(wi, normalize(to_lamp)) > cosine;
                r.estimate = hits ? 100.0f : 0.02f;
                if (distances) r.distance = hits ? length(to_lamp) : 2;
            }
        return records;
    };
    const PixelBounds bounds{0, 0, 1, 1};
    const GuidingField near = GuidingLearner::learn(lists(true), {}, bounds, {1.0f});
    const GuidingField far = GuidingLearner::learn(lists(false), {}, bounds, {1.0f});
    const Facing up = facing_of({0, 0, 1});
    ASSERT_EQ(near.regions(), 1u);
    EXPECT_GT(near.find({}, up)->sphere.radius, 0.5f);
    EXPECT_EQ(far.find({}, up)->sphere.radius, 0);
    for (const Point3f p : {Point3f{0, 0, 0}, Point3f{0.7f, 0.7f, 0}, Point3f{-0.8f, 0.5f, 0}}) {
        const Vec3f wi = normalize(lamp - p);
        EXPECT_GT(near.find(p, up)->pdf(p, wi), 3 * far.find(p, up)->pdf(p, wi));
    }
}

// From a diffuse vertex comes what those around it scatter on average; from a glossy one what the path itself found.
TEST(GuidingTrace, GlossyVerticesBringWhatTheirPathFound) {
    const GuidingField field = floor_field(); // regions where x < 0 scatter 1
    const Facing up = facing_of({0, 0, 1});
    for (const bool glossy : {false, true}) {
        GuidingTrace trace;
        trace.clear();
        trace.begin({0.5f, 0, 1}, facing_of({0, 0, -1}), false, SampledSpectrum(1), SampledSpectrum(0));
        trace.survive(0.5f);
        trace.scatter({0, 0, -1}, 1, 1, 1);
        trace.arrive(SampledSpectrum(0.25f)); // of its light sample
        // The throughput has been divided by the probability of surviving.
        trace.begin({-0.6f, 0.1f, 0}, up, glossy, SampledSpectrum(2), SampledSpectrum(0.25f));
        trace.scatter({0, 0, 1}, 1, 1, 1);
        trace.arrive(SampledSpectrum(0.75f));
        trace.meet_light(SampledSpectrum(8), 0.25f, 0.25f); // 6 of it are left to light samples
        std::vector<GuidingRecord> records;
        trace.finish(SampledSpectrum(6.75f), &field, records);
        ASSERT_EQ(records.size(), 2u);
        EXPECT_EQ(records[0].glossy, glossy);
        EXPECT_FLOAT_EQ(records[0].estimate, 3); // no further vertex: what was found
        EXPECT_NEAR(double(records[1].estimate), glossy ? 0.5 * (6.75 - 0.25) : 0.5 * 2, 2e-3);
        EXPECT_FLOAT_EQ(records[1].distance, length(Point3f{0.5f, 0, 1} - Point3f{-0.6f, 0.1f, 0}));
        EXPECT_EQ(records[0].distance, 0);
        EXPECT_FLOAT_EQ(records[0].left_to_light_samples, 3); // over the throughput
    }
}

// The mean weight over directions of a diffuse surface is its albedo, and the reported density that of the directions.
TEST(GuidedScattering, FollowsItsDensityAndKeepsTheAlbedo) {
    const GuidingField field = floor_field();
    const Point3f p{0.6f, 0.1f, 0};
    const GuidingRegion& region = *field.find(p, facing_of({0, 0, 1}));
    ASSERT_GT(region.share, 0);
    const Frame frame = Frame::from_normal({0, 0, 1});
    const DiffuseBsdf bsdf{SampledSpectrum(0.6f)};
    const Vec3f wo = normalize(Vec3f{0.3f, -0.2f, 0.8f});
    double sum = 0, squares = 0;
    constexpr int count = 200000;
    for (int i = 0; i < count; ++i) {
        SampleStream numbers({.kind = SamplerKind::independent, .seed = 7}, 0, 0,
                             static_cast<std::uint64_t>(i));
        const auto s = sample_guided(bsdf, frame, p, wo, region, numbers, nullptr);
        const double w = s ? double(average(s->weight)) : 0;
        if (s) {
            const Vec3f wi = frame.to_world(s->wi);
            const BsdfEvaluation e = bsdf.evaluate(wo, s->wi, TransportMode::radiance, numbers);
            ASSERT_NEAR(double(s->pdf), double(region.mixed_pdf(region.pdf(p, wi), e.pdf)),
                        2e-3 * double(s->pdf));
        }
        sum += w;
        squares += w * w;
    }
    const double mean = sum / count, error = std::sqrt((squares / count - mean * mean) / count);
    EXPECT_LT(std::abs(mean - 0.6), 5 * error);
    EXPECT_GT(error, 0);
}

// The guide never draws the direction of a delta lobe: what the lobe brings comes from the other directions alone. A
// pane has nothing else, and loses nothing. The count is within 5.5 standard errors: a false alarm in 26 million.
TEST(GuidedScattering, DeltaLobesKeepTheirAlbedo) {
    const GuidingField field = floor_field();
    const Point3f p{0.6f, 0.1f, 0};
    const GuidingRegion& region = *field.find(p, facing_of({0, 0, 1}));
    ASSERT_GT(region.share, 0);
    const double share = double(region.share);
    const Frame frame = Frame::from_normal({0, 0, 1});
    const ThinDielectricBsdf pane{1.5f};
    const Vec3f wo = normalize(Vec3f{0.3f, -0.2f, 0.8f});
    constexpr int count = 20000;
    int found = 0;
    for (int i = 0; i < count; ++i) {
        SampleStream numbers({.kind = SamplerKind::independent, .seed = 12}, 0, 0,
                             static_cast<std::uint64_t>(i));
        const auto s = sample_guided(pane, frame, p, wo, region, numbers, nullptr);
        if (!s) continue;
        ++found;
        ASSERT_TRUE(s->specular);
        ASSERT_NEAR(double(average(s->weight)) * (1 - share), 1, 1e-5);
    }
    EXPECT_NEAR(found, count * (1 - share), 5.5 * std::sqrt(count * share * (1 - share)));
}

// Branches bring what the pixel expects, within both bounds.
TEST(GuidedScattering, SplitsByWhatAPathIsExpectedToBring) {
    GuidingRegion region;
    region.radiance = 2;
    const auto branches = [&](float throughput, int most = most_branches_of_sample, float expected = 4) {
        return guided_branches(region, SampledSpectrum(throughput), most, expected);
    };
    EXPECT_EQ(branches(0), 1);
    EXPECT_EQ(branches(3.9f), 1);
    EXPECT_EQ(branches(4.1f), 2);
    EXPECT_EQ(branches(6.1f), 3);
    EXPECT_EQ(branches(1e30f), most_branches_at_vertex);
    EXPECT_EQ(branches(1e30f, 3), 3);
    EXPECT_EQ(branches(1e30f, 1), 1);
    EXPECT_EQ(branches(1e30f, 64, 0), 1); // it is not known what the pixel expects
    EXPECT_EQ(branches(std::numeric_limits<float>::quiet_NaN()), 1);
    // Branches share what a sample may have.
    for (const int at_each : {2, 3, 4}) {
        PathState state({});
        int leaves = 1;
        for (int i = 0; i < 10; ++i) {
            const int count = branches(2.0f * float(at_each) + 0.1f, state.branches);
            state.split(count);
            leaves *= count;
        }
        EXPECT_LE(leaves, most_branches_of_sample);
        EXPECT_GT(leaves, most_branches_of_sample / 4);
        EXPECT_NEAR(double(average(state.throughput)), 1.0 / leaves, 1e-6);
    }
}

// Strong ones always; weak ones, and those whose light is rarely seen, rarely.
TEST(GuidedScattering, TracesLightSamplesByWhatTheyBring) {
    GuidingRegion region;
    const auto survival = [&](float contribution, float visible, float expected = 4) {
        region.visible = visible;
        return guided_light_survival(region, SampledSpectrum(contribution), expected);
    };
    EXPECT_EQ(survival(2, 1), 1);
    EXPECT_EQ(survival(1e30f, 1), 1);
    EXPECT_FLOAT_EQ(survival(1, 1), 0.5f);
    EXPECT_FLOAT_EQ(survival(2, 0.01f), 0.1f);
    EXPECT_EQ(survival(21, 0.01f), 1);
    EXPECT_EQ(survival(-1, 1), 1);            // a fault, which is reported
    EXPECT_EQ(survival(1e-6f, 1e-6f), 0.05f); // unbiased: never 0
    EXPECT_EQ(survival(1e-6f, 1e-6f, 0), 1);  // it is not known what the pixel expects
    EXPECT_EQ(survival(std::numeric_limits<float>::quiet_NaN(), 1), 1);
}

// Counted on the square that the guide's directions are learned on, where its density is constant by squares. The
// weights are those of a phase function of the mean 1.
TEST(GuidedScattering, DirectionsFromPhaseFunctionsFollowTheirDensity) {
    const GuidingField field = floor_field();
    const Point3f p{0.6f, 0.1f, 0};
    const GuidingRegion& region = *field.find(p, facing_of({0, 0, 1}));
    const Vec3f wo = normalize(Vec3f{0.3f, -0.2f, 0.8f});
    for (const float g : {0.0f, 0.7f}) {
        const HenyeyGreenstein phase{g};
        std::uint64_t i = 0;
        double weights = 0, squares = 0;
        int off = 0;
        const TestResult r = rectangle_chi_squared_test(
            [&](Vec2f) {
                SampleStream numbers({.kind = SamplerKind::independent, .seed = 9}, 0, 0, i++);
                const GuidedDirection d = sample_guided(phase, p, wo, region, numbers, nullptr);
                const float pdf = region.mixed_pdf(region.pdf(p, d.wi), phase.pdf(wo, d.wi));
                off += !(std::abs(d.pdf - pdf) <= 1e-3f * pdf) || !(std::abs(length(d.wi) - 1) < 1e-5f);
                off += !(std::abs(d.weight * pdf - phase.pdf(wo, d.wi)) <= 1e-3f * pdf);
                weights += double(d.weight);
                squares += double(d.weight) * double(d.weight);
                return equal_area_sphere_to_square(d.wi);
            },
            [&](Vec2d v) {
                const Vec3f wi = equal_area_square_to_sphere(Vec2f(v));
                return double(region.mixed_pdf(region.pdf(p, wi), phase.pdf(wo, wi))) * 4 * pi;
            },
            {0, 0}, {1, 1}, {.samples = 100000, .cells_x = 16, .cells_y = 16});
        EXPECT_TRUE(r.passes(significance)) << g << ": " << r.description;
        EXPECT_EQ(off, 0) << g;
        const double n = double(i), mean = weights / n, error = std::sqrt((squares / n - mean * mean) / n);
        EXPECT_LT(std::abs(mean - 1), 5 * error + 1e-5) << g;
    }
}

// Where nothing guides, as in smooth glass, Russian roulette goes by what the whole path carries: a branch is no weaker
// than the path that was split.
TEST(GuidedSplitting, RouletteWithoutAGuideDoesNotUndoIt) {
    PathState state{CameraSample{}};
    state.throughput = SampledSpectrum(0.8f);
    const float strength = max_value(state.throughput) * state.roulette_scale;
    state.split(4);
    state.split(2);
    EXPECT_FLOAT_EQ(max_value(state.throughput), 0.1f);
    EXPECT_FLOAT_EQ(max_value(state.throughput) * state.roulette_scale, strength);
    EXPECT_EQ(state.branches, 8);
}

} // namespace
} // namespace montelux
