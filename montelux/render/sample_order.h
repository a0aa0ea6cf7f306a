// SampleOrder: the order in which the samples of a pixel are taken, and how they split into replicates.
#pragma once

#include <cstdint>

#include "montelux/mc/random/sampler_settings.h"

namespace montelux {

// One of several renders that share the samples of a picture.
struct Slice {
    std::uint32_t index = 0, count = 1; // index < count

    bool operator==(const Slice&) const = default;
};

// A replicate is a single sample of the independent sampler, one randomisation of the point set of the
// others, and a group of chains if samples are states of these; replicates are independent of one another. Slice k of n takes the replicates k, k + n, k + 2n, ...
class SampleOrder {
  public:
    SampleOrder(const SamplerSettings& sampler, Slice slice)
        : replicate_size_(sampler.kind == SamplerKind::independent && !sampler.chains
                              ? 1
                              : points_per_replicate(sampler)),
          samples_(sampler.chains ? sampler.spp / replicate_size_ * replicate_size_ : sampler.spp),
          slice_(slice) {}

    std::uint32_t replicate_size() const { return replicate_size_; }
    // Sample index of the i-th sample that this slice takes.
    std::uint64_t index(std::uint64_t i) const {
        return (i / replicate_size_ * slice_.count + slice_.index) * replicate_size_ + i % replicate_size_;
    }
    // Is every replicate complete after the first n samples?
    bool closed(std::uint64_t n) const { return n % replicate_size_ == 0; }
    // Samples that this slice takes of spp; the last replicate may be shorter than the others, but no group of chains.
    std::uint64_t share() const {
        const std::uint64_t whole = samples_ / replicate_size_, rest = samples_ % replicate_size_;
        const std::uint64_t mine = whole / slice_.count + (slice_.index < whole % slice_.count);
        return mine * replicate_size_ + (whole % slice_.count == slice_.index ? rest : 0);
    }

  private:
    std::uint32_t replicate_size_;
    std::uint64_t samples_;
    Slice slice_;
};

} // namespace montelux
