#include "montelux/mc/integrate/techniques/technique.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

void throw_bad_density(const PointBatch& x, std::size_t i, double p) {
    std::ostringstream what;
    what.precision(17);
    what << "the density is " << p << " at (";
    for (int d = 0; d < x.dimensions(); ++d) what << (d ? ", " : "") << x(i, d);
    what << "); expected a number that is not negative";
    throw Error("Technique", what.str());
}

} // namespace

Technique::Technique(int uniforms, int dimensions, BatchSample sample, BatchDensity density)
    : uniforms_(uniforms), dimensions_(dimensions), sample_(std::move(sample)), density_(std::move(density)) {
    if (uniforms < 1 || dimensions < 1)
        throw Error("Technique", "expected at least one uniform number and one dimension, got " +
                                     std::to_string(uniforms) + " and " + std::to_string(dimensions));
    if (!sample_ || !density_) throw Error("Technique", "expected functions for both sample and density");
}

Technique::Technique(std::vector<Distribution> factors)
    : uniforms_(static_cast<int>(factors.size())), dimensions_(uniforms_) {
    if (factors.empty()) throw Error("Technique", "expected at least one distribution, found none");
    sample_ = [factors](const PointBatch& u, PointBuffer& x) {
        for (int d = 0; d < x.dimensions(); ++d)
            factors[static_cast<std::size_t>(d)].sample(u.coordinate(d), x.coordinate(d));
    };
    density_ = [factors = std::move(factors)](const PointBatch& x, std::span<double> p) {
        factors[0].pdf(x.coordinate(0), p);
        std::vector<double> factor(factors.size() > 1 ? p.size() : 0);
        for (std::size_t d = 1; d < factors.size(); ++d) {
            factors[d].pdf(x.coordinate(static_cast<int>(d)), factor);
            for (std::size_t i = 0; i < p.size(); ++i) p[i] *= factor[i];
        }
    };
}

Technique Technique::functions(int uniforms, int dimensions, PointSample sample, PointDensity density) {
    if (!sample || !density) throw Error("Technique", "expected functions for both sample and density");
    return {uniforms, dimensions,
            [sample = std::move(sample)](const PointBatch& u, PointBuffer& x) {
                std::vector<double> xi(static_cast<std::size_t>(u.dimensions()));
                std::vector<double> at(static_cast<std::size_t>(x.dimensions()));
                for (std::size_t i = 0; i < u.count(); ++i) {
                    u.gather(i, xi.data());
                    sample(xi, at);
                    for (int d = 0; d < x.dimensions(); ++d) x(i, d) = at[static_cast<std::size_t>(d)];
                }
            },
            [density = std::move(density)](const PointBatch& x, std::span<double> p) {
                std::vector<double> at(static_cast<std::size_t>(x.dimensions()));
                for (std::size_t i = 0; i < p.size(); ++i) {
                    x.gather(i, at.data());
                    p[i] = density(at);
                }
            }};
}

Technique Technique::functions(std::function<double(double)> sample, std::function<double(double)> density) {
    if (!sample || !density) throw Error("Technique", "expected functions for both sample and density");
    return functions(
        1, 1,
        [sample = std::move(sample)](std::span<const double> u, std::span<double> x) { x[0] = sample(u[0]); },
        [density = std::move(density)](std::span<const double> x) { return density(x[0]); });
}

Technique Technique::batch(int uniforms, int dimensions, BatchSample sample, BatchDensity density) {
    return {uniforms, dimensions, std::move(sample), std::move(density)};
}

Technique Technique::uniform(const Domain& domain) {
    const double volume = domain.constant_volume();
    if (volume == 0)
        throw Error("Technique::uniform",
                    "the density over " + domain.description() + " is not constant; expected a finite box");
    return {domain.uniforms(), domain.dimensions(),
            [domain](const PointBatch& u, PointBuffer& x) {
                std::vector<double> ignored(u.count(), 1.0);
                domain.map(u, x, ignored);
            },
            [volume, ranges = std::vector<Range>(domain.ranges().begin(), domain.ranges().end())](
                const PointBatch& x, std::span<double> p) {
                std::fill(p.begin(), p.end(), 1 / volume);
                for (std::size_t d = 0; d < ranges.size(); ++d)
                    for (std::size_t i = 0; i < p.size(); ++i) {
                        const double v = x(i, static_cast<int>(d));
                        if (!(v >= ranges[d].lower && v <= ranges[d].upper)) p[i] = 0;
                    }
            }};
}

void Technique::sample(const PointBatch& u, PointBuffer& x) const {
    x.resize(u.count(), dimensions_);
    sample_(u, x);
}

void Technique::density(const PointBatch& x, std::span<double> p) const {
    density_(x, p);
    for (std::size_t i = 0; i < p.size(); ++i)
        if (!(p[i] >= 0)) throw_bad_density(x, i, p[i]);
}

} // namespace montelux
