#include "montelux/mc/integrate/witness/guide_zeros.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "montelux/mc/integrate/adaptive/mode_search.h"
#include "montelux/mc/integrate/infinity.h"
#include "montelux/mc/integrate/unit_points.h"
#include "montelux/mc/random/hash.h"

namespace montelux {
namespace {

constexpr std::size_t scattered = 256, most_zeros = 8, most_variables = 8;
constexpr double apart = 0.1;        // of the cube's width: between starts
constexpr double of_ordinary = 1e-3; // of the median at scattered points: what counts as zero
constexpr double same_zero = 1e-9, at_face = 1e-5;
constexpr double inside = 1e-3;                      // distance from the opposite face, where a climb goes on
constexpr double nearest = 1e-12, same_point = 1e-9; // to faces, and of two points there

// Values of a guide at points of the cube.
std::vector<double> values_at(const Integrand::BatchFunction& guide, const Domain& domain,
                              const PointBatch& u) {
    PointBuffer x(u.count(), domain.dimensions());
    std::vector<double> volumes(u.count(), 1.0);
    domain.map(u, x, volumes);
    ValueBuffer g(u.count(), 1);
    guide(x, g);
    std::vector<double> values(u.count());
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = std::as_const(g)(i, 0);
    return values;
}

// |guide| at points of the cube; infinite where it is not finite.
std::vector<double> sizes_at(const Integrand::BatchFunction& guide, const Domain& domain,
                             const PointBatch& u) {
    std::vector<double> sizes = values_at(guide, domain, u);
    for (double& size : sizes) size = std::isfinite(size) ? std::abs(size) : infinity;
    return sizes;
}

double distance(const std::vector<double>& a, const std::vector<double>& b) {
    double most = 0;
    for (std::size_t d = 0; d < a.size(); ++d) most = std::max(most, std::abs(a[d] - b[d]));
    return most;
}

class ZeroSearch {
  public:
    ZeroSearch(const Domain& domain, std::uint64_t seed)
        : domain_(domain), n_(domain.uniforms()), u_(scattered, n_) {
        ScrambledSobol(n_, hash_key(seed, 0x67756964), 0).fill(u_, 0);
    }

    void operator()(const Integrand::BatchFunction& guide, std::size_t index, std::vector<GuideZero>& zeros) {
        const std::vector<double> sizes = sizes_at(guide, domain_, u_);
        const std::vector<char> depends = dependences(guide, sizes);
        std::vector<std::size_t> order(scattered);
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::ranges::sort(order, {}, [&](std::size_t i) { return sizes[i]; });
        const double ordinary = sizes[order[scattered / 2]];
        std::vector<std::vector<double>> starts;
        for (std::size_t i : order) {
            if (starts.size() == most_zeros || !(sizes[i] <= ordinary)) break;
            std::vector<double> at(static_cast<std::size_t>(n_), 0.5);
            for (std::size_t d = 0; d < at.size(); ++d)
                if (depends[d]) at[d] = u_.view()(i, static_cast<int>(d));
            if (std::ranges::any_of(starts, [&](const auto& s) { return distance(s, at) < apart; })) continue;
            starts.push_back(at);
            std::vector<double> zero = climb_to_zero(guide, domain_, std::move(at));
            if (goes_on_behind(zero)) zero = climb_to_zero(guide, domain_, std::move(zero));
            if (is_at_face(zero)) continue;
            if (!(std::abs(guide_at(guide, domain_, zero)) < of_ordinary * ordinary)) continue;
            const auto is_zero = [&](const GuideZero& other) { return distance(other.u, zero) < same_zero; };
            if (std::ranges::none_of(zeros, is_zero)) zeros.push_back({zero, index});
        }
    }

  private:
    static bool is_at_face(const std::vector<double>& zero) {
        return std::ranges::any_of(zero, [](double u) { return u < at_face || u > 1 - at_face; });
    }

    // Moves a point at a face behind the opposite one, if that is the same place: where a sphere's azimuth begins.
    bool goes_on_behind(std::vector<double>& zero) const {
        bool moved = false;
        for (std::size_t d = 0; d < zero.size(); ++d) {
            if (!(zero[d] < at_face || zero[d] > 1 - at_face)) continue;
            PointBuffer faces(2, n_), x(2, domain_.dimensions());
            for (std::size_t e = 0; e < zero.size(); ++e)
                for (std::size_t i = 0; i < 2; ++i)
                    faces(i, static_cast<int>(e)) = e != d ? zero[e] : i == 0 ? nearest : 1 - nearest;
            std::array<double, 2> volumes{1, 1};
            domain_.map(faces, x, volumes);
            bool same = true;
            for (int e = 0; e < domain_.dimensions(); ++e) {
                const double a = x.view()(0, e), b = x.view()(1, e);
                same = same && std::abs(a - b) <= same_point * (1 + std::abs(a));
            }
            if (!same) continue;
            zero[d] = zero[d] < at_face ? 1 - inside : inside;
            moved = true;
        }
        return moved;
    }

    // On which variables the guide depends: whether it changes where one has another point's value.
    std::vector<char> dependences(const Integrand::BatchFunction& guide,
                                  const std::vector<double>& sizes) const {
        constexpr std::size_t few = 16;
        std::vector<char> depends(static_cast<std::size_t>(n_));
        PointBuffer shifted(few, n_);
        for (int d = 0; d < n_; ++d) {
            for (int e = 0; e < n_; ++e)
                for (std::size_t i = 0; i < few; ++i) shifted(i, e) = u_.view()(e == d ? i + 1 : i, e);
            const std::vector<double> changed = sizes_at(guide, domain_, shifted);
            depends[static_cast<std::size_t>(d)] = !std::ranges::equal(changed, std::span(sizes).first(few));
        }
        return depends;
    }

    const Domain& domain_;
    int n_;
    PointBuffer u_;
};

} // namespace

std::vector<GuideZero> guide_zeros(std::span<const Integrand::BatchFunction> guides, const Domain& domain,
                                   std::uint64_t seed) {
    std::vector<GuideZero> zeros;
    if (guides.empty() || static_cast<std::size_t>(domain.uniforms()) > most_variables) return zeros;
    ZeroSearch search(domain, seed);
    for (std::size_t i = 0; i < guides.size(); ++i) search(guides[i], i, zeros);
    return zeros;
}

double guide_at(const Integrand::BatchFunction& guide, const Domain& domain, std::span<const double> u) {
    PointBuffer there(1, static_cast<int>(u.size()));
    for (std::size_t d = 0; d < u.size(); ++d) there(0, static_cast<int>(d)) = u[d];
    return values_at(guide, domain, there)[0];
}

std::vector<double> climb_to_zero(const Integrand::BatchFunction& guide, const Domain& domain,
                                  std::vector<double> u, std::optional<std::size_t> fixed) {
    std::vector<std::size_t> moving;
    for (std::size_t d = 0; d < u.size(); ++d)
        if (d != fixed) moving.push_back(d);
    std::vector<double> at;
    at.reserve(moving.size());
    for (std::size_t d : moving) at.push_back(u[d]);
    const DensityFunction inverse = [&](const PointBatch& points, std::span<double> h) {
        PointBuffer all(points.count(), static_cast<int>(u.size()));
        for (std::size_t d = 0; d < u.size(); ++d)
            std::ranges::fill(all.coordinate(static_cast<int>(d)), u[d]);
        for (std::size_t k = 0; k < moving.size(); ++k)
            std::ranges::copy(points.coordinate(static_cast<int>(k)),
                              all.coordinate(static_cast<int>(moving[k])).begin());
        const std::vector<double> sizes = sizes_at(guide, domain, all);
        for (std::size_t i = 0; i < sizes.size(); ++i) h[i] = 1 / (sizes[i] + 1e-300);
    };
    const std::uint64_t n = moving.size();
    climb_to_pole(inverse, at, 40 * (2 * n * n + 6));
    for (std::size_t k = 0; k < moving.size(); ++k) u[moving[k]] = at[k];
    return u;
}

} // namespace montelux
