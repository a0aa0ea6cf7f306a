// ChainStatistics: what the chains of a Metropolis render did: acceptances, and whether they agree.
#pragma once

#include <cstdint>
#include <type_traits>

#include "montelux/mc/integrate/metropolis/chain_agreement.h"

namespace montelux {

// Trivially copyable; part of a checkpoint.
struct ChainStatistics {
    std::uint64_t large_steps = 0, small_steps = 0;
    // Sums of acceptance probabilities.
    double large_accepted = 0, small_accepted = 0;
    std::uint64_t groups = 0;
    std::uint64_t dark_groups = 0; // none of their independent starting points found light
    // Of the plan (ChainPlan), the same for all groups.
    float longest_step = 0, large_step_probability = 0;
    std::uint64_t chains = 0, states = 0; // of a group, of a chain
    std::uint64_t starting_points = 0;    // of a group
    // Over halves of groups: place on the film (as fractions), and logarithm of the size.
    ChainAgreement<3> agreement;

    void merge(const ChainStatistics& later) {
        large_steps += later.large_steps;
        small_steps += later.small_steps;
        large_accepted += later.large_accepted;
        small_accepted += later.small_accepted;
        groups += later.groups;
        dark_groups += later.dark_groups;
        agreement.merge(later.agreement);
        longest_step = later.longest_step;
        large_step_probability = later.large_step_probability;
        chains = later.chains;
        states = later.states;
        starting_points = later.starting_points;
    }
    double large_acceptance() const {
        return large_steps > 0 ? large_accepted / static_cast<double>(large_steps) : 0;
    }
    double small_acceptance() const {
        return small_steps > 0 ? small_accepted / static_cast<double>(small_steps) : 0;
    }
};
static_assert(std::is_trivially_copyable_v<ChainStatistics>);

} // namespace montelux
