#include "montelux/mc/integrate/problem_fingerprint.h"

#include <bit>
#include <cstddef>
#include <utility>
#include <vector>

#include "montelux/mc/random/hash.h"

namespace montelux {

std::uint64_t problem_fingerprint(const Integrand& f, const Evaluator& evaluator, const std::string& method,
                                  const IntegrationOptions& options) {
    std::uint64_t key =
        hash_key(options.seed, evaluator.dimensions(), evaluator.components(), options.full_covariance);
    auto mix = [&key](double v) { key = hash_key(key, std::bit_cast<std::uint64_t>(v)); };
    for (char c : method + evaluator.domain().description())
        key = hash_key(key, static_cast<std::uint64_t>(c));
    PointBuffer u(4, evaluator.dimensions()), x(4, evaluator.domain().dimensions());
    for (std::size_t i = 0; i < u.count(); ++i)
        for (int d = 0; d < u.dimensions(); ++d)
            u(i, d) = 0.1 + 0.2 * static_cast<double>(i) + 0.05 * (d % 3);
    std::vector<double> volume(u.count(), 1.0);
    evaluator.domain().map(u, x, volume);
    for (double v : volume) mix(v);
    for (int d = 0; d < x.dimensions(); ++d)
        for (double v : x.coordinate(d)) mix(v);
    ValueBuffer g(u.count(), evaluator.components());
    f(x, g);
    for (int c = 0; c < g.components(); ++c)
        for (double v : std::as_const(g).component(c)) mix(v);
    return key;
}

} // namespace montelux
