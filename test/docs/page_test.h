// Declarations that the programs of docs/integration.md need in addition to their own text; page_examples.awk
// makes a test of them.
#pragma once

#include "test/temporary_folder.h"
#include <cmath>
#include <filesystem>
#include <functional>
#include <gtest/gtest.h>
#include <iostream>
#include <limits>
#include <numbers>
#include <span>
#include <sstream>
#include <streambuf>
#include <string>
#include <vector>

#include "montelux/mc/dist/distribution.h"
#include "montelux/mc/dist/families.h"
#include "montelux/mc/dist/marginal_conditional.h"
#include "montelux/mc/dist/product.h"
#include "montelux/mc/integrate/adaptive/adaptive.h"
#include "montelux/mc/integrate/auto.h"
#include "montelux/mc/integrate/integrate.h"
#include "montelux/mc/integrate/integrate_log.h"
#include "montelux/mc/integrate/metropolis/metropolis_chain.h"
#include "montelux/mc/integrate/quasi/quasi.h"
#include "montelux/mc/integrate/techniques/control_variate.h"
#include "montelux/mc/integrate/techniques/importance.h"
#include "montelux/mc/integrate/techniques/multiple_importance.h"
#include "montelux/mc/integrate/vegas/adaptive_map.h"
#include "montelux/mc/integrate/vegas/vegas.h"

namespace montelux::page {

// Captures std::cout from construction to `end`.
class Printed {
  public:
    explicit Printed(int line) : line_(line), before_(std::cout.rdbuf(text_.rdbuf())) {}
    ~Printed() { end(); }
    Printed(const Printed&) = delete;
    Printed& operator=(const Printed&) = delete;

    void expect(const std::string& text) const {
        EXPECT_EQ(text_.str(), text) << "what the program of line " << line_ << " prints";
    }
    void end() {
        if (before_ != nullptr) std::cout.rdbuf(before_);
        before_ = nullptr;
    }

  private:
    int line_;
    std::ostringstream text_;
    std::streambuf* before_;
};

// Programs write files: into a temporary folder.
class PageExamples : public testing::Test {
  protected:
    void SetUp() override { std::filesystem::current_path(folder_.path()); }
    void TearDown() override { std::filesystem::current_path(before_); }

  private:
    std::filesystem::path before_ = std::filesystem::current_path();
    TemporaryFolder folder_;
};

// Names that the page leaves to the reader: an integrand, one that resembles it, a family, a density.
inline const Domain domain{{0, std::numbers::pi / 2}, {0, 1}};
inline const Method method;
inline const Budget budget{.evaluations = 20'000};
inline double f(std::span<const double> x) { return std::sin(x[0]) * x[1]; }
inline double h(std::span<const double> x) { return x[0] * x[1]; }
inline constexpr double integral_of_h = std::numbers::pi * std::numbers::pi / 16; // over `domain`
inline double log_density(std::span<const double> x) { return -(x[0] * x[0] + x[1] * x[1]) / 2; }
inline auto f_of(double mass) {
    return [mass](std::span<const double> x) { return 1 / (mass * mass + x[0] * x[1]); };
}
inline const std::vector<double> masses{1, 1.1, 1.2};

} // namespace montelux::page

// The namespaces, so that programs may name the library's things with and without montelux::.
#define PAGE_TEST                                                                                            \
    using namespace montelux;                                                                                \
    using namespace montelux::page;                                                                          \
    TEST_F(PageExamples, PrintWhatThePageShows)
