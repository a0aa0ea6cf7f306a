#include "bench/hard/bank.h"

#include "bench/hard/draws.h"

namespace montelux::bench {

std::span<const HardFamily> hard_families() {
    static const std::vector<HardFamily> all = [] {
        std::vector<HardFamily> families;
        for (const auto& group : {peak_families(), shell_families(), ridge_families(), jump_families(),
                                  singular_families(), infinite_families(), physics_families(),
                                  option_families(), high_dimensional_families(), control_families()})
            families.insert(families.end(), group.begin(), group.end());
        return families;
    }();
    return all;
}

const HardFamily* hard_family_named(std::string_view name) {
    for (const auto& families : {hard_families(), judging_families()})
        for (const HardFamily& family : families)
            if (family.name == name) return &family;
    return nullptr;
}

HardProblem::HardProblem(const HardFamily& family, std::uint64_t seed)
    : BenchProblem(seed), family_(&family) {
    Draws draws(family.name, seed);
    integral_ = family.draw(draws);
    set_ranges(integral_.ranges);
    set_exact(integral_.exact);
}

} // namespace montelux::bench
