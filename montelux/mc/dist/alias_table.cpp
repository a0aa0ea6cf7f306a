#include "montelux/mc/dist/alias_table.h"

#include "montelux/mc/dist/weights.h"
#include "montelux/mc/math/error.h"

namespace montelux {

AliasTable::AliasTable(std::span<const float> weights)
    : weight_sum_(checked_weight_sum("AliasTable", weights)) {
    build(weights);
}
AliasTable::AliasTable(std::span<const double> weights)
    : weight_sum_(checked_weight_sum("AliasTable", weights)) {
    build(weights);
}

template <typename T>
void AliasTable::build(std::span<const T> weights) {
    std::size_t n = weights.size();
    if (n > std::numeric_limits<std::uint32_t>::max())
        throw Error("AliasTable", "more than 2^32 - 1 weights");
    bins_.resize(n);

    // Heights relative to the mean: a bin holds exactly 1.
    std::vector<double> height(n);
    std::vector<std::uint32_t> small, large;
    std::uint32_t heaviest = 0;
    for (std::size_t i = 0; i < n; ++i) {
        double p =
            weight_sum_ > 0 ? static_cast<double>(weights[i]) / weight_sum_ : 1 / static_cast<double>(n);
        auto index = static_cast<std::uint32_t>(i);
        bins_[i] = {1, static_cast<float>(p), index};
        height[i] = p * static_cast<double>(n);
        (height[i] < 1 ? small : large).push_back(index);
        if (height[i] > height[heaviest]) heaviest = index;
    }
    while (!small.empty() && !large.empty()) {
        std::uint32_t s = small.back(), l = large.back();
        small.pop_back();
        bins_[s].threshold = height[s];
        bins_[s].alias = l;
        height[l] -= 1 - height[s];
        if (height[l] < 1) {
            large.pop_back();
            small.push_back(l);
        }
    }
    // What rounding leaves over fills its own bin, unless its probability is zero.
    for (std::uint32_t s : small)
        if (bins_[s].probability == 0) {
            bins_[s].threshold = 0;
            bins_[s].alias = heaviest;
        }
}

} // namespace montelux
