// DeviceValues: values of an integrand at points that a device draws, read by batches as those of an Evaluator.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "montelux/mc/device/device_sampler.h"
#include "montelux/mc/integrate/sampling.h"
#include "montelux/mc/integrate/unit_points.h"

namespace montelux {

// Draws are made by one thread at a time, reads of the last block by any number.
class DeviceValues {
  public:
    // Null where the evaluator's integrand is on no device. Throws Error where the domain is no box.
    static std::unique_ptr<DeviceValues> of(const Evaluator& g);

    DeviceSampler& sampler() { return sampler_; }
    // Points of a block: as many as the integrand asks for, if memory allows, and at least a batch.
    std::uint64_t block_size() const {
        constexpr std::uint64_t most_bytes = 1 << 27, least = 1 << 12, most = 1 << 20;
        const std::uint64_t bytes = sizeof(double) * (static_cast<std::uint64_t>(g_.components()) + 2);
        return std::clamp<std::uint64_t>(g_.integrand().on_device().block, batch_size,
                                         std::clamp(most_bytes / bytes, least, most));
    }
    // The same of each replicate, where a block has points of all: at least one.
    std::uint64_t block_of_each(std::uint64_t replicates) const {
        return std::max<std::uint64_t>(1, block_size() / replicates);
    }
    // Blocks are summed on the device from here on, if the integrand has one component. Values are copied of batches
    // alone whose sums do not say everything: with values that are not finite, that must be scaled, that are larger
    // in magnitude than `floor`, that of their tail, or that are the largest of the run. What OnDevice::after does to values is asked of the least and the
    // greatest of a batch, in a call of their own: where it leaves these, it must leave those between them.
    void summarise_above(double floor);
    // Of the batch that begins at that point of the block; null where its values were copied, for read().
    const DeviceSummary* summary(std::uint64_t number) const;

    // The points of fill_random. `placed`: in the sampler's boxes and by its map.
    void draw_random(std::uint64_t seed, std::uint32_t stream, std::uint64_t first, std::uint64_t count,
                     bool placed = false);
    // Replicate r is that of ScrambledSobol(dimensions, seed, first_replicate + r); its point first + i is number
    // r * each + i of the block.
    void set_replicates(std::uint64_t seed, std::uint32_t first_replicate, int replicates);
    void draw_sobol(std::uint64_t first, std::uint64_t each);

    // Points first, first + 1, ... of the mixture that the sampler was given.
    void draw_mixture(std::uint64_t first, std::uint64_t count);

    // Values of g at points number, number + 1, ... of the block. `points` fills in their coordinates in the unit cube
    // before the domain; it is called where a value is not finite or the largest of the run.
    void read(std::uint64_t number, ValueBatch g, const std::function<void(PointBuffer&)>& points,
              NonFiniteCount& non_finite) const;
    // The same for `count` points of a mixture: values at those that lie inside the cube, and the density there.
    // `points` fills in all of them.
    void read_inside(std::uint64_t number, std::uint64_t count, ValueBuffer& g, std::vector<double>& density,
                     const std::function<void(PointBuffer&)>& points, NonFiniteCount& non_finite) const;
    // |dx/dy| of the sampler's map at these points.
    std::span<const double> jacobian(std::uint64_t number, std::size_t n) const {
        return {block_.jacobian + number, n};
    }

  private:
    explicit DeviceValues(const Evaluator& g);
    void begin(std::uint64_t count) const;
    // `each`: points of a replicate.
    void copy_what_sums_hide(std::uint64_t each);

    Evaluator g_;
    DeviceSampler sampler_;
    DeviceSampler::Block block_;
    double floor_ = 0;
    std::uint64_t each_ = 0;
    std::vector<char> copied_; // of each batch
};

// sum_batches over points that a device draws, if there is one: draw(first, count) has it evaluate a block of them, and
// add(first, count, number, sum) gets points [first, first + count), of which the first has that number in the block.
template <typename Draw, typename Make, typename Add, typename Sum = std::invoke_result_t<const Make&>>
std::optional<Sum> sum_blocks(std::uint64_t count, const DeviceValues* device, const Draw& draw,
                              const Make& make, const Add& add, const CancelFlag* cancel) {
    const std::uint64_t size = device ? device->block_size() : count;
    std::optional<Sum> all;
    for (std::uint64_t begin = 0; begin < count; begin += size) {
        const std::uint64_t n = std::min(size, count - begin);
        try {
            if (device) draw(begin, n);
        } catch (const IntegrandInterrupted&) {
            return std::nullopt;
        }
        auto sum = sum_batches(
            n, make,
            [&](std::uint64_t first, std::uint64_t batch, Sum& to) { add(begin + first, batch, first, to); },
            cancel);
        if (!sum) return std::nullopt;
        if (all)
            all->merge(*sum);
        else
            all = std::move(sum);
    }
    return all ? std::move(all) : make();
}

} // namespace montelux
