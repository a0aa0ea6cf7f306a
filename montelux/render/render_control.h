// When a render stops, what it tells meanwhile, and what of it survives.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include "montelux/film/film.h"
#include "montelux/film/film_error.h"
#include "montelux/mc/parallel/parallel_for.h"
#include "montelux/render/bad_sample_report.h"
#include "montelux/render/sample_order.h"
#include "montelux/transport/ray_tracer.h"

namespace montelux {

// What is asked for. The samples of the description's sampler are the most a pixel gets: on average over the
// picture where they are allocated adaptively, each where they are not.
struct RenderTarget {
    // Relative error of the picture (FilmError::relative), or the error, relative to the mean luminance,
    // within which a share `quantile` of the pixels lies. 0: none.
    double error = 0;
    double quantile = 0;
    double seconds = 0; // wall clock, of all sessions of a resumed render; 0: no limit
    bool adaptive = false;
    Slice slice{};

    bool operator==(const RenderTarget&) const = default;
};

enum class RenderStop : std::uint8_t {
    samples,   // all samples were taken
    error,     // the error was reached
    time,      // the time was used up
    cancelled, // somebody asked for it
};
std::string_view to_string(RenderStop reason);

struct RenderReport {
    std::uint64_t samples = 0;
    double seconds = 0;     // of the loop, wall clock
    double cpu_seconds = 0; // of the loop, CPU time summed over threads
    double ray_seconds = 0; // of those, spent in Embree (extrapolated from timed rays)
    RayStatistics rays;
    BadSampleReport bad;
    std::uint64_t clamped_samples = 0; // by the film's limit
    RenderStop stop = RenderStop::samples;

    bool cancelled() const { return stop == RenderStop::cancelled; }
};

// A render between two samples of any of its pixels: what a checkpoint holds. Whoever continues it ends with
// the same bits as somebody who was never stopped.
struct RenderState {
    Film film;
    // Samples that each pixel shall have at the end of the present round; empty before the first.
    std::vector<std::uint32_t> goals;
    RenderReport report; // so far

    explicit RenderState(const FilmSettings& settings) : film(settings) {}
};

class RoundExecutor;

struct RenderProgress {
    std::uint64_t samples_done = 0, samples_total = 0; // the total is a guess where a target is given
    double seconds = 0;
    // After each round at whose end no unit is open.
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
    // Set by whoever wants to see the state: `checkpoint`, which resets it, is then called as soon as no
    // sample is being taken.
    const std::atomic<bool>* look = nullptr;
    const CancelFlag* cancel = nullptr;
    // Who takes the samples; the threads of this process where there is none. The result is the same.
    RoundExecutor* executor = nullptr;
};

} // namespace montelux
