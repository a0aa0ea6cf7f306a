// A mixture density for a device: its tables, and the points that replicates draw from its channels.
#pragma once

#include <cstdint>

#include "montelux/mc/device/device_sampler.h"
#include "montelux/mc/integrate/adaptive/mixture_density.h"

namespace montelux {

// Points [begin, end) of each replicate in turn, channel by channel: those of sample_mixture, in its order.
void set_mixture(DeviceSampler& sampler, const MixtureDensity& mixture, std::uint64_t key, int replicates,
                 std::uint64_t begin, std::uint64_t end);

} // namespace montelux
