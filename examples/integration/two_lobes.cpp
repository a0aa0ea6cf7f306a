// An integrand of two lobes, a wide and a narrow one, times a quantity that neither density contains: |x|^2
// (N(x; a, s^2) + N(x; b, t^2)) over the plane, which is |a|^2 + 2 s^2 + |b|^2 + 2 t^2. Samples of both
// densities are combined by multiple importance sampling; each heuristic is unbiased.
#include "comparison.h"
#include <limits>
#include <montelux/mc/dist/family/normal.h>
#include <montelux/mc/integrate/integrate.h>
#include <montelux/mc/integrate/techniques/importance.h>
#include <montelux/mc/integrate/techniques/multiple_importance.h>
#include <span>
#include <vector>

using namespace montelux;

struct Lobe {
    double x, y, deviation;

    Technique density() const {
        return Technique(
            {Distribution(NormalDistribution(x, deviation)), Distribution(NormalDistribution(y, deviation))});
    }
    double operator()(std::span<const double> at) const {
        return NormalDistribution(x, deviation).pdf(at[0]) * NormalDistribution(y, deviation).pdf(at[1]);
    }
    double integral() const { return x * x + y * y + 2 * deviation * deviation; }
};
constexpr Lobe wide{0, 0, 1}, narrow{1, 0.5, 0.1};

int main() {
    Comparison comparison(4); // wider, since one of this many comparisons would sometimes exceed three errors
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const Domain plane{{-infinity, infinity}, {-infinity, infinity}};
    const double exact = wide.integral() + narrow.integral();
    const Budget budget{.evaluations = 200'000};
    const auto f = [](std::span<const double> x) {
        return (x[0] * x[0] + x[1] * x[1]) * (wide(x) + narrow(x));
    };
    const auto compare = [&](const char* what, const Method& method) {
        const IntegrationResult r = integrate(f, plane, method, budget);
        comparison.add(what, r.estimate(), exact);
        for (const std::string& warning : r.warnings) std::cout << "  warning: " << warning << "\n";
    };

    compare("the wide density alone", Importance{wide.density()});
    const std::vector<WeightedTechnique> both{{wide.density()}, {narrow.density()}};
    compare("both, balance heuristic", MultipleImportance{both, MisHeuristic::balance()});
    compare("both, power heuristic", MultipleImportance{both, MisHeuristic::power(2)});
    compare("both, cutoff heuristic", MultipleImportance{both, MisHeuristic::cutoff(0.1)});
    compare("both, maximum heuristic", MultipleImportance{both, MisHeuristic::maximum()});
    compare("both, optimal weights", MultipleImportance{both, OptimalWeights{}});
    // Three samples of the wide density for one of the narrow one: each sum is divided by its own count.
    const std::vector<WeightedTechnique> unequal{{wide.density(), 3}, {narrow.density(), 1}};
    compare("three to one, balance heuristic", MultipleImportance{unequal, MisHeuristic::balance()});
    return comparison.exit_code();
}
