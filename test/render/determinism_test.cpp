// The picture depends only on the scene and the seed: not on threads, tiles, or the unit of length.
#include "test/render/mixed_scene.h"
#include "test/sanitized.h"
#include <cstring>
#include <gtest/gtest.h>

#include "montelux/mc/parallel/parallel_for.h"

namespace montelux::testing {
namespace {

int differing_pixels(const Film& a, const Film& b, const PixelBounds& within) {
    int n = 0;
    for (int y = within.y0; y < within.y1; ++y)
        for (int x = within.x0; x < within.x1; ++x) n += !same_pixel(a.pixel(x, y), b.pixel(x, y));
    return n;
}

// Seven threads are started on any machine: a picture of 40 x 24 has six tiles.
TEST(Determinism, AnyNumberOfThreads) {
    SceneBuilder b = mixed_scene(1, 40, 24);
    b.description.film.filter = GaussianFilter{};
    b.description.sampler.spp = under_sanitizers ? 4 : 16;
    std::vector<std::vector<Film>> films; // of each number of threads, by sampler
    for (const int threads : {1, 2, 7})
        with_threads(threads, [&] {
            const auto prepared = prepared_scene(b.description);
            std::vector<Film>& of_samplers = films.emplace_back();
            for (const SamplerKind kind : samplers) {
                b.description.sampler.kind = kind;
                of_samplers.push_back(render(b.description, prepared));
            }
        });
    for (std::size_t i = 1; i < films.size(); ++i)
        for (std::size_t k = 0; k < films[0].size(); ++k)
            EXPECT_EQ(differing_pixels(films[0][k], films[i][k], films[0][k].bounds()), 0)
                << "sampler " << int(samplers[k]);
}

// A window of the picture, whose tiles and their order are others, has the same pixels.
TEST(Determinism, AnyCropAndOrderOfTiles) {
    SceneBuilder b = mixed_scene(1, 40, 24);
    b.description.sampler.spp = 8;
    const auto prepared = prepared_scene(b.description);
    for (SamplerKind kind : samplers) {
        b.description.sampler.kind = kind;
        b.description.film.crop = {0, 0, 40, 24};
        Film whole = render(b.description, prepared);
        for (PixelBounds crop : {PixelBounds{5, 3, 29, 20}, PixelBounds{39, 23, 40, 24}}) {
            b.description.film.crop = crop;
            Film part = render(b.description, prepared);
            EXPECT_EQ(differing_pixels(whole, part, crop), 0) << "sampler " << int(kind);
        }
    }
}

TEST(Determinism, SeedsDifferAndRepeat) {
    SceneBuilder b = mixed_scene(1, 8, 8);
    b.description.sampler.spp = 8;
    const auto prepared = prepared_scene(b.description), prepared_again = prepared_scene(b.description);
    for (SamplerKind kind : samplers) {
        b.description.sampler.kind = kind;
        b.description.sampler.seed = 1;
        Film first = render(b.description, prepared), again = render(b.description, prepared_again);
        b.description.sampler.seed = 2;
        Film other = render(b.description, prepared);
        EXPECT_EQ(differing_pixels(first, again, first.bounds()), 0) << "sampler " << int(kind);
        EXPECT_EQ(differing_pixels(first, other, first.bounds()), 64) << "sampler " << int(kind);
    }
}

// Millimetres or kilometres: the same random numbers make the same paths, but for the few that rounding
// sends around an edge. Wrong offsets would speckle the picture at one of the scales.
TEST(Determinism, AnyUnitOfLength) {
    SceneBuilder unit = mixed_scene(1, 24, 24);
    unit.description.sampler.spp = 64;
    Film reference = render(unit.description);
    for (double scale : {1e-3, 1e4}) {
        SceneBuilder b = mixed_scene(scale, 24, 24);
        b.description.sampler.spp = 64;
        Film film = render(b.description);
        double mean = 0, reference_mean = 0, worst = 0;
        int differing = 0;
        for (int y = 0; y < 24; ++y)
            for (int x = 0; x < 24; ++x) {
                const auto &m = film.pixel(x, y).replicates(), &r = reference.pixel(x, y).replicates();
                mean += m.mean(1);
                reference_mean += r.mean(1);
                double difference = std::abs(m.mean(1) - r.mean(1));
                differing += difference > 1e-3 * r.mean(1);
                worst = std::max(worst, difference / r.standard_error(1));
                EXPECT_NEAR(film.pixel(x, y).depth(), scale * reference.pixel(x, y).depth(),
                            2e-2 * scale * reference.pixel(x, y).depth());
            }
        RecordProperty("differing pixels", differing);
        EXPECT_LT(differing, 24 * 24 / 4) << scale;
        EXPECT_LT(worst, 4) << scale;
        EXPECT_NEAR(mean / reference_mean, 1, 5e-3) << scale;
    }
}

} // namespace
} // namespace montelux::testing
