// Settings of a sampler: its point set, and how samples split into replicates.
#pragma once

#include <cstdint>

namespace montelux {

enum class SamplerKind : std::uint8_t {
    independent,
    stratified,
    halton,
    hammersley,
    sobol,
    sobol_blue_noise
};

struct SamplerSettings {
    SamplerKind kind = SamplerKind::sobol;
    std::uint64_t seed = 0;
    std::uint32_t spp = 16;
    std::uint32_t replicates = 1; // independent randomisations that the samples of a pixel are split into
    std::uint32_t replicate_points = 0; // if not 0: points of each, however many replicates that makes
    // Samples are states of Markov chains: whatever the kind, those of a replicate depend on one another.
    bool chains = false;
};

// Points of one randomisation: spp / replicates, rounded up, and at least 1, unless they are
// given. Powers of two suit the Sobol' kinds best, squares the stratified one.
constexpr std::uint32_t points_per_replicate(const SamplerSettings& s) {
    if (s.replicate_points != 0) return s.replicate_points;
    const std::uint32_t replicates = s.replicates == 0 ? 1 : s.replicates;
    const std::uint32_t points = s.spp / replicates + (s.spp % replicates != 0);
    return points == 0 ? 1 : points;
}

// A replicate is a run of consecutive samples. Beyond spp, a continued render starts new replicates of the
// same length.
constexpr std::uint64_t replicate_of(const SamplerSettings& s, std::uint64_t sample_index) {
    return sample_index / points_per_replicate(s);
}
constexpr std::uint32_t index_in_replicate(const SamplerSettings& s, std::uint64_t sample_index) {
    return static_cast<std::uint32_t>(sample_index % points_per_replicate(s));
}

} // namespace montelux
