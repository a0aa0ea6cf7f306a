#include "test/mc/dist/family_cases.h"
#include "test/mc/dist/message_of.h"
#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <random>

#include "montelux/mc/stats/chi_squared.h"
#include "montelux/mc/stats/z_test.h"

namespace montelux {
namespace {

constexpr double family_significance = 1e-7;
constexpr double epsilon = std::numeric_limits<double>::epsilon();

// Every family goes through every test here.
class FamilyTest : public testing::TestWithParam<FamilyCase> {
  protected:
    const Distribution& d() const { return GetParam().distribution; }
};

TEST_P(FamilyTest, ValuesComputedElsewhere) {
    double tolerance = GetParam().tolerance;
    for (const FamilyReference& r : GetParam().references) {
        SCOPED_TRACE(r.x);
        // x itself is rounded where a family subtracts it from an end or a location.
        double slack = 4 * epsilon * std::abs(r.x) * r.pdf;
        EXPECT_NEAR(d().pdf(r.x), r.pdf, tolerance * r.pdf + 1e-300);
        EXPECT_NEAR(d().cdf(r.x), r.cdf, tolerance * r.cdf + slack);
        EXPECT_NEAR(d().cdf_complement(r.x), r.cdf_complement, tolerance * r.cdf_complement + slack);
        double conditioned = tolerance * (std::abs(r.x) + std::min(r.cdf, r.cdf_complement) / r.pdf);
        if (r.cdf < 0.5)
            EXPECT_NEAR(d().quantile(r.cdf), r.x, conditioned);
        else
            EXPECT_NEAR(d().quantile_complement(r.cdf_complement), r.x, conditioned);
    }
}

TEST_P(FamilyTest, QuantileUndoesCdfInBothTails) {
    for (double p : {1e-300, 1e-100, 1e-30, 1e-12, 1e-6, 0.01, 0.2, 0.4999, 0.5, 0.75, 0.999}) {
        double low = d().quantile(p), high = d().quantile_complement(p);
        // What half an ulp of x does to the probability; nothing is checked where x has run into an end, or out
        // of the normal numbers.
        auto slack = [&](double x) { return 4 * epsilon * std::abs(x) * d().pdf(x); };
        auto usable = [&](double x) {
            return x > d().lower() && x < d().upper() && std::abs(x) > 1e-290 && std::isfinite(x);
        };
        if (usable(low)) {
            EXPECT_NEAR(d().cdf(low), p, 1e-12 * p + slack(low)) << "p = " << p << ", x = " << low;
            EXPECT_NEAR(d().cdf(low) + d().cdf_complement(low), 1, 1e-14);
        }
        if (usable(high)) {
            EXPECT_NEAR(d().cdf_complement(high), p, 1e-12 * p + slack(high))
                << "q = " << p << ", x = " << high;
        }
    }
}

// Eight-point Gauss-Legendre on panels that are graded towards a finite lower end.
double quadrature(const Distribution& d, double from, double to) {
    constexpr double node[4] = {0.1834346424956498, 0.5255324099163290, 0.7966664774136267,
                                0.9602898564975363};
    constexpr double weight[4] = {0.3626837833783620, 0.3137066458778873, 0.2223810344533745,
                                  0.1012285362903763};
    constexpr int panels = 1000;
    auto edge = [&](int i) {
        double t = static_cast<double>(i) / panels;
        if (std::isinf(d.lower())) return from + t * (to - from);
        return d.lower() + (from - d.lower()) * std::pow((to - d.lower()) / (from - d.lower()), t);
    };
    double sum = 0;
    for (int i = 0; i < panels; ++i) {
        double middle = 0.5 * (edge(i) + edge(i + 1)), half = 0.5 * (edge(i + 1) - edge(i));
        for (int k = 0; k < 4; ++k)
            sum += half * weight[k] * (d.pdf(middle - half * node[k]) + d.pdf(middle + half * node[k]));
    }
    return sum;
}

TEST_P(FamilyTest, PdfIntegratesToDifferencesOfTheCdf) {
    const std::vector<double> p{1e-3, 0.02, 0.1, 0.3, 0.6, 0.9, 0.98, 0.999};
    for (std::size_t i = 0; i + 1 < p.size(); ++i) {
        double from = d().quantile(p[i]), to = d().quantile(p[i + 1]);
        EXPECT_NEAR(quadrature(d(), from, to), p[i + 1] - p[i], 1e-7 * (p[i + 1] - p[i])) << p[i];
        EXPECT_NEAR(d().cdf(to) - d().cdf(from), p[i + 1] - p[i], 1e-13);
    }
}

TEST_P(FamilyTest, SamplesFollowThePdf) {
    double from = d().quantile(0.001), to = d().quantile(0.999);
    // Along a logarithmic axis where the density is infinite at its lower end.
    bool logarithmic = std::isfinite(d().lower()) && std::isinf(d().pdf(d().lower()));
    auto axis = [&](double x) { return logarithmic ? std::log(x - d().lower()) : x; };
    auto pdf = [&](double y) {
        if (!logarithmic) return d().pdf(y);
        double distance = std::exp(y);
        return d().pdf(d().lower() + distance) * distance;
    };
    auto r = interval_chi_squared_test([&](double xi) { return axis(d().sample(xi)); }, pdf, axis(from),
                                       axis(to), {.samples = 50000, .cells_x = 60});
    EXPECT_TRUE(r.passes(family_significance)) << r.description;
}

TEST_P(FamilyTest, EnginesOfTheStandardLibraryDriveIt) {
    std::mt19937_64 engine(3);
    std::vector<double> values;
    values.reserve(4000);
    for (int i = 0; i < 4000; ++i) values.push_back(d()(engine));
    auto r = kolmogorov_smirnov_test(values, [&](double x) { return d().cdf(x); });
    EXPECT_TRUE(r.passes(family_significance)) << r.description;
}

TEST_P(FamilyTest, EndsAreWhatTheySay) {
    EXPECT_EQ(d().cdf(d().lower()), 0);
    EXPECT_EQ(d().cdf(d().upper()), 1);
    EXPECT_EQ(d().cdf_complement(d().lower()), 1);
    EXPECT_EQ(d().cdf_complement(d().upper()), 0);
    EXPECT_DOUBLE_EQ(d().quantile(0), d().lower());
    EXPECT_DOUBLE_EQ(d().quantile(1), d().upper());
    EXPECT_DOUBLE_EQ(d().quantile_complement(0), d().upper());
    EXPECT_DOUBLE_EQ(d().quantile_complement(1), d().lower());
    for (double outside : {d().lower() - 1, d().upper() + 1}) EXPECT_EQ(d().pdf(outside), 0) << outside;
    EXPECT_TRUE(std::isfinite(d().sample(0)));
    EXPECT_TRUE(std::isfinite(d().sample(one_minus_epsilon_d)));
    double last = d().sample(0);
    for (int i = 1; i < 4096; ++i) {
        double next = d().sample(i / 4096.0);
        ASSERT_LE(last, next) << i;
        last = next;
    }
}

INSTANTIATE_TEST_SUITE_P(All, FamilyTest, testing::ValuesIn(family_cases()),
                         [](const auto& family) { return family.param.name; });

TEST(Families, BadParametersGiveAMessage) {
    EXPECT_EQ(
        message_of([] { NormalDistribution(0, -1); }),
        "NormalDistribution: mean = 0, deviation = -1; expected a finite mean and a finite deviation above "
        "zero");
    EXPECT_EQ(message_of([] { BetaDistribution(0, 2); }),
              "BetaDistribution: a = 0, b = 2; expected two finite parameters above zero");
    EXPECT_EQ(message_of([] { ChiSquaredDistribution(-3); }),
              "ChiSquaredDistribution: degrees_of_freedom = -3; expected a finite number above zero");
    const double nan = std::nan("");
    const std::vector<std::function<void()>> bad{
        [&] { UniformDistribution(2, 1); },        [&] { UniformDistribution(nan, 1); },
        [&] { UniformDistribution(0, infinity); }, [&] { ExponentialDistribution(0.0); },
        [&] { LinearDistribution(-1, 1); },        [&] { NormalDistribution(nan, 1); },
        [&] { LogNormalDistribution(0, 0); },      [&] { CauchyDistribution(0, -2); },
        [&] { LaplaceDistribution(infinity, 1); }, [&] { LogisticDistribution(0, nan); },
        [&] { WeibullDistribution(0, 1); },        [&] { ParetoDistribution(1, 0); },
        [&] { PowerLawDistribution(-1, 0, 1); },   [&] { PowerLawDistribution(0.5, 1, infinity); },
        [&] { PowerLawDistribution(1, 2, 1); },    [&] { TriangularDistribution(0, 2, 1); },
        [&] { TriangularDistribution(1, 1, 1); },  [&] { GammaDistribution(-1, 1); },
        [&] { StudentTDistribution(0.0); },        [&] { GgxAngleDistribution(0.0); },
    };
    for (std::size_t i = 0; i < bad.size(); ++i) {
        std::string sentence = message_of(bad[i]);
        EXPECT_NE(sentence.find("Distribution: "), std::string::npos) << i << ": " << sentence;
        EXPECT_NE(sentence.find("; expected "), std::string::npos) << i << ": " << sentence;
    }
}

// Shapes where one piece has no width.
TEST(Families, TriangularWithItsModeAtAnEnd) {
    TriangularDistribution rising(0, 1, 1), falling(0, 0, 1);
    for (double xi : {0.0, 0.2, 0.9, 1.0}) {
        EXPECT_NEAR(rising.quantile(xi), std::sqrt(xi), 1e-15);
        EXPECT_NEAR(falling.quantile(xi), 1 - std::sqrt(1 - xi), 1e-15);
        EXPECT_NEAR(rising.cdf(rising.quantile(xi)), xi, 1e-15);
        EXPECT_NEAR(falling.cdf(falling.quantile(xi)), xi, 1e-15);
    }
    EXPECT_EQ(rising.pdf(1), 2);
    EXPECT_EQ(falling.pdf(0), 2);
}

// The form that is printed for the GGX angle, beside the one that is used.
TEST(Families, GgxAngleByItsCosine) {
    for (double a : {0.05, 0.3, 0.7, 1.0}) {
        GgxAngleDistribution d(a);
        for (double xi : {0.01, 0.25, 0.5, 0.99}) {
            double printed = std::sqrt((1 - xi) / (xi * (a * a - 1) + 1));
            EXPECT_NEAR(std::cos(d.quantile(xi)), printed, 1e-14);
            const double tangent = std::tan(d.quantile(xi));
            EXPECT_NEAR(d.squared_tangent_quantile(xi) / (tangent * tangent), 1, 1e-12);
        }
    }
}

// Student's law between its two ends.
TEST(Families, StudentIsCauchyForOneAndNormalForMany) {
    StudentTDistribution one(1), many(1e9);
    CauchyDistribution cauchy;
    NormalDistribution normal;
    for (double xi : {1e-12, 0.01, 0.3, 0.9}) {
        EXPECT_NEAR(one.quantile(xi) / cauchy.quantile(xi), 1, 1e-12);
        EXPECT_NEAR(many.quantile(xi) / normal.quantile(xi), 1, 1e-7);
    }
}

} // namespace
} // namespace montelux
