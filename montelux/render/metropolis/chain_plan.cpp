#include "montelux/render/metropolis/chain_plan.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>
#include <vector>

#include "montelux/mc/parallel/parallel_for.h"
#include "montelux/render/metropolis/chain_bundle.h"

namespace montelux {
namespace {

constexpr std::uint64_t piece = 1024;         // paths that a thread takes at a time
constexpr std::uint64_t most_paths = 1 << 22; // in search of light
constexpr std::size_t adapting_chains = 16, adapting_steps = 768;
constexpr double wanted_acceptance = 0.5;
constexpr double fewest_large_steps = 0.1, most_large_steps = 0.5; // shares

// A path of the pilot.
struct PilotPoint {
    Point2f film;
    float size = 0, brightness = 0;
};

bool take_paths(const PrimarySampler& sampler, const Accelerator& accelerator, const ChainKeys& keys,
                std::uint64_t begin, std::vector<PilotPoint>& points, const std::function<bool()>& stop) {
    const std::uint64_t pieces = (points.size() - begin) / piece;
    std::atomic<bool> stopped{false};
    parallel_for(static_cast<std::int64_t>(pieces), [&](std::int64_t p) {
        if (stopped || stop()) {
            stopped = true;
            return;
        }
        RayTracer tracer(accelerator);
        PrimarySampler::Memory memory;
        constexpr std::size_t at_once = 64;
        std::vector<PrimarySamples> samples(at_once, PrimarySamples(PhiloxStream(0)));
        std::vector<PrimarySamples*> states;
        for (PrimarySamples& s : samples) states.push_back(&s);
        std::vector<PrimarySample> results(at_once);
        for (std::uint64_t i = begin + static_cast<std::uint64_t>(p) * piece, end = i + piece; i < end;
             i += at_once) {
            for (std::size_t k = 0; k < at_once; ++k) {
                samples[k].restart(keys.stream(ChainKeys::starting_point, ChainKeys::pilot, i + k));
                samples[k].propose_large();
            }
            sampler.evaluate(tracer, states, FilmImportance(), memory, results);
            for (std::size_t k = 0; k < at_once; ++k)
                points[i + k] = {results[k].film, static_cast<float>(results[k].size), results[k].brightness};
        }
    });
    return !stopped;
}

double mean_size(const std::vector<PilotPoint>& points) {
    double sum = 0;
    for (const PilotPoint& p : points) sum += double(p.size);
    return sum / static_cast<double>(points.size());
}

// 1 / brightness of cells with 64 points or so each. The brightest points count less, and dark cells are not quite so
// important, for their brightness is not known well.
FilmImportance importance_of(const PrimarySampler& sampler, const std::vector<PilotPoint>& points) {
    constexpr double points_per_cell = 64, brightest = 8, floor = 0.1;
    const Vec2f size = sampler.film_size();
    const double cells = static_cast<double>(points.size()) / points_per_cell;
    const double width = std::max(8.0, std::sqrt(double(size.x) * double(size.y) / cells));
    const int columns = std::max(1, static_cast<int>(double(size.x) / width));
    const int rows = std::max(1, static_cast<int>(double(size.y) / width));
    const auto count = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
    FilmImportance importance(sampler.film_begin(), size, columns, rows, std::vector<float>(count, 1.0f));
    double all = 0;
    for (const PilotPoint& p : points) all += double(p.brightness) / static_cast<double>(points.size());
    const double limit = brightest * all;
    std::vector<double> sums(count, 0), numbers(count, 0);
    double mean = 0;
    for (const PilotPoint& p : points) {
        const std::size_t cell = importance.cell(p.film);
        const double brightness = std::min(double(p.brightness), limit);
        sums[cell] += brightness;
        numbers[cell] += 1;
        mean += brightness / static_cast<double>(points.size());
    }
    for (std::size_t i = 0; i < count; ++i) {
        const double brightness = numbers[i] > 0 ? sums[i] / numbers[i] : mean;
        importance.values()[i] = static_cast<float>(mean / (brightness + floor * mean));
    }
    return importance;
}

// Chains that start at points of the pilot; the step grows or shrinks after each of their steps, less and less
// (Robbins, Monro 1951, "A Stochastic Approximation Method").
struct Adaptation {
    double step = 0;
    double large_acceptance = 0; // of large steps
};
Adaptation adapt(const PrimarySampler& sampler, const Accelerator& accelerator, const ChainKeys& keys,
                 const ChainPlan& plan, const std::vector<PilotPoint>& points,
                 const std::function<bool()>& stop) {
    std::vector<double> cdf;
    double sum = 0;
    for (const PilotPoint& p : points) cdf.push_back(sum += double(p.size) * plan.importance.at(p.film));
    std::vector<PhiloxStream> starts, walks;
    for (std::size_t c = 0; c < adapting_chains; ++c) {
        const double at = (static_cast<double>(c) + 0.5) / adapting_chains * sum;
        const auto i = static_cast<std::uint64_t>(std::lower_bound(cdf.begin(), cdf.end(), at) - cdf.begin());
        starts.push_back(keys.stream(ChainKeys::starting_point, ChainKeys::pilot, i));
        walks.push_back(keys.stream(ChainKeys::walk, ChainKeys::pilot, c));
    }
    RayTracer tracer(accelerator);
    ChainBundle bundle(sampler, plan.importance);
    bundle.begin(tracer, starts, walks);
    double large = 0, large_accepted = 0;
    double log_step = std::log(plan.small_step.longest());
    for (std::size_t t = 0; t < adapting_steps && !stop(); ++t) {
        double accepted = 0, small = 0;
        bundle.step(tracer, plan.large_step_probability, SmallStep(std::exp(log_step)),
                    [&](std::size_t, const Mutation& m) {
                        if (m.large) {
                            large_accepted += m.acceptance;
                            large += 1;
                            return;
                        }
                        accepted += m.acceptance;
                        small += 1;
                    });
        if (small == 0) continue;
        log_step += (accepted / small - wanted_acceptance) / std::pow(1 + 0.1 * static_cast<double>(t), 0.7);
        log_step = std::clamp(log_step, std::log(1e-4), std::log(0.25));
    }
    return {std::exp(log_step), large > 0 ? large_accepted / large : 0};
}

} // namespace

std::optional<ChainPlan> make_chain_plan(const PrimarySampler& sampler, const Accelerator& accelerator,
                                         const SceneDescription& description, std::uint32_t spp,
                                         const std::function<bool()>& stop) {
    const PixelBounds& crop = description.film.crop;
    const std::uint64_t paths = std::uint64_t{spp} * static_cast<std::uint64_t>(crop.width()) *
                                static_cast<std::uint64_t>(crop.height());
    const ChainKeys keys(description.sampler.seed);
    ChainPlan plan;
    plan.size = GroupSize::of(paths);
    if (description.integrator.large_step_probability > 0)
        plan.large_step_probability = double(description.integrator.large_step_probability);
    std::vector<PilotPoint> points;
    std::uint64_t wanted = std::clamp<std::uint64_t>(paths / 4 / piece * piece, 4 * piece, 128 * piece);
    double mean = 0;
    // Of shorter paths chains may have nothing to follow.
    const std::uint64_t most = description.integrator.max_depth < 2 ? wanted : most_paths;
    for (; !(mean > 0) && wanted <= most; wanted *= 2) {
        const std::uint64_t begin = points.size();
        points.resize(wanted);
        if (!take_paths(sampler, accelerator, keys, begin, points, stop)) return std::nullopt;
        mean = mean_size(points);
    }
    plan.pilot_paths = points.size();
    if (!(mean > 0)) return plan;
    plan.importance = importance_of(sampler, points);
    for (const PilotPoint& p : points)
        plan.scale += double(p.size) * plan.importance.at(p.film) / static_cast<double>(points.size());
    const Adaptation adaptation = adapt(sampler, accelerator, keys, plan, points, stop);
    plan.small_step = SmallStep(adaptation.step);
    // Where large steps are often accepted, they explore as well as small ones, and are independent.
    if (!(description.integrator.large_step_probability > 0))
        plan.large_step_probability =
            std::clamp(adaptation.large_acceptance, fewest_large_steps, most_large_steps);
    plan.pilot_paths += adapting_chains * adapting_steps;
    if (stop()) return std::nullopt;
    return plan;
}

} // namespace montelux
