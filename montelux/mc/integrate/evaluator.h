// An integrand over the unit cube: the user's function, its domain, and a policy for values that are not
// finite.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include "montelux/mc/integrate/domain.h"
#include "montelux/mc/integrate/integrand.h"
#include "montelux/mc/integrate/witness/largest_values.h"

namespace montelux {

enum class NonFinitePolicy : std::uint8_t {
    skip,       // count as zero, are counted and reported
    throw_error // ends the integration with an Error that names the point
};

// NaN and infinite values that were met, and the point x of the first.
struct NonFiniteCount {
    std::uint64_t count = 0;
    std::vector<double> first_point; // empty while the count is zero
    // NaN where the integrand had vanished on the way out, as x^4 exp(x) / (exp(x) - 1)^2 has; not in `count`.
    std::uint64_t vanished = 0;

    // In the order of the samples.
    void merge(const NonFiniteCount& later);
};

// A box of the unit cube in which a component counts as zero, since its values are noise there.
struct NoiseBox {
    int component;
    std::vector<double> lower, upper;
};

// g(u) = f(x(u)) |dx/du|, whose integral over the unit cube is that of f over the domain. One evaluator
// serves all threads.
class Evaluator {
  public:
    // Throws Error where integrand and domain do not fit.
    Evaluator(Integrand integrand, Domain domain, NonFinitePolicy policy = NonFinitePolicy::skip);

    // Variables u.
    int dimensions() const { return domain_.uniforms(); }
    int components() const { return integrand_.components(); }
    const Domain& domain() const { return domain_; }
    const Integrand& integrand() const { return integrand_; }
    NonFinitePolicy policy() const { return policy_; }

    // Largest values from now on, where a place for them is given; outlives its use.
    void keep_largest(LargestValues* largest) { largest_ = largest; }
    const LargestValues* kept_largest() const { return largest_; }
    // Boxes in which values count as zero from now on.
    void leave_out(std::vector<NoiseBox> noise) { noise_ = std::move(noise); }

    // g at points u; values that are not finite become zero and are counted (see NonFiniteCount), and the indices of their points
    // added to `where`, if that is given. Scratch memory is the thread's.
    void operator()(const PointBatch& u, ValueBatch g, NonFiniteCount& non_finite,
                    std::vector<std::size_t>* where = nullptr) const;

    // Makes g of values f that a device computed at points of the unit cube; `volume` is null where the change of
    // volume is constant. `points` fills in those points, and is called where a value is not finite or larger than those kept.
    void complete(ValueBatch g, const double* volume, const std::function<void(PointBuffer&)>& points,
                  NonFiniteCount& non_finite) const;

    // f at points x of the domain, for estimators that draw these themselves; not-finite values as above.
    void at_points(const PointBatch& x, ValueBatch f, NonFiniteCount& non_finite) const;

  private:
    // Multiplies by the change of volume: the constant one, or else `volume` of each point.
    void scale(ValueBatch g, const double* volume) const;
    // Whether a component vanishes on the way from the origin, or a finite end, to a point of infinite ranges where it is NaN:
    // the last value that is none is zero, or falls from half of its distance by 2^-64 or more, as no power does.
    bool vanishes_before(std::span<const double> x, int component) const;
    // Sets values in the boxes of noise to zero.
    void silence(const PointBatch& u, ValueBatch g) const;
    void screen(const PointBatch& x, ValueBatch values, NonFiniteCount& non_finite,
                std::vector<std::size_t>* where = nullptr) const;

    Integrand integrand_;
    Domain domain_;
    NonFinitePolicy policy_;
    LargestValues* largest_ = nullptr;
    std::vector<NoiseBox> noise_;
};

} // namespace montelux
