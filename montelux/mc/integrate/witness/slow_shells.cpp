#include "montelux/mc/integrate/witness/slow_shells.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace montelux {
namespace {

constexpr double slow = 0.51; // 1 / sqrt(r) among them, whose variance is infinite by a logarithm

// Integral of an exponential that has these values at both ends of an interval.
double between(double first, double last, double length) {
    if (!(first > 0) || !(last > 0)) return 0;
    const double logarithm = std::log(first / last);
    return std::abs(logarithm) < 1e-6 ? first * length : (first - last) / logarithm * length;
}

} // namespace

int SlowShells::codimension() const {
    return static_cast<int>(std::ranges::count_if(place, [](double u) { return u != free; }));
}

bool SlowShells::is_slow(std::size_t component) const {
    constexpr std::size_t outer = 1, inner = 4;
    const auto mass = [&](std::size_t i) { return std::abs(shells[i].value[component]) * shells[i].volume; };
    return std::ranges::all_of(shells, [&](const Witness& w) { return std::isfinite(w.value[component]); }) &&
           fall_slowly(mass(outer), mass(inner), exponents[inner] - exponents[outer], codimension());
}

bool fall_slowly(double outer_mass, double inner_mass, double exponents_between, int codimension) {
    return outer_mass > 0 && inner_mass > 0 && std::isfinite(outer_mass) && std::isfinite(inner_mass) &&
           std::log2(outer_mass / inner_mass) < slow * codimension * exponents_between;
}

double unreached(const SlowShells& slow, std::size_t c, std::span<const double> q, double points) {
    const std::size_t count = slow.shells.size();
    const double n = slow.codimension();
    std::vector<double> mass, expected; // per unit of the exponent; of the points
    for (std::size_t i = 0; i < count; ++i) {
        const Witness& shell = slow.shells[i];
        mass.push_back(std::abs(shell.value[c]) * shell.volume * n * std::numbers::ln2);
        expected.push_back(points * q[i] * shell.volume);
    }
    double sum = 0;
    if (expected[0] < 1 && expected[0] > 0)
        sum += mass[0] * std::min(slow.exponents[0], -std::log2(expected[0]) / n);
    for (std::size_t i = 0; i + 1 < count; ++i) {
        const double length = slow.exponents[i + 1] - slow.exponents[i];
        double first = 0, end = 1; // the part of the interval where fewer than one point is expected
        if ((expected[i] < 1) != (expected[i + 1] < 1)) {
            const double crossing = expected[i] > 0 && expected[i + 1] > 0
                                        ? std::log(expected[i]) / std::log(expected[i] / expected[i + 1])
                                        : 0;
            (expected[i] < 1 ? end : first) = crossing;
        } else if (expected[i] >= 1) {
            continue;
        }
        const double ratio = mass[i] > 0 ? mass[i + 1] / mass[i] : 0;
        sum +=
            between(mass[i] * std::pow(ratio, first), mass[i] * std::pow(ratio, end), length * (end - first));
    }
    const double last = slow.exponents[count - 1] - slow.exponents[count - 2];
    const double fall = mass[count - 1] > 0 ? std::log(mass[count - 2] / mass[count - 1]) / last : 0;
    if (fall > 0 && expected[count - 1] < 1) sum += mass[count - 1] / fall;
    return sum;
}

std::vector<Unreached> unreached(std::span<const SlowShells> all, std::size_t components,
                                 const UnitDensity* density, double points) {
    std::vector<Unreached> found(components);
    std::vector<double> most(components), q;
    std::vector<std::vector<double>> sums(components); // by codimension
    for (const SlowShells& slow : all) {
        q.clear();
        for (const Witness& w : slow.shells) q.push_back(density ? pdf_at(*density, w.u) : 1);
        for (std::size_t c = 0; c < components; ++c) {
            const double mass = unreached(slow, c, q, points);
            sums[c].resize(slow.place.size() + 1);
            double& sum = sums[c][static_cast<std::size_t>(slow.codimension())];
            sum += mass;
            found[c].mass = std::max(found[c].mass, sum);
            if (mass > most[c]) most[c] = mass, found[c].at = &slow;
        }
    }
    return found;
}

void save(StateWriter& state, const SlowShells& slow) {
    state.put(slow.place);
    state.put(slow.exponents);
    for (const Witness& w : slow.shells) save(state, w);
}

void load(StateReader& state, SlowShells& slow) {
    slow.place = state.get_doubles();
    slow.exponents = state.get_doubles();
    slow.shells.resize(slow.exponents.size());
    for (Witness& w : slow.shells) load(state, w);
}

} // namespace montelux
