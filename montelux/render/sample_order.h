// Which samples of a pixel are taken in which order, and which of them form one unit of its error estimate.
#pragma once

#include <cstdint>

#include "montelux/mc/random/sampler_settings.h"

namespace montelux {

// One of several renders that share the samples of a picture.
struct Slice {
    std::uint32_t index = 0, count = 1; // index < count

    bool operator==(const Slice&) const = default;
};

// A unit is one sample of the independent sampler, and one replicate of the others; units are independent of
// one another. Slice k of n takes the units k, k + n, k + 2n, ...
class SampleOrder {
  public:
    SampleOrder(const SamplerSettings& sampler, Slice slice)
        : unit_(sampler.kind == SamplerKind::independent ? 1 : points_per_replicate(sampler)),
          samples_(sampler.spp), slice_(slice) {}

    std::uint32_t unit() const { return unit_; }
    // Sample index of the i-th sample that this slice takes.
    std::uint64_t index(std::uint64_t i) const {
        return (i / unit_ * slice_.count + slice_.index) * unit_ + i % unit_;
    }
    // Is no unit open after the first n samples?
    bool closed(std::uint64_t n) const { return n % unit_ == 0; }
    // Samples that this slice takes of spp; the last replicate may be shorter than the others.
    std::uint64_t share() const {
        const std::uint64_t whole = samples_ / unit_, rest = samples_ % unit_;
        const std::uint64_t mine = whole / slice_.count + (slice_.index < whole % slice_.count);
        return mine * unit_ + (whole % slice_.count == slice_.index ? rest : 0);
    }

  private:
    std::uint32_t unit_;
    std::uint64_t samples_;
    Slice slice_;
};

} // namespace montelux
