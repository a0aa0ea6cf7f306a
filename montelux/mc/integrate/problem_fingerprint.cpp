#include "montelux/mc/integrate/problem_fingerprint.h"

#include <bit>
#include <cstddef>
#include <utility>
#include <vector>

#include "montelux/mc/integrate/domain_probe.h"
#include "montelux/mc/random/hash.h"

namespace montelux {

std::uint64_t problem_fingerprint(const Integrand& f, const Evaluator& evaluator, const std::string& method,
                                  const IntegrationOptions& options) {
    std::uint64_t key =
        hash_key(options.seed, evaluator.dimensions(), evaluator.components(), options.full_covariance);
    auto mix = [&key](double v) { key = hash_key(key, std::bit_cast<std::uint64_t>(v)); };
    for (char c : method + evaluator.domain().description())
        key = hash_key(key, static_cast<std::uint64_t>(c));
    const DomainProbe probe(evaluator.domain());
    for (double v : probe.numbers()) mix(v);
    ValueBuffer g(probe.x.count(), evaluator.components());
    f(probe.x, g);
    for (int c = 0; c < g.components(); ++c)
        for (double v : std::as_const(g).component(c)) mix(v);
    return key;
}

} // namespace montelux
