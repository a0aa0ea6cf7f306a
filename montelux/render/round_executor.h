// RoundExecutor: takes the samples of a round; the interface by which other processes take part.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "montelux/film/film_error.h"
#include "montelux/mc/parallel/cancel_flag.h"
#include "montelux/render/render_state.h"

namespace montelux {

class ChainRenderer;
struct ChainWatch;
class TileRenderer;

// The render loop as an executor sees it. Called only from the thread that runs the round.
struct RoundWatch {
    // Whether the round must end before its target sample counts are reached. The argument says whether it
    // has taken samples: short intervals between checkpoints must not stop progress.
    std::function<bool(bool something_done)> stop;
    // Samples of this round so far, beyond those in the state's report, and the error of the picture if
    // known: for progress only.
    std::function<void(std::uint64_t samples, const std::optional<FilmError>& error)> tell;
    // The render's cancel flag, or null. When it is set, the executor returns as soon as it can.
    const CancelFlag* cancel = nullptr;
};

class RoundExecutor {
  public:
    virtual ~RoundExecutor() = default;

    // Takes the missing samples of all pixels, up to state.target_samples, in their order, until none is
    // missing or the watch stops it. At the end the state's film, splats and report contain everything that was
    // taken.
    virtual void run(const TileRenderer& tiles, RenderState& state, const RoundWatch& watch) = 0;
    // Of a Metropolis render, as ChainRenderer::run: adds groups until all pixels have so many samples, or the watch says
    // otherwise.
    virtual void run(ChainRenderer& chains, RenderState& state, std::uint32_t target_samples,
                     const ChainWatch& watch) = 0;
    // Runs `work`, which takes long and is no part of a round, in another thread on this process's threads. Meanwhile calls
    // between(), which may request the work to end, many times a second. Rethrows exceptions.
    virtual void meanwhile(const std::function<void()>& work, const std::function<void()>& between) = 0;
    // The render loop ends: what run() was given is not used any more.
    virtual void release() = 0;
    // Whether the render must end as if cancelled, because the executor cannot continue.
    virtual bool failed() const = 0;
};

} // namespace montelux
