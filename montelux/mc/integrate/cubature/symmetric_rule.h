// Fully symmetric rules on a box: one value and a graded family of null rules from the same points.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "montelux/mc/integrate/points.h"

namespace montelux {

// Points of [-1, 1]^n, all permutations and changes of sign of a few generators, with weights that integrate
// polynomials up to a degree exactly; and null rules: weights at the same points that give zero for all
// polynomials up to a lower degree, so that their values measure the integrand's distance from such a
// polynomial (Berntsen, Espelid & Genz 1991, "An adaptive algorithm for the approximate calculation of
// multiple integrals"; Berntsen & Espelid 1991, "Error estimation in automatic quadrature routines"). Only
// generators are tabulated: weights and null rules follow from the moment equations.
class SymmetricRule {
  public:
    // Coordinates of a generator that are not zero, each above zero.
    using Generator = std::vector<double>;

    // Weights of a rule of this odd degree on the orbits of the generators, the first of which is the centre.
    // If these leave a choice of weights, that of least square sum is taken. `probe` above zero adds points
    // at this distance on the axes that no rule uses, see edge_surprise(). Throws Error where no weights
    // reach the degree.
    SymmetricRule(int dimensions, int degree, std::vector<Generator> generators, double probe = 0);

    int dimensions() const { return dimensions_; }
    // Polynomials of total degree up to this one are integrated exactly.
    int degree() const { return degree_; }
    std::size_t points() const { return points_.count(); }
    // Points in [-1, 1]^n, orbit after orbit.
    const PointBuffer& offsets() const { return points_; }

    // Null rules, from the highest degree to the lowest, orthonormal with respect to the sum over the points
    // and scaled so that each has the square sum of weights of the rule.
    int null_rules() const { return static_cast<int>(null_degrees_.size()); }
    // Polynomials up to this degree give zero.
    int null_degree(int k) const { return null_degrees_[static_cast<std::size_t>(k)]; }

    // The mean of a function over the box from its values at the points; the values of the null rules go into
    // `nulls`.
    double apply(std::span<const double> values, std::span<double> nulls) const;

    // Distance of the integrand from the rule's polynomials.
    struct Assessment {
        double error; // of the mean over the box: an estimate that should rarely be too small
        double ratio; // the largest ratio of null rules of successive degrees; below 1 they fall, as they do
                      // where the integrand is smooth at the scale of the box
    };
    // Error from the values of the null rules. While they fall by a factor r from degree to degree, it is 4 r
    // times that of the highest degree (the rule's own degree is higher by 2, another factor of r); otherwise
    // the largest of them (Berntsen & Espelid 1991). Values below `rounding` are ignored.
    Assessment assess(std::span<const double> nulls, double rounding = 0) const;

    // An error of the mean in one variable that no even rule sees, from null rules of the part that is odd in x: the
    // largest of them, less where they fall from degree to degree, as if they fell on to the rule's degree. Jumps at -a
    // and b look odd where no point lies between a and b. Zero in several variables.
    double odd_surprise(std::span<const double> values, double rounding = 0) const;

    // How far the integrand is from a cubic along each axis: a tenth of the coefficient of x^4 of the quartic
    // through the centre and two orbits on the axis, and the probes' difference from that quartic, so that a
    // zero of either does not hide an axis. Adds scale times these to `sums`, one per axis. Needs two orbits
    // on the axes.
    void add_roughness(std::span<const double> values, double scale, std::span<double> sums) const;

    // An error of the mean over the box that no rule sees: the probes' difference from the quartic through
    // the points on their axis, beyond 0.8 times its coefficient of x^4, times the part of the box beyond the
    // outermost point. It is large if a jump runs along a face. Zero without probes.
    double edge_surprise(std::span<const double> values) const;

    // Prediction of the middle of a face by the two outermost points on its side of the axis.
    struct FaceValue {
        double value;  // by a straight line through them
        double slack;  // extrapolation beyond the outermost value
        double unseen; // part of the box that lies beyond the outermost point
    };
    // Needs two orbits on the axes, or one and probes.
    FaceValue face_value(std::span<const double> values, int axis, bool upper) const;

  private:
    struct Orbit {
        std::size_t first = 0, count = 0;
    };

    // Along an axis: the coefficient of x^4 of the quartic through its points, and the parts, even and odd in
    // x, by which the probes differ from the quartic.
    struct AxisTerms {
        double quartic, even, odd;
    };
    AxisTerms axis_terms(std::span<const double> values, std::size_t axis) const;
    static PointBuffer orbit(int dimensions, const Generator& generator);
    void solve(const std::vector<Generator>& generators);
    void solve_odd(const std::vector<Generator>& generators);
    // Assessment by the sizes of null rules of the highest degrees, highest first; at least one.
    static Assessment assess_sizes(std::span<const double> sizes, double rounding);

    int dimensions_, degree_;
    PointBuffer points_;
    std::vector<Orbit> orbits_;
    std::vector<double> weights_;      // of a point of each orbit; sum over all points is 1
    std::vector<double> null_weights_; // null rule after null rule, as `weights_`
    std::vector<int> null_degrees_;
    std::vector<double> odd_null_weights_; // of differences over each orbit of two points; one variable
    // The two innermost orbits on the axes, and their distances from the centre.
    std::size_t inner_ = 0, outer_ = 0;
    double inner_at_ = 0, outer_at_ = 0;
    double probe_at_ = 0;
    std::size_t first_probe_ = 0;
    // Where the values of the two outermost sets of points on the axes start, and their distances.
    std::size_t first_last_ = 0, first_before_ = 0;
    double last_at_ = 0, before_at_ = 0;
};

} // namespace montelux
