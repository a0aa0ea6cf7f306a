// Fits a mixture density to an integrand, round by round.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "montelux/mc/integrate/adaptive/difference_walk.h"
#include "montelux/mc/integrate/adaptive/mixture_sampling.h"
#include "montelux/mc/integrate/adaptive/mode_search.h"

namespace montelux {

// Each round draws points from the density fitted so far and fits it again to the last rounds; the weights
// become more even, and so does the fit. The rounds' estimates of the integral do not enter the final one,
// which is therefore unbiased; they only check it.
class DensityTrainer {
  public:
    DensityTrainer(const Problem& problem, int uniform_units);

    // Granularity of the channels' shares from now on: with coarser shares fewer points divide exactly.
    void set_share_step(int step) { share_step_ = step; }
    // Takes the uniform points of the exploration; again after it continued.
    void start(SamplePoints&& points);
    // Over the points last taken: number of non-zero points, and effective number, (sum h)^2 / sum h^2, of
    // |g|.
    std::uint64_t nonzero() const { return nonzero_; }
    double effective_share() const { return effective_share_; }
    // Are values of one size wherever they are not zero, as those of indicators?
    bool flat_where_nonzero() const { return flat_size_ > 0; }
    // Whether these values are of that size, to within a factor of 2.
    bool is_of_flat_size(const std::vector<double>& values) const;

    // Searches for peaks until this many searches in a row lead to known ones; evaluations() counts the cost.
    void find_peaks(std::uint64_t max_evaluations, int fruitless = ModeSearch().fruitless,
                    std::uint64_t survey = 0);
    // Peaks that the last search found, and the points from which it chose where to begin.
    std::uint64_t peaks() const { return peaks_; }
    std::uint64_t searched_points() const { return searched_points_; }
    std::uint64_t search_evaluations() const { return search_evaluations_; } // of all searches
    // One round of n points, about (a multiple of what the density divides exactly). False when cancelled:
    // nothing changed.
    bool round(std::uint64_t n, const StepRequest& request);
    // Whether a round of n points ends before the deadline, at the last round's time per point. True without one: the
    // time is not saved, since another machine may resume.
    bool has_time_for(std::uint64_t n, const StepRequest& request) const;
    // Walks under |g| from points of the last round, and returns the share of the integral that lies where n
    // points of the density are expected to hit too rarely for their spread to tell. The next fit sees the
    // walked points.
    // Empty if the evaluations are too few for a walk.
    std::optional<double> unseen_share(double n, std::uint64_t max_evaluations);

    const MixtureDensity& density() const { return density_; }
    int rounds() const { return rounds_; }
    std::uint64_t evaluations() const { return evaluations_; }
    const NonFiniteCount& non_finite() const { return non_finite_; }
    // Relative variance of g / q within channels, of the last round.
    double relative_variance() const { return relative_variance_; }
    // Share of the integral, in the last rounds, at points where h / q is far above its mean: places that the
    // density does not cover.
    double uncovered_share() const { return uncovered_share_; }
    static constexpr double uncovered_matters = 2e-3; // above which it matters
    // With more variables there are no Gaussians, whose covariances grow with the square, and no walkers.
    static constexpr int max_gaussian_dimensions = 32;
    // The last two rounds' estimates of the first component, with variances as of independent points.
    struct Check {
        double value = 0, variance = 0;
    };
    const std::vector<Check>& checks() const { return checks_; }

    void save(StateWriter& state) const;
    void load(StateReader& state);

  private:
    struct Round {
        MixtureDensity density;
        PointBuffer x;
        std::vector<double> h, p; // p: the density there
        // Of h^exponent, estimated by its points.
        double integral(double exponent) const;
    };
    // The points of all recent rounds, and those remembered; p is the mixture of the rounds' densities.
    struct Pool {
        PointBuffer x;
        std::vector<double> h, p;
    };
    // One number for all components: the root of the sum of squares, each relative to its mean size.
    std::vector<double> steering(const ValueBuffer& g) const;
    // The same at points, counted.
    DensityFunction counted_steering(std::uint64_t& evaluations, NonFiniteCount& non_finite) const;
    // Are weights so uneven, or is so much uncovered, that Gaussians must be fitted again?
    bool lacking(int rounds, double relative_variance) const;
    struct Walk {
        WalkedPoints points;
        std::uint64_t evaluations = 0;
        NonFiniteCount non_finite;
    };
    // Continues a walk, or starts at points of the round just drawn. `traces`: some walkers begin on crests of
    // ridges, of which they could not reach the ends.
    Walk walk(const WalkedPoints& before, const Round& last, std::uint64_t max_evaluations,
              std::size_t longest, double exponent, bool traces = false) const;
    // Returns false when stopped; round() then restores the state.
    bool fit(const std::function<bool()>& stop);
    // Empty when stopped.
    std::optional<Pool> pool(const std::function<bool()>& stop) const;
    void remember(const Pool& all, std::span<const double> ratios);

    Problem problem_;
    int uniform_units_, share_step_ = 1;
    MixtureDensity density_;
    std::vector<double> scale_; // one per component
    std::vector<Round> recent_; // two at most
    // Points of all rounds with the greatest h / q at the time, so that later rounds do not forget them.
    PointBuffer remembered_;
    std::vector<double> remembered_h_;
    WalkedPoints walked_; // of the last walk,
    WalkedPoints scouts_; // and of the last check
    std::vector<Check> checks_;
    int rounds_ = 0, walks_ = 0;
    bool enriched_ = false;
    double flat_size_ = 0; // of values that are not zero; 0 where they differ
    double relative_variance_ = 0, effective_share_ = 0, uncovered_share_ = 0;
    std::uint64_t nonzero_ = 0, evaluations_ = 0, peaks_ = 0, searched_points_ = 0, search_evaluations_ = 0;
    NonFiniteCount non_finite_;
    double seconds_per_point_ = 0; // of the last round, its fit included
};

} // namespace montelux
