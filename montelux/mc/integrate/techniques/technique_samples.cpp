#include "montelux/mc/integrate/techniques/technique_samples.h"

#include <string>

#include "montelux/mc/integrate/techniques/domain_restriction.h"
#include "montelux/mc/integrate/unit_points.h"
#include "montelux/mc/math/error.h"

namespace montelux {

TechniqueSampler::TechniqueSampler(const Problem& problem, const std::vector<WeightedTechnique>& techniques)
    : problem_(problem), f_(restricted(problem.evaluator.integrand(), problem.evaluator.domain()),
                            problem.evaluator.domain(), problem.evaluator.policy()) {
    const int expected = problem.evaluator.domain().dimensions();
    constexpr std::uint64_t most = 1 << 30;
    for (const WeightedTechnique& t : techniques) {
        if (t.technique.dimensions() != expected)
            throw Error("multiple_importance", "a density has " + std::to_string(t.technique.dimensions()) +
                                                   " dimensions, but the domain has " +
                                                   std::to_string(expected));
        if (t.samples > most)
            throw Error("multiple_importance",
                        std::to_string(t.samples) + " samples in a round; expected at most 2^30");
        if (t.samples == 0) continue;
        techniques_.push_back(t);
        in_round_ += t.samples;
    }
    if (techniques_.empty()) throw Error("multiple_importance", "no technique draws a sample");
}

std::vector<Technique> TechniqueSampler::all() const {
    std::vector<Technique> all;
    for (const WeightedTechnique& t : techniques_) all.push_back(t.technique);
    return all;
}

void TechniqueSampler::draw(std::size_t i, std::uint64_t first, std::uint64_t count, Batch& batch,
                            NonFiniteCount& non_finite) const {
    const Technique& technique = techniques_[i].technique;
    batch.u.resize(count, technique.uniforms());
    batch.f.resize(count, f_.components());
    fill_random(batch.u, problem_.seed, static_cast<std::uint32_t>(i), first);
    technique.sample(batch.u, batch.x);
    batch.q.resize(techniques_.size() * count);
    batch.sum.assign(count, 0.0);
    for (std::size_t k = 0; k < techniques_.size(); ++k) {
        std::span<double> q(&batch.q[k * count], count);
        techniques_[k].technique.density(batch.x, q);
        const double n = static_cast<double>(techniques_[k].samples);
        for (std::size_t j = 0; j < count; ++j) batch.sum[j] += q[j] *= n;
    }
    f_.at_points(batch.x, batch.f, non_finite);

    const double* own = &batch.q[i * count];
    for (std::size_t j = 0; j < count; ++j) {
        if (own[j] > 0) continue;
        bool zero = true;
        for (int c = 0; c < f_.components(); ++c) {
            zero = zero && batch.f(j, c) == 0;
            batch.f.component(c)[j] = 0;
        }
        if (zero) continue;
        NonFiniteCount one{1, std::vector<double>(static_cast<std::size_t>(batch.x.dimensions()))};
        batch.x.view().gather(j, one.first_point.data());
        if (f_.policy() == NonFinitePolicy::throw_error)
            throw Error("multiple_importance", "technique " + std::to_string(i + 1) +
                                                   " drew a point at which its own density is zero");
        non_finite.merge(one);
    }
}

} // namespace montelux
