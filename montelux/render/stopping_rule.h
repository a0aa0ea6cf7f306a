// StoppingRule: whether a film has the error that a render was asked for.
#pragma once

#include <cstdint>
#include <optional>

#include "montelux/film/film.h"
#include "montelux/render/render_target.h"

namespace montelux {

// Samples of each pixel before a target of its error counts as met: whole replicates, enough to trust their spread.
std::uint64_t samples_to_trust(const RenderTarget& target, std::uint64_t replicate_size);

class StoppingRule {
  public:
    StoppingRule(const RenderTarget& target, std::uint32_t replicate_size)
        : target_(target), replicate_size_(replicate_size) {}

    // The error that the target limits; empty without a target, and while nothing was seen.
    std::optional<double> error_for_target(const Film& film, const FilmError& error) const;
    // All replicates must be closed.
    bool is_reached(const Film& film, const FilmError& error) const;

  private:
    const RenderTarget& target_;
    std::uint32_t replicate_size_;
};

} // namespace montelux
