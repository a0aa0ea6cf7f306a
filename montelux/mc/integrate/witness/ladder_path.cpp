#include "montelux/mc/integrate/witness/ladder_path.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <tuple>
#include <utility>

#include "montelux/mc/integrate/points.h"
#include "montelux/mc/integrate/unit_points.h"
#include "montelux/mc/integrate/witness/shells.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/random/hash.h"

namespace montelux {
namespace {

constexpr std::size_t most_anchors = 16; // of a variable,
constexpr std::size_t most_guided = 12;  // by places
constexpr std::size_t most_searched = 8; // variables of a map whose nearest points are searched for
constexpr double same_place = 0x1p-50;
// Exponent of the smallest distance from a place that was found by climbing, and how far from it that place may lie.
constexpr double finest_of_climb = 36, of_climb = 0x1p-36;

bool are_near(const Anchor& a, const Anchor& b) { return std::abs(a.u - b.u) < same_place; }

} // namespace

int LadderPath::codimension() const {
    int sum = 0;
    for (std::size_t d = 0; d < side.size(); ++d) sum += rate(d);
    return sum;
}

double LadderPath::finest() const {
    double least = std::min(finest_at_origin, precise_to);
    for (std::size_t d = 0; d < side.size(); ++d)
        if (side[d] != 0) least = std::min(least, (anchors[d].finest + std::log2(reach[d])) / rate(d));
    return std::min(least, std::max(finest_inside, finest_at_origin / codimension()));
}

double LadderPath::end() const {
    constexpr double near = 20; // exponent of a small distance
    if (codimension() != 1) return infinity;
    const auto d =
        static_cast<std::size_t>(std::ranges::find_if(side, [](double s) { return s != 0; }) - side.begin());
    const double distance = anchors[d].finest - finest_inside;
    const bool at_end = anchors[d].u == 0 || anchors[d].u == 1;
    return at_end && distance > near && anchors[d].finest < finest_at_origin ? distance : infinity;
}

double LadderPath::volume(double exponent, const std::vector<double>& across) const {
    double product = std::min(1.0, thickness * std::exp2(exponent));
    for (std::size_t d = 0; d < side.size(); ++d)
        product *= side[d] != 0 ? reach[d] * std::exp2(-rate(d) * exponent) : across[d];
    return product;
}

std::vector<double> LadderPath::at(double exponent) const {
    std::vector<double> u(side.size());
    for (std::size_t d = 0; d < u.size(); ++d)
        u[d] = std::clamp(anchors[d].u + side[d] * reach[d] * off_grid * std::exp2(-rate(d) * exponent),
                          std::numeric_limits<double>::min(), 1 - 0x1p-53);
    return u;
}

std::pair<std::vector<double>, std::vector<double>> LadderPath::within(double exponent) const {
    std::vector<double> lower(side.size(), 0.0), upper(side.size(), 1.0);
    const std::vector<double> farthest = at(exponent);
    for (std::size_t d = 0; d < side.size(); ++d)
        if (side[d] != 0) std::tie(lower[d], upper[d]) = std::minmax(anchors[d].u, farthest[d]);
    return {lower, upper};
}

LadderPaths::LadderPaths(const Domain& domain, std::size_t dimensions,
                         std::span<const std::vector<double>> landmarks,
                         std::span<const std::vector<double>> places, std::uint64_t seed)
    : domain_(domain), n_(dimensions), seed_(seed), anchors_(n_) {
    const std::span<const Range> ranges = domain_.ranges();
    for (double u : {0.0, 1.0, 0.5}) {
        places_.emplace_back();
        for (std::size_t d = 0; d < n_; ++d) {
            const Anchor a{u, finest_exponent(domain_, d, u)};
            places_.back().push_back(a);
            anchors_[d].push_back(a);
        }
    }
    for (const std::vector<double>& x : landmarks)
        if (const auto n = static_cast<std::size_t>(domain_.dimensions()); x.size() != n)
            throw Error("integrate", "a landmark has " + std::to_string(x.size()) +
                                         " coordinates; expected " + std::to_string(n) +
                                         ", one per variable");
    if (ranges.empty() && n_ > most_searched) return;
    if (!ranges.empty()) add_place(place_in_ranges(std::vector<double>(n_, 0.0)));
    std::vector<std::vector<Anchor>> of_landmarks;
    for (std::size_t i = 0; i < landmarks.size() && i < most_anchors; ++i)
        of_landmarks.push_back(ranges.empty() ? nearest_place(landmarks[i]) : place_in_ranges(landmarks[i]));
    for (std::size_t i = 0; i < places.size() && places_.size() < most_guided; ++i) {
        std::vector<Anchor> place;
        for (std::size_t d = 0; d < n_; ++d) {
            place.push_back(
                {places[i][d], ranges.empty()
                                   ? finest_of_climb
                                   : std::min(finest_of_climb, finest_exponent(domain_, d, places[i][d]))});
            // Numbers of a formula are exact, climbs come close to them.
            for (const std::vector<Anchor>& other : of_landmarks)
                if (!other.empty() && std::abs(other[d].u - places[i][d]) < of_climb) place.back() = other[d];
        }
        add_place(std::move(place));
    }
    for (std::vector<Anchor>& place : of_landmarks)
        if (places_.size() < most_anchors) add_place(std::move(place));
}

void LadderPaths::add_place(std::vector<Anchor> place) {
    for (std::size_t d = 0; d < place.size(); ++d)
        if (std::ranges::none_of(anchors_[d], [&](const Anchor& b) { return are_near(place[d], b); }))
            anchors_[d].push_back(place[d]);
    const auto is_place = [&](const std::vector<Anchor>& other) {
        return std::ranges::equal(place, other, are_near);
    };
    if (!place.empty() && std::ranges::none_of(places_, is_place)) places_.push_back(std::move(place));
}

std::vector<Anchor> LadderPaths::place_in_ranges(const std::vector<double>& x) const {
    const std::span<const Range> ranges = domain_.ranges();
    std::vector<Anchor> place;
    bool inside = false;
    for (std::size_t d = 0; d < n_; ++d) {
        place.push_back(anchors_[d][2]);
        if (!(x[d] > ranges[d].lower && x[d] < ranges[d].upper)) continue;
        const Anchor here = anchor(d, x[d]);
        if (!(here.u > 0 && here.u < 1)) continue;
        place.back() = here;
        inside = true;
    }
    return inside ? place : std::vector<Anchor>();
}

std::vector<Anchor> LadderPaths::nearest_place(const std::vector<double>& x) const {
    constexpr std::size_t scattered = 256;
    constexpr int most_steps = 400;
    const int n = static_cast<int>(n_);
    std::vector<double> best(n_, 0.5);
    double least = std::numeric_limits<double>::infinity();
    // Takes the nearest of these points of the cube, if nearer than the best one.
    const auto improves = [&](const PointBuffer& u) {
        PointBuffer at(u.count(), domain_.dimensions());
        std::vector<double> volumes(u.count(), 1.0);
        domain_.map(u, at, volumes);
        const double before = least;
        for (std::size_t i = 0; i < u.count(); ++i) {
            double squares = 0;
            for (std::size_t d = 0; d < x.size(); ++d)
                squares += std::pow(at.view()(i, static_cast<int>(d)) - x[d], 2);
            if (!(squares < least)) continue;
            least = squares;
            for (int d = 0; d < n; ++d) best[static_cast<std::size_t>(d)] = u.view()(i, d);
        }
        return least < before;
    };
    PointBuffer u(scattered, n);
    fill_random(u, seed_, 0, 0);
    improves(u);
    // Compass search (Kolda, Lewis and Torczon 2003, "Optimization by direct search").
    PointBuffer around(2 * n_, n);
    int exponent = 3;
    for (int step = 0; step < most_steps && exponent < finest_inside; ++step) {
        for (std::size_t i = 0; i < around.count(); ++i)
            for (int d = 0; d < n; ++d) {
                const double center = best[static_cast<std::size_t>(d)];
                const double by =
                    d == static_cast<int>(i / 2) ? std::ldexp(i % 2 ? 1.0 : -1.0, -exponent) : 0;
                around(i, d) = std::clamp(center + by, 0.0, 1.0);
            }
        if (!improves(around)) ++exponent;
    }
    std::vector<Anchor> place;
    place.reserve(best.size());
    for (double c : best) place.push_back({c, finest_inside});
    return place;
}

Anchor LadderPaths::anchor(std::size_t d, double x) const {
    PointBuffer at(1, static_cast<int>(n_)), u(1, static_cast<int>(n_));
    for (std::size_t e = 0; e < n_; ++e) at(0, static_cast<int>(e)) = x;
    std::array<double, 1> volume{1};
    domain_.inverse(at, u, volume);
    const double here = u.view()(0, static_cast<int>(d));
    return {here, here > 0 && here < 1 ? finest_exponent(domain_, d, here) : finest_inside};
}

double LadderPaths::random() {
    return static_cast<double>(hash_key(seed_, 0x6c6f6f6b, drawn_++) >> 11) * 0x1p-53;
}

std::vector<LadderPath> LadderPaths::along(std::size_t d, const std::vector<double>& through,
                                           bool ends) const {
    std::vector<LadderPath> paths;
    for (std::size_t i = 0; i < anchors_[d].size() && (!ends || i < 2); ++i)
        for (double side : {1.0, -1.0}) {
            const double r = reach(anchors_[d][i].u, side);
            if (r == 0) continue;
            LadderPath path{{}, std::vector<double>(n_, 0.0), std::vector<double>(n_, 0.0)};
            for (std::size_t e = 0; e < n_; ++e)
                path.anchors.push_back(e == d ? anchors_[d][i] : Anchor{through[e], finest_inside});
            path.side[d] = side;
            path.reach[d] = r;
            paths.push_back(std::move(path));
        }
    return paths;
}

std::vector<LadderPath> LadderPaths::joint() {
    std::vector<LadderPath> paths;
    const std::size_t mixed = n_ <= 3 ? 16 : 8, corners = n_ <= 3 ? std::size_t{1} << n_ : 0;
    for (std::size_t i = 0; i < places_.size() + mixed; ++i) {
        const bool place = i < places_.size();
        LadderPath path;
        for (std::size_t d = 0; d < n_; ++d) {
            const std::size_t count = anchors_[d].size();
            const Anchor anchor =
                place ? places_[i][d]
                : i < places_.size() + corners
                    ? anchors_[d][(i - places_.size()) >> d & 1]
                    : anchors_[d][std::min(count - 1,
                                           static_cast<std::size_t>(random() * static_cast<double>(count)))];
            const double side = anchor.u == 0 ? 1 : anchor.u == 1 ? -1 : place || random() < 0.5 ? 1 : -1;
            path.anchors.push_back(anchor);
            path.side.push_back(side);
            // The first ones along diagonals, where ridges are; the others in directions of their own.
            path.reach.push_back(reach(anchor.u, side) * (place ? 1 : 0.5 + 0.5 * random()));
        }
        path.is_diagonal = place;
        if (place) {
            LadderPath opposite = path;
            bool inside = false;
            for (std::size_t d = 0; d < n_; ++d)
                if (path.anchors[d].u != 0 && path.anchors[d].u != 1) {
                    inside = true;
                    opposite.side[d] = -path.side[d];
                    opposite.reach[d] = std::min(opposite.reach[d], reach(path.anchors[d].u, -path.side[d]));
                }
            if (inside) paths.push_back(std::move(opposite));
        }
        paths.push_back(std::move(path));
    }
    return paths;
}

LadderPath LadderPaths::to_corner(const std::vector<double>& place, std::vector<int> rates) const {
    LadderPath path{{}, {}, std::vector<double>(n_, 1.0), std::move(rates)};
    for (std::size_t d = 0; d < n_; ++d) {
        path.anchors.push_back(anchors_[d][place[d] == 0 ? 0 : 1]);
        path.side.push_back(place[d] == 0 ? 1 : -1);
    }
    return path;
}

std::vector<LadderPath> LadderPaths::of_two_scales(const std::vector<double>& place) const {
    std::vector<LadderPath> paths;
    for (std::size_t one = 0; one < n_; ++one)
        for (int rate : {1, 2}) {
            if (n_ == 2 && rate == 2) continue; // the other variable's with 1
            std::vector<int> rates(n_, 3 - rate);
            rates[one] = rate;
            paths.push_back(to_corner(place, std::move(rates)));
        }
    return paths;
}

LadderPath LadderPaths::to_random_corner() {
    std::vector<double> place(n_);
    for (double& u : place) u = random() < 0.5;
    return to_corner(place);
}

std::vector<double> LadderPaths::generic_point() {
    std::vector<double> u(n_);
    for (double& c : u) c = 0.25 + 0.5 * random();
    return u;
}

void LadderPaths::vary(LadderPath& path) {
    for (std::size_t d = 0; d < n_; ++d)
        if (path.side[d] != 0) path.reach[d] *= 0.3 + 0.7 * random();
}

std::vector<double> LadderPaths::widths(const LadderPath& path) const {
    std::vector<double> widths(n_, 1.0);
    for (std::size_t d = 0; d < n_; ++d)
        if (path.side[d] == 0)
            for (const Anchor& a : anchors_[d])
                widths[d] = std::min(widths[d], std::abs(path.anchors[d].u - a.u));
    return widths;
}

} // namespace montelux
