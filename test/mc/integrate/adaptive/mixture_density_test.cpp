#include "test/mc/integrate/adaptive/uniform_points.h"
#include "test/significance.h"
#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <numeric>
#include <vector>

#include "montelux/mc/integrate/adaptive/boundary_density.h"
#include "montelux/mc/integrate/adaptive/mixture_density.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/stats/chi_squared.h"

namespace montelux {
namespace {

// Uniform, maps and two Gaussians, one of which sticks out of the square.
MixtureDensity mixture() {
    std::vector<MonotoneMap> maps{MonotoneMap({0, 0.3, 1}, {2, 1}),
                                  MonotoneMap({0, 0.25, 0.5, 0.75, 1}, {1, 3, 4, 2})};
    std::vector<Gaussian> gaussians{Gaussian({0.3, 0.6}, {0.05, 0, 0.03, 0.06}),
                                    Gaussian({0.95, 0.1}, {0.08, 0, -0.02, 0.05})};
    MixtureDensity density(2, std::move(maps), std::move(gaussians));
    density.set_shares({8, 24, 20, 12});
    return density;
}
// The same with the channel of the boundary.
MixtureDensity with_boundary() {
    const MixtureDensity inner = mixture();
    MixtureDensity density(2, {inner.maps().begin(), inner.maps().end()},
                           {inner.gaussians().begin(), inner.gaussians().end()}, true);
    density.set_shares({8, 10, 14, 20, 12});
    return density;
}
double pdf_at(const MixtureDensity& density, double x, double y) {
    PointBuffer point(1, 2);
    point(0, 0) = x;
    point(0, 1) = y;
    double p;
    density.pdf(point, {&p, 1});
    return p;
}
// Of a function at the points of a grid of the unit square.
double mean_over_square(const std::function<double(double, double)>& f, int cells) {
    double sum = 0;
    for (int i = 0; i < cells; ++i)
        for (int j = 0; j < cells; ++j) sum += f((i + 0.5) / cells, (j + 0.5) / cells);
    return sum / (static_cast<double>(cells) * cells);
}
TEST(MixtureDensity, UniformAtFirst) {
    const MixtureDensity density(2);
    EXPECT_EQ(density.channels(), 1);
    EXPECT_EQ(density.shares()[0], MixtureDensity::units);
    EXPECT_EQ(pdf_at(density, 0.2, 0.9), 1);
}

TEST(MixtureDensity, SharesAddUpAndDivideThePoints) {
    const MixtureDensity density = mixture();
    ASSERT_EQ(density.channels(), 4);
    for (std::uint64_t n : {64u, 128u, 6400u}) {
        std::uint64_t sum = 0;
        for (int k = 0; k < density.channels(); ++k) sum += density.channel_points(k, n);
        EXPECT_EQ(sum, n);
    }
    // Before any are set.
    const MixtureDensity fresh(2, {}, {density.gaussians().begin(), density.gaussians().end()});
    EXPECT_EQ(std::accumulate(fresh.shares().begin(), fresh.shares().end(), 0), MixtureDensity::units);
}

TEST(MixtureDensity, IsTheSumOfItsChannels) {
    const MixtureDensity density = with_boundary();
    const PointBuffer x = uniform_points(500, 2, 1);
    std::vector<double> sum(500, 0.0), part(500), all(500);
    for (int k = 0; k < density.channels(); ++k) {
        density.channel_pdf(k, x, part);
        const double share = density.shares()[static_cast<std::size_t>(k)] / 64.0;
        for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += share * part[i];
    }
    density.pdf(x, all);
    for (std::size_t i = 0; i < sum.size(); ++i) {
        EXPECT_NEAR(all[i], sum[i], 1e-13 * sum[i]);
        EXPECT_GE(all[i], 8 / 64.0); // the uniform share bounds it
        const double product = density.maps()[0].pdf(x.view()(i, 0)) * density.maps()[1].pdf(x.view()(i, 1));
        density.channel_pdf(2, x.view().slice(i, 1), {&part[0], 1});
        EXPECT_NEAR(part[0], product, 1e-13 * product);
        double boundary = 1;
        for (int d = 0; d < 2; ++d) {
            const double at = x.view()(i, d);
            multiply_boundary_pdf({&at, 1}, {&boundary, 1});
        }
        density.channel_pdf(1, x.view().slice(i, 1), {&part[0], 1});
        EXPECT_NEAR(part[0], boundary, 1e-13 * boundary);
    }
}

TEST(MixtureDensity, IntegratesToOneWithWhatLiesOutside) {
    // Without the Gaussian that sticks out.
    MixtureDensity inside = mixture();
    inside.set_shares({8, 24, 32, 0});
    EXPECT_NEAR(mean_over_square([&](double x, double y) { return pdf_at(inside, x, y); }, 500), 1, 1e-5);
    // With it, a part is missing, in which samples fall as often.
    const MixtureDensity density = mixture();
    const std::size_t count = 100'000;
    PointBuffer x;
    std::vector<double> at;
    density.sample(3, uniform_points(count, 2, 4), x, at);
    const double kept = static_cast<double>(x.count()) / static_cast<double>(count);
    EXPECT_LT(kept, 0.9);
    EXPECT_NEAR(mean_over_square([&](double a, double b) { return pdf_at(density, a, b); }, 500),
                1 - 12 / 64.0 * (1 - kept), 0.002);
}

TEST(MixtureDensity, PointsComeWithTheDensityOfTheWhole) {
    const MixtureDensity density = with_boundary();
    for (int k = 0; k < density.channels(); ++k) {
        PointBuffer x;
        std::vector<double> at;
        density.sample(k, uniform_points(2000, 2, 7), x, at);
        ASSERT_EQ(at.size(), x.count());
        std::vector<double> all(x.count());
        density.pdf(x, all);
        for (std::size_t i = 0; i < all.size(); ++i) {
            EXPECT_NEAR(at[i], all[i], 1e-9 * all[i]) << "channel " << k;
            for (int d = 0; d < 2; ++d) {
                EXPECT_GE(x(i, d), 0);
                EXPECT_LT(x(i, d), 1);
            }
        }
    }
}

TEST(MixtureDensity, PointsOfAllChannelsTogetherFollowIt) {
    const MixtureDensity density = mixture();
    const std::uint64_t count = 64 * 3000;
    CellCounts counts({0, 0}, {1, 1}, 24, 24);
    for (int k = 0; k < density.channels(); ++k) {
        const std::uint64_t share = density.channel_points(k, count);
        PointBuffer x;
        std::vector<double> at;
        density.sample(k, uniform_points(share, 2, static_cast<std::uint64_t>(20 + k)), x, at);
        for (std::size_t i = 0; i < x.count(); ++i) counts.add({x(i, 0), x(i, 1)});
        for (std::size_t i = x.count(); i < share; ++i) counts.add_failure();
    }
    const TestResult r = counts.test([&](Vec2d p) { return pdf_at(density, p.x, p.y); }, 5);
    EXPECT_TRUE(r.passes(significance)) << r.description;
}

// Mean of h^2 / q over the square, for points that are uniform.
double second_moment(const MixtureDensity& density, const PointBatch& x, const std::vector<double>& h) {
    std::vector<double> q(x.count());
    density.pdf(x, q);
    double sum = 0;
    for (std::size_t i = 0; i < h.size(); ++i) sum += h[i] * h[i] / q[i];
    return sum / static_cast<double>(h.size());
}

TEST(MixtureDensity, OptimisedSharesLowerTheSecondMoment) {
    MixtureDensity density = mixture();
    density.set_shares({16, 16, 16, 16});
    const PointBuffer x = uniform_points(20'000, 2, 5);
    const std::vector<double> p(x.count(), 1.0);
    std::vector<double> h(x.count()), part(x.count());
    // Three quarters of the first Gaussian and a quarter of the maps.
    density.channel_pdf(2, x, h);
    density.channel_pdf(1, x, part);
    for (std::size_t i = 0; i < h.size(); ++i) h[i] = 0.75 * h[i] + 0.25 * part[i];
    const double before = second_moment(density, x, h);
    density.optimise_shares(x, h, p, 4);
    const double after = second_moment(density, x, h);
    EXPECT_LT(after, 0.7 * before);
    EXPECT_EQ(std::accumulate(density.shares().begin(), density.shares().end(), 0), MixtureDensity::units);
    EXPECT_GE(density.shares()[0], 4);
    EXPECT_NEAR(density.shares()[2], 0.75 * 60, 5);
    EXPECT_EQ(density.shares()[3], 0);
    // No neighbour is better: a unit from any channel to any other.
    const std::vector<int> best(density.shares().begin(), density.shares().end());
    for (std::size_t from = 0; from < best.size(); ++from)
        for (std::size_t to = 0; to < best.size(); ++to) {
            std::vector<int> other = best;
            if (from == to || --other[from] < (from == 0 ? 4 : 0)) continue;
            ++other[to];
            density.set_shares(other);
            EXPECT_GT(second_moment(density, x, h), 0.98 * after);
        }
}

TEST(MixtureDensity, UniformChannelKeepsItsShare) {
    MixtureDensity density = mixture();
    const PointBuffer x = uniform_points(5000, 2, 5);
    std::vector<double> h(x.count());
    density.channel_pdf(2, x, h);
    for (int least : {1, 4, 32}) {
        density.optimise_shares(x, h, std::vector<double>(x.count(), 1.0), least);
        EXPECT_EQ(density.shares()[0], least);
    }
    // Where nothing was seen nothing changes.
    density.set_shares({8, 24, 20, 12});
    density.optimise_shares(x, std::vector<double>(x.count(), 0.0), std::vector<double>(x.count(), 1.0), 4);
    EXPECT_EQ(density.shares()[1], 24);
}

TEST(MixtureDensity, SavedOneHasTheSameBitsAndMisfitsAreRefused) {
    const MixtureDensity density = with_boundary();
    StateWriter saved;
    density.save(saved);
    const std::vector<std::uint64_t> words(saved.words().begin(), saved.words().end());
    StateReader reader(words);
    const MixtureDensity loaded = MixtureDensity::load(reader, 2);
    EXPECT_TRUE(reader.at_end());
    const PointBuffer x = uniform_points(100, 2, 3);
    std::vector<double> a(100), b(100);
    density.pdf(x, a);
    loaded.pdf(x, b);
    EXPECT_EQ(a, b);
    StateReader other(words);
    EXPECT_THROW(MixtureDensity::load(other, 3), Error);
    std::vector<std::uint64_t> wrong = words;
    ++wrong.back(); // a share
    StateReader damaged(wrong);
    EXPECT_THROW(MixtureDensity::load(damaged, 2), Error);
}

TEST(MixtureDensity, BalancedPointsAreWhatTheSharesDivide) {
    MixtureDensity density(2, {}, {Gaussian({0.3, 0.4}, {0.02, 0, 0, 0.02})});
    const auto balanced = [&](std::vector<int> shares) {
        density.set_shares(std::move(shares));
        return density.balanced_points();
    };
    EXPECT_EQ(MixtureDensity(2).balanced_points(), 1u);
    EXPECT_EQ(balanced({64, 0}), 1u);
    EXPECT_EQ(balanced({32, 32}), 2u);
    EXPECT_EQ(balanced({16, 48}), 4u);
    EXPECT_EQ(balanced({8, 56}), 8u);
    EXPECT_EQ(balanced({7, 57}), 64u);
}

TEST(MixtureDensity, SharesAreMultiplesOfTheStep) {
    const Gaussian g({0.3, 0.4}, {0.1, 0, 0, 0.1});
    const PointBuffer x = uniform_points(500, 2, 1);
    const std::vector<double> p(x.count(), 1.0);
    std::vector<double> h(x.count());
    g.log_pdf(x, h);
    for (double& v : h) v = 0.1 + std::exp(v);
    for (int step : {1, 2, 8, 16}) {
        MixtureDensity density(2, {}, {g, g.widened(2), g.widened(3)});
        density.optimise_shares(x, h, p, 3, step, 1);
        int sum = 0;
        for (int share : density.shares()) {
            EXPECT_EQ(share % step, 0);
            EXPECT_GE(share, 0);
            sum += share;
        }
        EXPECT_EQ(sum, MixtureDensity::units);
        EXPECT_GE(density.shares().front(), 3);
        EXPECT_GE(density.shares().back(), step);
    }
}

TEST(MixtureDensity, TheBoundaryKeepsAShareThatItDoesNotEarn) {
    MixtureDensity density = with_boundary();
    const PointBuffer x = uniform_points(500, 2, 1);
    const std::vector<double> p(x.count(), 1.0);
    std::vector<double> h(x.count());
    density.gaussians()[0].log_pdf(x, h);
    for (double& v : h) v = std::exp(v);
    for (int step : {1, 4}) {
        density.optimise_shares(x, h, p, 4, step);
        EXPECT_EQ(density.shares()[1], step);
        EXPECT_EQ(std::accumulate(density.shares().begin(), density.shares().end(), 0),
                  MixtureDensity::units);
    }
}

// Where uniform points are best the boundary's share comes from theirs, not from channels that have none.
TEST(MixtureDensity, NoShareIsNegative) {
    const MixtureDensity parts = mixture();
    const PointBuffer x = uniform_points(2000, 2, 5);
    const std::vector<double> flat(x.count(), 1.0);
    for (int step : {1, 4, 8}) {
        MixtureDensity density(2, {parts.maps().begin(), parts.maps().end()},
                               {parts.gaussians().begin(), parts.gaussians().end()}, true);
        density.optimise_shares(x, flat, flat, 4, step);
        EXPECT_EQ(std::accumulate(density.shares().begin(), density.shares().end(), 0),
                  MixtureDensity::units);
        for (int share : density.shares()) EXPECT_GE(share, 0) << step;
    }
}

TEST(MixtureDensity, WidenedKeepsSharesAndMeans) {
    MixtureDensity density(2, {}, {Gaussian({0.3, 0.4}, {0.02, 0, 0, 0.02})});
    density.set_shares({16, 48});
    const MixtureDensity wide = density.widened(1.5);
    EXPECT_EQ(wide.shares()[1], 48);
    EXPECT_EQ(wide.gaussians()[0].mean()[1], 0.4);
    EXPECT_NEAR(wide.gaussians()[0].cholesky()[3], 0.03, 1e-15);
}

TEST(MixtureDensity, IdleGaussiansAreDropped) {
    const Gaussian narrow({0.3, 0.3}, {0.1, 0, 0, 0.1}), wide({0.6, 0.6}, {0.2, 0, 0, 0.2});
    MixtureDensity density(2, {}, {narrow, wide, narrow});
    density.set_shares({10, 0, 54, 0});
    PointBuffer x(1, 2);
    x(0, 0) = x(0, 1) = 0.5;
    double before, after;
    density.pdf(x, {&before, 1});
    density.drop_idle();
    density.pdf(x, {&after, 1});
    EXPECT_EQ(before, after);
    ASSERT_EQ(density.gaussians().size(), 1u);
    EXPECT_EQ(density.gaussians()[0].mean()[0], 0.6);
    EXPECT_EQ(std::vector<int>(density.shares().begin(), density.shares().end()), (std::vector<int>{10, 54}));
}

} // namespace
} // namespace montelux
