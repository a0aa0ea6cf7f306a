#include "montelux/mc/integrate/witness/first_look.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <iterator>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include "montelux/mc/integrate/infinity.h"
#include "montelux/mc/integrate/witness/diagonal_ridges.h"
#include "montelux/mc/integrate/witness/guide_zeros.h"
#include "montelux/mc/integrate/witness/ladder_masses.h"
#include "montelux/mc/integrate/witness/ladder_path.h"
#include "montelux/mc/integrate/witness/lost_digits.h"
#include "montelux/mc/integrate/witness/peak.h"
#include "montelux/mc/integrate/witness/raw_values.h"
#include "montelux/mc/integrate/witness/ridge.h"

namespace montelux {
namespace {

using Point = std::vector<double>;

constexpr double matters = 1e-3;   // of the greatest mass of a shell: a difference between two
constexpr double outstanding = 16; // times the median of the look
constexpr std::size_t most_peaks = 3, more_corners = 8;
constexpr std::size_t most_followed = 3; // variables in which ridges are followed to the ends
constexpr double same_root = 0.05;       // of the distance between two
constexpr double least_followed = 1e-4;  // of a ridge's mass
constexpr double same_branch = 0.125;    // of the cube's width: of a ridge that leads to two ends
constexpr int most_climbed = 8;          // variables in which peaks are climbed and measured

std::string number_text(double x) {
    std::array<char, 32> text;
    std::snprintf(text.data(), text.size(), "%.6g", x);
    return text.data();
}

// Tuple of n texts as "(a, b)", or "a" if there is one.
std::string tuple_text(int n, const std::function<std::string(int)>& part) {
    if (n == 1) return part(0);
    constexpr int most = 8;
    std::string text;
    for (int d = 0; d < std::min(most, n); ++d) text += (d > 0 ? ", " : "(") + part(d);
    return text + (n > most ? ", ...)" : ")");
}

// Largest |value| of a row, before the sizes of components are known.
double greatest(const std::vector<double>& row) {
    double most = 0;
    for (double v : row) most = std::max(most, std::isnan(v) ? infinity : std::abs(v));
    return most;
}

class Look {
  public:
    Look(const Evaluator& evaluator, const LookSettings& settings)
        : raw_(evaluator), settings_(settings), n_(static_cast<std::size_t>(evaluator.dimensions())),
          zeros_(guide_zeros(settings.guides, evaluator.domain(), settings.seed)),
          paths_(evaluator.domain(), n_, settings.landmarks, places_of(zeros_), settings.seed),
          masses_(raw_, paths_), largest_(static_cast<std::size_t>(evaluator.components()), 0.0) {}

    FirstLook operator()() {
        const auto begin = std::chrono::steady_clock::now();
        std::vector<LadderPath> paths = n_ == 1 ? paths_.along(0, {}) : paths_.joint();
        walk(paths);
        if (n_ > 1 && !look_.slow.empty()) walk(corner_paths());
        if (n_ > 1) {
            find_ridges(); // while evaluations are left to measure them
            find_peaks(deep_);
            for (std::size_t d = 0; d < n_ && affordable(4 * ladder.size()); ++d) {
                // Through a generic point, where no other variable is near a pole of its own; then through the
                // greatest value, where masses along a line say nothing of the integral.
                walk(paths_.along(d, paths_.generic_point(), true));
                if (const Witness* top = best()) walk(paths_.along(d, Point(top->u)), *top);
            }
        }
        std::vector<std::size_t> all(look_.witnesses.size());
        std::iota(all.begin(), all.end(), std::size_t{0});
        find_peaks(all);
        look_.unresolved = masses_.unresolved();
        look_.evaluations = raw_.evaluations();
        look_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
        return std::move(look_);
    }

  private:
    bool affordable(std::size_t points) const {
        return raw_.evaluations() + points <= settings_.most_evaluations;
    }
    // Further ladders where a corner is slow: to it, and to more corners of many variables.
    std::vector<LadderPath> corner_paths() {
        std::vector<LadderPath> paths;
        for (const SlowShells& slow : look_.slow)
            if (slow.codimension() == static_cast<int>(n_))
                for (LadderPath& path : paths_.of_two_scales(slow.place)) paths.push_back(std::move(path));
        for (std::size_t i = 0; n_ > 3 && i < more_corners; ++i) paths.push_back(paths_.to_random_corner());
        return paths;
    }

    // Evaluates the ladders, keeps what they saw and tests whether their masses fall; not of those that lead through a point.
    void walk(std::vector<LadderPath> paths, const std::optional<Witness>& through = {}) {
        std::vector<Point> points;
        std::vector<double> volumes;
        std::size_t walked = 0;
        for (; walked < paths.size() && affordable(points.size() + ladder.size()); ++walked)
            place(paths[walked], points, volumes);
        auto rows = raw_(points);
        if (affordable(0))
            measure_diagonals(raw_, paths, points, rows, volumes,
                              settings_.most_evaluations - raw_.evaluations());
        for (std::size_t i = 0; i < points.size(); ++i) {
            const LadderPath& path = paths[i / ladder.size()];
            volumes[i] = path.volume(path.exponent(i % ladder.size()), paths_.widths(path));
            if (through && points[i] == through->u) volumes[i] = std::min(volumes[i], through->volume);
            if (path.thickness < infinity && std::isfinite(greatest(rows[i])) &&
                (look_.on_ridges.empty() || greatest(rows[i]) > greatest(look_.on_ridges[0].value)))
                look_.on_ridges.assign(1, {points[i], rows[i], volumes[i]});
            masses_.see(rows[i], volumes[i]);
        }
        for (std::size_t p = 0; p < walked; ++p) {
            double noise = infinity;
            const auto along = std::span(rows).subspan(p * ladder.size(), ladder.size());
            for (std::size_t c = 0; c < components(); ++c) {
                const double of_component = masses_.noise(paths[p], along, c);
                noise = std::min(noise, of_component);
                if (through || !look_.divergence.empty()) continue;
                if (masses_.diverge(paths[p], along, c, of_component)) look_.divergence = place_of(paths[p]);
                if (of_component == infinity) continue;
                const auto [lower, upper] = paths[p].within(of_component);
                look_.noise.push_back({static_cast<int>(c), lower, upper});
            }
            if (noise == infinity) continue;
            // Noise is no evidence.
            paths[p].precise_to = precise * noise;
            std::vector<Point> precise_points;
            std::vector<double> their_volumes;
            place(paths[p], precise_points, their_volumes);
            std::ranges::copy(raw_(precise_points), along.begin());
            std::ranges::copy(precise_points,
                              points.begin() + static_cast<std::ptrdiff_t>(p * ladder.size()));
            std::ranges::copy(their_volumes,
                              volumes.begin() + static_cast<std::ptrdiff_t>(p * ladder.size()));
        }
        for (std::size_t i = 0; i < points.size(); ++i)
            if (keep(points[i], rows[i], volumes[i], i % ladder.size() == 0) &&
                is_inside(paths[i / ladder.size()]) &&
                size(rows[i]) > outstanding * size(rows[i - i % ladder.size()]))
                deep_.push_back(look_.witnesses.size() - 1);
        refine(paths, walked, rows, volumes);
        if (through || !look_.divergence.empty()) return;
        for (std::size_t p = 0; p < walked; ++p) note_slow(paths[p], rows, p * ladder.size());
    }

    // Adds the points of a ladder, and the volumes of their shells.
    void place(const LadderPath& path, std::vector<Point>& points, std::vector<double>& volumes) const {
        for (std::size_t shell = 0; shell < ladder.size(); ++shell) {
            points.push_back(path.at(path.exponent(shell)));
            volumes.push_back(path.volume(path.exponent(shell), paths_.widths(path)));
        }
    }

    // Keeps a ladder whose masses fall slowly. In several variables the smaller values of it and of another one to the
    // same face or corner, at whose points densities are compared: the first may lie on a ridge.
    void note_slow(const LadderPath& path, const std::vector<std::vector<double>>& rows, std::size_t first) {
        SlowShells slow{std::vector<double>(n_, SlowShells::free), {}, {}};
        bool inside = false;
        for (std::size_t d = 0; d < n_; ++d) {
            if (path.side[d] == 0) continue;
            slow.place[d] = path.anchors[d].u;
            if (n_ == 1 || slow.place[d] == 0 || slow.place[d] == 1) continue;
            // Two diagonals lead to a place inside; in fewer variables the search for poles looks there.
            if (path.codimension() < static_cast<int>(n_) || !path.is_diagonal) return;
            inside = true;
        }
        if (look_.slow.size() == SlowShells::most ||
            std::ranges::any_of(look_.slow, [&](const SlowShells& other) {
                return other.place == slow.place && is_same_side(path, other);
            }))
            return;
        for (std::size_t i = 0; i < ladder.size(); ++i) {
            const double k = path.exponent(i);
            slow.exponents.push_back(k);
            slow.shells.push_back({path.at(k), rows[first + i],
                                   path.volume(k, std::vector<double>(n_, 1.0)) *
                                       std::exp2(inside ? static_cast<double>(n_ - 1) : 0)});
        }
        if (!any_slow(slow)) return;
        if (n_ > 1) {
            if (!affordable(ladder.size())) return;
            LadderPath other = path;
            const Point through = paths_.generic_point();
            for (std::size_t d = 0; d < n_; ++d)
                if (path.side[d] == 0) other.anchors[d].u = through[d];
            paths_.vary(other);
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

    // Whether the shells lie on the sides of their place to which a path leads.
    static bool is_same_side(const LadderPath& path, const SlowShells& shells) {
        for (std::size_t d = 0; d < path.side.size(); ++d)
            if (path.side[d] * (shells.shells.front().u[d] - path.anchors[d].u) < 0) return false;
        return true;
    }

    bool any_slow(const SlowShells& slow) const {
        for (std::size_t c = 0; c < components(); ++c)
            if (slow.is_slow(c)) return true;
        return false;
    }

    // Looks between shells of a ladder that differ by masses which matter: a rise or a peak may lie there. What lies
    // outside of 2^-8 other points see.
    void refine(const std::vector<LadderPath>& paths, std::size_t walked,
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
                    of_between.push_back(paths[p].volume(k * finest, paths_.widths(paths[p])));
                }
                if (!affordable(between.size())) return;
                const auto seen = raw_(between);
                for (std::size_t j = 0; j < seen.size(); ++j) keep(between[j], seen[j], of_between[j], false);
            }
    }

    std::size_t components() const { return static_cast<std::size_t>(raw_.evaluator().components()); }

    // Whether no variable that moves goes to an end.
    static bool is_inside(const LadderPath& path) {
        for (std::size_t d = 0; d < path.side.size(); ++d)
            if (path.side[d] != 0 && (path.anchors[d].u == 0 || path.anchors[d].u == 1)) return false;
        return true;
    }

    std::string place_of(const LadderPath& path) const {
        const Domain& domain = raw_.evaluator().domain();
        PointBuffer u(1, static_cast<int>(n_)), x(1, domain.dimensions());
        for (std::size_t d = 0; d < n_; ++d)
            u(0, static_cast<int>(d)) =
                std::clamp(path.anchors[d].u, std::numeric_limits<double>::min(), 1 - 0x1p-53);
        std::array<double, 1> volume{1};
        domain.map(u, x, volume);
        if (domain.ranges().empty() && std::ranges::none_of(path.side, [](double side) { return side == 0; }))
            return limit_text(domain, path.at(ladder.back()));
        std::string place;
        for (std::size_t d = 0; d < n_; ++d) {
            if (path.side[d] == 0) continue;
            double to = domain.ranges().empty() ? path.anchors[d].u : x.view()(0, static_cast<int>(d));
            if (!domain.ranges().empty() && path.anchors[d].u == 0) to = domain.ranges()[d].lower;
            if (!domain.ranges().empty() && path.anchors[d].u == 1) to = domain.ranges()[d].upper;
            if (std::abs(to) < 1e-15) to = 0; // of the centre of a symmetric range
            place +=
                (place.empty() ? "" : ", ") +
                (domain.ranges().empty() ? "x" + std::to_string(d + 1) : domain.name(static_cast<int>(d))) +
                " -> " + number_text(to);
        }
        return domain.ranges().empty() ? place + " (variables of the unit cube)" : place;
    }

    // `ordinary`: the outermost point of a ladder, which tells what sizes values usually have. False for values that are not
    // finite.
    bool keep(const Point& u, const std::vector<double>& row, double volume, bool ordinary) {
        if (!masses_.see(row, volume)) return false;
        for (std::size_t c = 0; c < row.size(); ++c) largest_[c] = std::max(largest_[c], std::abs(row[c]));
        if (ordinary) ordinary_.push_back(look_.witnesses.size());
        look_.witnesses.push_back({u, row, volume});
        return true;
    }
    // Size of a value: the sum over components, or that one which is looked at, each relative to the largest seen.
    double size(const std::vector<double>& row) const { return size(row, largest_); }
    double size(const std::vector<double>& row, const std::vector<double>& unit) const {
        double sum = 0;
        for (std::size_t c = 0; c < row.size(); ++c)
            if (unit[c] > 0 && c == component_.value_or(c)) sum += std::abs(row[c]) / unit[c];
        return std::isfinite(sum) ? sum : 0;
    }
    double median_size() const {
        std::vector<double> sizes;
        for (std::size_t i : ordinary_) sizes.push_back(size(look_.witnesses[i].value));
        if (sizes.empty()) return 0;
        std::ranges::nth_element(sizes, sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2));
        return sizes[sizes.size() / 2];
    }
    const Witness* best() const {
        const auto top =
            std::ranges::max_element(look_.witnesses, {}, [&](const Witness& w) { return size(w.value); });
        return top == look_.witnesses.end() ? nullptr : &*top;
    }

    // Climbs from those of these witnesses that stand out.
    void find_peaks(const std::vector<std::size_t>& from) {
        if (ordinary_.empty() || n_ > most_climbed) return;
        const double median = median_size();
        std::vector<Witness> starts;
        starts.reserve(from.size());
        for (std::size_t i : from) starts.push_back(look_.witnesses[i]);
        std::ranges::sort(starts, std::greater{}, [&](const Witness& w) { return size(w.value); });
        for (const Witness& start : starts) {
            if (look_.peaks.size() >= most_peaks + of_ridges_ || !affordable(40 * n_)) break;
            if (!(size(start.value) > outstanding * median)) break;
            const Magnitude magnitude = [&](const std::vector<double>& row) { return size(row); };
            const auto is_known = [&](const Witness& w) {
                return std::ranges::any_of(
                    look_.peaks, [&](const Witness& peak) { return belongs(raw_, w, peak, magnitude); });
            };
            if (is_known(start)) continue;
            Witness top = climb(raw_, start, magnitude);
            if (is_known(top)) continue;
            measure(raw_, top, magnitude);
            if (is_rounding(top)) continue;
            std::vector<Witness> opposite = opposite_peaks(raw_, top, magnitude);
            look_.peaks.push_back(std::move(top));
            std::ranges::move(opposite, std::back_inserter(look_.peaks));
        }
        for (; flanked_ < look_.peaks.size(); ++flanked_) see_flanks(look_.peaks[flanked_]);
    }

    // Points on the flanks of a peak: a region of cubature that its top is not in may hold a part of it.
    void see_flanks(const Witness& peak) {
        std::vector<Point> points;
        for (std::size_t d = 0; d < n_; ++d)
            for (double distance : {-2.0, 2.0}) { // extents
                points.push_back(peak.u);
                double& u = points.back()[d];
                u += distance * peak.extent[d];
                if (!(u > 0 && u < 1)) points.pop_back();
            }
        const auto rows = raw_(points);
        for (std::size_t i = 0; i < points.size(); ++i) keep(points[i], rows[i], peak.volume, false);
    }

    static std::vector<Point> places_of(const std::vector<GuideZero>& zeros) {
        std::vector<Point> places;
        places.reserve(zeros.size());
        for (const GuideZero& zero : zeros) places.push_back(zero.u);
        return places;
    }

    // Tells ridges from peaks: there the integrand is as high at several zeros of a guide as between two of them. Their
    // volume is that along the way, of which the box around one point is a small part.
    void find_ridges() {
        for (std::size_t first = 0, next = 0; first < zeros_.size() && n_ <= most_climbed; first = next) {
            std::vector<Point> zeros;
            for (; next < zeros_.size() && zeros_[next].guide == zeros_[first].guide; ++next)
                zeros.push_back(zeros_[next].u);
            // One component may vanish where another has a ridge.
            for (std::size_t c = 0; c < components() && zeros.size() > 1 && affordable(40 * n_); ++c) {
                component_ = c;
                find_ridge(settings_.guides[zeros_[first].guide], zeros);
            }
            component_.reset();
        }
    }

    // `beside`: the guide is one that was shifted to a ridge beside a valley, beside which no further ones are looked for.
    void find_ridge(const Integrand::BatchFunction& guide, std::vector<Point> zeros, bool beside = false) {
        const Magnitude magnitude = [&](const std::vector<double>& row) { return size(row); };
        // The nearest pair: a climb from between remote points of a curve may lead anywhere.
        const std::vector<Link> tree = tree_of(zeros);
        const Link& nearest = *std::ranges::min_element(tree, {}, &Link::length);
        Point between(n_);
        for (std::size_t d = 0; d < n_; ++d) between[d] = 0.5 * (zeros[nearest.a][d] + zeros[nearest.b][d]);
        zeros.push_back(climb_to_zero(guide, raw_.evaluator().domain(), between));
        // Isolated roots: a climb from between two of them leads to either.
        for (std::size_t end : {nearest.a, nearest.b})
            if (distance(zeros.back(), zeros[end]) < same_root * nearest.length) return;
        const auto rows = raw_(zeros);
        for (std::size_t i = 0; i < rows.size(); ++i)
            if (!keep(zeros[i], rows[i], 0, false)) return;
        Witness top{zeros.back(), rows.back()};
        const double height = size(top.value), ordinary = outstanding * median_size();
        measure(raw_, top, magnitude);
        if (is_rounding(top)) return;
        if (!(height > 0) || is_valley(raw_, top, magnitude)) {
            if (!beside) find_ridges_beside(guide, top, zeros);
            return;
        }
        double length = 0;
        std::vector<std::size_t> high;
        for (const Link& link : tree)
            if (std::min(size(rows[link.a]), size(rows[link.b])) > 0.5 * height) length += link.length;
        for (std::size_t i = 0; i < rows.size(); ++i)
            if (size(rows[i]) > 0.5 * height) high.push_back(i);
        top.volume *= std::max(1.0, length / (2 * *std::ranges::max_element(top.extent)));
        if (height > ordinary && length > 0)
            for (std::size_t i : high) { // each speaks for its part
                const double part = top.volume / static_cast<double>(high.size());
                look_.peaks.push_back({zeros[i], rows[i], part, top.extent});
                ++of_ridges_;
            }
        if (n_ <= most_followed) follow(guide, zeros, least_followed * height * top.volume);
    }

    // An integrand that vanishes where a guide does may have ridges on both sides: there the guide has the value that it
    // has at the integrand's top beside the valley, or its negative.
    void find_ridges_beside(const Integrand::BatchFunction& guide, const Witness& valley,
                            const std::vector<Point>& zeros) {
        const Domain& domain = raw_.evaluator().domain();
        if (!affordable(40 * n_)) return;
        const Witness top = climb(raw_, valley, [&](const std::vector<double>& row) { return size(row); });
        if (!(size(top.value) > median_size())) return;
        Point half = top.u; // where an indicator is as high
        for (std::size_t d = 0; d < n_; ++d) half[d] = 0.5 * (half[d] + valley.u[d]);
        if (raw_({half})[0] == top.value) return;
        const double level = guide_at(guide, domain, top.u);
        for (double value : {level, -level}) {
            const Integrand::BatchFunction beside = [&guide, value](const PointBatch& x, ValueBatch y) {
                guide(x, y);
                for (std::size_t i = 0; i < x.count(); ++i) y(i, 0) -= value;
            };
            std::vector<Point> moved;
            moved.reserve(zeros.size());
            for (const Point& zero : zeros) moved.push_back(climb_to_zero(beside, domain, zero));
            if (affordable(40 * n_)) find_ridge(beside, std::move(moved), true);
        }
    }

    // Follows a ridge to the ends of the variables from that of its points which is nearest; those ends first where its
    // first part holds most.
    void follow(const Integrand::BatchFunction& guide, const std::vector<Point>& points, double least) {
        // Sizes in units that do not change by what is found here.
        const Magnitude magnitude = [this, unit = largest_](const std::vector<double>& row) {
            return size(row, unit);
        };
        struct End {
            std::size_t d;
            double side, mass;
            Point from;
        };
        std::vector<End> ends;
        for (std::size_t d = 0; d < n_; ++d)
            for (double side : {-1.0, 1.0}) {
                const Point& from =
                    *std::ranges::max_element(points, {}, [&](const Point& u) { return side * u[d]; });
                const RidgeToEnd first = follow_ridge(raw_, guide, from, d, side, magnitude, least, 0);
                if (!first.tops.empty())
                    ends.push_back({d, side, magnitude(first.tops[0].value) * first.tops[0].volume, from});
            }
        std::ranges::sort(ends, std::greater{}, &End::mass);
        std::vector<Point> followed;
        for (const End& end : ends) {
            if (!affordable(0)) return;
            const RidgeToEnd ridge = follow_ridge(raw_, guide, end.from, end.d, end.side, magnitude, least,
                                                  settings_.most_evaluations - raw_.evaluations());
            const std::size_t before = followed.size();
            for (const Witness& w : ridge.tops) {
                // A curve may lead to the ends of two variables at once.
                const auto is_near = [&](const Point& u) { return largest_difference(u, w.u) < same_branch; };
                if (keep(w.u, w.value, w.volume, false))
                    look_.witnesses.back().is_part =
                        std::ranges::none_of(std::span(followed).first(before), is_near);
                followed.push_back(w.u);
            }
            if (ridge.beyond > 0 && look_.witnesses.back().is_part)
                masses_.add_unresolved(ridge.tops.back(), ridge.beyond);
            if (ridge.diverges && look_.divergence.empty())
                look_.divergence = limit_text(raw_.evaluator().domain(), ridge.tops.back().u);
        }
    }

    static double largest_difference(const Point& a, const Point& b) {
        double most = 0;
        for (std::size_t d = 0; d < a.size(); ++d) most = std::max(most, std::abs(a[d] - b[d]));
        return most;
    }

    static double distance(const Point& a, const Point& b) {
        double squares = 0;
        for (std::size_t d = 0; d < a.size(); ++d) squares += std::pow(a[d] - b[d], 2);
        return std::sqrt(squares);
    }

    struct Link {
        std::size_t a, b;
        double length;
    };
    // A tree of points: links from each but the first to the nearest before it.
    static std::vector<Link> tree_of(const std::vector<Point>& points) {
        std::vector<Link> tree;
        for (std::size_t i = 1; i < points.size(); ++i) {
            Link link{i, 0, infinity};
            for (std::size_t j = 0; j < i; ++j)
                if (const double length = distance(points[i], points[j]); length < link.length)
                    link = {i, j, length};
            tree.push_back(link);
        }
        return tree;
    }

    RawValues raw_;
    LookSettings settings_;
    std::size_t n_;
    std::vector<GuideZero> zeros_;
    LadderPaths paths_;
    LadderMasses masses_;
    std::vector<double> largest_; // |g| of each component
    std::optional<std::size_t> component_;
    std::vector<std::size_t> ordinary_; // witnesses
    // Witnesses close to a place inside, far above the beginning of their ladder.
    std::vector<std::size_t> deep_;
    std::size_t of_ridges_ = 0; // peaks on ridges,
    std::size_t flanked_ = 0;   // and those whose flanks were seen
    FirstLook look_;
};

} // namespace

FirstLook first_look(const Evaluator& evaluator, const LookSettings& settings) {
    return Look(evaluator, settings)();
}

std::string place_text(const Domain& domain, std::span<const double> at) {
    PointBuffer u(1, static_cast<int>(at.size())), x(1, domain.dimensions());
    for (int d = 0; d < u.dimensions(); ++d) u(0, d) = at[static_cast<std::size_t>(d)];
    std::array<double, 1> volume{1};
    domain.map(u, x, volume);
    constexpr double rounding = 1e-12; // beside the largest coordinate
    double largest = 0;
    for (int d = 0; d < domain.dimensions(); ++d) largest = std::max(largest, std::abs(x.view()(0, d)));
    return tuple_text(domain.dimensions(), [&](int d) {
        return number_text(std::abs(x.view()(0, d)) < rounding * largest ? 0 : x.view()(0, d));
    });
}

std::string limit_text(const Domain& domain, std::span<const double> at) {
    return tuple_text(domain.dimensions(), [&](int d) { return domain.name(d); }) + " -> " +
           place_text(domain, at);
}

} // namespace montelux
