#include "montelux/bake/brdf_table.h"

#include <string>

#include "montelux/bake/brdf_integrals.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/parallel/parallel_for.h"

namespace montelux {
namespace {

constexpr int largest_table = 4096;

} // namespace

Image brdf_table(const BrdfTableSettings& settings) {
    const int size = settings.size;
    if (size < 1 || size > largest_table)
        throw Error("BRDF table", "the size is " + std::to_string(size) + "; expected 1 to " +
                                      std::to_string(largest_table));
    const BrdfIntegrals integrals;
    Image table(size, size, {"R", "G", "B", "error.R", "error.G", "error.B"});
    auto roughness = [&](int y) { return (y + 0.5) / size; };
    auto set = [&](int x, int y, int channel, double value, double error) {
        table.set(x, y, channel, static_cast<float>(value));
        table.set(x, y, channel + 3, static_cast<float>(error));
    };
    auto fill_row = [&](int y) {
        const double alpha = roughness(y) * roughness(y);
        AlbedoTerm extra;
        if (settings.extra == BrdfTableExtra::average_albedo) extra = integrals.ggx_average_albedo(alpha);
        for (int x = 0; x < size; ++x) {
            const double n_dot_v = (x + 0.5) / size;
            const SplitSumTerms terms = integrals.ggx(n_dot_v, alpha);
            if (settings.extra == BrdfTableExtra::sheen) extra = integrals.charlie_sheen(n_dot_v, alpha);
            set(x, y, 0, terms.scale, terms.error);
            set(x, y, 1, terms.bias, terms.error);
            set(x, y, 2, extra.value, extra.error);
        }
    };
    constexpr int rows_at_a_time = 16;
    for (int first = 0; first < size; first += rows_at_a_time) {
        const int rows = std::min(rows_at_a_time, size - first);
        const bool complete = parallel_for(
            rows, [&](std::int64_t i) { fill_row(first + static_cast<int>(i)); }, settings.cancel);
        if (!complete) return {};
        if (settings.progress) settings.progress(static_cast<double>(first + rows) / size);
    }
    return table;
}

} // namespace montelux
