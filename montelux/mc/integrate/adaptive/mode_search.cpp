#include "montelux/mc/integrate/adaptive/mode_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "montelux/mc/integrate/unit_points.h"
#include "montelux/mc/random/hash.h"

namespace montelux {
namespace {

constexpr double nowhere = -std::numeric_limits<double>::max();
constexpr double least_excess = 3; // of log h above what known modes explain, for another search
constexpr double first_difference = 0.02, close_difference = 5e-4,
                 least_difference = 1e-8;                    // of coordinates, in widths of the cube
constexpr double longest_step = 0.3;                         // of a coordinate
constexpr double of_last_step = 0.01, least_at_pole = 1e-13; // differences on the way to a pole
// Variables up to which a step takes the whole matrix of curvatures.
constexpr std::size_t whole_curvature = 6;
constexpr std::array survey_scales{3.0, 6.0, 12.0, 24.0}; // standard deviations around a mode
constexpr std::size_t surveyed_modes = 2;
// Distance that climbing keeps from the faces, and its bound by the known width of a peak: differences, which reach half as
// far, must show curvatures there.
constexpr double least_coordinate = 1e-6, least_of_extent = 1e-3;

class Climber {
  public:
    // `to_poles`: where h is infinite log h is convex, and differences must become smaller with the steps.
    Climber(const DensityFunction& h, int dimensions, std::uint64_t budget, bool to_poles = false)
        : h_(h), n_(static_cast<std::size_t>(dimensions)), budget_(budget), to_poles_(to_poles) {}

    std::uint64_t left() const { return budget_; }

    // log h at points of the cube; far below everything outside it.
    std::vector<double> log_at(const std::vector<std::vector<double>>& points) {
        PointBuffer x(points.size(), static_cast<int>(n_));
        std::vector<char> inside(points.size(), 1);
        for (std::size_t i = 0; i < points.size(); ++i)
            for (std::size_t d = 0; d < n_; ++d) {
                inside[i] = inside[i] && points[i][d] > 0 && points[i][d] < 1;
                x(i, static_cast<int>(d)) = std::clamp(points[i][d], 1e-12, 1 - 1e-12);
            }
        std::vector<double> values(points.size());
        h_(x, values);
        budget_ -= std::min<std::uint64_t>(budget_, points.size());
        for (std::size_t i = 0; i < points.size(); ++i)
            values[i] = inside[i] && values[i] > 0 ? std::log(values[i]) : nowhere;
        return values;
    }

    // Moves x uphill, by Newton steps with a backtracking line search; returns log h there. `width`: of
    // the first differences.
    double climb(std::vector<double>& x, double width = first_difference, double least = least_coordinate) {
        double top = log_at({x})[0];
        const double least_width = to_poles_ ? least_at_pole : std::min(least_difference, 1e-3 * width);
        constexpr std::array lengths{1.0, 0.4, 0.16, 0.064, 0.026, 0.01};
        for (int step = 0; step < 60 && budget_ >= 2 * n_ + lengths.size(); ++step) {
            std::vector<std::vector<double>> around;
            std::vector<double> h(n_);
            for (std::size_t d = 0; d < n_; ++d) {
                h[d] = std::min({width, 0.5 * x[d], 0.5 * (1 - x[d])});
                for (double sign : {1.0, -1.0}) {
                    around.push_back(x);
                    around.back()[d] += sign * h[d];
                }
            }
            const std::vector<double> f = log_at(around);
            if (std::ranges::find(f, nowhere) != f.end()) {
                // Zero there, by a jump or an underflow: takes closer differences.
                width *= 0.3;
                if (width < least_width) break;
                continue;
            }
            double expected = 0;
            const std::vector<double> direction = uphill(x, top, h, f, expected);
            if (!(expected > 1e-3)) {
                if (!to_poles_) break;
                // Differences may reach beyond a pole, where the slope turns.
                width *= 0.3;
                if (width < least_width) break;
                continue;
            }
            std::vector<std::vector<double>> tries;
            const auto add_try = [&](const std::vector<double>& along, double length) {
                tries.push_back(x);
                for (std::size_t d = 0; d < n_; ++d)
                    tries.back()[d] = std::clamp(x[d] + length * along[d], least, 1 - least);
            };
            if (to_poles_) // one of these is exact where h is infinite on a plane, the others at a point
                for (double length : {1.0, 2.0}) add_try(step_to_pole(h, f), length);
            for (double length : lengths) add_try(direction, length);
            const double before = top;
            const std::vector<double> from = x;
            const std::size_t compared = to_poles_ ? 3 : 1;
            for (std::size_t i = 0; i < tries.size(); ++i) { // the first is nearly always the best
                if (i >= compared && top > before) break;
                const double f_try = log_at({tries[i]})[0];
                if (!(f_try > top)) continue;
                top = f_try;
                x = tries[i];
            }
            if (to_poles_ && top > before) {
                double moved = 0;
                for (std::size_t d = 0; d < n_; ++d) moved = std::max(moved, std::abs(x[d] - from[d]));
                width = std::min(width, std::max(least_width, of_last_step * moved));
            }
            if (top - before < 1e-3) {
                if (top > before && !to_poles_) break;
                width *= 0.3;
                if (width < least_width) break;
            }
        }
        return top;
    }

    // The step up the slope at whose end 1/h is zero, if it falls as steadily as here: exact where h is infinite on a
    // plane.
    std::vector<double> step_to_pole(const std::vector<double>& h, const std::vector<double>& f) const {
        std::vector<double> step(n_);
        double squares = 0;
        for (std::size_t d = 0; d < n_; ++d) {
            step[d] = (f[2 * d] - f[2 * d + 1]) / (2 * h[d]);
            squares += step[d] * step[d];
        }
        for (double& s : step) s = squares > 0 ? s / squares : 0;
        return step;
    }

    // A step uphill from the values f around x at differences h, and the rise that its slope promises. In few variables by
    // the whole matrix of curvatures, so that it follows ridges in any direction; else along each variable alone.
    std::vector<double> uphill(const std::vector<double>& x, double top, const std::vector<double>& h,
                               const std::vector<double>& f, double& expected) {
        std::vector<double> gradient(n_), curvature(n_ * n_, 0.0), direction(n_, 0.0);
        for (std::size_t d = 0; d < n_; ++d) {
            gradient[d] = (f[2 * d] - f[2 * d + 1]) / (2 * h[d]);
            curvature[d * n_ + d] = (f[2 * d] + f[2 * d + 1] - 2 * top) / (h[d] * h[d]);
        }
        bool whole = n_ > 1 && n_ <= whole_curvature && budget_ >= 4 * n_ * n_;
        if (whole) {
            std::vector<std::vector<double>> corners;
            for (std::size_t i = 0; i < n_; ++i)
                for (std::size_t j = 0; j < i; ++j)
                    for (auto [a, b] :
                         {std::pair(1, 1), std::pair(-1, -1), std::pair(1, -1), std::pair(-1, 1)}) {
                        corners.push_back(x);
                        corners.back()[i] += a * h[i];
                        corners.back()[j] += b * h[j];
                    }
            const std::vector<double> g = log_at(corners);
            whole = std::ranges::find(g, nowhere) == g.end();
            std::size_t at = 0;
            for (std::size_t i = 0; whole && i < n_; ++i)
                for (std::size_t j = 0; j < i; ++j, at += 4)
                    curvature[i * n_ + j] = curvature[j * n_ + i] =
                        (g[at] + g[at + 1] - g[at + 2] - g[at + 3]) / (4 * h[i] * h[j]);
        }
        if (whole) {
            const Eigensystem axes = symmetric_eigensystem(curvature, static_cast<int>(n_));
            for (std::size_t k = 0; k < n_; ++k) {
                double slope = 0;
                for (std::size_t d = 0; d < n_; ++d) slope += axes.vectors[d * n_ + k] * gradient[d];
                const double size = std::abs(axes.values[k]);
                const double step = std::clamp(size > 0 ? slope / size : 0, -longest_step, longest_step);
                for (std::size_t d = 0; d < n_; ++d) direction[d] += step * axes.vectors[d * n_ + k];
            }
        } else {
            for (std::size_t d = 0; d < n_; ++d) {
                const double c = curvature[d * n_ + d];
                direction[d] = std::clamp(c < 0 || to_poles_ ? gradient[d] / std::abs(c)
                                          : gradient[d] > 0  ? 0.1
                                                             : -0.1,
                                          -longest_step, longest_step);
            }
        }
        for (std::size_t d = 0; d < n_; ++d) expected += std::abs(gradient[d] * direction[d]);
        return direction;
    }

    // The Gaussian whose logarithm is curved like log h at x.
    std::optional<Gaussian> laplace(const std::vector<double>& x, double top, double widest,
                                    const std::vector<double>& extent = {}) {
        if (budget_ < 8 * n_ + 2 * n_ * n_) return std::nullopt;
        // Steps over which log h falls by something like one half.
        std::vector<double> h = extent.empty() ? std::vector<double>(n_, first_difference) : extent;
        for (std::size_t d = 0; d < n_; ++d) h[d] = std::min(h[d], 0.49 * std::min(x[d], 1 - x[d]));
        for (int round = 0; round < 16; ++round) {
            std::vector<std::vector<double>> around;
            for (std::size_t d = 0; d < n_; ++d)
                for (double sign : {1.0, -1.0}) {
                    around.push_back(x);
                    around.back()[d] += sign * h[d];
                }
            const std::vector<double> f = log_at(around);
            bool good = true;
            for (std::size_t d = 0; d < n_; ++d) {
                const double fall = top - 0.5 * (f[2 * d] + f[2 * d + 1]);
                double next = h[d];
                if (fall > 1) next *= 0.4;
                if (fall < 0.02) next *= 2.5;
                next = std::min(next, 0.49 * std::min(x[d], 1 - x[d]));
                good = good && next == h[d];
                h[d] = next;
            }
            if (good || budget_ < 2 * n_ + 2 * n_ * n_) break;
        }
        std::vector<std::vector<double>> stencil;
        auto shifted = [&](std::size_t i, double a, std::size_t j, double b) {
            stencil.push_back(x);
            stencil.back()[i] += a;
            stencil.back()[j] += b;
        };
        for (std::size_t i = 0; i < n_; ++i) {
            shifted(i, h[i], i, 0);
            shifted(i, -h[i], i, 0);
            for (std::size_t j = 0; j < i; ++j)
                for (auto [a, b] : {std::pair(1, 1), std::pair(-1, -1), std::pair(1, -1), std::pair(-1, 1)})
                    shifted(i, a * h[i], j, b * h[j]);
        }
        const std::vector<double> f = log_at(stencil);
        std::vector<double> precision(n_ * n_);
        std::size_t at = 0;
        for (std::size_t i = 0; i < n_; ++i) {
            precision[i * n_ + i] = -(f[at] + f[at + 1] - 2 * top) / (h[i] * h[i]);
            at += 2;
            for (std::size_t j = 0; j < i; ++j, at += 4)
                precision[i * n_ + j] = precision[j * n_ + i] =
                    -(f[at] + f[at + 1] - f[at + 2] - f[at + 3]) / (4 * h[i] * h[j]);
        }
        for (double v : precision)
            if (!std::isfinite(v) || std::abs(v) > 1e100) return std::nullopt;
        const Eigensystem axes = symmetric_eigensystem(precision, static_cast<int>(n_));
        const std::vector<double> widths = axis_widths(x, top, axes, widest);
        std::vector<double> covariance(n_ * n_, 0.0);
        for (std::size_t k = 0; k < n_; ++k) {
            const double variance = widths[k] * widths[k];
            for (std::size_t i = 0; i < n_; ++i)
                for (std::size_t j = 0; j < n_; ++j)
                    covariance[i * n_ + j] += variance * axes.vectors[i * n_ + k] * axes.vectors[j * n_ + k];
        }
        std::vector<double> factor = cholesky_factor(covariance, static_cast<int>(n_));
        if (factor.empty()) return std::nullopt;
        return Gaussian(x, std::move(factor));
    }

  private:
    // Standard deviations along the axes of log h's curvature, at most `widest`. A Gaussian as wide as a
    // curved ridge or shell looks straight would cover its surroundings: if h falls sooner, the deviations
    // are shorter.
    std::vector<double> axis_widths(const std::vector<double>& x, double top, const Eigensystem& axes,
                                    double widest) {
        constexpr int halvings = 6;
        constexpr double fallen = 1; // twice as far, in logarithm, as a Gaussian at its width
        std::vector<double> widths(n_);
        std::vector<std::size_t> open;
        for (std::size_t k = 0; k < n_; ++k) {
            widths[k] = 1 / std::sqrt(std::max(axes.values[k], 1 / (widest * widest)));
            open.push_back(k);
        }
        for (int i = 0; i < halvings && !open.empty() && budget_ >= 2 * open.size(); ++i) {
            std::vector<std::vector<double>> ends;
            for (std::size_t k : open)
                for (double sign : {1.0, -1.0}) {
                    ends.push_back(x);
                    for (std::size_t d = 0; d < n_; ++d)
                        ends.back()[d] =
                            std::clamp(x[d] + sign * widths[k] * axes.vectors[d * n_ + k], 1e-6, 1 - 1e-6);
                }
            const std::vector<double> f = log_at(ends);
            std::vector<std::size_t> shorter;
            for (std::size_t j = 0; j < open.size(); ++j)
                if (top - std::max(f[2 * j], f[2 * j + 1]) > fallen) {
                    widths[open[j]] /= 2;
                    shorter.push_back(open[j]);
                }
            open = std::move(shorter);
        }
        return widths;
    }

    const DensityFunction& h_;
    std::size_t n_;
    std::uint64_t budget_;
    bool to_poles_;
};

// The point farthest from all known modes, among those where h was seen.
std::vector<double>::const_iterator least_explained(const std::vector<double>& log_h,
                                                    const std::vector<double>& explained) {
    auto least = log_h.begin();
    for (auto i = log_h.begin(); i != log_h.end(); ++i) {
        const auto at = [&](auto place) {
            return explained[static_cast<std::size_t>(place - log_h.begin())];
        };
        if (*i != nowhere && (*least == nowhere || at(i) < at(least))) least = i;
    }
    return least;
}

std::optional<Gaussian> diagonal_gaussian(const std::vector<double>& mean,
                                          const std::vector<double>& deviations) {
    const std::size_t n = mean.size();
    std::vector<double> factor(n * n, 0.0);
    for (std::size_t d = 0; d < n; ++d) {
        if (!(deviations[d] > 0)) return std::nullopt;
        factor[d * n + d] = deviations[d];
    }
    return Gaussian(mean, std::move(factor));
}

} // namespace

double climb_to_pole(const DensityFunction& h, std::vector<double>& x, std::uint64_t max_evaluations) {
    return Climber(h, static_cast<int>(x.size()), max_evaluations, true)
        .climb(x, first_difference, least_at_pole);
}

std::vector<Gaussian> find_modes(const DensityFunction& h, const PointBatch& x,
                                 std::span<const double> h_at_x, const ModeSearch& settings) {
    Climber climber(h, x.dimensions(), settings.max_evaluations);
    const std::size_t n = x.count();
    std::vector<Gaussian> modes;
    std::vector<double> tops; // log h at the modes
    std::vector<double> excess(
        n); // log h above the highest of the known modes' Gaussians, scaled to their tops
    for (std::size_t i = 0; i < n; ++i) excess[i] = h_at_x[i] > 0 ? std::log(h_at_x[i]) : nowhere;
    std::vector<double> explained(n, nowhere), log_h = excess;
    std::vector<double> log_pdf(n), point(static_cast<std::size_t>(x.dimensions()));
    auto add = [&](Gaussian&& mode, double top) {
        mode.log_pdf(x, log_pdf);
        for (std::size_t i = 0; i < n; ++i) {
            explained[i] = std::max(explained[i], top + log_pdf[i] - mode.log_norm());
            excess[i] = log_h[i] == nowhere ? nowhere : log_h[i] - explained[i];
        }
        modes.push_back(std::move(mode));
        tops.push_back(top);
    };
    auto is_known = [&](const std::vector<double>& at) {
        return std::any_of(modes.begin(), modes.end(), [&](const Gaussian& g) {
            return g.squared_distance(at) < 1 + 0.5 * x.dimensions();
        });
    };
    for (const Witness& peak : settings.peaks) {
        const double extent = *std::ranges::min_element(peak.extent);
        const double least = std::min(least_coordinate, least_of_extent * extent);
        std::vector<double> at = peak.u;
        for (double& u : at) u = std::clamp(u, least, 1 - least);
        const double top = climber.climb(at, extent, least);
        if (top == nowhere || is_known(at)) continue;
        std::optional<Gaussian> mode = climber.laplace(at, top, settings.widest, peak.extent);
        // A cusp or a corner has no curvature: as wide as it is at half its height.
        if (!mode) mode = diagonal_gaussian(at, peak.extent);
        if (mode) add(std::move(*mode), top);
    }
    // Climbs from a point where h exceeds the known modes, and adds the mode there, if it is a new one.
    const auto climb_from = [&](const std::vector<double>& begin, bool exceeds) {
        std::vector<double> at = begin;
        double top = climber.climb(at);
        if (exceeds && is_known(at)) {
            // What exceeds the known modes is another one's: its slope shows in closer differences.
            at = begin;
            top = climber.climb(at, close_difference);
        }
        if (is_known(at)) return false;
        std::optional<Gaussian> mode = climber.laplace(at, top, settings.widest);
        if (mode) add(std::move(*mode), top);
        return mode.has_value();
    };
    int fruitless = 0, remote = 0;
    while (climber.left() > 0 && fruitless < settings.fruitless &&
           static_cast<int>(modes.size()) < settings.most_modes) {
        auto start = std::max_element(excess.begin(), excess.end());
        if (start == excess.end() || *start == nowhere) break;
        if (!modes.empty() && *start < least_excess) {
            if (remote++ == settings.remote) break;
            start = excess.begin() + (least_explained(log_h, explained) - log_h.begin());
        }
        const auto index = static_cast<std::size_t>(start - excess.begin());
        x.gather(index, point.data());
        excess[index] = log_h[index] = nowhere; // each start once
        fruitless = climb_from(point, remote == 0) ? 0 : fruitless + 1;
    }
    // Narrow modes beside wide ones: a small part of the cube leads to them, but a fair one of their neighbourhood.
    const std::uint64_t points = settings.survey / (surveyed_modes * survey_scales.size());
    for (std::size_t k = 0; points > 0 && k < std::min(modes.size(), surveyed_modes); ++k)
        for (double scale : survey_scales) {
            if (climber.left() < 2 * points) break;
            PointBuffer u(points, x.dimensions()), drawn(points, x.dimensions());
            fill_random(u, hash_key(settings.seed, k), static_cast<std::uint32_t>(scale), 0);
            modes[k].widened(scale).sample(u, drawn);
            std::vector<std::vector<double>> places(points, point);
            for (std::size_t i = 0; i < places.size(); ++i) drawn.view().gather(i, places[i].data());
            const std::vector<double> h_there = climber.log_at(places);
            std::vector<char> tried(places.size());
            for (;;) {
                double most = least_excess;
                std::optional<std::size_t> best;
                for (std::size_t i = 0; i < places.size(); ++i) {
                    if (tried[i] || h_there[i] == nowhere) continue;
                    double known = nowhere;
                    for (std::size_t j = 0; j < modes.size(); ++j)
                        known = std::max(known, tops[j] - 0.5 * modes[j].squared_distance(places[i]));
                    if (h_there[i] - known > most) most = h_there[i] - known, best = i;
                }
                if (!best || climber.left() == 0) break;
                tried[*best] = 1;
                if (!climb_from(places[*best], true)) break;
            }
        }
    return modes;
}

} // namespace montelux
