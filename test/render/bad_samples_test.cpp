// Samples that are NaN, infinite or negative: counted, reported, replayed; stopping early; clamping.
#include "test/render/mixed_scene.h"
#include <gtest/gtest.h>
#include <limits>

#include "montelux/mc/math/error.h"

namespace montelux::testing {
namespace {

// A sky of radiance 1 and in front of its right half (camera space is left-handed: -x) a square that emits
// something else.
SceneBuilder half_bad(float emission) {
    SceneBuilder b;
    b.add_uniform_light(1);
    Index black = b.add(DiffuseMaterial{gray(0)});
    b.add_mesh(square(Transform::translate({-1, 0, 0}) * Transform::rotate(90, {1, 0, 0})), black, 1);
    for (Light& light : b.scene.lights)
        if (auto* area = std::get_if<AreaLight>(&light)) *area = {emission, 1, true, area->shape};
    b.look({0, -3, 0}, {0, 0, 0}, 30);
    b.description.sampler.spp = 16;
    return b;
}

TEST(BadSamples, AreCountedReportedAndReplayed) {
    const float infinity = std::numeric_limits<float>::infinity();
    const std::pair<float, BadSample::Kind> cases[] = {
        {std::numeric_limits<float>::quiet_NaN(), BadSample::Kind::nan},
        {infinity, BadSample::Kind::infinite},
        {-2.0f, BadSample::Kind::negative}};
    for (auto [emission, kind] : cases)
        for (SamplerKind sampler : {SamplerKind::independent, SamplerKind::sobol}) {
            SceneBuilder b = half_bad(emission);
            b.description.sampler.kind = sampler;
            Film film(b.description.film);
            RenderReport report = Renderer(b.description).render(film);
            EXPECT_EQ(report.samples, 64u * 16);
            std::uint64_t of_kind = kind == BadSample::Kind::nan        ? report.bad.nan
                                    : kind == BadSample::Kind::infinite ? report.bad.infinite
                                                                        : report.bad.negative;
            EXPECT_EQ(of_kind, report.bad.count());
            EXPECT_EQ(of_kind, 32u * 16); // the right half
            std::uint64_t in_pixels = 0;
            for (int y = 0; y < 8; ++y)
                for (int x = 0; x < 8; ++x) {
                    const Pixel& p = film.pixel(x, y);
                    in_pixels += p.bad();
                    EXPECT_EQ(p.samples(), 16u);
                    EXPECT_EQ(p.bad(), x < 4 ? 0u : 16u);
                    if (x < 4) {
                        EXPECT_NEAR(p.replicates().mean(1), 1, 0.5);
                    } else {
                        EXPECT_EQ(p.replicates().mean(1), 0);
                    }
                }
            EXPECT_EQ(in_pixels, report.bad.count());
            // The one of lowest sample index, then row, then column.
            ASSERT_TRUE(report.bad.first.has_value());
            EXPECT_EQ(*report.bad.first, (BadSample{kind, 4, 0, 0}));
        }
}

// One sample in many is bad; rendering its pixel alone finds it again.
TEST(BadSamples, TheFirstOffenderIsFoundAlone) {
    SceneBuilder b = half_bad(std::numeric_limits<float>::quiet_NaN());
    // Seen through the whole pixel column only now and then: a strip on the edge of a column.
    b.scene.meshes[0] = square(Transform::translate({-0.55, 0, 0}) * Transform::rotate(90, {1, 0, 0}) *
                               Transform::scale({0.004, 0.2, 1}));
    Film film(b.description.film);
    RenderReport report = Renderer(b.description).render(film);
    ASSERT_TRUE(report.bad.first.has_value());
    EXPECT_GT(report.bad.nan, 0u);
    EXPECT_LT(report.bad.nan, 32u);
    BadSample first = *report.bad.first;
    b.description.film.crop = {first.x, first.y, first.x + 1, first.y + 1};
    Film alone(b.description.film);
    RenderReport replay = Renderer(b.description).render(alone);
    ASSERT_TRUE(replay.bad.first.has_value());
    EXPECT_EQ(*replay.bad.first, first);
    EXPECT_EQ(alone.pixel(first.x, first.y).bad(), film.pixel(first.x, first.y).bad());
    EXPECT_TRUE(same_pixel(alone.pixel(first.x, first.y), film.pixel(first.x, first.y)));
}

TEST(BadSamples, ReportsMergeInAnyOrder) {
    const BadSample late{BadSample::Kind::nan, 0, 0, 7}, low{BadSample::Kind::infinite, 9, 3, 2},
        high{BadSample::Kind::negative, 1, 2, 2},
        right{BadSample::Kind::nan, 5, 2, 2}; // in the row of `high`
    BadSampleReport a, b;
    a.add(late);
    a.add(low);
    b.add(high);
    BadSampleReport ab = a, ba = b, with_none = a;
    ab.merge(b);
    ba.merge(a);
    with_none.merge({});
    EXPECT_EQ(ab.count(), 3u);
    EXPECT_EQ(*ab.first, high);
    EXPECT_EQ(*ba.first, high);
    EXPECT_EQ(*with_none.first, low);
    BadSampleReport left_last, right_last;
    left_last.add(right);
    left_last.add(high);
    right_last.add(high);
    right_last.add(right);
    EXPECT_EQ(*left_last.first, high);
    EXPECT_EQ(*right_last.first, high);
}

// Whenever it is stopped, every pixel holds whole samples, equal to those of a full run.
TEST(Cancel, LeavesAValidFilm) {
    for (SamplerKind kind : {SamplerKind::independent, SamplerKind::sobol})
        for (std::uint64_t after : {std::uint64_t{1}, std::uint64_t{2000}}) {
            SceneBuilder b = mixed_scene(1, 24, 24);
            b.description.sampler.spp = 64;
            b.description.sampler.kind = kind;
            Renderer renderer(b.description);
            Film film(b.description.film);
            CancelFlag cancel;
            RenderReport report = renderer.render(
                film,
                [&](const RenderProgress& p) {
                    if (p.samples_done >= after) cancel.request();
                },
                &cancel);
            EXPECT_TRUE(report.cancelled());
            std::uint64_t samples = 0;
            for (int y = 0; y < 24; ++y)
                for (int x = 0; x < 24; ++x) {
                    const Pixel& p = film.pixel(x, y);
                    samples += p.samples();
                    EXPECT_LT(p.samples(), 64u);
                    EXPECT_GT(p.samples(), 0u);
                    EXPECT_GT(p.replicates().count(), 0u);
                    EXPECT_TRUE(std::isfinite(p.replicates().mean(1)));
                    if (kind == SamplerKind::independent) {
                        EXPECT_EQ(p.replicates().count(), p.samples());
                    }
                }
            EXPECT_EQ(samples, report.samples);
            EXPECT_GE(samples, after);
        }
}

TEST(Cancel, BeforeTheStart) {
    SceneBuilder b = mixed_scene(1, 24, 24);
    Film film(b.description.film);
    CancelFlag cancel;
    cancel.request();
    RenderReport report = Renderer(b.description).render(film, {}, &cancel);
    EXPECT_TRUE(report.cancelled());
    EXPECT_EQ(report.samples, 0u);
    EXPECT_EQ(film.error().mean_samples, 0);
}

TEST(Cancel, AfterTheEndIsTooLate) {
    SceneBuilder b = half_bad(1);
    Film film(b.description.film);
    CancelFlag cancel;
    RenderReport report = Renderer(b.description)
                              .render(
                                  film,
                                  [&](const RenderProgress& p) {
                                      if (p.samples_done == p.samples_total) cancel.request();
                                  },
                                  &cancel);
    EXPECT_FALSE(report.cancelled());
    EXPECT_EQ(report.samples, 64u * 16);
}

TEST(Progress, CountsUpToTheTotal) {
    SceneBuilder b = half_bad(1);
    Film film(b.description.film);
    std::uint64_t last = 0;
    bool rising = true, knows_error = false;
    Renderer(b.description).render(film, [&](const RenderProgress& p) {
        rising = rising && p.samples_done >= last && p.samples_total == 64u * 16;
        last = p.samples_done;
        knows_error = p.error.has_value();
    });
    EXPECT_TRUE(rising);
    EXPECT_TRUE(knows_error);
    EXPECT_EQ(last, 64u * 16);
}

// With one sample per pixel the picture is the samples: none may exceed the limit, and hues stay.
TEST(MaxComponentValue, ClampsSamples) {
    SceneBuilder b = mixed_scene(1, 24, 24);
    b.description.sampler.spp = 1;
    Film free = render(b.description);
    const float limit = 0.5f;
    b.description.film.max_component_value = limit;
    Film clamped = render(b.description);
    int above = 0;
    for (int y = 0; y < 24; ++y)
        for (int x = 0; x < 24; ++x) {
            const auto &f = free.pixel(x, y).replicates(), &c = clamped.pixel(x, y).replicates();
            double largest = std::max({f.mean(0), f.mean(1), f.mean(2)});
            above += largest > limit;
            double factor = largest > limit ? limit / largest : 1;
            for (int k = 0; k < 3; ++k)
                EXPECT_NEAR(c.mean(k), factor * f.mean(k), 1e-5 * (1 + std::abs(f.mean(k))));
        }
    EXPECT_GT(above, 50);
}

TEST(Renderer, RefusesNoSamples) {
    SceneBuilder b = half_bad(1);
    b.description.sampler.spp = 0;
    EXPECT_THROW(Renderer{b.description}, Error);
}

} // namespace
} // namespace montelux::testing
