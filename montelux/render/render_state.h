// RenderState: film and report of a render so far, the content of a checkpoint.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "montelux/film/film.h"
#include "montelux/film/splat_film.h"
#include "montelux/render/bad_sample_report.h"
#include "montelux/render/guide_summary.h"
#include "montelux/render/integrator_summary.h"
#include "montelux/render/merging_bias.h"
#include "montelux/render/merging_summary.h"
#include "montelux/render/metropolis/chain_statistics.h"
#include "montelux/transport/guiding/guiding_field.h"
#include "montelux/transport/ray_tracer.h"

namespace montelux {

enum class RenderStop : std::uint8_t {
    samples,   // all samples were taken
    error,     // the error was reached
    time,      // the time was used up
    cancelled, // on request
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
    ChainStatistics chains;            // of a Metropolis render
    RenderStop stop = RenderStop::samples;
    GuideSummary guide;      // of a render that may be guided
    IntegratorChoice choice; // of a render whose integrator was chosen by a pilot
    MergingSummary merging;

    bool cancelled() const { return stop == RenderStop::cancelled; }
};

// A render between two samples of any of its pixels. A render resumed from it ends with the same bits as an
// uninterrupted one.
struct RenderState {
    Film film;
    // Target sample count of each pixel in the current round; empty before the first.
    std::vector<std::uint32_t> target_samples;
    RenderReport report; // so far
    // Of an integrator that traces light, what its paths brought in the open pass over the film: a pass is one replicate
    // of every pixel.
    std::optional<SplatFilm> splats;
    std::optional<MergingBias> bias{};           // where paths merge
    std::shared_ptr<const GuidingField> guide{}; // that paths follow, or null

    explicit RenderState(const FilmSettings& settings) : film(settings) {}
    // Throws Error as film_layers_of() does.
    explicit RenderState(const SceneDescription& description)
        : film(description.film, film_layers_of(description)) {
        if (traces_light(description.integrator.method)) splats.emplace(description.film.crop);
        if (merges(description.integrator)) bias.emplace(description.film.crop);
    }
};

} // namespace montelux
