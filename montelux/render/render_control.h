// RenderControl: progress, checkpoints and cancelling of a running render, and the executor of its rounds.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>

#include "montelux/film/film_error.h"
#include "montelux/mc/parallel/parallel_for.h"

namespace montelux {

struct RenderState;

class RoundExecutor;

struct RenderProgress {
    std::uint64_t samples_done = 0, samples_total = 0; // the total is a guess where a target is given
    double seconds = 0;
    // After each round at whose end no replicate is open.
    std::optional<FilmError> error;
};

// Called from one thread at a time, several times a second.
using ProgressCallback = std::function<void(const RenderProgress&)>;

struct RenderControl {
    ProgressCallback progress;
    // Called when `checkpoint_seconds` have passed since the last call, while no sample is being taken; and
    // at the end, before the film is closed.
    std::function<void(const RenderState&)> checkpoint;
    double checkpoint_seconds = 60;
    // Setting `snapshot_wanted` asks for one call of `snapshot`, as soon as no sample is being taken and
    // unless the render ends then; the render resets it. Checkpoints keep their times.
    std::function<void(const RenderState&)> snapshot;
    std::atomic<bool>* snapshot_wanted = nullptr;
    const CancelFlag* cancel = nullptr;
    // Who takes the samples; the threads of this process where there is none. The result is the same.
    RoundExecutor* executor = nullptr;
};

} // namespace montelux
