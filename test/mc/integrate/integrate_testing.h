// What the tests of the driver share: a method, an integrand, errors that are expected, results compared.
#pragma once

#include <cstdint>
#include <functional>
#include <gtest/gtest.h>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "montelux/mc/integrate/basic_monte_carlo.h"
#include "montelux/mc/integrate/integrate.h"
#include "montelux/mc/math/error.h"

namespace montelux {

inline const Method basic = BasicMonteCarlo{};

inline double product(std::span<const double> x) { return 4 * x[0] * x[1]; } // 1 over the unit square

// Calls f and expects an Error that contains the text.
inline void expect_error(const std::string& text, const std::function<void()>& f) {
    try {
        f();
        ADD_FAILURE() << "no error; expected one that says '" << text << "'";
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find(text), std::string::npos) << error.what();
    }
}

inline bool same_but_for_time(const IntegrationResult& a, const IntegrationResult& b) {
    if (a.history.size() != b.history.size()) return false;
    for (std::size_t i = 0; i < a.history.size(); ++i)
        if (a.history[i].evaluations != b.history[i].evaluations ||
            a.history[i].value != b.history[i].value ||
            a.history[i].standard_error != b.history[i].standard_error)
            return false;
    return a.value == b.value && a.standard_error == b.standard_error && a.covariance == b.covariance &&
           a.evaluations == b.evaluations && a.non_finite == b.non_finite &&
           a.first_non_finite_point == b.first_non_finite_point && a.stop == b.stop &&
           a.warnings == b.warnings;
}

// An estimator of ten steps, all of a given size.
struct TenSteps {
    static constexpr std::string_view name = "ten steps";
    std::uint64_t evaluations_of_a_step = 10;

    class Steps final : public Estimator {
      public:
        explicit Steps(std::uint64_t size) : size_(size) {}
        StepOutcome step(const StepRequest& request) override {
            if (done_ == 10) return StepOutcome::finished;
            if (request.max_evaluations < size_) return StepOutcome::exhausted;
            ++done_;
            return StepOutcome::advanced;
        }
        Tally tally() const override {
            Tally t;
            t.value = {7};
            t.standard_error = {1};
            t.evaluations = done_ * size_;
            return t;
        }
        void save(StateWriter& state) const override { state.put(done_); }
        void load(StateReader& state) override { done_ = state.get_word(); }

      private:
        std::uint64_t size_, done_ = 0;
    };
    std::unique_ptr<Estimator> estimator(const Problem&) const {
        return std::make_unique<Steps>(evaluations_of_a_step);
    }
};

} // namespace montelux
