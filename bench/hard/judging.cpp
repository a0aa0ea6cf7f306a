#include "bench/hard/judging.h"

namespace montelux::bench {

std::span<const HardFamily> judging_families() {
    static const std::vector<HardFamily> all = [] {
        std::vector<HardFamily> families;
        for (const auto& group :
             {judging_scale_families(), judging_statistics_families(), judging_model_families(),
              judging_finance_families(), judging_jump_families(), judging_singular_families(),
              judging_physics_families()})
            families.insert(families.end(), group.begin(), group.end());
        return families;
    }();
    return all;
}

} // namespace montelux::bench
