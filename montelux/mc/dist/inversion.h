// The inversion method as a recipe: a sampler for any non-negative function on an interval.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "montelux/mc/dist/distribution_1d.h"
#include "montelux/mc/dist/inversion_pieces.h"
#include "montelux/mc/dist/search.h"
#include "montelux/mc/math/compensated.h"
#include "montelux/mc/math/increasing_root.h"

namespace montelux {

struct InversionOptions {
    // Where f is infinite, jumps, or has a narrow peak, inside the interval: panels end there and are graded
    // towards it. Any order.
    std::vector<double> break_points = {};
    // Of c, relative. What was reached is relative_error().
    double tolerance = 1e-12;
};

// F is integrated panel by panel (Gauss-Legendre, the worst panel halved until the total settles), so that
// c = F(b) - F(a); then P(x) = (F(x) - F(a)) / c, the density is f / c, and X = P^-1(xi) by bisection over
// the panels and safeguarded Newton steps within one. a may be -infinity and b infinity. f may jump, and be
// infinite at a, at b and at break points as long as it is integrable there: next to a point x0, f is only
// resolved down to distances of |x0| epsilon, so put strong singularities at 0. Found without help are
// features wider than a 256th of the interval and, next to 0, finite ends and break points, at scales from
// 1e-7 to 1e7; give narrower peaks a break point. Satisfies TwoTailedDistribution1D; the error of P is
// absolute, about the tolerance.
template <typename F>
class NumericalInversion : public SampledByInversion<NumericalInversion<F>> {
  public:
    // Throws Error when the interval or a break point is wrong, f is negative or not finite at a node, f is
    // zero at all of them, or its integral does not settle (f is not integrable).
    NumericalInversion(F f, double a, double b, const InversionOptions& options = {})
        : f_(std::move(f)), a_(a), b_(b), pieces_(inversion_pieces(a, b, options.break_points)) {
        build(options.tolerance);
    }
    NumericalInversion(F f, double a, double b, double tolerance)
        : NumericalInversion(std::move(f), a, b, InversionOptions{{}, tolerance}) {}

    double lower() const { return a_; }
    double upper() const { return b_; }
    // The integral c of f, and the estimate of its relative error.
    double integral() const { return below_.back(); }
    double relative_error() const { return relative_error_; }

    double pdf(double x) const { return x >= a_ && x <= b_ ? f_(x) / integral() : 0; }
    double cdf(double x) const {
        if (!(x > a_)) return 0;
        if (!(x < b_)) return 1;
        std::size_t i = panel_of(x);
        const Panel& panel = panels_[i];
        double part = gauss(panel.piece, panel.from, parameter(panel, x));
        return std::min(below_[i] + part, below_[i + 1]) / integral();
    }
    double cdf_complement(double x) const {
        if (!(x > a_)) return 1;
        if (!(x < b_)) return 0;
        std::size_t i = panel_of(x);
        const Panel& panel = panels_[i];
        double part = gauss(panel.piece, parameter(panel, x), panel.to);
        return std::min(above_[i + 1] + part, above_[i]) / integral();
    }
    double quantile(double xi) const {
        return xi <= 0.5 ? from_left(xi * integral()) : from_right((1 - xi) * integral());
    }
    double quantile_complement(double q) const {
        return q < 0.5 ? from_right(q * integral()) : from_left((1 - q) * integral());
    }

  private:
    // `from` is the parameter of its left end, whether or not it is the smaller one.
    struct Panel {
        std::uint32_t piece;
        double from, to, value;
    };
    // A panel, the values of its halves and how far they are from its own.
    struct Split {
        Panel left, right;
        double error;
        double value() const { return left.value + right.value; }
        bool operator<(const Split& other) const { return error < other.error; }
    };

    // f as a density in the parameter of a piece.
    double density(std::uint32_t piece, double t) const {
        const InversionPiece& p = pieces_[piece];
        return p.jacobian(t, f_(p.x(t)));
    }
    // Eight points, by symmetry, between any two parameters in either order.
    template <typename Function>
    static double gauss(double from, double to, const Function& g) {
        constexpr std::array<double, 4> node{0.1834346424956498, 0.5255324099163290, 0.7966664774136267,
                                             0.9602898564975363};
        constexpr std::array<double, 4> weight{0.3626837833783620, 0.3137066458778873, 0.2223810344533745,
                                               0.1012285362903763};
        double middle = 0.5 * (from + to), half = 0.5 * (to - from), sum = 0;
        if (half == 0) return 0; // where g may be infinite
        for (std::size_t i = 0; i < 4; ++i) {
            double low = g(middle - half * node[i]);
            double high = g(middle + half * node[i]);
            sum += weight[i] * (low + high);
        }
        return sum * std::abs(half);
    }
    double gauss(std::uint32_t piece, double from, double to) const {
        return gauss(from, to, [&](double t) { return density(piece, t); });
    }
    Panel checked_panel(std::uint32_t piece, double from, double to) const {
        auto checked = [&](double t) {
            double x = pieces_[piece].x(t), y = f_(x);
            if (!(y >= 0 && std::isfinite(y))) throw_bad_density(x, y);
            return pieces_[piece].jacobian(t, y);
        };
        return {piece, from, to, gauss(from, to, checked)};
    }
    Split split(const Panel& whole) const {
        double middle = 0.5 * (whole.from + whole.to);
        Panel left = checked_panel(whole.piece, whole.from, middle);
        Panel right = checked_panel(whole.piece, middle, whole.to);
        double error = std::abs(left.value + right.value - whole.value);
        double rounding = 8 * std::numeric_limits<double>::epsilon() * whole.value;
        return {left, right, error > rounding ? error : 0};
    }

    void build(double tolerance) {
        std::vector<Split> open, done; // open is a heap, the worst first; done cannot be halved any more
        for (std::uint32_t piece = 0; piece < pieces_.size(); ++piece)
            for (auto [from, to] : pieces_[piece].first_panels())
                open.push_back(split(checked_panel(piece, from, to)));
        std::make_heap(open.begin(), open.end());
        constexpr int budget = 20000;
        double total = 0, error = 0;
        for (int step = 0; step < budget && !open.empty(); ++step) {
            // Running sums drift where a panel's first value was far off, so they are renewed now and then.
            if (step % 64 == 0) {
                total = error = 0;
                for (const Split& s : done) total += s.value();
                for (const Split& s : open) {
                    total += s.value();
                    error += s.error;
                }
            }
            if (open.front().error == 0 || error <= tolerance * total) break;
            std::pop_heap(open.begin(), open.end());
            Split worst = open.back();
            open.pop_back();
            total -= worst.value();
            error -= worst.error;
            for (const Panel& half : {worst.left, worst.right}) {
                Split next = split(half);
                total += next.value();
                if (pieces_[half.piece].divisible(half.from, half.to)) {
                    error += next.error;
                    open.push_back(next);
                    std::push_heap(open.begin(), open.end());
                } else {
                    done.push_back(next);
                }
            }
        }
        collect(open, done);
    }
    void collect(const std::vector<Split>& open, std::vector<Split>& done) {
        CompensatedSum error;
        std::size_t indivisible = done.size();
        done.insert(done.end(), open.begin(), open.end());
        for (const Split& s : done) {
            panels_.push_back(s.left);
            panels_.push_back(s.right);
            error.add(s.error);
        }
        std::sort(panels_.begin(), panels_.end(), [&](const Panel& p, const Panel& q) {
            if (p.piece != q.piece) return p.piece < q.piece;
            return pieces_[p.piece].rising() ? p.from < q.from : p.from > q.from;
        });
        CompensatedSum left, right;
        below_.assign(1, 0);
        for (const Panel& p : panels_) {
            starts_.push_back(pieces_[p.piece].x(p.from));
            left.add(p.value);
            below_.push_back(std::max(below_.back(), left.value()));
        }
        above_.assign(panels_.size() + 1, 0);
        for (std::size_t i = panels_.size(); i-- > 0;) {
            right.add(panels_[i].value);
            above_[i] = std::max(above_[i + 1], right.value());
        }
        double total = below_.back();
        if (!(total > 0)) throw_no_density(a_, b_);
        relative_error_ = error.value() / total;
        // A panel that cannot be halved any more and still matters, or errors that halving does not shrink.
        for (std::size_t i = 0; i < indivisible; ++i)
            if (done[i].value() > 1e-4 * total)
                throw_not_integrable(pieces_[done[i].left.piece].x(done[i].left.to));
        const Split& worst = *std::max_element(done.begin(), done.end());
        if (!(std::isfinite(total) && relative_error_ < 1e-4))
            throw_not_integrable(pieces_[worst.left.piece].x(worst.left.to));
    }

    std::size_t panel_of(double x) const { return find_last_not_above(starts_.data(), starts_.size(), x); }
    double parameter(const Panel& panel, double x) const {
        double t = pieces_[panel.piece].parameter(x);
        return std::clamp(t, std::min(panel.from, panel.to), std::max(panel.from, panel.to));
    }
    // The x with the integral `target` of f to its left, and to its right.
    double from_left(double target) const {
        std::size_t i = find_last_not_above(below_.data(), panels_.size(), target);
        while (i > 0 && below_[i] == below_[i + 1]) --i;
        return invert(panels_[i], panels_[i].from, panels_[i].to, target - below_[i]);
    }
    double from_right(double target) const {
        // above_ falls: the last entry above the target.
        auto last = std::partition_point(above_.begin(), above_.end(), [&](double v) { return v > target; });
        auto i = static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, last - above_.begin() - 1));
        return invert(panels_[i], panels_[i].to, panels_[i].from, target - above_[i + 1]);
    }
    // The point at which the integral from `anchor` towards `end` is `rest`.
    double invert(const Panel& panel, double anchor, double end, double rest) const {
        if (!(rest > 0)) return pieces_[panel.piece].x(anchor);
        double lo = std::min(anchor, end), hi = std::max(anchor, end);
        double start = anchor + std::min(1.0, rest / panel.value) * (end - anchor);
        double sign = end > anchor ? 1 : -1;
        double t = increasing_root(lo, hi, start, [&](double at) {
            double miss = gauss(panel.piece, anchor, at) - rest;
            return std::pair(sign * miss, density(panel.piece, at));
        });
        return pieces_[panel.piece].x(t);
    }

    F f_;
    double a_, b_, relative_error_ = 0;
    std::vector<InversionPiece> pieces_;
    std::vector<Panel> panels_;         // from left to right
    std::vector<double> starts_;        // x of the left end of each panel
    std::vector<double> below_, above_; // integral left of the start of panel i, and right of it
};

} // namespace montelux
