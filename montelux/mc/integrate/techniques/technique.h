// A sampling technique: uniform numbers to points of a domain, and the density of any point.
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <functional>
#include <span>
#include <vector>

#include "montelux/mc/dist/distribution.h"
#include "montelux/mc/dist/product.h"
#include "montelux/mc/integrate/domain.h"
#include "montelux/mc/integrate/points.h"

namespace montelux {

// A joint distribution with a number of variables fixed by its type: ProductDistribution,
// MarginalConditional, or a user's class. sample(xi) maps the open unit cube to points that follow pdf(x).
template <typename D>
concept JointDistribution = std::same_as<typename D::Point, std::array<double, D::dimensions>> &&
    requires(const D& d, const typename D::Point& x) {
    { d.sample(x) } -> std::same_as<typename D::Point>;
    { d.pdf(x) } -> std::convertible_to<double>;
};

// Points X that follow a density p, with respect to the measure in which the integral is taken. p must
// integrate to 1 and be above zero wherever the integrand is not zero; points outside the domain may be drawn
// and count as zeros. The functions are called from several threads at once.
class Technique {
  public:
    // Fills x, which has room for as many points as u.
    using BatchSample = std::function<void(const PointBatch& u, PointBuffer& x)>;
    // p[i] = density of point i.
    using BatchDensity = std::function<void(const PointBatch& x, std::span<double> p)>;
    using PointSample = std::function<void(std::span<const double> u, std::span<double> x)>;
    using PointDensity = std::function<double(std::span<const double> x)>;

    // Independent coordinates, each by inversion.
    Technique(std::vector<Distribution> factors);
    // One coordinate.
    Technique(Distribution distribution) : Technique(std::vector<Distribution>{std::move(distribution)}) {}
    template <Distribution1D D>
    Technique(D distribution) : Technique(Distribution(std::move(distribution))) {}
    template <JointDistribution D>
    Technique(D joint) : Technique(from_joint(std::move(joint))) {}
    template <Distribution1D D>
    Technique(RuntimeProduct<D> product) : Technique(from_product(std::move(product))) {}

    // From functions: `uniforms` numbers in (0, 1) to a point of `dimensions` coordinates.
    static Technique functions(int uniforms, int dimensions, PointSample sample, PointDensity density);
    // The same for numbers, one to one: double(double) both.
    static Technique functions(std::function<double(double)> sample, std::function<double(double)> density);
    static Technique batch(int uniforms, int dimensions, BatchSample sample, BatchDensity density);
    // Uniform over a domain; its map must change volume by a constant factor (a finite box), or Error is
    // thrown.
    static Technique uniform(const Domain& domain);

    int uniforms() const { return uniforms_; }
    int dimensions() const { return dimensions_; }

    // x is resized to as many points as u has. If a technique returns coordinates that are not finite, the
    // point's density is set to 0.
    void sample(const PointBatch& u, PointBuffer& x) const;
    // Throws Error for a density that is negative or NaN, with the point.
    void density(const PointBatch& x, std::span<double> p) const;

  private:
    Technique(int uniforms, int dimensions, BatchSample sample, BatchDensity density);

    template <typename D>
    static Technique from_joint(D joint) {
        constexpr auto n = static_cast<int>(D::dimensions);
        auto point = [](std::span<const double> x) {
            typename D::Point p;
            std::copy_n(x.begin(), n, p.begin());
            return p;
        };
        return functions(
            n, n,
            [joint, point](std::span<const double> u, std::span<double> x) {
                const typename D::Point at = joint.sample(point(u));
                std::copy_n(at.begin(), n, x.begin());
            },
            [joint, point](std::span<const double> x) { return joint.pdf(point(x)); });
    }
    template <typename D>
    static Technique from_product(RuntimeProduct<D> product) {
        const int n = static_cast<int>(product.dimensions());
        return functions(
            n, n, [product](std::span<const double> u, std::span<double> x) { product.sample(u, x); },
            [product](std::span<const double> x) { return product.pdf(x); });
    }

    int uniforms_, dimensions_;
    BatchSample sample_;
    BatchDensity density_;
};

} // namespace montelux
