// The running scale of an integrand: powers of two that keep sums of squares within the range of doubles.
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <mutex>
#include <vector>

#include "montelux/mc/integrate/integrand.h"
#include "montelux/mc/integrate/state_archive.h"

namespace montelux {

// What the integrand's function returns: f, or log f of a positive f.
enum class IntegrandForm : std::uint8_t { value, logarithm };

// Estimators see f_c 2^-k_c with one exponent k_c for each component. Scaling by a power of two is exact, so
// an estimate does not depend on the unit of f. The exponents follow the first magnitudes met; `adjust` moves
// them where squares of later ones would overflow or underflow, and the estimate then starts again.
class IntegrandScale {
  public:
    // `common`: one exponent serves all components, so that an absolute error has one scaled value. The
    // volume factor of the domain is of order 2^volume_exponent. The scale outlives integrands made by
    // `scaled`.
    IntegrandScale(int components, IntegrandForm form, bool common, double volume_exponent);

    IntegrandForm form() const { return form_; }
    double exponent(std::size_t component) const { return exponents_[component]; }
    const std::vector<double>& exponents() const { return exponents_; }
    // x 2^k_c; may overflow or underflow, as the value in the user's unit does.
    double unscaled(double x, std::size_t component) const;
    // x 2^-k, for `common` scales.
    double scaled(double x) const;
    // x 2^(k_a + k_b).
    double unscaled_product(double x, std::size_t a, std::size_t b) const;
    // Largest magnitudes met; given back after looks whose extreme values no estimate contains.
    std::vector<double> largest() const;
    void restore_largest(const std::vector<double>& largest);
    // Forgets the magnitudes met and keeps exponents of zero, for values of which few are far beyond the others.
    void ignore_spikes();
    // Moves exponents whose components left the safe range. True: the estimate so far is void.
    bool adjust();

    void save(StateWriter& state) const;
    // Throws Error where the number of components differs.
    void load(StateReader& state);

  private:
    friend Integrand scaled(const Integrand& f, IntegrandScale& scale);
    // Chooses the exponents by the first batch that is not all zeros, before any such value was scaled.
    void settle(const ValueBatch& values);
    void apply(std::size_t component, std::span<double> values);

    IntegrandForm form_;
    bool common_;
    double volume_exponent_;
    double limit_;                  // of scaled values
    std::vector<double> exponents_; // whole numbers
    // Largest finite |f|, or log f, of each component; from all threads.
    std::unique_ptr<std::atomic<double>[]> largest_;
    std::atomic<bool> settled_ = false;
    std::mutex settling_;
};

// f 2^-k, whose magnitudes `scale` notes. A logarithm of -infinity is an f of zero; +infinity and NaN stay
// values that are not finite.
Integrand scaled(const Integrand& f, IntegrandScale& scale);

} // namespace montelux
