#include "montelux/mc/integrate/adaptive/density_trainer.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>

#include "montelux/mc/integrate/adaptive/difference_walk.h"
#include "montelux/mc/integrate/adaptive/more_gaussians.h"
#include "montelux/mc/integrate/adaptive/ridge_trace.h"
#include "montelux/mc/integrate/adaptive/surprises.h"
#include "montelux/mc/integrate/witness/first_look.h"
#include "montelux/mc/random/hash.h"
#include "montelux/mc/stats/pareto_tail.h"

namespace montelux {
namespace {

using Clock = std::chrono::steady_clock;
constexpr double flat_share = 0.95;           // effective share of the points that are not zero
constexpr double enough_even = 0.3;           // relative variance below which no Gaussians are added
constexpr int first_fit_before_gaussians = 2; // rounds that maps alone are given
constexpr int em_steps = 20;
constexpr int most_gaussians = 40, most_added = 6; // in all, and by a round
constexpr double far_above = 10;                   // times the mean of h / q
constexpr std::size_t most_remembered = 128;
constexpr double exploring_width = 1.5;
constexpr double safe_width = 1.1;
constexpr std::size_t least_walked = 4, most_walked = 128; // steps of walkers after a round
constexpr double share_of_traced = 0.25;                   // of the walkers of a check
constexpr std::size_t longest_check = 1024;                // steps that check the density
constexpr double few_hits = 4;      // their spread hardly shows in that of the replicates
constexpr double heavy_shape = 0.4; // of the tail of a round's weights; from 0.5 the variance is infinite
constexpr std::uint64_t least_seen = 16; // non-zero points of a round needed for a fit
constexpr std::size_t pdf_block = 8192;

// Scouts walk under |g|^(1 / temperature). In many variables it is lower, so that their effective number, when
// they are weighted to |g|, stays within an order of magnitude for a Gaussian.
double scout_temperature(int dimensions) { return std::min(4.0, 1 + 15.0 / dimensions); }

bool is_heavy_tailed(std::span<const double> weights) {
    ParetoTail tail;
    tail.add(weights);
    const auto fit = tail.fit(weights.size());
    return fit && fit->shape > heavy_shape;
}

// Evaluates q at each point, in blocks. Returns false when stopped.
bool pdf_until(const MixtureDensity& density, const PointBatch& x, std::span<double> q,
               const std::function<bool()>& stop) {
    for (std::size_t first = 0; first < x.count(); first += pdf_block) {
        if (stop()) return false;
        const std::size_t count = std::min(pdf_block, x.count() - first);
        density.pdf(x.slice(first, count), q.subspan(first, count));
    }
    return true;
}

} // namespace

DensityTrainer::DensityTrainer(const Problem& problem, int uniform_units)
    : problem_(problem), uniform_units_(uniform_units), density_(problem.evaluator.dimensions()) {}

std::vector<double> DensityTrainer::steering(const ValueBuffer& g) const {
    std::vector<double> h(g.count());
    if (g.components() == 1) {
        for (std::size_t i = 0; i < h.size(); ++i) h[i] = std::abs(g(i));
        return h;
    }
    for (int c = 0; c < g.components(); ++c) {
        const double inverse =
            scale_[static_cast<std::size_t>(c)] > 0 ? 1 / scale_[static_cast<std::size_t>(c)] : 0;
        for (std::size_t i = 0; i < h.size(); ++i) h[i] += g(i, c) * inverse * (g(i, c) * inverse);
    }
    for (double& v : h) v = std::sqrt(v);
    return h;
}

void DensityTrainer::start(SamplePoints&& points) {
    scale_.assign(static_cast<std::size_t>(points.g.components()), 0.0);
    for (int c = 0; c < points.g.components(); ++c)
        for (double v : std::as_const(points.g).component(c))
            scale_[static_cast<std::size_t>(c)] += std::abs(v) / static_cast<double>(points.g.count());
    // Known peaks may be all that is not zero.
    for (std::size_t c = 0; problem_.look && c < scale_.size(); ++c)
        for (const Witness& peak : problem_.look->peaks)
            scale_[c] = std::max(scale_[c], std::abs(peak.value[c]) * peak.volume);
    std::vector<double> h = steering(points.g);
    double sum = 0, squares = 0;
    nonzero_ = 0;
    for (double v : h) {
        nonzero_ += v > 0;
        sum += v;
        squares += v * v;
    }
    effective_share_ = squares > 0 ? sum * sum / squares / static_cast<double>(h.size()) : 0;
    const double nonzero = static_cast<double>(nonzero_);
    flat_size_ = nonzero_ > 0 && sum * sum > flat_share * squares * nonzero ? sum / nonzero : 0;
    recent_.clear();
    recent_.push_back({density_, std::move(points.x), std::move(h), std::move(points.density)});
}

bool DensityTrainer::is_of_flat_size(const std::vector<double>& values) const {
    ValueBuffer g(1, static_cast<int>(values.size()));
    for (std::size_t c = 0; c < values.size(); ++c) g.component(static_cast<int>(c))[0] = values[c];
    return steering(g)[0] < 2 * flat_size_;
}

void DensityTrainer::find_peaks(std::uint64_t max_evaluations, int fruitless, std::uint64_t survey) {
    if (density_.dimensions() > max_gaussian_dimensions) return;
    // Assigned at the end, so that an exception of the integrand changes nothing.
    std::uint64_t evaluations = 0;
    NonFiniteCount non_finite;
    const DensityFunction h = counted_steering(evaluations, non_finite);
    const Round& seen = recent_.back();
    ModeSearch settings{.fruitless = fruitless, .max_evaluations = max_evaluations};
    settings.seed = problem_.seed;
    settings.survey = survey;
    if (problem_.look) settings.peaks = problem_.look->peaks;
    std::vector<Gaussian> modes = find_modes(h, seen.x, seen.h, settings);
    evaluations_ += evaluations;
    non_finite_.merge(non_finite);
    peaks_ = modes.size();
    searched_points_ = seen.h.size();
    search_evaluations_ += evaluations;
    if (modes.empty()) return;
    for (Gaussian& g : modes) g = g.widened(1.2);
    density_ = MixtureDensity(density_.dimensions(), {}, std::move(modes));
    const int even = (MixtureDensity::units - uniform_units_) / (density_.channels() - 1);
    std::vector<int> shares(static_cast<std::size_t>(density_.channels()),
                            even >= share_step_ ? even / share_step_ * share_step_ : even);
    shares[0] = MixtureDensity::units - shares.back() * (density_.channels() - 1);
    density_.set_shares(std::move(shares));
}

bool DensityTrainer::round(std::uint64_t n, const StepRequest& request) {
    // After a search for peaks, the density is tried before it is fitted. While weights are uneven, every
    // second round draws from wider Gaussians, which see the ends of ridges.
    const bool wide =
        rounds_ % 2 == 1 && lacking(rounds_, relative_variance_) && !density_.gaussians().empty();
    const MixtureDensity drawn = wide ? density_.widened(exploring_width) : density_;
    const std::uint64_t balanced = drawn.balanced_points();
    const Clock::time_point begin = Clock::now();
    n = std::max<std::uint64_t>(1, n / balanced) * balanced;
    SamplePoints points;
    const auto sums = sample_mixture(problem_.evaluator, drawn, hash_key(problem_.seed, 1, rounds_), 1, 0, n,
                                     &points, request.cancel);
    if (!sums) return false;
    const double mean = sums->sums.sum(0, 0) / static_cast<double>(n),
                 variance = sums->independent_variance(n);
    std::vector<double> h = steering(points.g);
    double total = 0;
    for (std::size_t i = 0; i < h.size(); ++i) total += h[i] / points.density[i];
    const double mean_size = total / static_cast<double>(n); // of the first component for scalars
    double spread = variance;
    if (points.g.components() > 1) {
        double squares = 0;
        for (std::size_t i = 0; i < h.size(); ++i)
            squares += std::pow(h[i] / points.density[i] - mean_size, 2);
        spread = squares / (static_cast<double>(n) * static_cast<double>(n));
    }
    const double relative_variance = wide ? relative_variance_
                                     : mean_size > 0
                                         ? spread * static_cast<double>(n) / (mean_size * mean_size)
                                         : std::numeric_limits<double>::infinity();
    const auto seen = static_cast<std::uint64_t>(std::ranges::count_if(h, [](double v) { return v > 0; }));
    // Worse than the exploration: Gaussians of peaks at faces lie partly outside the cube or beyond a jump.
    const bool useless = seen < std::min(nonzero_, least_seen);
    Round drawn_round{drawn, std::move(points.x), std::move(h), std::move(points.density)};
    Walk walked;
    if (!useless && lacking(rounds_ + 1, relative_variance) && !density_.gaussians().empty())
        walked = walk(walked_, drawn_round, n / 4, most_walked, 1);

    const auto before = std::tuple(rounds_, evaluations_, non_finite_, checks_, relative_variance_, density_,
                                   recent_, walked_, walks_, enriched_, uncovered_share_);
    // Nothing is changed before this line, so an exception of the integrand changes nothing.
    ++rounds_;
    evaluations_ += sums->evaluations + walked.evaluations;
    non_finite_.merge(sums->non_finite);
    non_finite_.merge(walked.non_finite);
    checks_.push_back({mean, variance});
    if (checks_.size() > 2) checks_.erase(checks_.begin());
    relative_variance_ = relative_variance;
    if (useless) {
        density_ = MixtureDensity(density_.dimensions());
    } else {
        recent_.push_back(std::move(drawn_round));
        if (recent_.size() > 2) recent_.erase(recent_.begin());
    }
    if (!walked.points.h.empty()) {
        walked_ = std::move(walked.points);
        ++walks_;
    }
    if (fit([&] { return request.over(); })) {
        seconds_per_point_ =
            std::chrono::duration<double>(Clock::now() - begin).count() / static_cast<double>(n);
        return true;
    }
    std::tie(rounds_, evaluations_, non_finite_, checks_, relative_variance_, density_, recent_, walked_,
             walks_, enriched_, uncovered_share_) = before;
    return false;
}

bool DensityTrainer::has_time_for(std::uint64_t n, const StepRequest& request) const {
    if (request.deadline == Clock::time_point::max()) return true;
    const double seconds = seconds_per_point_ * static_cast<double>(n);
    return std::chrono::duration<double>(request.deadline - Clock::now()).count() > seconds;
}

bool DensityTrainer::lacking(int rounds, double relative_variance) const {
    return rounds > first_fit_before_gaussians && density_.dimensions() <= max_gaussian_dimensions &&
           (relative_variance > enough_even || uncovered_share_ > uncovered_matters);
}

DensityFunction DensityTrainer::counted_steering(std::uint64_t& evaluations,
                                                 NonFiniteCount& non_finite) const {
    return [this, &evaluations, &non_finite](const PointBatch& x, std::span<double> values) {
        ValueBuffer g(x.count(), problem_.evaluator.components());
        problem_.evaluator(x, g, non_finite);
        evaluations += x.count();
        std::ranges::copy(steering(g), values.begin());
    };
}

DensityTrainer::Walk DensityTrainer::walk(const WalkedPoints& before, const Round& last,
                                          std::uint64_t max_evaluations, std::size_t longest, double exponent,
                                          bool traces) const {
    DifferenceWalk settings;
    settings.key = hash_key(problem_.seed, 5, walks_);
    settings.exponent = exponent;
    Walk walk;
    const std::uint64_t most_traced = traces && last.x.dimensions() > 1 ? max_evaluations / 4 : 0;
    if ((max_evaluations - most_traced) / settings.walkers < least_walked) return walk;
    const DensityFunction h = counted_steering(walk.evaluations, walk.non_finite);
    TracedPoints traced;
    if (most_traced > 0) {
        std::vector<double> ratios(last.h.size());
        for (std::size_t i = 0; i < ratios.size(); ++i) ratios[i] = last.h[i] / last.p[i];
        traced = trace_ridge(h, last.x, last.h, ratios, hash_key(problem_.seed, 6, walks_), most_traced);
    }
    settings.steps =
        std::min<std::uint64_t>(longest, (max_evaluations - walk.evaluations) / settings.walkers);
    const bool begins = before.h.empty();
    const std::size_t first = begins ? 0 : before.h.size() - settings.walkers;
    const PointBatch from = begins ? last.x.view() : before.x.view().slice(first, settings.walkers);
    PointBuffer starts(from.count() + traced.h.size(), from.dimensions());
    for (int d = 0; d < from.dimensions(); ++d) {
        const auto end = std::ranges::copy(from.coordinate(d), starts.coordinate(d).begin()).out;
        if (!traced.h.empty()) std::ranges::copy(traced.x.view().coordinate(d), end);
    }
    const std::vector<double>& h_of_all = begins ? last.h : before.h;
    std::vector<double> h_there(h_of_all.begin() + static_cast<std::ptrdiff_t>(first), h_of_all.end());
    std::vector<double> weights(from.count(), 1.0);
    for (std::size_t i = 0; begins && i < weights.size(); ++i)
        weights[i] = std::pow(last.h[i], exponent) / last.p[i];
    const double total = std::accumulate(weights.begin(), weights.end(), 0.0),
                 of_each =
                     share_of_traced / (1 - share_of_traced) * total / static_cast<double>(traced.h.size());
    h_there.insert(h_there.end(), traced.h.begin(), traced.h.end());
    weights.resize(starts.count(), of_each);
    walk.points = walk_by_differences(h, starts, h_there, weights, settings);
    return walk;
}

double DensityTrainer::Round::integral(double exponent) const {
    double sum = 0;
    for (std::size_t i = 0; i < h.size(); ++i)
        sum += std::pow(h[i], exponent) / p[i] / static_cast<double>(h.size());
    return sum;
}

std::optional<double> DensityTrainer::unseen_share(double n, std::uint64_t max_evaluations) {
    const Round& last = recent_.back();
    const double exponent = 1 / scout_temperature(density_.dimensions());
    Walk walked = walk(scouts_, last, max_evaluations, longest_check, exponent, true);
    if (walked.points.h.empty()) return std::nullopt;
    const double mean = last.integral(1);
    const std::size_t count = walked.points.h.size();
    const double largest = *std::max_element(walked.points.h.begin(), walked.points.h.end());
    // Each walked point stands for a share of the integral, and for so many of the n points.
    std::vector<double> shares(count), hits(count);
    double total = 0;
    for (std::size_t i = 0; i < count; ++i)
        total += shares[i] = std::pow(walked.points.h[i] / largest, 1 - exponent);
    density_.pdf(walked.points.x, hits);
    for (std::size_t i = 0; i < count; ++i) {
        shares[i] /= total;
        hits[i] *= mean / walked.points.h[i];
    }
    evaluations_ += walked.evaluations;
    non_finite_.merge(walked.non_finite);
    scouts_ = std::move(walked.points);
    ++walks_;
    std::vector<std::uint32_t> order(count);
    std::iota(order.begin(), order.end(), std::uint32_t{0});
    std::ranges::sort(order, [&](std::uint32_t a, std::uint32_t b) {
        return hits[a] != hits[b] ? hits[a] < hits[b] : a < b;
    });
    double expected = 0, unseen = 0;
    for (std::uint32_t i : order) {
        expected += hits[i] * shares[i] * n;
        if (expected >= few_hits || hits[i] * far_above > 1) break;
        unseen += shares[i];
    }
    return unseen;
}

std::optional<DensityTrainer::Pool> DensityTrainer::pool(const std::function<bool()>& stop) const {
    const int dimensions = density_.dimensions();
    const Round& last = recent_.back();
    std::size_t drawn = walked_.h.size() + scouts_.h.size(); // points that have a density
    for (const Round& r : recent_) drawn += r.h.size();
    const std::size_t count = drawn + remembered_h_.size();
    Pool pool;
    pool.x.resize(count, dimensions);
    auto add = [&](const PointBatch& x, std::span<const double> h) {
        const auto at = static_cast<std::ptrdiff_t>(pool.h.size());
        for (int d = 0; d < dimensions; ++d)
            std::ranges::copy(x.coordinate(d), pool.x.coordinate(d).begin() + at);
        pool.h.insert(pool.h.end(), h.begin(), h.end());
    };
    for (const Round& r : recent_) add(r.x, r.h);
    for (const WalkedPoints* walked : {&walked_, &scouts_})
        if (!walked->h.empty()) add(walked->x, walked->h);
    if (!remembered_h_.empty()) add(remembered_, remembered_h_);
    pool.p.assign(count, 0.0);
    for (const WalkedPoints* walked : {&walked_, &scouts_}) {
        if (walked->h.empty()) continue;
        // The density of walkers is a power of h over its integral, which the last round estimates.
        const double integral = last.integral(walked->exponent);
        const double share = static_cast<double>(walked->h.size()) / static_cast<double>(drawn);
        for (std::size_t i = 0; integral > 0 && i < count; ++i)
            pool.p[i] += std::pow(pool.h[i], walked->exponent) / integral * share;
    }
    std::vector<double> part(count);
    for (const Round& r : recent_) {
        if (!pdf_until(r.density, pool.x, part, stop)) return std::nullopt;
        for (std::size_t i = 0; i < count; ++i)
            pool.p[i] += part[i] * static_cast<double>(r.h.size()) / static_cast<double>(drawn);
    }
    return pool;
}

bool DensityTrainer::fit(const std::function<bool()>& stop) {
    const int dimensions = density_.dimensions();
    const Round& last = recent_.back();
    // The maps follow only the last round, whose weights are the most even.
    std::vector<double> weights(last.h.size());
    for (std::size_t i = 0; i < weights.size(); ++i) weights[i] = last.h[i] / last.p[i];
    if (!(std::accumulate(weights.begin(), weights.end(), 0.0) > 0)) return true;
    MapFit settings;
    settings.bins = std::clamp(static_cast<int>(std::sqrt(static_cast<double>(last.h.size())) / 3), 8, 48);
    std::vector<MonotoneMap> maps(static_cast<std::size_t>(dimensions));
    parallel_for(dimensions, [&](std::int64_t d) {
        maps[static_cast<std::size_t>(d)] =
            fit_monotone_map(last.x.view().coordinate(static_cast<int>(d)), weights, settings);
    });
    std::vector<Gaussian> gaussians(density_.gaussians().begin(), density_.gaussians().end());
    const bool uneven = rounds_ > first_fit_before_gaussians && relative_variance_ > enough_even &&
                        dimensions <= max_gaussian_dimensions;
    const bool more = !enriched_ && uneven;
    const bool boundary = density_.has_boundary() || (uneven && is_heavy_tailed(weights));
    // Gaussians are fitted to all recent points, weighted by the mixture of the densities that drew them.
    const std::optional<Pool> seen = pool(stop);
    if (!seen) return false;
    const Pool& all = *seen;
    weights.resize(all.h.size());
    double total = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) total += weights[i] = all.h[i] / all.p[i];
    // Truncated, so that no single point draws a Gaussian to itself (Ionides 2008, "Truncated Importance
    // Sampling").
    const double largest = total / std::sqrt(static_cast<double>(weights.size()));
    for (double& w : weights) w = std::min(w, largest);
    if (more) {
        enriched_ = true;
        gaussians = gaussians.empty() ? scattered_gaussians(all.x, weights) : split_gaussians(gaussians);
    }
    if (!gaussians.empty() && !fit_gaussians(gaussians, all.x, weights, em_steps, stop)) return false;
    if (stop()) return false;
    for (Gaussian& g : gaussians) g = g.widened(safe_width); // heavier tails cost little, missing tails much
    MixtureDensity density_before = std::move(density_);
    density_ = MixtureDensity(dimensions, maps, gaussians, boundary);
    density_.optimise_shares(all.x, all.h, all.p, uniform_units_, share_step_, 0, stop);
    std::vector<double> ratios(all.h.size());
    auto compare = [&](const MixtureDensity& density) {
        if (!pdf_until(density, all.x, ratios, stop)) return false;
        for (std::size_t i = 0; i < ratios.size(); ++i) ratios[i] = all.h[i] / ratios[i];
        return true;
    };
    auto second_moment = [&] {
        const double most = MixtureDensity::beyond_reach * total / static_cast<double>(ratios.size());
        double sum = 0;
        for (std::size_t i = 0; i < ratios.size(); ++i) sum += weights[i] * std::min(ratios[i], most);
        return sum;
    };
    if (!compare(density_before)) return false;
    const double before = second_moment();
    if (!compare(density_)) return false;
    if (second_moment() > before) {
        density_ = std::move(density_before);
        maps.assign(density_.maps().begin(), density_.maps().end());
        if (!compare(density_)) return false;
    }
    density_.drop_idle();
    const int room = most_gaussians - static_cast<int>(density_.gaussians().size());
    auto uncovered = [&] {
        double sum = 0;
        for (std::size_t i = 0; i < ratios.size(); ++i)
            if (ratios[i] > far_above * total / static_cast<double>(ratios.size()))
                sum += all.h[i] / all.p[i] / total;
        return sum;
    };
    uncovered_share_ = uncovered();
    if (lacking(rounds_, relative_variance_) && room > 0) {
        std::vector<Gaussian> added =
            gaussians_at_surprises(all.x, weights, ratios, {.most = std::min(room, most_added)});
        if (!added.empty()) {
            const int newest = static_cast<int>(added.size());
            gaussians.assign(density_.gaussians().begin(), density_.gaussians().end());
            gaussians.insert(gaussians.end(), added.begin(), added.end());
            density_ =
                MixtureDensity(dimensions, std::move(maps), std::move(gaussians), density_.has_boundary());
            density_.optimise_shares(all.x, all.h, all.p, uniform_units_, share_step_, newest, stop);
            if (!compare(density_)) return false;
            uncovered_share_ = uncovered();
        }
    }
    remember(all, ratios);
    return true;
}

void DensityTrainer::remember(const Pool& all, std::span<const double> ratios) {
    std::vector<std::uint32_t> order(ratios.size());
    std::iota(order.begin(), order.end(), std::uint32_t{0});
    const std::size_t kept = std::min(most_remembered, order.size());
    std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(kept), order.end(),
                      [&](std::uint32_t a, std::uint32_t b) {
                          return ratios[a] != ratios[b] ? ratios[a] > ratios[b] : a < b;
                      });
    PointBuffer x(kept, all.x.dimensions());
    std::vector<double> h(kept);
    for (std::size_t i = 0; i < kept; ++i) {
        for (int d = 0; d < x.dimensions(); ++d) x(i, d) = all.x.view()(order[i], d);
        h[i] = all.h[order[i]];
    }
    remembered_ = std::move(x);
    remembered_h_ = std::move(h);
}

} // namespace montelux
