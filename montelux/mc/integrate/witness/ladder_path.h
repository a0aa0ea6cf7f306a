// Ladders of points by which a first look walks towards the places where peaks and poles usually lie.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "montelux/mc/integrate/domain.h"
#include "montelux/mc/integrate/infinity.h"

namespace montelux {

// Exponents of the distances of a ladder of points, in units of the cube's width.
inline constexpr std::array<double, 6> ladder{3, 8, 15, 24, 36, 50};

struct Anchor {
    double u, finest; // exponent of the smallest distance that the coordinate resolves
};

// A ladder towards a point: u_d = anchor_d + side_d reach_d 2^(-rate_d k) for the variables that move.
struct LadderPath {
    std::vector<Anchor> anchors;
    std::vector<double> side; // 0: the variable does not move
    std::vector<double> reach;
    std::vector<int> rates = {};  // empty: 1
    double precise_to = infinity; // exponent beyond which values are noise
    bool is_diagonal = false;     // the same part of the way to the end in each variable
    double thickness = infinity;  // of a ridge on which a diagonal lies, in units of the reach

    int rate(std::size_t d) const { return side[d] == 0 ? 0 : rates.empty() ? 1 : rates[d]; }
    // Shells at k have a volume of 2^(-k codimension).
    int codimension() const;
    double finest() const;
    // Exponent of a shell of its ladder.
    double exponent(std::size_t shell) const {
        return ladder[shell] * std::min(finest(), ladder.back()) / ladder.back();
    }
    // Exponent of the distance between zero and the range's end where that is small, else infinity. Functions that grow towards
    // zero are constant in shells beyond it.
    double end() const;
    // Volume of the shell around the anchor; `across`: widths in the variables that do not move. On a ridge
    // only a layer of the shell.
    double volume(double exponent, const std::vector<double>& across) const;
    std::vector<double> at(double exponent) const;
    // The box of what is closer to the anchor, on this side; all of the variables that do not move.
    std::pair<std::vector<double>, std::vector<double>> within(double exponent) const;
};

// The ladders of one look. (seed, order of the calls) determine what is random.
class LadderPaths {
  public:
    // `landmarks`: points near which features may lie. Of a box, a coordinate outside of its range stands for the range's
    // centre; of another domain of up to eight variables, a point stands for the nearest one.
    // `places`: points of the cube that climbs found, which come first.
    LadderPaths(const Domain& domain, std::size_t dimensions, std::span<const std::vector<double>> landmarks,
                std::span<const std::vector<double>> places, std::uint64_t seed);

    // Ends, centre and origin of a variable, and the landmarks' coordinates.
    std::span<const Anchor> anchors(std::size_t d) const { return anchors_[d]; }
    // Both sides of each anchor of a variable, the others fixed; or of its ends alone.
    std::vector<LadderPath> along(std::size_t d, const std::vector<double>& through, bool ends = false) const;
    // All variables at once: each place, each corner of up to three variables, and some with an anchor of its own in each
    // variable.
    std::vector<LadderPath> joint();
    // Further ladders to a corner (`place`: 0 or 1 per variable): on them one variable falls with the square of the others
    // or the others with its, since x + y^2 has two scales.
    std::vector<LadderPath> of_two_scales(const std::vector<double>& place) const;
    LadderPath to_random_corner();
    std::vector<double> generic_point();
    // Other directions to the same anchors.
    void vary(LadderPath& path);
    // Scales at which the coordinates that do not move were found: distances from the nearest of their anchors.
    std::vector<double> widths(const LadderPath& path) const;

  private:
    double random();
    Anchor anchor(std::size_t d, double x) const;
    // Place of a point of a box; empty where no coordinate is inside.
    std::vector<Anchor> place_in_ranges(const std::vector<double>& x) const;
    // Place whose point of the domain is nearest.
    std::vector<Anchor> nearest_place(const std::vector<double>& x) const;
    // Adds a place, unless it is one already, or empty.
    void add_place(std::vector<Anchor> place);
    LadderPath to_corner(const std::vector<double>& place, std::vector<int> rates = {}) const;

    const Domain& domain_;
    std::size_t n_;
    std::uint64_t seed_, drawn_ = 0;
    std::vector<std::vector<Anchor>>
        anchors_; // of each variable: its ends, its centre, the origin, the landmarks
    std::vector<std::vector<Anchor>> places_; // the same as points
};

} // namespace montelux
