#include "montelux/mc/integrate/chains/walker_ensemble.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "montelux/mc/integrate/metropolis/acceptance.h"
#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

constexpr double longest_stretch = 2; // a of Goodman and Weare
constexpr int most_expansions = 1000; // of a slice
constexpr int most_contractions = 1000;

} // namespace

// The slice of one walker: points x + t * direction with t in (left, right) where log p is at least `level`.
struct WalkerEnsemble::Slice {
    enum class Phase : std::uint8_t { left, right, shrink };
    std::size_t walker;
    std::vector<double> direction;
    double level, left, right, t = 0;
    int left_steps, right_steps; // expansions that remain
    int contractions = 0;
    Phase phase = Phase::left;
};

WalkerEnsemble::WalkerEnsemble(EnsembleMove move, LogDensityCalls density, std::vector<double> starts,
                               std::uint64_t key, std::uint32_t number)
    : move_(move), density_(std::move(density)), d_(density_.dimensions()), key_(key), number_(number),
      numbers_(key), x_(std::move(starts)), log_p_(x_.size() / d_) {
    density_(x_, log_p_);
    for (std::size_t i = 0; i < size(); ++i)
        if (!(log_p_[i] > -std::numeric_limits<double>::infinity()))
            throw Error("chains", "the density is zero, or not a number, where walker " + std::to_string(i) +
                                      " of ensemble " + std::to_string(number) + " starts");
}

void WalkerEnsemble::step(bool adapt) {
    // A stream lasts for 2^34 numbers; a fresh one for every 4096 steps does not end.
    if ((steps_ & 0xfff) == 0)
        numbers_ = PhiloxStream(key_, {number_, static_cast<std::uint32_t>(steps_ >> 12),
                                       static_cast<std::uint32_t>(steps_ >> 44)});
    ++steps_;
    expansions_ = contractions_ = 0;
    const std::size_t middle = size() / 2;
    for (const Half& half : {Half{0, middle, middle, size()}, Half{middle, size(), 0, middle}})
        move_ == EnsembleMove::stretch ? stretch(half) : slice(half);
    if (!adapt || move_ == EnsembleMove::stretch) return;
    // Karamanis and Beutler, equation 9: as many expansions as contractions; with gains that fall, so that noise
    // averages out.
    const double e = static_cast<double>(std::max<std::uint64_t>(1, expansions_));
    const double factor = 2 * e / (e + static_cast<double>(contractions_));
    width_ *= std::pow(factor, 1 / std::sqrt(static_cast<double>(++adaptations_)));
}

std::size_t WalkerEnsemble::choose(std::size_t begin, std::size_t end) {
    const double u = numbers_.next_double();
    return begin + static_cast<std::size_t>(u * static_cast<double>(end - begin));
}

void WalkerEnsemble::evaluate() {
    answers_.resize(asked_.size() / d_);
    density_(asked_, answers_);
}

void WalkerEnsemble::stretch(const Half& half) {
    asked_.resize((half.end - half.begin) * d_);
    std::vector<std::pair<double, double>>
        draws; // log of the factor of the acceptance, and the number to compare it
    for (std::size_t i = half.begin; i < half.end; ++i) {
        const std::size_t other = choose(half.other_begin, half.other_end);
        // The factor z has a density proportional to 1 / sqrt z on [1 / a, a].
        const double root = 1 + (longest_stretch - 1) * numbers_.next_double();
        const double z = root * root / longest_stretch;
        for (std::size_t k = 0; k < d_; ++k)
            asked_[(i - half.begin) * d_ + k] =
                x_[other * d_ + k] + z * (x_[i * d_ + k] - x_[other * d_ + k]);
        draws.emplace_back((static_cast<double>(d_) - 1) * std::log(z), numbers_.next_double());
    }
    evaluate();
    for (std::size_t i = half.begin; i < half.end; ++i) {
        const std::size_t at = i - half.begin;
        if (!(draws[at].second < acceptance_of_log_ratio(draws[at].first + answers_[at] - log_p_[i])))
            continue;
        std::copy_n(asked_.begin() + static_cast<std::ptrdiff_t>(at * d_), d_,
                    x_.begin() + static_cast<std::ptrdiff_t>(i * d_));
        log_p_[i] = answers_[at];
        ++moved_;
    }
}

void WalkerEnsemble::slice(const Half& half) {
    std::vector<Slice> open;
    for (std::size_t i = half.begin; i < half.end; ++i) {
        const std::size_t a = choose(half.other_begin, half.other_end);
        const std::size_t b = choose(half.other_begin, half.other_end - 1);
        const std::size_t other = b < a ? b : b + 1; // not a
        Slice s;
        s.walker = i;
        for (std::size_t k = 0; k < d_; ++k)
            s.direction.push_back(width_ * (x_[a * d_ + k] - x_[other * d_ + k]));
        // Neal 2003, "Slice Sampling", section 4.1 and figure 3: stepping out by at most m in all, divided at random
        // between the two ends.
        s.level = log_p_[i] + std::log(1 - numbers_.next_double());
        s.left = -numbers_.next_double();
        s.right = s.left + 1;
        s.left_steps = static_cast<int>(numbers_.next_double() * most_expansions);
        s.right_steps = most_expansions - 1 - s.left_steps;
        open.push_back(std::move(s));
    }
    // All slices at once, each with the point that it asks for next.
    while (!open.empty()) {
        asked_.clear();
        for (Slice& s : open) {
            if (s.phase == Slice::Phase::shrink)
                s.t = s.left + (s.right - s.left) * numbers_.next_double();
            else
                s.t = s.phase == Slice::Phase::left ? s.left : s.right;
            for (std::size_t k = 0; k < d_; ++k)
                asked_.push_back(x_[s.walker * d_ + k] + s.t * s.direction[k]);
        }
        evaluate();
        std::size_t kept = 0;
        for (std::size_t n = 0; n < open.size(); ++n) {
            Slice& s = open[n];
            const bool inside = answers_[n] >= s.level;
            bool done = false;
            if (s.phase == Slice::Phase::left) {
                if (inside && s.left_steps > 0) {
                    s.left -= 1;
                    --s.left_steps;
                    ++expansions_;
                } else {
                    s.phase = Slice::Phase::right;
                }
            } else if (s.phase == Slice::Phase::right) {
                if (inside && s.right_steps > 0) {
                    s.right += 1;
                    --s.right_steps;
                    ++expansions_;
                } else {
                    s.phase = Slice::Phase::shrink;
                }
            } else if (inside) {
                std::copy_n(asked_.begin() + static_cast<std::ptrdiff_t>(n * d_), d_,
                            x_.begin() + static_cast<std::ptrdiff_t>(s.walker * d_));
                log_p_[s.walker] = answers_[n];
                ++moved_;
                done = true;
            } else {
                (s.t < 0 ? s.left : s.right) = s.t;
                ++contractions_;
                // A density that is a function contains x itself in every slice; only one that is none comes here.
                done = ++s.contractions == most_contractions;
            }
            if (done) continue;
            if (kept != n) open[kept] = std::move(s);
            ++kept;
        }
        open.erase(open.begin() + static_cast<std::ptrdiff_t>(kept), open.end());
    }
}

} // namespace montelux
