// ChainPlan: what all groups of chains of a Metropolis render share: their sizes, steps, scale and importance.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <optional>

#include "montelux/mc/integrate/metropolis/chain_weights.h"
#include "montelux/mc/random/hash.h"
#include "montelux/mc/random/philox_stream.h"
#include "montelux/render/bad_sample_report.h"
#include "montelux/render/metropolis/primary_sampler.h"

namespace montelux {

// A group: independent starting points, and bundles of chains from some of them. Together at most so many paths as it
// was made for.
struct GroupSize {
    std::uint64_t starting_points = 0;
    std::uint64_t bundles = 1, chains = 1; // chains per bundle
    std::uint64_t states = 0;              // per chain

    // An eighth of the paths are starting points. Chains are as long as possible, but enough of them for many threads
    // and for rays that are traced together.
    static GroupSize of(std::uint64_t paths) {
        GroupSize size;
        size.starting_points = std::max<std::uint64_t>(1, paths / 8);
        const std::uint64_t rest = paths - std::min(paths, size.starting_points);
        size.bundles = std::clamp<std::uint64_t>(rest / 1024, 1, 16);
        size.chains = std::clamp<std::uint64_t>(rest / (size.bundles * 8192), 1, 16);
        size.states = rest / (size.bundles * size.chains);
        return size;
    }
    std::uint64_t all_chains() const { return bundles * chains; }
    std::uint64_t all_states() const { return all_chains() * states; }
};

// The random numbers of a render's parts: a pure function of its seed.
struct ChainKeys {
    std::uint64_t key;

    explicit ChainKeys(std::uint64_t seed) : key(hash_key(seed, 0x6d6c74)) {}
    PhiloxStream stream(std::uint32_t part, std::uint64_t group, std::uint64_t index) const {
        return PhiloxStream(hash_key(key, group), {part, static_cast<std::uint32_t>(index),
                                                   static_cast<std::uint32_t>(index >> 32)});
    }
    static constexpr std::uint32_t starting_point = 1, walk = 2, choice = 3;
    static constexpr std::uint64_t pilot = ~std::uint64_t{0}; // its group
};

struct ChainPlan {
    GroupSize size;
    double large_step_probability = 0.3;
    SmallStep small_step{1.0 / 64};
    // An estimate of the integral of PrimarySample::size; 0: the pilot found no light.
    double scale = 0;
    FilmImportance importance;
    std::uint64_t pilot_paths = 0;

    ChainWeights weights() const {
        const double states = static_cast<double>(size.all_states());
        return {scale > 0 ? states / scale : 0,
                static_cast<double>(size.starting_points) + large_step_probability * states};
    }
    // Factor of splats: brings them near 1, where a SplatFilm is exact.
    double splat_scale() const {
        const double paths = static_cast<double>(size.starting_points + size.all_states());
        return scale > 0 ? paths / scale : paths;
    }
};

// The plan for groups of so many paths per pixel. It follows from a pilot: paths of its own, which no group contains, so
// that each group is unbiased given the plan, and all are alike. First independent paths: for the scale, the
// importance, and starting points; until one finds light, but at most 2^22. Then chains whose small steps adapt to an
// acceptance of one half; the share of large steps follows from how often these are accepted.
// Empty if `stop`, which any thread asks now and then, returns true.
std::optional<ChainPlan> make_chain_plan(const PrimarySampler& sampler, const Accelerator& accelerator,
                                         const SceneDescription& description, std::uint32_t spp,
                                         const std::function<bool()>& stop);

} // namespace montelux
