// The inversion method as a recipe: a sampler for any non-negative function on an interval.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <sstream>
#include <utility>
#include <vector>

#include "montelux/mc/dist/search.h"
#include "montelux/mc/math/compensated.h"
#include "montelux/mc/math/error.h"

namespace montelux {

// F is integrated panel by panel (Gauss-Legendre, panels halved until they agree), so that c = F(b) - F(a);
// then P(x) = (F(x) - F(a)) / c, the density is f / c, and X = P^-1(xi) by bisection over the panels and
// safeguarded Newton steps within one. f may jump, and may be infinite at a and b as long as it is
// integrable. A peak narrower than (b - a) / 256 can be missed: give such an f in pieces. Satisfies
// Distribution1D.
template <typename F>
class NumericalInversion {
  public:
    // Throws Error when [a, b] is empty or infinite, f is negative or not finite at a node, or f is zero
    // at all of them. The relative tolerance is that of c.
    NumericalInversion(F f, double a, double b, double tolerance = 1e-12) : f_(std::move(f)) {
        if (!(a < b && std::isfinite(b - a)))
            throw Error("NumericalInversion", "expected a finite interval that is not empty");
        constexpr int first_panels = 32;
        CompensatedSum rough;
        std::array<double, first_panels> whole;
        auto edge = [&](int i) { return i == first_panels ? b : a + (b - a) * i / first_panels; };
        for (int i = 0; i < first_panels; ++i) {
            whole[i] = gauss(edge(i), edge(i + 1), true);
            rough.add(whole[i]);
        }
        edges_.push_back(a);
        cumulative_.push_back(0);
        CompensatedSum total;
        for (int i = 0; i < first_panels; ++i)
            refine(edge(i), edge(i + 1), whole[i], tolerance * rough.value() / first_panels, 0, total);
        if (!(cumulative_.back() > 0))
            throw Error("NumericalInversion",
                        "the function is zero wherever it was asked; it has no density");
    }

    double lower() const { return edges_.front(); }
    double upper() const { return edges_.back(); }
    // The integral c of f.
    double integral() const { return cumulative_.back(); }
    double pdf(double x) const { return x >= lower() && x <= upper() ? f_(x) / integral() : 0; }
    double cdf(double x) const {
        if (x <= lower()) return 0;
        if (x >= upper()) return 1;
        std::size_t i = find_last_not_above(edges_.data(), edges_.size() - 1, x);
        return std::min(1.0, (cumulative_[i] + gauss(edges_[i], x, false)) / integral());
    }
    // xi in [0, 1).
    double quantile(double xi) const {
        double target = xi * integral();
        std::size_t i = find_last_not_above(cumulative_.data(), cumulative_.size() - 1, target);
        while (i > 0 && cumulative_[i] == cumulative_[i + 1]) --i; // only for xi >= 1, outside the contract
        double start = edges_[i], lo = start, hi = edges_[i + 1];
        double rest = target - cumulative_[i], share = rest / (cumulative_[i + 1] - cumulative_[i]);
        double x = lo + std::clamp(share, 0.0, 1.0) * (hi - lo);
        for (int step = 0; step < 100; ++step) {
            double miss = gauss(start, x, false) - rest, slope = f_(x);
            (miss > 0 ? hi : lo) = x;
            double next = x - miss / slope;
            if (!(next > lo && next < hi)) next = lo + 0.5 * (hi - lo);
            if (std::abs(next - x) <= 1e-15 * std::max(std::abs(x), upper() - lower())) return next;
            x = next;
        }
        return x;
    }

  private:
    // Eight points on [-1, 1], by symmetry.
    double gauss(double a, double b, bool check) const {
        constexpr std::array<double, 4> node{0.1834346424956498, 0.5255324099163290, 0.7966664774136267,
                                             0.9602898564975363};
        constexpr std::array<double, 4> weight{0.3626837833783620, 0.3137066458778873, 0.2223810344533745,
                                               0.1012285362903763};
        double middle = 0.5 * (a + b), half = 0.5 * (b - a), sum = 0;
        for (std::size_t i = 0; i < 4; ++i)
            for (double x : {middle - half * node[i], middle + half * node[i]}) {
                double y = f_(x);
                if (check && !(y >= 0 && std::isfinite(y))) {
                    std::ostringstream what;
                    what << "the function is " << y << " at x = " << x
                         << "; expected a finite number that is not negative";
                    throw Error("NumericalInversion", what.str());
                }
                sum += weight[i] * y;
            }
        return sum * half;
    }
    void refine(double a, double b, double whole, double tolerance, int depth, CompensatedSum& total) {
        double middle = 0.5 * (a + b), left = gauss(a, middle, true), right = gauss(middle, b, true);
        constexpr int first_depth = 1, last_depth = 44; // halved so often, a panel is lost in rounding
        bool agree = std::abs(left + right - whole) <= tolerance;
        if ((depth >= first_depth && agree) || depth >= last_depth) {
            for (auto [end, part] : {std::pair(middle, left), std::pair(b, right)}) {
                total.add(part);
                edges_.push_back(end);
                cumulative_.push_back(std::max(cumulative_.back(), total.value()));
            }
            return;
        }
        refine(a, middle, left, tolerance, depth + 1, total);
        refine(middle, b, right, tolerance, depth + 1, total);
    }

    F f_;
    std::vector<double> edges_, cumulative_; // of the panels; integral of f from a to each edge
};

} // namespace montelux
