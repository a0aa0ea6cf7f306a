// Any distribution of one variable as a value, for programs that read their distribution from input.
#pragma once

#include <concepts>
#include <cstddef>
#include <memory>
#include <span>
#include <type_traits>
#include <utility>

#include "montelux/mc/dist/distribution_1d.h"
#include "montelux/mc/dist/inversion.h"
#include "montelux/mc/math/error.h"

namespace montelux {

// Holds an immutable distribution of any type, shared by copies; safe to use from many threads. Satisfies
// TwoTailedDistribution1D. A call is one virtual call more than on the type itself, and allocates nothing;
// the forms that take spans make it once for all values.
class Distribution : public SampledByInversion<Distribution> {
  public:
    template <Distribution1D D>
    requires(!std::same_as<D, Distribution>) Distribution(D distribution)
        : held_(std::make_shared<const Held<D>>(std::move(distribution))) {}

    template <Distribution1D D>
    static Distribution from(D distribution) {
        return Distribution(std::move(distribution));
    }
    // With density proportional to f(x) >= 0 on [a, b], whose ends may be infinite; see NumericalInversion.
    template <typename F>
    static Distribution from_density(F f, double a, double b, const InversionOptions& options = {}) {
        return Distribution(NumericalInversion<F>(std::move(f), a, b, options));
    }

    double lower() const { return held_->lower(); }
    double upper() const { return held_->upper(); }
    double pdf(double x) const { return held_->pdf(x); }
    double cdf(double x) const { return held_->cdf(x); }
    double cdf_complement(double x) const { return held_->cdf_complement(x); }
    double quantile(double xi) const { return held_->quantile(xi); }
    double quantile_complement(double q) const { return held_->quantile_complement(q); }

    using SampledByInversion<Distribution>::sample;
    // x[i] = sample(xi[i]) and p[i] = pdf(x[i]); the spans are of one length, or Error is thrown. Input and
    // output may be the same memory.
    void sample(std::span<const double> xi, std::span<double> x) const {
        expect_equal(xi.size(), x.size());
        held_->sample(xi, x);
    }
    void pdf(std::span<const double> x, std::span<double> p) const {
        expect_equal(x.size(), p.size());
        held_->pdf(x, p);
    }

    // The distribution that is held, or nullptr where it is of another type.
    template <Distribution1D D>
    const D* as() const {
        auto* held = dynamic_cast<const Held<D>*>(held_.get());
        return held ? &held->distribution : nullptr;
    }

  private:
    struct Interface {
        virtual ~Interface() = default;
        virtual double lower() const = 0;
        virtual double upper() const = 0;
        virtual double pdf(double x) const = 0;
        virtual double cdf(double x) const = 0;
        virtual double cdf_complement(double x) const = 0;
        virtual double quantile(double xi) const = 0;
        virtual double quantile_complement(double q) const = 0;
        virtual void sample(std::span<const double> xi, std::span<double> x) const = 0;
        virtual void pdf(std::span<const double> x, std::span<double> p) const = 0;
    };
    template <typename D>
    struct Held final : Interface {
        explicit Held(D d) : distribution(std::move(d)) {}

        double lower() const override { return distribution.lower(); }
        double upper() const override { return distribution.upper(); }
        double pdf(double x) const override { return distribution.pdf(x); }
        double cdf(double x) const override { return distribution.cdf(x); }
        double cdf_complement(double x) const override { return montelux::cdf_complement(distribution, x); }
        double quantile(double xi) const override { return distribution.quantile(xi); }
        double quantile_complement(double q) const override {
            return montelux::quantile_complement(distribution, q);
        }
        void sample(std::span<const double> xi, std::span<double> x) const override {
            for (std::size_t i = 0; i < xi.size(); ++i) x[i] = sample_by_inversion(distribution, xi[i]);
        }
        void pdf(std::span<const double> x, std::span<double> p) const override {
            for (std::size_t i = 0; i < x.size(); ++i) p[i] = distribution.pdf(x[i]);
        }

        D distribution;
    };
    static void expect_equal(std::size_t in, std::size_t out) {
        if (in != out) throw Error("Distribution", "expected spans of one length");
    }

    std::shared_ptr<const Interface> held_;
};

} // namespace montelux
