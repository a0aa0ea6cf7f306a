// Passes of integrators that trace light: the splats of a pass over the film become part of its pixels.
#pragma once

#include <cstdint>

#include "montelux/film/film.h"
#include "montelux/film/splat_film.h"

namespace montelux {

// Throws Error where the sums have lost light.
void check_sums(const SplatFilm& splats);

// Adds to each pixel's open replicate the splats of the pass, divided by the number of its samples, each of which has
// traced a light path. Splats reach the edge of the film from beyond it, as samples do.
void add_splats(Film& film, const SplatFilm& splats, const PixelBounds& tile, std::uint64_t samples);

// Samples of the open pass, of all pixels.
std::uint64_t open_samples(const Film& film);

// Ends the open pass of a render that takes no more samples, as Film::end_replicates does without splats: a pass that
// all pixels have taken as far counts if it has at least half of the `points` of a whole one. One that some pixels
// have taken further than others is forgotten, unless it is the first.
void end_pass(Film& film, const SplatFilm& splats, std::uint32_t points);
// Forgets the open pass of a copy of the film.
void drop_pass(Film& film);

} // namespace montelux
