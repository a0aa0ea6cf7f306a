// RenderControl: progress, checkpoints, snapshots and cancellation of a running render; its executor.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "montelux/film/film.h"
#include "montelux/mc/parallel/cancel_flag.h"
#include "montelux/render/render_forecast.h"

namespace montelux {

struct RenderState;
class LiveFilm;
class RoundExecutor;

// A tile whose pixels have reached their target sample counts. The pixels are the film's, and do not change
// before the callback returns.
struct FinishedTile {
    PixelBounds bounds;
    std::uint64_t round = 0; // from 0 at the start or resumption of the render
    const Film* film = nullptr;
};

struct RenderProgress {
    std::uint64_t samples_done = 0, samples_total = 0; // with a target the total is an estimate
    double seconds = 0;
    // After each round that ends with no open replicate.
    std::optional<FilmError> error;
    std::optional<ErrorQuantile> quantile; // with a target quantile, as `error`
    RenderForecast forecast;
    bool ended = false; // in the last call
};

// Called from one thread at a time, several times a second, and once at the end.
using ProgressCallback = std::function<void(const RenderProgress&)>;

struct RenderControl {
    ProgressCallback progress;
    // Called every `checkpoint_seconds`, while no sample is being taken, and at the end, before the film is
    // closed.
    std::function<void(const RenderState&)> checkpoint;
    double checkpoint_seconds = 60;
    // Called when all pixels of a tile have their samples of a round: once per tile and round, from the
    // rendering threads, for several tiles at once.
    std::function<void(const FinishedTile&)> tile;
    // For snapshots by other threads; null: none. With an executor a snapshot ends the round early.
    LiveFilm* live = nullptr;
    const CancelFlag* cancel = nullptr;
    // A render that is cancelled or runs out of time leaves its last replicates open: another call continues it, and
    // ends with the same bits as one that was not interrupted.
    bool keep_open = false;
    // Takes the samples; null: the threads of this process. The result is the same.
    RoundExecutor* executor = nullptr;
};

} // namespace montelux
