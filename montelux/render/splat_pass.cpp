#include "montelux/render/splat_pass.h"

#include <algorithm>

#include "montelux/mc/math/error.h"

namespace montelux {

void check_sums(const SplatFilm& splats) {
    if (splats.overflows() > 0 || splats.bad() > 0)
        throw Error("film", "the sums of light that is brought to a pixel are too large; lower the exposure");
}

void add_splats(Film& film, const SplatFilm& splats, const PixelBounds& tile, std::uint64_t samples) {
    if (samples == 0) return;
    const double share = 1 / static_cast<double>(samples);
    for (int y = tile.y0; y < tile.y1; ++y)
        for (int x = tile.x0; x < tile.x1; ++x) film.pixel(x, y).add_splats(splats.sum(x, y) * share);
}

std::uint64_t open_samples(const Film& film) {
    std::uint64_t samples = 0;
    for (const Pixel& p : film.pixels()) samples += p.open_samples();
    return samples;
}

void end_pass(Film& film, const SplatFilm& splats, std::uint32_t points) {
    const std::uint32_t first = film.pixels().front().open_samples();
    const bool even =
        std::ranges::all_of(film.pixels(), [&](const Pixel& p) { return p.open_samples() == first; });
    if (!even && film.pixels().front().replicates().count() > 0) return drop_pass(film);
    add_splats(film, splats, film.bounds(), open_samples(film));
    film.end_replicates(points);
}

void drop_pass(Film& film) { film.drop_replicates(); }

} // namespace montelux
