// RenderControl: progress, checkpoints, looks at and cancelling of a running render, and who takes its samples.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "montelux/film/film.h"
#include "montelux/mc/parallel/parallel_for.h"

namespace montelux {

struct RenderState;
class LiveFilm;
class RoundExecutor;

// A tile whose pixels have reached their target sample counts. The pixels are those of the film, and do not
// change before the callback returns.
struct FinishedTile {
    PixelBounds bounds;
    std::uint64_t round = 0; // counted from 0 since the render began or was resumed
    const Film* film = nullptr;
};

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
    // Called when all pixels of a tile have their samples of a round: once per tile and round, from the threads
    // that render, for several tiles at once.
    std::function<void(const FinishedTile&)> tile;
    // For threads that look at the render meanwhile; null: none. With an executor a look ends the round early.
    LiveFilm* live = nullptr;
    const CancelFlag* cancel = nullptr;
    // Who takes the samples; the threads of this process where there is none. The result is the same.
    RoundExecutor* executor = nullptr;
};

} // namespace montelux
