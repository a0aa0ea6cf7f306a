#include "montelux/mc/dist/piecewise_1d.h"

#include <cmath>
#include <sstream>

#include "montelux/mc/dist/weights.h"
#include "montelux/mc/math/compensated.h"
#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

void check_interval(const char* where, double lower, double upper) {
    if (lower < upper && std::isfinite(upper - lower)) return;
    std::ostringstream what;
    what << "the interval [" << lower << ", " << upper << "] is empty or not finite";
    throw Error(where, what.str());
}

} // namespace

PiecewiseConstant1D::PiecewiseConstant1D(std::span<const double> values, double lower, double upper)
    : lower_(lower), upper_(upper) {
    build(values);
}
PiecewiseConstant1D::PiecewiseConstant1D(std::span<const float> values, double lower, double upper)
    : lower_(lower), upper_(upper) {
    build(values);
}

template <typename T>
void PiecewiseConstant1D::build(std::span<const T> values) {
    double sum = checked_weight_sum("PiecewiseConstant1D", values);
    check_interval("PiecewiseConstant1D", lower_, upper_);
    std::vector<double> weights(values.begin(), values.end());
    DiscreteDistribution pieces(weights);
    cdf_.resize(values.size() + 1);
    for (std::size_t i = 0; i < values.size(); ++i) cdf_[i + 1] = pieces.cdf(i);
    width_ = (upper_ - lower_) / static_cast<double>(values.size());
    integral_ = sum * width_;
}

PiecewiseLinear1D::PiecewiseLinear1D(std::span<const double> x, std::span<const double> f)
    : x_(x.begin(), x.end()), density_(f.begin(), f.end()) {
    if (x.size() != f.size()) throw Error("PiecewiseLinear1D", "expected as many values as nodes");
    build();
}
PiecewiseLinear1D::PiecewiseLinear1D(std::span<const double> f, double lower, double upper)
    : x_(f.size()), density_(f.begin(), f.end()) {
    check_interval("PiecewiseLinear1D", lower, upper);
    for (std::size_t i = 0; i < f.size(); ++i) {
        double t = static_cast<double>(i) / static_cast<double>(f.size() - 1);
        x_[i] = lower + (upper - lower) * t;
    }
    if (f.size() > 1) x_.back() = upper;
    build();
}

void PiecewiseLinear1D::build() {
    checked_weight_sum("PiecewiseLinear1D", std::span<const double>(density_));
    if (x_.size() < 2) throw Error("PiecewiseLinear1D", "expected at least two nodes");
    std::size_t n = size();
    std::vector<double> area(n);
    CompensatedSum sum;
    for (std::size_t i = 0; i < n; ++i) {
        check_interval("PiecewiseLinear1D", x_[i], x_[i + 1]);
        area[i] = 0.5 * (density_[i] + density_[i + 1]) * (x_[i + 1] - x_[i]);
        sum.add(area[i]);
    }
    integral_ = sum.value();
    if (!(integral_ > 0)) {
        density_.assign(n + 1, 1);
        for (std::size_t i = 0; i < n; ++i) area[i] = x_[i + 1] - x_[i];
        integral_ = 0;
    }
    DiscreteDistribution pieces(area);
    cdf_.resize(n + 1);
    for (std::size_t i = 0; i < n; ++i) cdf_[i + 1] = pieces.cdf(i);
    for (double& d : density_) d /= pieces.weight_sum();
}

PiecewiseLinear1D::Inverted PiecewiseLinear1D::invert_cdf(double u) const {
    std::size_t i = find_last_not_above(cdf_.data(), size(), u);
    while (i > 0 && cdf_[i] == cdf_[i + 1]) --i;
    double h = x_[i + 1] - x_[i], a = density_[i], b = density_[i + 1];
    // Solve a t + (b - a) t^2 / 2 = q with t in [0, 1]; this form of the root has no cancellation, and
    // holds for a = b as well.
    double q = std::max(0.0, u - cdf_[i]) / h;
    double root = std::sqrt(std::max(0.0, a * a + 2 * (b - a) * q));
    double t = a + root > 0 ? std::min(2 * q / (a + root), 1.0) : 0.0;
    return {x_[i] + t * h, a + t * (b - a), i};
}

double PiecewiseLinear1D::density(double x) const {
    if (!(x >= lower() && x <= upper())) return 0;
    std::size_t i = find_last_not_above(x_.data(), size(), x);
    double t = (x - x_[i]) / (x_[i + 1] - x_[i]);
    return density_[i] + t * (density_[i + 1] - density_[i]);
}

double PiecewiseLinear1D::integral_to(double x) const {
    std::size_t i = find_last_not_above(x_.data(), size(), x);
    double h = x_[i + 1] - x_[i], t = (x - x_[i]) / h;
    double q = t * density_[i] + 0.5 * t * t * (density_[i + 1] - density_[i]);
    return std::min(cdf_[i] + q * h, 1.0);
}

} // namespace montelux
