#include "montelux/mc/integrate/witness/first_look.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include "montelux/mc/integrate/witness/peak.h"
#include "montelux/mc/integrate/witness/raw_values.h"
#include "montelux/mc/integrate/witness/ridge.h"
#include "montelux/mc/integrate/witness/shells.h"
#include "montelux/mc/random/hash.h"

namespace montelux {
namespace {

using Point = std::vector<double>;

// Exponents of the distances of a ladder of points, in units of the cube's width.
constexpr std::array<double, 6> ladder{3, 8, 15, 24, 36, 50};
constexpr double suspicious = 0.2; // of the inner shells' masses beside the outer ones'
constexpr double matters = 1e-3;   // of the greatest mass of a shell: a difference between two
constexpr double outstanding = 16; // times the median of the look
constexpr std::size_t most_peaks = 3, more_corners = 8;
constexpr int most_climbed = 8;          // variables in which peaks are climbed and measured
constexpr std::size_t most_anchors = 16; // of a variable

struct Anchor {
    double u, finest; // exponent of the smallest distance that the coordinate resolves
};

// A ladder towards a point: u_d = anchor_d + side_d reach_d 2^(-rate_d k) for the variables that move.
struct Path {
    std::vector<Anchor> anchors;
    std::vector<double> side; // 0: the variable does not move
    std::vector<double> reach;
    std::vector<int> rates = {}; // empty: 1

    int rate(std::size_t d) const { return side[d] == 0 ? 0 : rates.empty() ? 1 : rates[d]; }
    // Shells at k have a volume of 2^(-k codimension).
    int codimension() const {
        int sum = 0;
        for (std::size_t d = 0; d < side.size(); ++d) sum += rate(d);
        return sum;
    }
    double finest() const {
        double least = finest_at_origin;
        for (std::size_t d = 0; d < side.size(); ++d)
            if (side[d] != 0) least = std::min(least, (anchors[d].finest + std::log2(reach[d])) / rate(d));
        return std::min(least, std::max(finest_inside, finest_at_origin / codimension()));
    }
    // Volume of the shell around the anchor; `across`: widths in the variables that do not move.
    double volume(double exponent, const std::vector<double>& across) const {
        double product = 1;
        for (std::size_t d = 0; d < side.size(); ++d)
            product *= side[d] != 0 ? reach[d] * std::exp2(-rate(d) * exponent) : across[d];
        return product;
    }
    Point at(double exponent) const {
        Point u(side.size());
        for (std::size_t d = 0; d < u.size(); ++d)
            u[d] = std::clamp(anchors[d].u + side[d] * reach[d] * off_grid * std::exp2(-rate(d) * exponent),
                              std::numeric_limits<double>::min(), 1 - 0x1p-53);
        return u;
    }
};

class Look {
  public:
    Look(const Evaluator& evaluator, const LookSettings& settings)
        : raw_(evaluator), settings_(settings), n_(static_cast<std::size_t>(evaluator.dimensions())),
          largest_(static_cast<std::size_t>(evaluator.components()), 0.0) {
        for (std::size_t d = 0; d < n_; ++d) anchors_.push_back(anchors_of(d));
    }

    FirstLook operator()() {
        const auto begin = std::chrono::steady_clock::now();
        std::vector<Path> paths = n_ == 1 ? line_paths(0, {}) : joint_paths();
        walk(paths);
        if (n_ > 1 && !look_.slow.empty()) walk(corner_paths());
        if (n_ > 1) {
            for (std::size_t d = 0; d < n_ && affordable(4 * ladder.size()); ++d) {
                // Through a generic point, where no other variable is near a pole of its own; then through the
                // greatest value, where masses along a line say nothing of the integral.
                walk(line_paths(d, generic_point(), true));
                if (const Witness* top = best()) walk(line_paths(d, Point(top->u)), false);
            }
        }
        find_peaks();
        look_.evaluations = raw_.evaluations();
        look_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
        return std::move(look_);
    }

  private:
    bool affordable(std::size_t points) const {
        return raw_.evaluations() + points <= settings_.most_evaluations;
    }
    double random() {
        return static_cast<double>(hash_key(settings_.seed, 0x6c6f6f6b, drawn_++) >> 11) * 0x1p-53;
    }

    // Ends first, then the centre, the origin and the landmarks.
    std::vector<Anchor> anchors_of(std::size_t d) const {
        const Domain& domain = raw_.evaluator().domain();
        const std::span<const Range> ranges = domain.ranges();
        if (ranges.empty()) return {{0, finest_inside}, {1, finest_inside}, {0.5, finest_inside}};
        const Range range = ranges[d];
        std::vector<Anchor> anchors;
        for (double u : {0.0, 1.0, 0.5}) anchors.push_back({u, finest_exponent(domain, d, u)});
        std::vector<double> places(settings_.landmarks.begin(), settings_.landmarks.end());
        places.insert(places.begin(), 0.0);
        std::vector<double> known;
        for (double x : places) {
            if (!(x > range.lower && x < range.upper) || anchors.size() >= most_anchors) continue;
            PointBuffer at(1, static_cast<int>(n_)), u(1, static_cast<int>(n_));
            for (std::size_t e = 0; e < n_; ++e) at(0, static_cast<int>(e)) = x;
            std::array<double, 1> volume{1};
            domain.inverse(at, u, volume);
            const double here = u.view()(0, static_cast<int>(d));
            const bool near =
                std::ranges::any_of(anchors, [&](const Anchor& a) { return std::abs(a.u - here) < 0x1p-50; });
            if (!near && here > 0 && here < 1) anchors.push_back({here, finest_exponent(domain, d, here)});
        }
        return anchors;
    }

    // Both sides of each anchor of a variable, the others fixed; or of its ends alone.
    std::vector<Path> line_paths(std::size_t d, const Point& through, bool ends = false) const {
        std::vector<Path> paths;
        for (std::size_t i = 0; i < anchors_[d].size() && (!ends || i < 2); ++i)
            for (double side : {1.0, -1.0}) {
                const double r = reach(anchors_[d][i].u, side);
                if (r == 0) continue;
                Path path{{}, std::vector<double>(n_, 0.0), std::vector<double>(n_, 0.0)};
                for (std::size_t e = 0; e < n_; ++e)
                    path.anchors.push_back(e == d ? anchors_[d][i] : Anchor{through[e], finest_inside});
                path.side[d] = side;
                path.reach[d] = r;
                paths.push_back(std::move(path));
            }
        return paths;
    }

    // All variables at once: the same anchor in each, each corner of up to three variables, and some with an anchor of its
    // own in each variable.
    std::vector<Path> joint_paths() {
        std::vector<Path> paths;
        std::size_t most = 0;
        for (const auto& anchors : anchors_) most = std::max(most, anchors.size());
        const std::size_t mixed = n_ <= 3 ? 16 : 8, corners = n_ <= 3 ? std::size_t{1} << n_ : 0;
        for (std::size_t i = 0; i < most + mixed; ++i) {
            Path path;
            for (std::size_t d = 0; d < n_; ++d) {
                const std::size_t count = anchors_[d].size();
                const std::size_t which =
                    i < most ? std::min(i, count - 1)
                    : i < most + corners
                        ? (i - most) >> d & 1
                        : std::min(count - 1,
                                   static_cast<std::size_t>(random() * static_cast<double>(count)));
                const Anchor anchor = anchors_[d][which];
                const double side = anchor.u == 0                ? 1
                                    : anchor.u == 1              ? -1
                                    : i < most || random() < 0.5 ? 1
                                                                 : -1;
                path.anchors.push_back(anchor);
                path.side.push_back(side);
                // The first ones along diagonals, where ridges are; the others in directions of their own.
                path.reach.push_back(reach(anchor.u, side) * (i < most ? 1 : 0.5 + 0.5 * random()));
            }
            if (i < most && paths.size() < most) {
                Path opposite = path;
                bool inside = false;
                for (std::size_t d = 0; d < n_; ++d)
                    if (path.anchors[d].u != 0 && path.anchors[d].u != 1) {
                        inside = true;
                        opposite.side[d] = -path.side[d];
                        opposite.reach[d] =
                            std::min(opposite.reach[d], reach(path.anchors[d].u, -path.side[d]));
                    }
                if (inside) paths.push_back(std::move(opposite));
            }
            paths.push_back(std::move(path));
        }
        return paths;
    }

    Path to_corner(const std::vector<double>& place, std::vector<int> rates = {}) const {
        Path path{{}, {}, std::vector<double>(n_, 1.0), std::move(rates)};
        for (std::size_t d = 0; d < n_; ++d) {
            path.anchors.push_back(anchors_[d][place[d] == 0 ? 0 : 1]);
            path.side.push_back(place[d] == 0 ? 1 : -1);
        }
        return path;
    }

    // Further ladders where a corner is slow: to it, on which one variable falls with the square of the others or the
    // others with its, since x + y^2 has two scales; and to more corners of many variables.
    std::vector<Path> corner_paths() {
        std::vector<Path> paths;
        for (const SlowShells& slow : look_.slow) {
            if (slow.codimension() < static_cast<int>(n_)) continue;
            for (std::size_t one = 0; one < n_; ++one)
                for (int rate : {1, 2}) {
                    if (n_ == 2 && rate == 2) continue; // the other variable's with 1
                    std::vector<int> rates(n_, 3 - rate);
                    rates[one] = rate;
                    paths.push_back(to_corner(slow.place, std::move(rates)));
                }
        }
        for (std::size_t i = 0; n_ > 3 && i < more_corners; ++i) {
            Point place(n_);
            for (double& u : place) u = random() < 0.5;
            paths.push_back(to_corner(place));
        }
        return paths;
    }

    Point generic_point() {
        Point u(n_);
        for (double& c : u) c = 0.25 + 0.5 * random();
        return u;
    }

    // Evaluates the ladders and keeps what they saw. `tests`: whether their masses fall.
    void walk(const std::vector<Path>& paths, bool tests = true) {
        std::vector<Point> points;
        std::vector<double> volumes;
        std::size_t walked = 0;
        for (; walked < paths.size() && affordable(points.size() + ladder.size()); ++walked) {
            const double finest = std::min(paths[walked].finest(), ladder.back());
            for (double k : ladder) {
                points.push_back(paths[walked].at(k * finest / ladder.back()));
                volumes.push_back(paths[walked].volume(k * finest / ladder.back(), widths_of(paths[walked])));
            }
        }
        const auto rows = raw_(points);
        for (std::size_t i = 0; i < points.size(); ++i) keep(points[i], rows[i], volumes[i], true);
        refine(paths, walked, rows, volumes);
        if (!tests || !look_.divergence.empty()) return;
        for (std::size_t p = 0; p < walked; ++p)
            for (std::size_t c = 0; c < components(); ++c)
                if (is_suspicious(paths[p], rows, p * ladder.size(), c)) {
                    if (diverges(paths[p], c)) {
                        look_.divergence = place_of(paths[p]);
                        return;
                    }
                    if (paths[p].codimension() == 1) note_unresolved(paths[p], rows, p * ladder.size(), c);
                }
        for (std::size_t p = 0; p < walked; ++p) note_slow(paths[p], rows, p * ladder.size());
    }

    // Keeps a ladder whose masses fall slowly. In several variables the smaller values of it and of another one to the
    // same face or corner, at whose points densities are compared: the first may lie on a ridge.
    void note_slow(const Path& path, const std::vector<std::vector<double>>& rows, std::size_t first) {
        SlowShells slow{std::vector<double>(n_, SlowShells::free), {}, {}};
        for (std::size_t d = 0; d < n_; ++d) {
            if (path.side[d] == 0) continue;
            slow.place[d] = path.anchors[d].u;
            if (slow.place[d] != 0 && slow.place[d] != 1) return;
        }
        if (look_.slow.size() == SlowShells::most ||
            std::ranges::find(look_.slow, slow.place, &SlowShells::place) != look_.slow.end())
            return;
        const double finest = std::min(path.finest(), ladder.back()) / ladder.back();
        for (std::size_t i = 0; i < ladder.size(); ++i) {
            const double k = ladder[i] * finest;
            slow.exponents.push_back(k);
            slow.shells.push_back(
                {path.at(k), rows[first + i], path.volume(k, std::vector<double>(n_, 1.0))});
        }
        if (!any_slow(slow)) return;
        if (n_ > 1) {
            if (!affordable(ladder.size())) return;
            Path other = path;
            const Point through = generic_point();
            for (std::size_t d = 0; d < n_; ++d)
                (path.side[d] != 0 ? other.reach[d] *= 0.3 + 0.7 * random()
                                   : other.anchors[d].u = through[d]);
            std::vector<Point> points;
            for (double k : slow.exponents) points.push_back(other.at(k));
            const auto seen = raw_(points);
            for (std::size_t i = 0; i < points.size(); ++i) {
                slow.shells[i].u = points[i];
                for (std::size_t c = 0; c < components(); ++c)
                    slow.shells[i].value[c] =
                        std::min(std::abs(slow.shells[i].value[c]), std::abs(seen[i][c]));
            }
            if (!any_slow(slow)) return;
        }
        look_.slow.push_back(std::move(slow));
    }

    bool any_slow(const SlowShells& slow) const {
        for (std::size_t c = 0; c < components(); ++c)
            if (slow.is_slow(c)) return true;
        return false;
    }

    // Looks between shells of a ladder that differ by masses which matter: a rise or a peak may lie there. What lies
    // outside of 2^-8 other points see.
    void refine(const std::vector<Path>& paths, std::size_t walked,
                const std::vector<std::vector<double>>& rows, const std::vector<double>& volumes) {
        double most = 0;
        for (std::size_t i = 0; i < rows.size(); ++i) most = std::max(most, size(rows[i]) * volumes[i]);
        for (std::size_t p = 0; p < walked; ++p)
            for (std::size_t i = 1; i + 1 < ladder.size(); ++i) {
                const std::size_t at = p * ladder.size() + i;
                const double difference = std::abs(size(rows[at]) - size(rows[at + 1]));
                if (!(difference * volumes[at] > matters * most)) continue;
                const double finest = std::min(paths[p].finest(), ladder.back()) / ladder.back();
                std::vector<Point> between;
                std::vector<double> of_between;
                for (double k = ladder[i] + 1; k < ladder[i + 1]; ++k) {
                    between.push_back(paths[p].at(k * finest));
                    of_between.push_back(paths[p].volume(k * finest, widths_of(paths[p])));
                }
                if (!affordable(between.size())) return;
                const auto seen = raw_(between);
                for (std::size_t j = 0; j < seen.size(); ++j) keep(between[j], seen[j], of_between[j], false);
            }
    }

    // Scales at which the coordinates that do not move were found: distances from the nearest of their anchors.
    std::vector<double> widths_of(const Path& path) const {
        std::vector<double> widths(n_, 1.0);
        for (std::size_t d = 0; d < n_; ++d)
            if (path.side[d] == 0)
                for (const Anchor& a : anchors_[d])
                    widths[d] = std::min(widths[d], std::abs(path.anchors[d].u - a.u));
        return widths;
    }

    std::size_t components() const { return static_cast<std::size_t>(raw_.evaluator().components()); }

    // What lies beyond the finest shell, if masses fall by a power.
    void note_unresolved(const Path& path, const std::vector<std::vector<double>>& rows, std::size_t first,
                         std::size_t c) {
        if (path.finest() > finest_inside) return;
        const double finest = std::min(path.finest(), ladder.back()) / ladder.back();
        const double from = ladder[3] * finest, to = ladder[5] * finest;
        const double outer = std::abs(rows[first + 3][c]) * std::exp2(-from);
        const double inner = std::abs(rows[first + 5][c]) * std::exp2(-to);
        const double fall = std::log2(outer / inner) / (to - from); // 1 - power
        if (!(fall > 0 && fall < 0.9)) return;
        look_.unresolved.resize(components(), 0.0);
        look_.unresolved[c] += inner * path.reach[0] * off_grid / fall;
    }

    bool is_suspicious(const Path& path, const std::vector<std::vector<double>>& rows, std::size_t first,
                       std::size_t c) const {
        const double finest = std::min(path.finest(), ladder.back());
        auto mass = [&](std::size_t i) {
            const double g = std::abs(rows[first + i][c]);
            return std::isnan(g) ? 0
                                 : g * std::exp2(-path.codimension() * ladder[i] * finest / ladder.back());
        };
        const double inner = std::max(mass(4), mass(5)), outer = std::max(mass(2), mass(3));
        return inner > 0 && (std::isinf(inner) || inner >= suspicious * outer);
    }

    // Do all variables that move go to infinity?
    bool goes_to_infinity(const Path& path) const {
        const std::span<const Range> ranges = raw_.evaluator().domain().ranges();
        if (ranges.empty()) return false;
        for (std::size_t d = 0; d < n_; ++d)
            if (path.side[d] != 0 && !(path.anchors[d].u == 0 && std::isinf(ranges[d].lower)) &&
                !(path.anchors[d].u == 1 && std::isinf(ranges[d].upper)))
                return false;
        return true;
    }

    // Shells at infinity, farther out than points of the unit cube can be: |f| at distances 2^k, times the square of the
    // volume that these have, so that masses are those of shells of width 2^-k.
    bool diverges_at_infinity(const Path& path, std::size_t c) {
        const int codimension = path.codimension();
        PointBuffer u(1, static_cast<int>(n_)), x(1, static_cast<int>(n_));
        for (std::size_t d = 0; d < n_; ++d)
            u(0, static_cast<int>(d)) = path.side[d] == 0 ? path.anchors[d].u : 0.5;
        std::array<double, 1> volume{1};
        raw_.evaluator().domain().map(u, x, volume);
        const ShellValues values = [&](std::span<const double> exponents) {
            std::vector<Point> points;
            for (double k : exponents) {
                points.emplace_back(n_);
                for (std::size_t d = 0; d < n_; ++d)
                    points.back()[d] = path.side[d] == 0 ? x.view()(0, static_cast<int>(d))
                                                         : -path.side[d] * std::exp2(path.rate(d) * k) /
                                                               (off_grid * path.reach[d]);
            }
            const auto rows = raw_.at(points);
            std::vector<double> g;
            for (std::size_t i = 0; i < rows.size(); ++i)
                g.push_back(std::abs(rows[i][c]) * std::exp2(2 * codimension * exponents[i]));
            return g;
        };
        return masses_diverge(values, finest_at_origin / codimension, codimension);
    }

    bool diverges(const Path& path, std::size_t c) {
        if (path.codimension() == 1) return diverges_along(path, c);
        // Other directions, since a diagonal may be a ridge.
        for (int i = 0; i < 2; ++i) {
            Path other = path;
            for (std::size_t d = 0; d < n_; ++d) other.reach[d] *= 0.3 + 0.7 * random();
            if (!diverges_along(other, c)) return ridge_diverges_along(path, c);
        }
        return diverges_along(path, c);
    }

    bool ridge_diverges_along(const Path& path, std::size_t c) {
        constexpr double far_out = 20; // exponent
        return goes_to_infinity(path) && diverges_along(path, c) &&
               ridge_diverges(raw_, path.at(far_out),
                              [c](const std::vector<double>& row) { return std::abs(row[c]); });
    }

    bool diverges_along(const Path& path, std::size_t c) {
        if (goes_to_infinity(path)) return diverges_at_infinity(path, c);
        const ShellValues values = [&](std::span<const double> exponents) {
            std::vector<Point> points;
            for (double k : exponents) points.push_back(path.at(k));
            std::vector<double> g;
            for (const auto& row : raw_(points)) g.push_back(std::abs(row[c]));
            return g;
        };
        return masses_diverge(values, path.finest(), path.codimension());
    }

    std::string place_of(const Path& path) const {
        const Domain& domain = raw_.evaluator().domain();
        PointBuffer u(1, static_cast<int>(n_)), x(1, domain.dimensions());
        for (std::size_t d = 0; d < n_; ++d)
            u(0, static_cast<int>(d)) =
                std::clamp(path.anchors[d].u, std::numeric_limits<double>::min(), 1 - 0x1p-53);
        std::array<double, 1> volume{1};
        domain.map(u, x, volume);
        std::string place;
        for (std::size_t d = 0; d < n_; ++d) {
            if (path.side[d] == 0) continue;
            double to = domain.ranges().empty() ? path.anchors[d].u : x.view()(0, static_cast<int>(d));
            if (!domain.ranges().empty() && path.anchors[d].u == 0) to = domain.ranges()[d].lower;
            if (!domain.ranges().empty() && path.anchors[d].u == 1) to = domain.ranges()[d].upper;
            if (std::abs(to) < 1e-15) to = 0; // of the centre of a symmetric range
            std::array<char, 64> text;
            std::snprintf(text.data(), text.size(), "%s%s -> %.6g", place.empty() ? "" : ", ",
                          n_ == 1 ? "x" : ("x" + std::to_string(d + 1)).c_str(), to);
            place += text.data();
        }
        return domain.ranges().empty() ? place + " (variables of the unit cube)" : place;
    }

    // `ordinary`: a point of a ladder as it is, which tells what sizes values usually have.
    void keep(const Point& u, const std::vector<double>& row, double volume, bool ordinary) {
        for (std::size_t c = 0; c < row.size(); ++c)
            if (!std::isfinite(row[c])) return;
        for (std::size_t c = 0; c < row.size(); ++c) largest_[c] = std::max(largest_[c], std::abs(row[c]));
        if (ordinary) ordinary_.push_back(look_.witnesses.size());
        look_.witnesses.push_back({u, row, volume});
    }
    // Size of a value: the sum over components, each relative to the largest seen.
    double size(const std::vector<double>& row) const {
        double sum = 0;
        for (std::size_t c = 0; c < row.size(); ++c)
            if (largest_[c] > 0) sum += std::abs(row[c]) / largest_[c];
        return std::isfinite(sum) ? sum : 0;
    }
    const Witness* best() const {
        const auto top =
            std::ranges::max_element(look_.witnesses, {}, [&](const Witness& w) { return size(w.value); });
        return top == look_.witnesses.end() ? nullptr : &*top;
    }

    void find_peaks() {
        if (ordinary_.empty() || n_ > most_climbed) return;
        std::vector<double> sizes;
        for (std::size_t i : ordinary_) sizes.push_back(size(look_.witnesses[i].value));
        std::ranges::nth_element(sizes, sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2));
        const double median = sizes[sizes.size() / 2];
        std::vector<Witness> starts = look_.witnesses;
        std::ranges::sort(starts, std::greater{}, [&](const Witness& w) { return size(w.value); });
        for (const Witness& start : starts) {
            if (look_.peaks.size() == most_peaks || !affordable(40 * n_)) break;
            if (!(size(start.value) > outstanding * median)) break;
            if (std::ranges::any_of(look_.peaks, [&](const Witness& p) { return belongs(start, p); }))
                continue;
            const Magnitude magnitude = [&](const std::vector<double>& row) { return size(row); };
            Witness top = climb(raw_, start, magnitude);
            if (std::ranges::any_of(look_.peaks, [&](const Witness& p) { return belongs(top, p); })) continue;
            measure(raw_, top, magnitude);
            if (!is_rounding(top)) look_.peaks.push_back(std::move(top));
        }
    }

    // Does the value fall along the line from the top of a known peak? Otherwise it is another one.
    bool belongs(const Witness& w, const Witness& top) {
        std::vector<Point> between;
        for (double t : {0.25, 0.5, 0.75}) {
            Point u(n_);
            for (std::size_t d = 0; d < n_; ++d) u[d] = w.u[d] + t * (top.u[d] - w.u[d]);
            between.push_back(std::move(u));
        }
        const double least = 0.5 * std::min(size(w.value), size(top.value));
        return std::ranges::all_of(raw_(between), [&](const auto& row) { return size(row) >= least; });
    }

    RawValues raw_;
    LookSettings settings_;
    std::size_t n_;
    std::vector<std::vector<Anchor>> anchors_;
    std::vector<double> largest_;       // |g| of each component
    std::vector<std::size_t> ordinary_; // witnesses
    std::uint64_t drawn_ = 0;
    FirstLook look_;
};

} // namespace

FirstLook first_look(const Evaluator& evaluator, const LookSettings& settings) {
    return Look(evaluator, settings)();
}

} // namespace montelux
