#include "montelux/mc/integrate/witness/imprecise_mass.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

#include "montelux/mc/integrate/unit_points.h"
#include "montelux/mc/integrate/witness/ladder_path.h"
#include "montelux/mc/random/hash.h"

namespace montelux {
namespace {

constexpr std::size_t batch = 256;
constexpr int most_dimensions_weighed = 64;
constexpr double imprecise = 0.01;  // relative error of values that lost their digits
constexpr double finest_scale = 54; // exponent of the smallest distance from an anchor
constexpr double uniform_share_of_scales = 1.0 / 3;
constexpr std::uint64_t stream = 0x726f756e64;

// Density of one variable: a part is uniform, and of the rest each anchor has the same share, with distances from it whose
// logarithms are uniform. It may leave the unit interval.
class AllScales {
  public:
    explicit AllScales(std::span<const Anchor> anchors) {
        for (const Anchor& a : anchors) {
            const double least = std::exp2(-std::min(finest_scale, a.finest));
            for (const double sign : {1.0, -1.0})
                sides_.push_back({a.u, a.u == 0 ? 1 : a.u == 1 ? -1 : sign, least});
        }
    }
    // From two numbers in (0, 1).
    double sample(double choice, double along) const {
        if (choice < uniform_share_of_scales) return along;
        const double side = (choice - uniform_share_of_scales) / (1 - uniform_share_of_scales) *
                            static_cast<double>(sides_.size());
        const Side& s = sides_[std::min(static_cast<std::size_t>(side), sides_.size() - 1)];
        const double u = s.from + s.sign * std::pow(s.least, along);
        return std::clamp(u, s.from == 0 ? 0.0 : -1.0, s.from == 1 ? 1 - 0x1p-53 : 2.0);
    }
    double pdf(double u) const {
        double sum = 0;
        for (const Side& s : sides_)
            if (const double distance = (u - s.from) * s.sign; distance >= s.least)
                sum += 1 / (distance * -std::log(s.least));
        return uniform_share_of_scales +
               (1 - uniform_share_of_scales) * sum / static_cast<double>(sides_.size());
    }

  private:
    struct Side {
        double from, sign, least; // distance
    };
    std::vector<Side> sides_;
};

// Density of all variables, for products of them: towards a random corner, where the sum of the exponents of the distances
// from its faces is uniform, and so is its division.
class Corners {
  public:
    explicit Corners(int variables) : n_(variables) {}
    // `random`: two numbers for each variable, and one for the sum.
    void sample(const PointBatch& random, std::size_t i, double sum, PointBuffer& u) const {
        double all = 0;
        for (int d = 0; d < n_; ++d) all -= std::log(random(i, d));
        for (int d = 0; d < n_; ++d) {
            const double distance = 0.5 * std::exp2(-finest_scale * sum * -std::log(random(i, d)) / all);
            u(i, d) = random(i, n_ + d) < 0.5 ? distance : std::min(1 - distance, 1 - 0x1p-53);
        }
    }
    double pdf(const PointBuffer& u, std::size_t i) const {
        double sum = 0,
               logarithm = std::lgamma(n_) - std::log(finest_scale) - n_ * std::log(2 * std::numbers::ln2);
        for (int d = 0; d < n_; ++d) {
            const double distance = std::min(u.view()(i, d), 1 - u.view()(i, d));
            sum -= std::log2(2 * distance);
            logarithm -= std::log(distance);
        }
        return sum > finest_scale ? 0
               : n_ == 1          ? std::exp(logarithm)
                                  : std::exp(logarithm - (n_ - 1) * std::log(sum));
    }

  private:
    int n_;
};

// Sums over points of one component.
class Imprecise {
  public:
    // `error`: by rounding.
    void add(double weight, double value, double error) {
        const double size = std::abs(value);
        all_ += weight * size;
        if (!(error > 0) || std::isinf(error)) return;
        if (size == 0) {
            zero_volume_ += weight;
            of_zeros_ += weight * error;
        } else if (error > imprecise * size) {
            volume_ += weight;
            mass_ += weight * size;
        } else {
            of_digits_ += weight * error;
        }
    }
    // Zeros by rounding hold no more than their errors, and about as much as other values that lost their digits, or as all:
    // towards a pole errors grow without limit, and values do not.
    double total(double points) const {
        const double size = volume_ > 0 ? mass_ / volume_ : all_ / points;
        return of_digits_ + mass_ + (size > 0 ? std::min(of_zeros_, zero_volume_ * size) : of_zeros_);
    }

  private:
    double all_ = 0, of_digits_ = 0, mass_ = 0, volume_ = 0, zero_volume_ = 0, of_zeros_ = 0;
};

} // namespace

std::vector<double> imprecise_mass(const Evaluator& evaluator, std::span<const std::vector<double>> landmarks,
                                   std::uint64_t seed, std::size_t points) {
    const Integrand::BatchFunction& rounding = evaluator.integrand().rounding();
    if (!rounding || evaluator.dimensions() > most_dimensions_weighed || points < batch) return {};
    const int n = evaluator.dimensions(), components = evaluator.components();
    const Domain& domain = evaluator.domain();
    const LadderPaths paths(domain, static_cast<std::size_t>(n), landmarks, {}, seed);
    std::vector<AllScales> scales;
    scales.reserve(static_cast<std::size_t>(n));
    for (int d = 0; d < n; ++d) scales.emplace_back(paths.anchors(static_cast<std::size_t>(d)));
    const Corners corners(n);

    std::vector<Imprecise> masses(static_cast<std::size_t>(components));
    std::vector<double> weight(batch), volume(batch);
    PointBuffer random(batch, 2 * n + 1), u(batch, n), x(batch, domain.dimensions());
    ValueBuffer g(batch, components), twice(batch, 2 * components);
    NonFiniteCount ignored;
    const ScrambledSobol sobol(2 * n + 1, hash_key(seed, stream), 0);
    const std::size_t whole = points / batch * batch;
    for (std::size_t first = 0; first < whole; first += batch) {
        sobol.fill(random, first);
        for (std::size_t i = 0; i < batch; ++i) {
            const double choice = random.view()(i, 2 * n);
            if (choice < 0.25) corners.sample(random, i, 4 * choice, u);
            double pdf = 1;
            bool outside = false;
            for (int d = 0; d < n; ++d) {
                const AllScales& density = scales[static_cast<std::size_t>(d)];
                const double along = random.view()(i, d);
                if (choice >= 0.25)
                    u(i, d) = choice < 0.5 ? density.sample(random.view()(i, n + d), along) : along;
                outside = outside || !(u.view()(i, d) > 0 && u.view()(i, d) < 1);
                pdf *= density.pdf(u.view()(i, d));
            }
            weight[i] = outside ? 0 : 1 / (0.5 + 0.25 * pdf + 0.25 * corners.pdf(u, i));
            for (int d = 0; outside && d < n; ++d) u(i, d) = 0.5;
        }
        std::ranges::fill(volume, 1.0);
        domain.map(u, x, volume);
        std::vector<std::size_t> not_finite;
        evaluator(u, g, ignored, &not_finite);
        for (std::size_t i : not_finite) weight[i] = 0;
        rounding(x, twice);
        for (int c = 0; c < components; ++c)
            for (std::size_t i = 0; i < batch; ++i) {
                const double value = g.view()(i, c), first_error = volume[i] * twice.view()(i, 2 * c) - value,
                             second_error = volume[i] * twice.view()(i, 2 * c + 1) - value;
                masses[static_cast<std::size_t>(c)].add(
                    weight[i], value, std::max(std::abs(first_error), std::abs(second_error)));
            }
    }
    std::vector<double> mass;
    mass.reserve(masses.size());
    const auto count = static_cast<double>(whole);
    for (const Imprecise& m : masses) mass.push_back(m.total(count) / count);
    return mass;
}

} // namespace montelux
