#include "montelux/render/integrator_choice.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "montelux/mc/math/error.h"
#include "montelux/mc/parallel/parallel_for.h"
#include "montelux/mc/random/hash.h"
#include "montelux/mc/stats/jackknife.h"
#include "montelux/render/check_render.h"
#include "montelux/render/integrator_pilot.h"
#include "montelux/render/missing_light.h"
#include "montelux/render/sample_allocation.h"
#include "montelux/render/tile_renderer.h"
#include "montelux/scene/setting_names.h"

namespace montelux {
namespace {

constexpr int pilot_tile = 8;
// The pilot of the path integrator begins with so many tiles, from which the time of the render is guessed. Fewer than
// `fewest_tiles` of another one say too little.
constexpr std::size_t first_tiles = 64, fewest_tiles = 16;
constexpr std::size_t most_tiles = 4096;
// Shares of the render's expected work that pilots of others may take.
constexpr double tile_share = 1.0 / 80, chain_share = 1.0 / 25;
// Guess of their work per sample over that of the path integrator, before it is measured.
constexpr double expected_work = 4;
// Time of a ray over that of a ray of the path integrator: the upper end of what was measured, 0.7 to 2.2 and 1.1 to 2.2.
// Path tracing wins in doubt.
constexpr double bidirectional_ray = 1.8, metropolis_ray = 2;
// So many times less time than path tracing must another integrator take, and that by two standard errors of the
// logarithm of their ratio: a firefly of path tracing must not decide alone.
constexpr double least_advantage = 1.25, certainty = 2;
// The errors follow from what the ratio is without each of so many parts of the tiles.
constexpr std::size_t jackknife_parts = 10;

double ray_cost(IntegratorKind kind) {
    switch (kind) {
    case IntegratorKind::bidirectional:
        return bidirectional_ray;
    case IntegratorKind::metropolis:
        return metropolis_ray;
    default:
        return 1;
    }
}

// Why an integrator cannot render this; empty if it can.
std::string obstacle_of(SceneDescription& description, const IntegratorChoiceSettings& settings,
                        IntegratorKind kind) {
    if (kind != IntegratorKind::path && description.integrator.guiding == Guiding::on)
        return std::string(name_of(kind)) + ": paths are to be guided, which only those of path can be";
    description.integrator.method = kind;
    std::string reason;
    try {
        check_render(description, sampler_of(description), settings.target(kind));
    } catch (const Error& e) {
        reason = e.what();
        reason = reason.substr(0, reason.rfind("; ")); // without the advice to choose path
    }
    description.integrator.method = IntegratorKind::automatic;
    return reason;
}

bool shows_light(const PilotPicture& picture) {
    return std::ranges::any_of(picture.parts, [](const PilotPart& part) {
        const auto is_lit = [](float luminance) { return luminance > 0; };
        return std::ranges::any_of(part.first, is_lit) || std::ranges::any_of(part.second, is_lit);
    });
}

// In an order that makes any first few of them a fair sample of the picture.
std::vector<PixelBounds> shuffled_tiles(const PixelBounds& crop) {
    const std::vector<PixelBounds> tiles = tiles_of(crop, pilot_tile);
    std::vector<std::pair<std::uint64_t, std::size_t>> keys;
    for (std::size_t i = 0; i < tiles.size(); ++i) keys.emplace_back(hash_key(0x70696c6f74, i), i);
    std::sort(keys.begin(), keys.end());
    std::vector<PixelBounds> shuffled;
    shuffled.reserve(keys.size());
    for (const auto& [key, i] : keys) shuffled.push_back(tiles[i]);
    return shuffled;
}

class Choice {
  public:
    Choice(SceneDescription& description, const IntegratorChoiceSettings& settings)
        : description_(description), settings_(settings), tiles_(shuffled_tiles(description.film.crop)),
          pixels_(static_cast<double>(pixel_count(description.film.crop))) {
        for (std::size_t i = 0; i < kinds.size(); ++i) summary_.candidates[i].kind = kinds[i];
    }

    std::shared_ptr<ChosenIntegrator> choose() {
        const RenderTarget target = settings_.target(IntegratorKind::path);
        if (target.slice.count > 1)
            throw Error("integrator auto",
                        "all slices of a picture must be rendered by the same integrator; choose one");
        if (description_.integrator.merging)
            throw Error("integrator auto",
                        "does not consider merging, whose bias no error bar contains; choose "
                        "the integrator 'bidirectional', or leave merging out");
        find_candidates();
        try {
            prepare();
            if (!take_pilots() || !look_for_missing_light()) return abandon();
        } catch (...) {
            abandon();
            throw;
        }
        return decide();
    }

  private:
    using Clock = std::chrono::steady_clock;
    static constexpr std::array kinds{IntegratorKind::path, IntegratorKind::bidirectional,
                                      IntegratorKind::metropolis};
    static constexpr std::size_t path = 0, bidirectional = 1, metropolis = 2;

    std::shared_ptr<ChosenIntegrator> abandon() {
        description_.integrator.method = IntegratorKind::automatic;
        return nullptr;
    }

    void find_candidates() {
        for (std::size_t i = 0; i < kinds.size(); ++i) {
            const std::string obstacle = obstacle_of(description_, settings_, kinds[i]);
            possible_[i] = obstacle.empty();
            if (possible_[i])
                summary_.candidates[i].outcome = CandidateOutcome::unaffordable;
            else if (i != path)
                refusals_.push_back(obstacle);
        }
    }

    // Once for all: tables for paths that start at lights change nothing for those that start at the camera.
    void prepare() {
        description_.integrator.method =
            possible_[bidirectional] ? IntegratorKind::bidirectional : IntegratorKind::path;
        prepared_ = std::make_shared<const PreparedScene>(description_);
        begin_ = Clock::now();
        begin(path);
    }
    // The renderer reads the integrator from the description: only one may take samples at a time.
    void begin(std::size_t i) {
        description_.integrator.method = kinds[i];
        renderers_[i].emplace(description_, settings_.target(kinds[i]), 0, prepared_);
        pilots_[i].emplace(*renderers_[i], tiles_);
    }
    double seconds() const { return std::chrono::duration<double>(Clock::now() - begin_).count(); }

    bool take_pilots() {
        if (!possible_[bidirectional] && !possible_[metropolis]) return true;
        std::size_t count = std::min(first_tiles, tiles_.size());
        if (!pilots_[path]->take_tiles(count, settings_.cancel)) return false;
        measure(count);
        const double samples = expected_samples();
        const double affordable =
            samples * pixels_ * tile_share / (2 * pilot_tile * pilot_tile * expected_work);
        const std::size_t tiles = std::min({tiles_.size(), most_tiles, static_cast<std::size_t>(affordable)});
        if (possible_[bidirectional] && tiles >= std::min(fewest_tiles, tiles_.size())) {
            if (tiles > count && !pilots_[path]->take_tiles(tiles, settings_.cancel)) return false;
            count = tiles;
            begin(bidirectional);
            if (!pilots_[bidirectional]->take_tiles(count, settings_.cancel)) return false;
            measure(count);
        }
        if (possible_[metropolis] && !shows_light(pilots_[path]->picture())) {
            summary_.candidates[metropolis].outcome = CandidateOutcome::refused;
            refusals_.push_back("metropolis: paths from the camera, which its chains follow, found no light");
        } else if (possible_[metropolis] && chains_are_affordable(samples)) {
            begin(metropolis);
            if (!pilots_[metropolis]->take_groups(count, settings_.cancel)) return false;
            measure(count);
        }
        return true;
    }

    bool chains_are_affordable(double samples) {
        description_.integrator.method = IntegratorKind::metropolis;
        const RenderTarget target = settings_.target(IntegratorKind::metropolis);
        const SampleOrder order(with_replicates(sampler_of(description_), target), target.slice);
        return 2.0 * order.replicate_size() * expected_work <= samples * chain_share;
    }

    // Samples per pixel that the path integrator would take.
    double expected_samples() const {
        const RenderTarget& target = renderers_[path]->target();
        auto samples = static_cast<double>(SampleOrder(renderers_[path]->sampler(), target.slice).share());
        if (target.error > 0) {
            const double variance = picture_variances_[path];
            if (variance > 0) samples = std::min(samples, variance / (target.error * target.error));
        }
        if (target.time > 0 && pilots_[path]->samples() > 0) {
            const double rate = pilots_[path]->samples() / pixels_ / std::max(seconds(), 1e-6);
            samples = std::min(samples, target.time * rate);
        }
        return samples;
    }

    // Of all integrators with a pilot, by those of the first tiles that uses(tile) is true for.
    template <typename Use>
    std::array<double, 3> variances(std::size_t tile_count, PilotMeasure by, const Use& uses) const {
        std::vector<std::size_t> ends, measured;
        std::vector<PilotPicture> pictures;
        for (std::size_t i = 0; i < kinds.size(); ++i)
            if (pilots_[i] && !pilots_[i]->picture().parts.empty()) {
                measured.push_back(i);
                pictures.push_back(part_of(pilots_[i]->picture(), tile_count, uses));
            }
        std::size_t used = 0;
        for (std::size_t t = 0; t < tile_count; ++t)
            if (uses(t)) ends.push_back(used += pixel_count(tiles_[t]));
        const std::vector<double> found = relative_variances(pictures, ends, by);
        std::array<double, 3> result{};
        for (std::size_t k = 0; k < measured.size(); ++k) result[measured[k]] = found[k];
        return result;
    }
    template <typename Use>
    PilotPicture part_of(PilotPicture picture, std::size_t tile_count, const Use& uses) const {
        for (PilotPart& part : picture.parts)
            for (std::vector<float>* values : {&part.first, &part.second}) {
                std::vector<float> used;
                std::size_t begin = 0;
                for (std::size_t t = 0; t < tile_count; ++t) {
                    const std::size_t end = begin + pixel_count(tiles_[t]);
                    if (uses(t)) append(used, *values, begin, end);
                    begin = end;
                }
                *values = std::move(used);
            }
        return picture;
    }
    static void append(std::vector<float>& to, const std::vector<float>& from, std::size_t begin,
                       std::size_t end) {
        to.insert(to.end(), from.begin() + static_cast<std::ptrdiff_t>(begin),
                  from.begin() + static_cast<std::ptrdiff_t>(end));
    }

    // What efforts are compared by.
    PilotMeasure measured_by() const {
        return settings_.target(IntegratorKind::path).error > 0 ? PilotMeasure::picture
                                                                : PilotMeasure::pixels;
    }
    void measure(std::size_t tile_count) {
        measured_tiles_ = tile_count;
        const auto all = [](std::size_t) { return true; };
        picture_variances_ = variances(tile_count, PilotMeasure::picture, all);
        const std::array<double, 3> of_samples = measured_by() == PilotMeasure::picture
                                                     ? picture_variances_
                                                     : variances(tile_count, PilotMeasure::pixels, all);
        for (std::size_t i = 0; i < kinds.size(); ++i) {
            if (!pilots_[i] || pilots_[i]->picture().parts.empty()) continue;
            IntegratorChoice::Candidate& candidate = summary_.candidates[i];
            candidate.outcome = CandidateOutcome::measured;
            candidate.effort = of_samples[i] * pilots_[i]->rays_per_sample() * ray_cost(kinds[i]);
            candidate.samples = static_cast<std::uint64_t>(pilots_[i]->samples());
        }
    }

    // The standard errors of the logarithms of path tracing's variance over those of the others. Not finite where one of
    // them has all its light, or noise, from one part of the tiles: then nothing is certain.
    std::array<double, 3> ratio_errors() const {
        std::array<std::array<double, jackknife_parts>, 3> logarithms{};
        for (std::size_t part = 0; part < jackknife_parts; ++part) {
            const std::array<double, 3> without = variances(
                measured_tiles_, measured_by(), [&](std::size_t t) { return t % jackknife_parts != part; });
            for (const std::size_t i : {bidirectional, metropolis})
                logarithms[i][part] = std::log(without[path]) - std::log(without[i]);
        }
        std::array<double, 3> errors{};
        for (const std::size_t i : {bidirectional, metropolis}) errors[i] = jackknife_error(logarithms[i]);
        return errors;
    }

    std::size_t best() const {
        std::size_t chosen = path;
        const auto effort = [&](std::size_t i) { return summary_.candidates[i].effort; };
        if (!(effort(bidirectional) > 0 || effort(metropolis) > 0)) return path;
        const std::array<double, 3> errors = ratio_errors();
        double least = std::numeric_limits<double>::infinity();
        for (const std::size_t i : {bidirectional, metropolis}) {
            const double advantage = least_advantage * std::exp(certainty * errors[i]);
            // 0: it found no light. Nothing is less than NaN.
            const bool wins = effort(i) > 0 && (effort(path) == 0 || advantage * effort(i) < effort(path));
            if (wins && effort(i) < least) {
                chosen = i;
                least = effort(i);
            }
        }
        return chosen;
    }

    // Where path tracing is best but would lack light that matters, the other way begins. False if it was cancelled.
    bool look_for_missing_light() {
        if (best() != path || !possible_[bidirectional]) return true;
        description_.integrator.method = kinds[path];
        const std::optional<MissingLight> missing =
            missing_light(description_, *prepared_, expected_samples() * pixels_);
        if (!missing || !missing->matters(settings_.target(kinds[path]).error)) return true;
        summary_.missing = missing->share;
        if (pilots_[bidirectional]) return true;
        const std::size_t count = std::min(first_tiles, tiles_.size());
        begin(bidirectional);
        if (!pilots_[bidirectional]->take_tiles(count, settings_.cancel)) return false;
        measure(count);
        return true;
    }

    std::shared_ptr<ChosenIntegrator> decide() {
        const std::size_t chosen = summary_.missing > 0 ? bidirectional : best();
        description_.integrator.method = summary_.chosen = kinds[chosen];
        summary_.decided = true;
        for (const auto& pilot : pilots_)
            if (pilot) summary_.cpu_seconds += pilot->cpu_seconds();
        const RenderTarget target = settings_.target(kinds[chosen]);
        const IntegratorPilot& pilot = *pilots_[chosen];
        if (target.error > 0 && target.quantile == 0 && pilot.samples() > 0)
            summary_.seconds_to_target = picture_variances_[chosen] / (target.error * target.error) *
                                         pixels_ * pilot.cpu_seconds() / pilot.samples() / thread_count();
        auto result = std::make_shared<ChosenIntegrator>(
            ChosenIntegrator{pilots_[chosen]->take_state(), std::move(prepared_), std::move(refusals_)});
        RenderReport& report = result->state.report;
        report.choice = summary_;
        report.cpu_seconds = summary_.cpu_seconds;
        report.seconds = seconds();
        return result;
    }

    SceneDescription& description_;
    const IntegratorChoiceSettings& settings_;
    std::vector<PixelBounds> tiles_;
    double pixels_;
    std::shared_ptr<const PreparedScene> prepared_;
    Clock::time_point begin_;
    std::array<bool, 3> possible_{};
    std::array<std::optional<Renderer>, 3> renderers_;
    std::array<std::optional<IntegratorPilot>, 3> pilots_;
    std::array<double, 3> picture_variances_{};
    std::size_t measured_tiles_ = 0;
    IntegratorChoice summary_;
    std::vector<std::string> refusals_;
};

} // namespace

std::shared_ptr<ChosenIntegrator> choose_integrator(SceneDescription& description,
                                                    const IntegratorChoiceSettings& settings) {
    return Choice(description, settings).choose();
}

} // namespace montelux
