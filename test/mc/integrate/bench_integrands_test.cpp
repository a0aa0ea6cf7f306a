#include "bench/integrate/gauss_legendre.h"
#include "bench/integrate/integrands.h"
#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <numbers>
#include <set>
#include <vector>

#include "montelux/mc/math/error.h"
#include "montelux/mc/random/philox_stream.h"

namespace montelux::bench {
namespace {

constexpr int seeds = 8;

// The integral over [a, b] by panels that end at the breaks.
double integrate_with_breaks(double a, double b, std::vector<double> breaks, int panels,
                             const std::function<double(double)>& f) {
    breaks.push_back(b);
    double total = 0;
    for (double end : breaks) {
        if (end <= a || end > b) continue;
        total += integrate_by_panels(a, end, panels, f);
        a = end;
    }
    return total;
}

// The integral over the unit cube by the product of a rule of N nodes in each coordinate.
template <std::size_t N>
double tensor_product(const BenchIntegrand& f) {
    const auto& rule = GaussLegendre<N>::rule();
    const int d = f.dimensions();
    std::vector<std::size_t> index(static_cast<std::size_t>(d), 0);
    std::vector<double> x(index.size());
    double total = 0;
    while (true) {
        double weight = 1;
        for (int j = 0; j < d; ++j) {
            x[j] = 0.5 + 0.5 * rule.nodes[index[j]];
            weight *= 0.5 * rule.weights[index[j]];
        }
        total += weight * f(x.data());
        int j = 0;
        while (j < d && ++index[j] == N) index[j++] = 0;
        if (j == d) return total;
    }
}

// For an integrand that is a product of functions of one coordinate each, from its values alone: its value at
// a point, times the integrals along the axes through that point.
double product_of_axes(const BenchIntegrand& f, std::vector<double> through) {
    const double centre = f(through.data());
    double product = centre;
    for (int j = 0; j < f.dimensions(); ++j) {
        product *= integrate_with_breaks(0, 1, {f.w()[j]}, 32, [&](double t) {
            std::vector<double> x = through;
            x[j] = t;
            return f(x.data()) / centre;
        });
    }
    return product;
}

// sum over the corners v of the cube of (-1)^|v| / (1 + c.v), over d! prod c_j, in 113 bits.
double corner_peak_by_corners(std::span<const double> c) {
    const auto d = static_cast<int>(c.size());
    __float128 sum = 0, divisor = 1;
    for (int j = 0; j < d; ++j) divisor *= static_cast<__float128>(c[j]) * (j + 1);
    for (unsigned v = 0; v < (1u << d); ++v) {
        __float128 base = 1;
        for (int j = 0; j < d; ++j)
            if (v >> j & 1) base += static_cast<__float128>(c[j]);
        const __float128 term = 1 / base;
        sum += __builtin_popcount(v) % 2 == 0 ? term : -term;
    }
    return static_cast<double>(sum / divisor);
}

double relative_difference(double a, double b) { return std::abs(a - b) / std::abs(b); }

std::vector<double> random_point(const BenchIntegrand& f, PhiloxStream& numbers) {
    std::vector<double> x;
    for (int j = 0; j < f.dimensions(); ++j) {
        const double u = numbers.next_double();
        x.push_back(std::isinf(f.upper()) ? u / (1 - u) : f.lower() + (f.upper() - f.lower()) * u);
    }
    return x;
}

TEST(BenchIntegrands, ProductsHaveTheIntegralsOfTheirAxes) {
    for (Family family : {Family::product_peak, Family::gaussian, Family::continuous, Family::discontinuous})
        for (int d : {2, 5, 8})
            for (int seed = 0; seed < seeds; ++seed) {
                const BenchIntegrand f({family, d}, seed);
                std::vector<double> through(f.w().begin(), f.w().end());
                if (family == Family::discontinuous)
                    for (double& x : through) x *= 0.5;
                EXPECT_LT(relative_difference(product_of_axes(f, through), f.exact()), 1e-12)
                    << line_name(f.line()) << " seed " << seed;
                // They are products indeed: the axes through another point give the same.
                for (double& x : through) x *= 0.9;
                EXPECT_LT(relative_difference(product_of_axes(f, through), f.exact()), 1e-11)
                    << line_name(f.line()) << " seed " << seed;
            }
}

TEST(BenchIntegrands, OscillatoryHasTheIntegralOfATensorProduct) {
    for (int seed = 0; seed < seeds; ++seed) {
        const BenchIntegrand f2({Family::oscillatory, 2}, seed), f5({Family::oscillatory, 5}, seed);
        EXPECT_LT(relative_difference(tensor_product<24>(f2), f2.exact()), 1e-12);
        EXPECT_LT(relative_difference(tensor_product<12>(f5), f5.exact()), 1e-12);
        EXPECT_GT(std::cos(f2.phase() + 3.0), 0.7);
    }
    const BenchIntegrand f8({Family::oscillatory, 8}, 0);
    EXPECT_LT(relative_difference(tensor_product<7>(f8), f8.exact()), 1e-10);
}

TEST(BenchIntegrands, CornerPeakHasTheIntegralOfItsCornersAndOfATensorProduct) {
    for (int d : {2, 5, 8})
        for (int seed = 0; seed < 100; ++seed) {
            const BenchIntegrand f({Family::corner_peak, d}, seed);
            EXPECT_LT(relative_difference(corner_peak_by_corners(f.c()), f.exact()), 1e-12)
                << d << " " << seed;
        }
    const BenchIntegrand f2({Family::corner_peak, 2}, 1), f5({Family::corner_peak, 5}, 1);
    EXPECT_LT(relative_difference(tensor_product<24>(f2), f2.exact()), 1e-12);
    EXPECT_LT(relative_difference(tensor_product<14>(f5), f5.exact()), 1e-11);
}

TEST(BenchIntegrands, PeaksAreTheirDefinitionAndHaveItsIntegral) {
    PhiloxStream numbers(3);
    for (Line line : {Line{Family::two_peaks, 4}, Line{Family::three_peaks, 8}, Line{Family::four_peaks, 8}})
        for (int seed = 0; seed < seeds; ++seed) {
            const BenchIntegrand f(line, seed);
            const double k = f.narrowness();
            auto side = [&](double t, double p) {
                return std::sqrt(k / std::numbers::pi) * std::exp(-k * (t - p) * (t - p));
            };
            double integral = 0;
            for (int peak = 0; peak < f.peaks(); ++peak) {
                double product = 1;
                for (double p : f.peak(peak))
                    product *= integrate_by_panels(0, 1, 32, [&](double t) { return side(t, p); });
                integral += product / f.peaks();
            }
            EXPECT_LT(relative_difference(integral, f.exact()), 1e-12) << line_name(line) << " seed " << seed;
            for (int trial = 0; trial < 20; ++trial) {
                const std::vector<double> x = random_point(f, numbers);
                double value = 0;
                for (int peak = 0; peak < f.peaks(); ++peak) {
                    double product = 1;
                    for (int j = 0; j < f.dimensions(); ++j) product *= side(x[j], f.peak(peak)[j]);
                    value += product / f.peaks();
                }
                EXPECT_NEAR(f(x.data()), value, 1e-10 * value);
            }
        }
    const BenchIntegrand two({Family::two_peaks, 4}, 1);
    EXPECT_LT(relative_difference(tensor_product<40>(two), two.exact()), 1e-10);
}

TEST(BenchIntegrands, RidgeIsTheMeanOfAGaussianAlongItAndHasItsIntegral) {
    PhiloxStream numbers(4);
    for (int d : {4, 8})
        for (int seed = 0; seed < seeds; ++seed) {
            const BenchIntegrand f({Family::ridge, d}, seed);
            const double k = f.narrowness(), a = f.ridge_begin(), b = f.ridge_end();
            auto side = [&](double t, double p) {
                return std::sqrt(k / std::numbers::pi) * std::exp(-k * (t - p) * (t - p));
            };
            const double integral = integrate_by_panels(a, b, 8, [&](double t) {
                const double one = integrate_by_panels(0, 1, 32, [&](double x) { return side(x, t); });
                return std::pow(one, d) / (b - a);
            });
            EXPECT_LT(relative_difference(integral, f.exact()), 1e-12) << d << " seed " << seed;
            // The error functions far from the ridge are known to the rounding of those on it.
            const std::vector<double> middle(static_cast<std::size_t>(d), 0.5);
            for (int trial = 0; trial < 20; ++trial) {
                // Near the diagonal, where the value is not tiny.
                std::vector<double> x = random_point(f, numbers);
                for (double& x_j : x) x_j = x[0] + 0.1 * (x_j - x[0]);
                const double value = integrate_by_panels(a, b, 32, [&](double t) {
                    double product = 1 / (b - a);
                    for (double x_j : x) product *= side(x_j, t);
                    return product;
                });
                EXPECT_NEAR(f(x.data()), value, 1e-9 * value + 1e-14 * f(middle.data()));
            }
        }
    const BenchIntegrand four({Family::ridge, 4}, 1);
    EXPECT_LT(relative_difference(tensor_product<40>(four), four.exact()), 1e-10);
}

TEST(BenchIntegrands, OneDimensionByQuadratureOverTheRangeAndOverTheUnitInterval) {
    for (Family family :
         {Family::sine, Family::exponential, Family::quadratic, Family::inverse_root, Family::jump})
        for (int seed = 0; seed < seeds; ++seed) {
            const BenchIntegrand f({family, 1}, seed);
            auto value = [&](double x) { return f(&x); };
            auto on_unit = [&](double u) { return f.on_unit_cube(&u); };
            const std::vector<double> breaks = {f.w()[0]};
            // x = s^2 takes the singularity of the root away.
            auto squared = [&](double s) { return 2 * s * value(s * s); };
            const double over_range = family == Family::inverse_root ? integrate_by_panels(0, 1, 4, squared)
                                      : family == Family::exponential
                                          ? integrate_by_panels(0, 20, 64, value)
                                          : integrate_with_breaks(f.lower(), f.upper(), breaks, 8, value);
            EXPECT_LT(relative_difference(over_range, f.exact()), 1e-12) << line_name(f.line());
            const double over_unit =
                family == Family::inverse_root
                    ? integrate_by_panels(0, 1, 4, [&](double s) { return 2 * s * on_unit(s * s); })
                    : integrate_with_breaks(0, 1, breaks, 64, on_unit);
            EXPECT_LT(relative_difference(over_unit, f.exact()), 1e-12) << line_name(f.line());
        }
}

TEST(BenchIntegrands, EveryLineHasANameAndAllFormsOfItAgree) {
    PhiloxStream numbers(5);
    std::set<std::string> names;
    for (Line line : bench_lines()) {
        EXPECT_TRUE(names.insert(line_name(line)).second) << line_name(line);
        EXPECT_EQ(line_named(line_name(line)), line);
        const BenchIntegrand f(line, 7);
        constexpr std::size_t n = 33;
        std::vector<std::vector<double>> columns(static_cast<std::size_t>(f.dimensions()),
                                                 std::vector<double>(n));
        std::vector<const double*> pointers;
        for (auto& column : columns) pointers.push_back(column.data());
        std::vector<double> expected(n), values(n), rows, row_values(n);
        for (std::size_t i = 0; i < n; ++i) {
            const std::vector<double> x = random_point(f, numbers);
            for (std::size_t j = 0; j < x.size(); ++j) columns[j][i] = x[j];
            expected[i] = f(x.data());
            const double extent = f.upper() - f.lower();
            for (double x_j : x)
                rows.push_back(std::isinf(extent) ? x_j / (1 + x_j) : (x_j - f.lower()) / extent);
        }
        f.evaluate(pointers.data(), n, values.data());
        f.rows_on_unit_cube(rows.data(), n, row_values.data());
        for (std::size_t i = 0; i < n; ++i) {
            EXPECT_NEAR(values[i], expected[i], 1e-13 * std::abs(expected[i])) << line_name(line);
            const double u = rows[i * static_cast<std::size_t>(f.dimensions())];
            const double jacobian = std::isinf(f.upper()) ? 1 / ((1 - u) * (1 - u)) : f.upper() - f.lower();
            EXPECT_NEAR(row_values[i], expected[i] * jacobian, 1e-9 * std::abs(row_values[i]))
                << line_name(line);
        }
    }
    EXPECT_EQ(names.size(), 28u);
    EXPECT_EQ(line_named("osc-3"), std::nullopt);
    EXPECT_THROW(BenchIntegrand({Family::gaussian, 9}, 0), Error);
    EXPECT_THROW(BenchIntegrand({Family::discontinuous, 1}, 0), Error);
    EXPECT_THROW(BenchIntegrand({Family::sine, 2}, 0), Error);
}

TEST(BenchIntegrands, SeedsDrawParametersOfTheGivenDifficulty) {
    std::set<double> integrals;
    for (int seed = 0; seed < 50; ++seed) {
        const BenchIntegrand f({Family::gaussian, 5}, seed), again({Family::gaussian, 5}, seed);
        EXPECT_EQ(f.exact(), again.exact());
        integrals.insert(f.exact());
        double difficulty = 0;
        for (double c : f.c()) difficulty += c;
        EXPECT_NEAR(difficulty, 15.2, 1e-12);
        const BenchIntegrand jump({Family::jump, 1}, seed);
        EXPECT_TRUE(jump.w()[0] > 0.2 && jump.w()[0] < 0.8);
    }
    EXPECT_EQ(integrals.size(), 50u);
}

// Ends of a range, where a map or the integrand is infinite.
TEST(BenchIntegrands, UnitCubeFormIsFiniteAtTheEdges) {
    for (Line line : bench_lines()) {
        const BenchIntegrand f(line, 0);
        for (double edge : {0.0, 1.0}) {
            const std::vector<double> u(static_cast<std::size_t>(f.dimensions()), edge);
            EXPECT_TRUE(std::isfinite(f.on_unit_cube(u.data()))) << line_name(line);
        }
    }
}

} // namespace
} // namespace montelux::bench
