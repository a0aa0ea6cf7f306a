// Who takes the samples of a round: the place where other processes come in.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "montelux/film/film_error.h"
#include "montelux/mc/parallel/parallel_for.h"
#include "montelux/render/render_state.h"

namespace montelux {

class TileRenderer;

// The render loop as an executor sees it. Called from the thread that runs the round alone.
struct RoundWatch {
    // Shall the round end before its target sample counts are reached? Something was done in it, or not yet:
    // short intervals between checkpoints must not keep a render from going on.
    std::function<bool(bool something_done)> stop;
    // Samples taken in this round so far, beyond those in the state's report, and the error of the picture
    // where it is known: for the progress alone.
    std::function<void(std::uint64_t samples, const std::optional<FilmError>& error)> tell;
    // The render's own, or null: whoever requested it is in a hurry.
    const CancelFlag* cancel = nullptr;
};

class RoundExecutor {
  public:
    virtual ~RoundExecutor() = default;

    // Takes the samples of pixels that have fewer than state.target_samples tells, in their order, until none
    // lacks any or the watch stops it. At the end film and report of the state hold everything that was
    // taken.
    virtual void run(const TileRenderer& tiles, RenderState& state, const RoundWatch& watch) = 0;
    // Is the render to end as if it had been cancelled, because the executor cannot go on?
    virtual bool failed() const = 0;
};

} // namespace montelux
