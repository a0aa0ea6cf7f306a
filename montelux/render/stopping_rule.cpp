#include "montelux/render/stopping_rule.h"

#include <algorithm>

namespace montelux {
namespace {

// Samples per pixel before its error is trusted; and before a picture counts as black.
constexpr std::uint64_t least_samples = 16, least_replicates = 4, samples_of_black = 4096;
// Degrees of freedom of the picture's error, as many as 16 replicates of one pixel have: stopping at the
// first error that is small enough selects errors that are small by chance, the more so the less certain
// they are.
constexpr double least_freedom = 15;

std::uint64_t fewest_replicates(const Film& film) {
    std::uint64_t fewest = film.pixels().front().replicates().count();
    for (const Pixel& p : film.pixels()) fewest = std::min(fewest, p.replicates().count());
    return fewest;
}

} // namespace

std::uint64_t samples_to_trust(const RenderTarget& target, std::uint64_t replicate_size) {
    // Few samples may all be dark by chance; pixels that found no light yet would satisfy a quantile.
    const std::uint64_t samples = target.quantile > 0 ? 4 * least_samples : least_samples;
    return std::max(least_replicates, (samples + replicate_size - 1) / replicate_size) * replicate_size;
}

std::optional<double> StoppingRule::error_for_target(const Film& film, const FilmError& error) const {
    if (!(target_.error > 0 && error.mean_luminance > 0)) return std::nullopt;
    return target_.quantile > 0 ? error_quantile(film, target_.quantile) : error.relative;
}

bool StoppingRule::is_reached(const Film& film, const FilmError& error) const {
    if (!(target_.error > 0)) return false;
    const std::optional<double> reached = error_for_target(film, error);
    if (fewest_replicates(film) * replicate_size_ < samples_to_trust(target_, replicate_size_)) return false;
    if (!reached) return error.mean_samples >= samples_of_black;
    return *reached <= target_.error && (target_.quantile > 0 || error_freedom(film) >= least_freedom);
}

} // namespace montelux
