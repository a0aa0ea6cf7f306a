#include "montelux/mc/stats/chi_squared.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <sstream>

#include "montelux/mc/math/compensated.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/math/special.h"

namespace montelux {
namespace {

// Gauss-Legendre nodes and weights of four points on [-1, 1].
constexpr std::array<double, 4> nodes{-0.8611363115940526, -0.3399810435848563, 0.3399810435848563,
                                      0.8611363115940526};
constexpr std::array<double, 4> weights{0.3478548451374538, 0.6521451548625461, 0.6521451548625461,
                                        0.3478548451374538};

using Density = std::function<double(Vec2d)>;

double gauss(const Density& f, Vec2d lower, Vec2d upper) {
    Vec2d middle = (lower + upper) * 0.5, half = (upper - lower) * 0.5;
    double sum = 0;
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j)
            sum += weights[i] * weights[j] * f({middle.x + half.x * nodes[i], middle.y + half.y * nodes[j]});
    return sum * half.x * half.y;
}

// The tolerance halves with each level: a quarter of the area may carry half of the error, which edges
// of supports need.
double adaptive(const Density& f, Vec2d lower, Vec2d upper, double whole, double tolerance, int depth) {
    Vec2d middle = (lower + upper) * 0.5;
    std::array<std::array<Vec2d, 2>, 4> quarters{{{lower, middle},
                                                  {Vec2d{middle.x, lower.y}, Vec2d{upper.x, middle.y}},
                                                  {Vec2d{lower.x, middle.y}, Vec2d{middle.x, upper.y}},
                                                  {middle, upper}}};
    std::array<double, 4> parts;
    for (std::size_t q = 0; q < 4; ++q) parts[q] = gauss(f, quarters[q][0], quarters[q][1]);
    double sum = parts[0] + parts[1] + parts[2] + parts[3];
    constexpr int first_depth = 1, last_depth = 7; // always splits once, so that no peak is missed
    if (depth >= first_depth && (std::abs(sum - whole) <= tolerance || depth >= last_depth)) return sum;
    double total = 0;
    for (std::size_t q = 0; q < 4; ++q)
        total += adaptive(f, quarters[q][0], quarters[q][1], parts[q], 0.5 * tolerance, depth + 1);
    return total;
}

} // namespace

TestResult chi_squared_test(std::span<const double> observed, std::span<const double> expected,
                            double pool_below) {
    if (observed.size() != expected.size())
        throw Error("chi_squared_test", "expected one expectation a count");
    double total = std::accumulate(observed.begin(), observed.end(), 0.0);
    std::vector<std::size_t> order(expected.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](auto a, auto b) { return expected[a] < expected[b]; });

    TestResult r;
    double impossible = 0, statistic = 0, last_expected = 0, last_observed = 0;
    int pools = 0;
    double e = 0, o = 0;
    bool valid = true;
    for (std::size_t i : order) {
        valid = valid && expected[i] >= 0; // NaN fails too
        if (expected[i] < 1e-9 * total) impossible += observed[i];
        e += expected[i];
        o += observed[i];
        if (e < pool_below) continue;
        statistic += (o - e) * (o - e) / e;
        last_expected = e;
        last_observed = o;
        ++pools;
        e = o = 0;
    }
    if ((e > 0 || o > 0) && pools > 0) { // what is left joins the last pool
        statistic -= (last_observed - last_expected) * (last_observed - last_expected) / last_expected;
        double oo = last_observed + o, ee = last_expected + e;
        statistic += (oo - ee) * (oo - ee) / ee;
    }
    r.statistic = statistic;
    r.degrees_of_freedom = pools - 1;
    bool outside = impossible > 1e-4 * total;
    std::ostringstream s;
    if (!valid || outside || pools == 0) {
        r.p_value = 0;
        s << (!valid ? "an expectation is negative or not a number"
                     : (outside ? "samples fell where the density is zero: " : "nothing to test"));
        if (valid && outside) s << impossible << " of " << total;
    } else {
        r.p_value = pools == 1 ? 1 : chi_squared_p_value(statistic, r.degrees_of_freedom);
        s << "chi-squared = " << statistic << " with " << r.degrees_of_freedom << " degrees of freedom, "
          << total << " samples, p = " << r.p_value;
    }
    r.description = s.str();
    return r;
}

CellCounts::CellCounts(Vec2d lower, Vec2d upper, int cells_x, int cells_y)
    : lower_(lower), upper_(upper), nx_(cells_x), ny_(cells_y) {
    if (!(cells_x > 0 && cells_y > 0 && lower.x < upper.x && lower.y < upper.y))
        throw Error("CellCounts", "expected at least one cell and a rectangle that is not empty");
    observed_.resize(static_cast<std::size_t>(nx_) * static_cast<std::size_t>(ny_));
}

void CellCounts::add(Vec2d p) {
    if (!(p.x >= lower_.x && p.x <= upper_.x && p.y >= lower_.y && p.y <= upper_.y)) {
        ++failures_;
        return;
    }
    ++total_;
    auto cell = [](double v, double lo, double hi, int n) {
        return std::min(static_cast<int>((v - lo) / (hi - lo) * n), n - 1);
    };
    int i = cell(p.x, lower_.x, upper_.x, nx_), j = cell(p.y, lower_.y, upper_.y, ny_);
    observed_[static_cast<std::size_t>(j) * nx_ + i] += 1;
}

TestResult CellCounts::test(const std::function<double(Vec2d)>& pdf, double pool_below) const {
    double n = static_cast<double>(total_ + failures_);
    if (!(n > 0)) throw Error("CellCounts", "no samples were added");
    std::vector<double> observed = observed_, expected(observed_.size());
    Vec2d cell{(upper_.x - lower_.x) / nx_, (upper_.y - lower_.y) / ny_};
    CompensatedSum integral;
    for (int j = 0; j < ny_; ++j)
        for (int i = 0; i < nx_; ++i) {
            Vec2d lo{lower_.x + i * cell.x, lower_.y + j * cell.y}, hi = lo + cell;
            double rough = gauss(pdf, lo, hi);
            // A small part of the standard deviation of the count, for the coarser of the two rules.
            double tolerance = 0.02 * std::sqrt((std::max(rough, 0.0) + 1 / n) / n);
            double p = adaptive(pdf, lo, hi, rough, tolerance, 0);
            expected[static_cast<std::size_t>(j) * nx_ + i] = n * p;
            integral.add(p);
        }
    double missing = 1 - integral.value();
    // A smaller error of the total would add less than 1 to the statistic; the quadrature is far more
    // accurate. A density that integrates to more than 1 is wrong.
    double slack = 1 / std::sqrt(n);
    if (missing < -slack) {
        TestResult r;
        std::ostringstream s;
        s << "the density integrates to " << integral.value() << ", more than 1";
        r.description = s.str();
        return r;
    }
    if (failures_ > 0 || missing > slack) {
        observed.push_back(static_cast<double>(failures_));
        expected.push_back(n * std::max(0.0, missing));
    }
    TestResult r = chi_squared_test(observed, expected, pool_below);
    std::ostringstream s;
    s << r.description << "; density integrates to " << integral.value() << ", " << failures_ << " of " << n
      << " samples failed or fell outside";
    r.description = s.str();
    return r;
}

} // namespace montelux
