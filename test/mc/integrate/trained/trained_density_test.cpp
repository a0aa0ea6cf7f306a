#include "test/mc/integrate/trained/trained_problems.h"
#include "test/significance.h"
#include "test/temporary_folder.h"
#include <fstream>
#include <gtest/gtest.h>
#include <string>

#include "montelux/mc/integrate/cubature/cubature.h"
#include "montelux/mc/integrate/infinity.h"
#include "montelux/mc/integrate/trained/samples.h"
#include "montelux/mc/integrate/trained/trained_density.h"
#include "montelux/mc/integrate/unit_points.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/stats/chi_squared.h"

namespace montelux {
namespace {

std::string error_of(const std::function<void()>& f) {
    try {
        f();
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

// Draws inside the domain are counted in cells; those outside are the failures of a density whose integral is
// below 1.
TestResult draws_against_pdf(const TrainedDensity& density) {
    constexpr std::uint64_t count = 100'000;
    PointBuffer v(count, 3);
    fill_random(v, 5, 0, 0);
    UnitDraws draws;
    density.unit().draw(v, draws);
    PointBuffer x(draws.index.size(), 2);
    std::vector<double> volume(draws.index.size(), 1.0);
    density.domain().map(draws.u, x, volume);
    CellCounts cells({-1, 0}, {3, 2}, 24, 16);
    for (std::size_t i = 0; i < x.count(); ++i) cells.add({x(i, 0), x(i, 1)});
    for (std::size_t i = x.count(); i < count; ++i) cells.add_failure();
    return cells.test(
        [&](Vec2d p) {
            const double at[] = {p.x, p.y};
            return density.pdf(at);
        },
        5);
}

TEST(TrainedDensity, DrawsOfAMixtureFollowItsPdf) {
    const TrainedDensity density = cut_bells();
    ASSERT_NE(density.unit().mixture(), nullptr);
    ASSERT_FALSE(density.unit().mixture()->gaussians().empty());
    const TestResult result = draws_against_pdf(density);
    EXPECT_TRUE(result.passes(significance)) << result.description;
}

TEST(TrainedDensity, DrawsOfAMapFollowItsPdf) {
    const TrainedDensity density = cut_bells(Vegas{.increments = 16});
    ASSERT_NE(density.unit().map(), nullptr);
    const TestResult result = draws_against_pdf(density);
    EXPECT_TRUE(result.passes(significance)) << result.description;
}

TEST(TrainedDensity, PdfAtADrawIsTheDensityOfTheDraw) {
    for (const TrainedDensity& density : {cut_bells(), cut_bells(Vegas{})}) {
        PointBuffer v(500, 3);
        fill_random(v, 6, 0, 0);
        UnitDraws draws;
        density.unit().draw(v, draws);
        std::vector<double> p(draws.index.size());
        density.unit().pdf(draws.u, p);
        for (std::size_t i = 0; i < p.size(); ++i)
            EXPECT_NEAR(p[i], draws.density[i], 1e-9 * p[i]) << "draw " << i;
    }
}

TEST(TrainedDensity, PdfOnInfiniteRangesIntegratesToOne) {
    const Domain domain{{-infinity, infinity}, {2, infinity}, {-infinity, 0}};
    auto f = [](std::span<const double> x) {
        return std::exp(-x[0] * x[0] - 2 * (x[1] - 2) + 3 * x[2]) * (1 + 0.5 * std::sin(x[0] * x[1]));
    };
    const TrainedDensity density = trained(f, domain, Vegas{.increments = 8}, 20000);
    const auto pdf = [&](std::span<const double> x) { return density.pdf(x); };
    const IntegrationResult r = integrate(pdf, domain, Vegas{}, {.evaluations = 200'000});
    EXPECT_NEAR(r.value[0], 1, 5 * r.standard_error[0]);
    EXPECT_LT(r.standard_error[0], 0.003);
}

TEST(TrainedDensity, PdfOutsideIsZeroAndOfOtherShapesRefused) {
    const TrainedDensity density = cut_bells();
    for (const auto& x : {std::vector<double>{-1.01, 1}, {1, 2.01}, {std::nan(""), 1}, {infinity, 1}})
        EXPECT_EQ(density.pdf(x), 0);
    EXPECT_NE(
        error_of([&] { density.pdf(std::vector<double>{1}); }).find("1 coordinates were given; expected 2"),
        std::string::npos);
    const TrainedDensity round = trained([](std::span<const double> x) { return std::exp(4 * x[0]); },
                                         Domain::ball({0, 0}), Vegas{}, 4000);
    EXPECT_NE(error_of([&] {
                  round.pdf(std::vector<double>{0, 0});
              }).find("expected a box of ranges"),
              std::string::npos);
}

TEST(TrainedDensity, MethodsWithoutTrainingHaveNone) {
    auto f = [](std::span<const double> x) { return x[0] + x[1]; };
    EXPECT_EQ(integrate(f, Domain::unit_cube(2), Cubature{}, {.evaluations = 20000}).density, nullptr);
    EXPECT_NE(integrate(f, Domain::unit_cube(2), VegasSobol{}, {.evaluations = 20000}).density, nullptr);
}

TEST(TrainedDensity, FileBringsItBack) {
    const TemporaryFolder folder;
    const std::string path = (folder / "trained.mx").string();
    for (TrainedDensity density : {cut_bells(), cut_bells(Vegas{})}) {
        density.set_notes({{"formula", "exp(-x)"}, {"empty", ""}});
        density.save(path);
        const TrainedDensity loaded = TrainedDensity::load(path);
        EXPECT_EQ(loaded.notes(), density.notes());
        EXPECT_EQ(loaded.words(), density.words());
        const Samples a = weighted_samples(density, CutBells::value, 100);
        const Samples b = weighted_samples(loaded, CutBells::value, 100);
        EXPECT_EQ(a.weight, b.weight);
        for (std::size_t i = 0; i < a.count(); ++i) EXPECT_EQ(a.x.view()(i, 1), b.x.view()(i, 1));
    }
}

TEST(TrainedDensity, DomainsThatAreNoBoxAreGivenAgain) {
    const TemporaryFolder folder;
    const std::string path = (folder / "ball.mx").string();
    auto f = [](std::span<const double> x) { return std::exp(4 * x[0]); };
    trained(f, Domain::ball({0, 0}), Vegas{}, 4000).save(path);
    EXPECT_NE(error_of([&] { TrainedDensity::load(path); }).find("ball in 2 dimensions"), std::string::npos);
    EXPECT_EQ(TrainedDensity::load(path, Domain::ball({0, 0})).domain().uniforms(), 2);
    for (const Domain& other : {Domain::ball({0, 0.001}), Domain::ball({0, 0, 0}), Domain::unit_cube(2)})
        EXPECT_NE(error_of([&] { TrainedDensity::load(path, other); }).find("on another domain"),
                  std::string::npos);
}

TEST(TrainedDensity, DamagedFilesAreRefusedByASentence) {
    const TemporaryFolder folder;
    const std::string path = (folder / "trained.mx").string();
    cut_bells().save(path);
    std::ifstream in(path, std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(in)), {});
    for (std::size_t i = 0; i < bytes.size(); i += 97) {
        std::string damaged = bytes;
        damaged[i] = static_cast<char>(damaged[i] ^ 0x10);
        folder.write("damaged.mx", damaged);
        folder.write("cut.mx", bytes.substr(0, i));
        for (const char* name : {"damaged.mx", "cut.mx"})
            EXPECT_NE(error_of([&] { TrainedDensity::load((folder / name).string()); }).find(name),
                      std::string::npos)
                << i;
    }
    EXPECT_NE(error_of([&] { TrainedDensity::load((folder / "none.mx").string()); }), "");
}

// Behind a right checksum, too, no number may lead astray: a density comes out, or an Error.
TEST(TrainedDensity, AnyWordsMakeADensityOrAnError) {
    for (const TrainedDensity& density : {cut_bells(), cut_bells(Vegas{.increments = 16})}) {
        const std::vector<std::uint64_t> words = density.words();
        int refused = 0;
        for (std::size_t i = 0; i < words.size(); ++i)
            for (std::uint64_t other :
                 {std::uint64_t{0}, ~std::uint64_t{0}, std::uint64_t{1} << 40, words[i] + 1,
                  words[i] ^ (std::uint64_t{1} << 63), std::uint64_t{0x7ff8000000000000}}) {
                std::vector<std::uint64_t> changed = words;
                changed[i] = other;
                const std::string error = error_of([&] {
                    const TrainedDensity made = TrainedDensity::from_words(changed);
                    EXPECT_EQ(weighted_samples(made, CutBells::value, 3, {.threads = 1}).count(), 3u);
                });
                refused += error.empty() ? 0 : 1;
            }
        EXPECT_GT(refused, static_cast<int>(words.size()));
        for (std::size_t n = 0; n < words.size(); n += 3)
            EXPECT_NE(error_of([&] {
                          TrainedDensity::from_words(
                              {words.begin(), words.begin() + static_cast<std::ptrdiff_t>(n)});
                      }),
                      "");
    }
}

} // namespace
} // namespace montelux
