#include "montelux/mc/integrate/witness/evidence.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

#include "montelux/mc/integrate/sampling.h"
#include "montelux/mc/integrate/trained/unit_density.h"
#include "montelux/mc/integrate/witness/imprecise_mass.h"
#include "montelux/mc/integrate/witness/pole_search.h"
#include "montelux/mc/integrate/witness/ridge.h"

namespace montelux {
namespace {

constexpr double least_of_all = 0.05; // standard errors: the least mass of a peak that counts beside others
constexpr double far_above = 32;      // times the mean of |g|: a value that is examined
constexpr std::uint64_t most_of_examination = 600; // evaluations, for each variable and one more

// Integral of |g|, or what is known of it.
double size_of(const Tally& tally, std::size_t c) {
    const double known = c < tally.absolute.size() ? tally.absolute[c] : 0;
    return std::max({known, std::abs(tally.value[c]),
                     std::isfinite(tally.standard_error[c]) ? tally.standard_error[c] : 0.0});
}

// Whether a point is within the half height of a peak.
bool lies_within(const Witness& peak, const std::vector<double>& u) {
    for (std::size_t d = 0; d < u.size(); ++d)
        if (std::abs(u[d] - peak.u[d]) > peak.extent[d]) return false;
    return true;
}

void save(StateWriter& state, const NoiseBox& box) {
    state.put(box.component);
    state.put(box.lower);
    state.put(box.upper);
}

void load(StateReader& state, NoiseBox& box) {
    box.component = state.get<int>();
    box.lower = state.get_doubles();
    box.upper = state.get_doubles();
}

template <typename T>
void save_all(StateWriter& state, const std::vector<T>& all) {
    state.put(static_cast<std::uint64_t>(all.size()));
    for (const T& one : all) save(state, one);
}

template <typename T>
void load_all(StateReader& state, std::vector<T>& all) {
    for (std::uint64_t n = state.get_word(); n > 0; --n) load(state, all.emplace_back());
}

} // namespace

Evidence::Evidence(Evaluator& evaluator, std::uint64_t seed)
    : evaluator_(evaluator), seed_(seed), largest_(evaluator.components()),
      examined_(static_cast<std::size_t>(evaluator.components())) {
    evaluator_.keep_largest(&largest_);
}

Evidence::~Evidence() { evaluator_.keep_largest(nullptr); }

void Evidence::look(const Integrand& f, std::uint64_t most_evaluations) {
    look_ = first_look(evaluator_, {f.landmarks(), f.guides(), most_evaluations, seed_});
    evaluator_.leave_out(look_.noise);
    evaluations_ += look_.evaluations;
    divergence_ = look_.divergence;
    largest_.clear();
    std::ranges::fill(examined_, Examined());
}

void Evidence::weigh_rounding(const Integrand& f, double evaluations) {
    constexpr double most_points = 4096, share = 0.1, evaluations_per_point = 3;
    imprecise_ = imprecise_mass(
        evaluator_, f.landmarks(), seed_,
        static_cast<std::size_t>(std::min(most_points, share * evaluations / evaluations_per_point)));
    largest_.clear();
}

void Evidence::rescale(std::span<const double> exponents) {
    const auto rescaled = [&](double x, std::size_t c) {
        return std::ldexp(x, static_cast<int>(exponents[c]));
    };
    const auto rescale_all = [&](std::vector<Witness>& all) {
        for (Witness& w : all)
            for (std::size_t c = 0; c < w.value.size(); ++c) w.value[c] = rescaled(w.value[c], c);
    };
    rescale_all(look_.peaks);
    rescale_all(look_.witnesses);
    rescale_all(look_.on_ridges);
    for (SlowShells& slow : look_.slow) rescale_all(slow.shells);
    for (std::size_t c = 0; c < examined_.size(); ++c) {
        examined_[c].size = rescaled(examined_[c].size, c);
        examined_[c].unresolved = rescaled(examined_[c].unresolved, c);
        if (c < look_.unresolved.size()) look_.unresolved[c] = rescaled(look_.unresolved[c], c);
        if (c < imprecise_.size()) imprecise_[c] = rescaled(imprecise_[c], c);
    }
    largest_.clear();
}

void Evidence::examine(const Tally& tally, std::uint64_t most_evaluations) {
    const std::uint64_t cost = most_of_examination * static_cast<std::uint64_t>(evaluator_.dimensions() + 1);
    std::uint64_t left = most_evaluations;
    if (!divergence_.empty()) return;
    std::vector<Witness> seen = largest_.witnesses();
    seen.insert(seen.end(), look_.on_ridges.begin(), look_.on_ridges.end()); // they may be poles
    for (const Witness& witness : seen)
        for (std::size_t c = 0; c < examined_.size(); ++c) {
            Examined& known = examined_[c];
            const double value = std::abs(witness.value[c]);
            if (!(value > 1.01 * known.size) || !(value > far_above * size_of(tally, c))) continue;
            if (left < cost) return;
            left -= cost;
            RawValues raw(evaluator_);
            const Magnitude magnitude = [c](const std::vector<double>& row) { return std::abs(row[c]); };
            Witness peak = witness;
            measure(raw, peak, magnitude);
            // A peak narrower than doubles can resolve holds about as much as their spacing does at its height.
            const bool rounds = is_rounding(peak);
            const double narrow = rounds ? value * peak.volume : 0;
            if (!rounds) {
                look_.found_by_chance =
                    look_.found_by_chance || std::ranges::none_of(look_.peaks, [&](const Witness& other) {
                        return belongs(raw, peak, other, magnitude);
                    });
                for (Witness& other : opposite_peaks(raw, peak, magnitude))
                    look_.peaks.push_back(std::move(other));
                look_.peaks.push_back(std::move(peak));
            }
            // Far out in several variables ridges look like poles.
            const bool far = witness.u.size() > 1 && is_far_out(evaluator_.domain(), witness.u);
            const PoleReport pole =
                far ? PoleReport{ridge_diverges(raw, witness.u, magnitude), 0, witness.u, {}}
                    : search_pole(raw, witness, c);
            known = {pole.u, value, std::max(pole.unresolved, narrow)};
            if (pole.diverges && (far || !is_far_out(evaluator_.domain(), pole.u)) && divergence_.empty())
                divergence_ = limit_text(evaluator_.domain(), pole.u);
            note_slow(pole.slow);
            evaluations_ += raw.evaluations();
        }
}

// Keeps a slow pole; greater values near it are followed to the same one.
void Evidence::note_slow(const SlowShells& slow) {
    constexpr double same = 0x1p-20;
    if (slow.shells.empty() || look_.slow.size() == SlowShells::most) return;
    const bool known = std::ranges::any_of(look_.slow, [&](const SlowShells& other) {
        for (std::size_t d = 0; d < slow.place.size(); ++d)
            if (std::abs(slow.place[d] - other.place[d]) > same) return false;
        return true;
    });
    if (!known) look_.slow.push_back(slow);
}

void Evidence::judge(const UnitDensity* density, const StepRequest& request, Tally& tally) const {
    const double points = static_cast<double>(tally.evaluations);
    std::vector<double> least(tally.standard_error);
    std::vector<Unreached> missed_of(tally.value.size());
    if (tally.statistical) missed_of = unreached(look_.slow, missed_of.size(), density, points);
    for (std::size_t c = 0; c < tally.value.size(); ++c) {
        const double tolerance = std::max(request.tolerance(c, tally.value[c]), tally.standard_error[c]);
        // Mass of a peak that points missed, or may have missed, and of all peaks and parts of ridges that they missed.
        double worst = 0, expected = 0, sum = 0;
        const Witness* where = nullptr;
        for (const auto* all : {&look_.peaks, &look_.witnesses})
            for (const Witness& w : *all) {
                if (!tally.statistical) break; // rules are compared with every witness
                const auto mass_by = [&](double q) {
                    return unexplained(w.value[c], w.volume, q, points, size_of(tally, c));
                };
                // Most witnesses are explained by any density.
                if (!(mass_by(0x1p-4) > least_of_all * tally.standard_error[c])) continue;
                // A peak speaks for those within it, but for parts of ridges.
                if (all == &look_.witnesses && !w.is_part &&
                    std::ranges::any_of(look_.peaks,
                                        [&](const Witness& peak) { return lies_within(peak, w.u); }))
                    continue;
                const double q = density ? pdf_at(*density, w.u) : 1, mass = mass_by(q);
                expected = std::max(expected, mass * std::exp(-points * q * w.volume));
                if (all == &look_.peaks || w.is_part) sum += mass;
                if (mass > worst) worst = mass, where = &w;
            }
        worst = std::max(worst, sum);
        least[c] = std::max(least[c], expected);
        std::array<char, 200> text;
        if (where && worst > tolerance) {
            std::snprintf(text.data(), text.size(),
                          "a peak at %s, seen but hardly sampled, may hold %.2g or more of the integral",
                          place_text(evaluator_.domain(), where->u).c_str(), worst);
            tally.warnings.emplace_back(text.data());
            least[c] = std::max(least[c], worst);
        }
        const double at_ends = c < look_.unresolved.size() ? look_.unresolved[c] : 0;
        const double imprecise = c < imprecise_.size() ? imprecise_[c] : 0;
        const double unresolved = std::max({examined_[c].unresolved, at_ends, imprecise});
        if (unresolved > tolerance) {
            const std::string what =
                unresolved == at_ends ? "lies closer to an end or a pole than doubles can tell"
                : unresolved == imprecise
                    ? "depends on digits that the integrand loses by cancellation"
                    : "lies closer to the peak or pole at " +
                          place_text(evaluator_.domain(), examined_[c].u) + " than doubles can tell";
            std::snprintf(text.data(), text.size(), "about %.2g of the integral %s", unresolved,
                          what.c_str());
            tally.warnings.emplace_back(text.data());
        }
        if (unresolved > tally.standard_error[c]) least[c] += unresolved;
        if (!tally.statistical) continue;
        const auto [missed, at] = missed_of[c];
        least[c] = std::hypot(least[c], missed);
        if (at && missed > tolerance) {
            std::snprintf(text.data(), text.size(),
                          "about %.2g of the integral lies closer to %s than the points reach", missed,
                          place_text(evaluator_.domain(), at->shells.back().u).c_str());
            tally.warnings.emplace_back(text.data());
        }
    }
    raise_standard_errors(least, tally);
}

void Evidence::save(StateWriter& state) const {
    largest_.save(state);
    state.put(evaluations_);
    state.put(std::string_view(divergence_));
    save_all(state, look_.witnesses);
    save_all(state, look_.peaks);
    save_all(state, look_.on_ridges);
    save_all(state, look_.slow);
    save_all(state, look_.noise);
    state.put(look_.found_by_chance);
    state.put(look_.evaluations);
    state.put(look_.unresolved);
    state.put(imprecise_);
    for (const Examined& e : examined_) {
        state.put(e.u);
        state.put(e.size);
        state.put(e.unresolved);
    }
}

void Evidence::load(StateReader& state) {
    largest_.load(state);
    evaluations_ = state.get_word();
    divergence_ = state.get_text();
    look_ = {};
    load_all(state, look_.witnesses);
    load_all(state, look_.peaks);
    load_all(state, look_.on_ridges);
    load_all(state, look_.slow);
    load_all(state, look_.noise);
    evaluator_.leave_out(look_.noise);
    look_.found_by_chance = state.get<int>() != 0;
    look_.evaluations = state.get_word();
    look_.unresolved = state.get_doubles();
    imprecise_ = state.get_doubles();
    for (Examined& e : examined_) {
        e.u = state.get_doubles();
        e.size = state.get_double();
        e.unresolved = state.get_double();
    }
}

} // namespace montelux
