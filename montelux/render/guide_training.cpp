#include "montelux/render/guide_training.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "montelux/mc/parallel/cpu_time.h"
#include "montelux/mc/parallel/parallel_for.h"
#include "montelux/mc/random/hash.h"
#include "montelux/render/round_executor.h"
#include "montelux/render/tile_renderer.h"
#include "montelux/transport/guiding/guiding_learner.h"

namespace montelux {
namespace {

constexpr int training_tile = 16;
constexpr std::size_t training_batch = 256;
// Sample indices that no render takes.
constexpr std::uint64_t first_training_index = std::uint64_t{1} << 40;
// The first round has at most as many paths, or one for each pixel.
constexpr double first_paths = 1 << 16;
// A trial begins with as many at least, or with so many where a time or an error decides how long the render is, or with
// one for each pixel.
constexpr double fewest_paths = 1 << 12, fewest_paths_to_time = 1 << 14;
// Shares of the render's samples. Those of a trial, guided and recorded, take one and a half to three times as long as
// unguided ones: a trial takes a twentieth of the time at most, and one that stays open twice as much.
constexpr double all_training = 1.0 / 6, trial = 1.0 / 60, open_trial = 1.0 / 32;
// Guided paths are shaded one by one and look up densities: a ray of theirs takes so many times as long.
constexpr double cost_of_guiding = 1.6;
// Gain of a guide that passes the trial, of one whose trial goes on, since the next will have learned from twice as many
// samples, and of one that is kept after it, when most of its cost is spent. What splitting and the roulette of light
// samples gain comes on top.
constexpr double least_gain = 1.1, least_gain_of_open = 0.85, least_gain_of_kept = 1;
// A guide that gains so many times as much as the one before may still gain much more.
constexpr double growing = 1.1;
// Guesses before the first round, of its records per sample.
constexpr double first_records_per_sample = 6;
// No path counts as more than the root of this many times what its pixel expects: the rarest ones would decide alone.
constexpr double most_relative_square = 1e5;

// Sums over the samples of each pixel of one round.
struct TrainingRound {
    std::vector<std::vector<GuidingRecord>> records; // of each tile
    std::vector<double> sums, squares;               // of the radiance
    std::vector<double> unguided_squares;            // as they would be without the guide
    std::vector<std::uint32_t> samples;              // of each pixel
    std::uint64_t rays = 0;
    double cpu_seconds = 0;

    std::uint64_t sample_count() const {
        return std::accumulate(samples.begin(), samples.end(), std::uint64_t{0});
    }

    std::size_t record_count() const {
        std::size_t count = 0;
        for (const auto& list : records) count += list.size();
        return count;
    }
};

// Whether a round of so many samples per pixel takes one of this pixel. Where it is less than one the pixels are spread
// evenly (Roberts 2018, "The Unreasonable Effectiveness of Quasirandom Sequences": R2), and rounds of more contain them.
bool is_taken(int x, int y, double samples) {
    const double place = 0.7548776662466927 * x + 0.5698402909980532 * y;
    return place - std::floor(place) < samples;
}

// Samples with indices from `first` on. `share` of the paths are kept as records, `most` records of each tile; of a pixel
// probably `expected_records`.
TrainingRound take_round(const SampleContext& context, const Accelerator& accelerator,
                         const GuideTrainingPlan& plan, std::uint64_t first, double samples, double share,
                         double expected_records, std::size_t most) {
    const auto of_pixel = static_cast<std::uint32_t>(std::max(samples, 1.0));
    const std::vector<PixelBounds> tiles = tiles_of(plan.bounds, training_tile);
    const auto width = static_cast<std::size_t>(plan.bounds.width());
    TrainingRound round;
    round.records.resize(tiles.size());
    round.sums.resize(pixel_count(plan.bounds));
    round.samples.resize(round.sums.size());
    round.squares.resize(round.sums.size());
    round.unguided_squares.resize(round.sums.size());
    struct Cost {
        std::uint64_t rays = 0;
        double cpu_seconds = 0;
    };
    std::vector<Cost> costs(tiles.size());
    const auto kept = static_cast<std::uint64_t>(share * 0x1p32);
    parallel_for(
        static_cast<std::int64_t>(tiles.size()),
        [&](std::int64_t t) {
            const double begin = thread_cpu_seconds();
            const auto index = static_cast<std::size_t>(t);
            const PixelBounds& tile = tiles[index];
            std::vector<GuidingRecord>& records = round.records[index];
            records.reserve(
                std::min(most, static_cast<std::size_t>(expected_records * double(pixel_count(tile)))));
            SampleContext::Batch batch;
            RayTracer tracer(accelerator);
            std::vector<SampleContext::Key> keys;
            std::vector<std::size_t> places;
            std::vector<SampleContext::Lesson> lessons(training_batch);
            const auto take = [&] {
                context.teach(
                    tracer, keys, batch, lessons,
                    [&](std::size_t i) {
                        const SampleContext::Key& key = keys[i];
                        const std::uint64_t h = hash_key(0x7061746873u, static_cast<std::uint64_t>(key.x),
                                                         static_cast<std::uint64_t>(key.y), key.index);
                        return (h >> 32) < kept && records.size() < most;
                    },
                    records);
                for (std::size_t i = 0; i < keys.size(); ++i) {
                    const double v = double(lessons[i].radiance);
                    round.sums[places[i]] += v;
                    round.squares[places[i]] += v * v;
                    round.unguided_squares[places[i]] += lessons[i].unguided_square;
                }
                keys.clear();
                places.clear();
            };
            for (int y = tile.y0; y < tile.y1; ++y)
                for (int x = tile.x0; x < tile.x1; ++x) {
                    if (!is_taken(x, y, samples)) continue;
                    const std::size_t place = static_cast<std::size_t>(y - plan.bounds.y0) * width +
                                              static_cast<std::size_t>(x - plan.bounds.x0);
                    round.samples[place] = of_pixel;
                    for (std::uint32_t s = 0; s < of_pixel; ++s) {
                        keys.push_back({x, y, first_training_index + first + s});
                        places.push_back(place);
                        if (keys.size() == training_batch) take();
                    }
                }
            if (!keys.empty()) take();
            costs[index] = {tracer.statistics.rays(), thread_cpu_seconds() - begin};
        },
        plan.cancel);
    for (const Cost& c : costs) {
        round.rays += c.rays;
        round.cpu_seconds += c.cpu_seconds;
    }
    return round;
}

// What each pixel expects: means around it, none below a share of the picture's. No pixel counts for much more than the
// picture's mean, unless most of those around it do.
std::vector<float> expected_radiance(const TrainingRound& round, const PixelBounds& bounds) {
    constexpr double most_of_mean = 20, least_of_mean = 0.02, taken_around = 16;
    const int width = bounds.width(), height = bounds.height();
    double mean = 0, taken = 0;
    for (std::size_t i = 0; i < round.sums.size(); ++i)
        if (round.samples[i] > 0) {
            mean += round.sums[i] / round.samples[i];
            ++taken;
        }
    mean /= std::max(taken, 1.0);
    const double share = std::max(taken, 1.0) / static_cast<double>(round.sums.size());
    const int radius = std::max(3, static_cast<int>(std::ceil(std::sqrt(taken_around / share) / 2)));
    std::vector<float> expected(round.sums.size());
    parallel_for(height, [&](std::int64_t row) {
        const int y = static_cast<int>(row);
        std::vector<double> around;
        for (int x = 0; x < width; ++x) {
            around.clear();
            for (int v = std::max(0, y - radius); v < std::min(height, y + radius + 1); ++v)
                for (int u = std::max(0, x - radius); u < std::min(width, x + radius + 1); ++u) {
                    const std::size_t i = static_cast<std::size_t>(v) * static_cast<std::size_t>(width) +
                                          static_cast<std::size_t>(u);
                    if (round.samples[i] > 0) around.push_back(round.sums[i] / round.samples[i]);
                }
            double e = mean;
            if (!around.empty()) {
                const auto middle = around.begin() + static_cast<std::ptrdiff_t>(around.size() / 2);
                std::nth_element(around.begin(), middle, around.end());
                const double most = most_of_mean * std::max(mean, *middle);
                double sum = 0;
                for (const double v : around) sum += std::min(v, most);
                e = sum / double(around.size());
            }
            expected[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                     static_cast<std::size_t>(x)] = static_cast<float>(std::max(e, least_of_mean * mean));
        }
    });
    return expected;
}

// Mean over the pixels of the second moment of a sample, over the square of what the pixel expects.
double relative_second_moment(const TrainingRound& round, const std::vector<double>& squares,
                              const std::vector<float>& expected) {
    double sum = 0, taken = 0;
    for (std::size_t i = 0; i < expected.size(); ++i) {
        if (round.samples[i] == 0) continue;
        ++taken;
        const double e = double(expected[i]);
        if (e > 0) sum += std::min(squares[i] / round.samples[i] / (e * e), most_relative_square);
    }
    return taken > 0 ? sum / taken : 0;
}

// Samples per pixel that the render will take without a guide.
double samples_of_render(const GuideTrainingPlan& plan, const TrainingRound& first, double wall_seconds) {
    double samples = static_cast<double>(plan.samples);
    const double of_first =
        static_cast<double>(first.sample_count()) / static_cast<double>(first.sums.size());
    if (plan.seconds > 0) samples = std::min(samples, plan.seconds / wall_seconds * of_first);
    if (plan.error > 0) {
        double mean = 0, variance = 0, taken = 0;
        for (std::size_t i = 0; i < first.sums.size(); ++i) {
            if (first.samples[i] == 0) continue;
            const double m = first.sums[i] / first.samples[i];
            mean += m;
            variance += first.squares[i] / first.samples[i] - (first.samples[i] > 1 ? m * m : 0);
            ++taken;
        }
        mean /= taken;
        variance /= taken;
        if (mean > 0) samples = std::min(samples, variance / std::pow(plan.error * mean, 2));
    }
    return samples;
}

// Samples per pixel of the first of rounds that each take twice as many: whole ones or, in a trial, 1/2, 1/4 or 1/8. Of
// small pictures several; not so many that three rounds take more than their share.
double first_samples(const GuideTrainingPlan& plan, bool automatic) {
    const auto pixels = double(pixel_count(plan.bounds));
    const double most = std::max(1.0, std::floor(first_paths / pixels));
    if (!automatic) return std::clamp(std::floor(all_training / 7 * double(plan.samples)), 1.0, most);
    // What pixels expect is learned from those around them, which must not be far away.
    constexpr double least_share = 1.0 / 8;
    // What a time or an error allows is not known yet.
    const bool unknown = plan.seconds > 0 || plan.error > 0;
    const double paths = unknown ? fewest_paths_to_time : fewest_paths;
    const double least = std::clamp(std::exp2(std::ceil(std::log2(paths / pixels))), least_share, 1.0);
    if (unknown) return least;
    const double samples = std::clamp(trial / 7 * double(plan.samples), least, most);
    return samples > 1 ? std::floor(samples) : std::exp2(std::floor(std::log2(samples)));
}

// Of the samples that the render takes, those that train a guide which passed its trial. One that gains little is not
// worth many, unless it gains more from round to round.
double share_of_training(double gain, double last_gain) {
    return gain > growing * last_gain ? all_training : std::clamp((gain - 1) / 8, open_trial, all_training);
}

} // namespace

TrainedGuide train_guide(SampleContext& context, const Accelerator& accelerator,
                         const IntegratorSettings& settings, const GuideTrainingPlan& plan) {
    using Clock = std::chrono::steady_clock;
    TrainedGuide trained;
    GuideSummary& summary = trained.summary;
    summary.decided = !context.can_be_guided();
    if (summary.decided) return trained;
    const bool automatic = settings.guiding == Guiding::automatic;
    const std::size_t memory = settings.guiding_memory << 20;
    // Records are sorted by pointers to them; the guide has the rest.
    const std::size_t most_records = memory / 8 * 7 / (sizeof(GuidingRecord) + sizeof(void*));
    const std::size_t tiles = tiles_of(plan.bounds, training_tile).size();
    const GuidingLearnerSettings learner{.most_bytes = memory / 8};
    const auto pixels = double(pixel_count(plan.bounds));
    double samples = first_samples(plan, automatic);
    if (automatic && 3 * samples > trial * double(plan.samples)) { // two rounds
        summary.outcome = GuideOutcome::too_short;
        summary.decided = true;
        return trained;
    }
    double taken = 0; // samples per pixel, of all rounds
    std::uint64_t next_index = 0;
    double records_per_sample = first_records_per_sample, budget = std::numeric_limits<double>::infinity();
    double unguided_cost = 0; // rays of a sample
    bool passed = false;      // the trial
    for (;;) {
        const double wanted = records_per_sample * pixels * samples;
        const double share = std::min(1.0, 0.9 * static_cast<double>(most_records) / wanted);
        const auto begin = Clock::now();
        TrainingRound round = take_round(context, accelerator, plan, next_index, samples, share,
                                         share * records_per_sample * samples, most_records / tiles);
        const double wall_seconds = std::chrono::duration<double>(Clock::now() - begin).count();
        summary.cpu_seconds += round.cpu_seconds;
        if (plan.cancel != nullptr && plan.cancel->requested()) {
            context.set_guide(nullptr);
            return {nullptr, {}};
        }
        const auto paths = std::max(1.0, static_cast<double>(round.sample_count()));
        next_index += static_cast<std::uint64_t>(std::ceil(samples));
        taken += samples;
        summary.samples += paths / pixels;
        ++summary.rounds;
        std::vector<float> expected = expected_radiance(round, plan.bounds);
        const double cost = static_cast<double>(round.rays) / paths;
        const double moment = relative_second_moment(round, round.squares, expected);
        const double last_gain = summary.gain;
        if (!context.guide()) {
            unguided_cost = cost;
            budget = samples_of_render(plan, round, wall_seconds);
        } else if (moment > 0) {
            // Estimated from guided samples: so few unguided ones would miss rare light, which dominates the variance.
            summary.gain = relative_second_moment(round, round.unguided_squares, expected) * unguided_cost /
                           (moment * cost * cost_of_guiding);
        }
        const bool memory_is_full = share < 0.5;
        const bool open = !passed && summary.gain >= least_gain_of_open && summary.gain < least_gain;
        // Where light is hidden, unguided samples underestimate how many samples an error target needs.
        const bool next_is_trial = (summary.rounds == 1 && plan.error > 0) ||
                                   (!(summary.rounds >= 3 && memory_is_full) &&
                                    taken + 2 * samples <= (open ? open_trial : trial) * budget);
        const bool gives_up =
            automatic && !next_is_trial && !(summary.gain >= (passed ? least_gain_of_kept : least_gain));
        passed = !next_is_trial;
        const bool nothing_found = round.record_count() == 0 || (!context.guide() && !(moment > 0));
        if (gives_up || nothing_found) {
            summary.outcome = nothing_found        ? GuideOutcome::nothing_found
                              : summary.rounds < 2 ? GuideOutcome::too_short
                                                   : GuideOutcome::would_not_pay;
            context.set_guide(nullptr);
            break;
        }
        records_per_sample = static_cast<double>(round.record_count()) / (share * pixels * samples);
        const double learning = process_cpu_seconds(); // all threads learn
        context.set_guide(std::make_shared<const GuidingField>(
            GuidingLearner::learn(round.records, learner, plan.bounds, std::move(expected))));
        summary.cpu_seconds += process_cpu_seconds() - learning;
        samples *= 2;
        // Twice at least: what the first guide learned without another one is noisy.
        const bool tries = automatic && next_is_trial;
        if (summary.rounds >= 3 && !tries &&
            (memory_is_full ||
             taken + samples >
                 (automatic ? share_of_training(summary.gain, last_gain) : all_training) * budget)) {
            summary.outcome = GuideOutcome::trained;
            break;
        }
    }
    trained.guide = context.guide();
    if (trained.guide) {
        summary.regions = trained.guide->regions();
        summary.bytes = trained.guide->bytes();
    }
    summary.decided = true;
    return trained;
}

TrainedGuide train_guide(SampleContext& context, const Accelerator& accelerator,
                         const IntegratorSettings& settings, const GuideTrainingPlan& plan,
                         RoundExecutor* executor) {
    if (executor == nullptr || !context.can_be_guided())
        return train_guide(context, accelerator, settings, plan);
    CancelFlag stop;
    GuideTrainingPlan shared = plan;
    shared.cancel = &stop;
    TrainedGuide trained;
    executor->meanwhile([&] { trained = train_guide(context, accelerator, settings, shared); },
                        [&] {
                            if ((plan.cancel != nullptr && plan.cancel->requested()) || executor->failed())
                                stop.request();
                        });
    return trained;
}

} // namespace montelux
