// DeviceSampler: points that a device draws, maps and evaluates, block by block.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "montelux/mc/device/device_function.h"

namespace montelux {

// A mixture density and the points of its channels, as DeviceMixture has them; without the keys of its sequences.
struct DeviceMixtureTables {
    std::vector<double> shares, bins = {}, powers = {}, gaussians = {};
    std::vector<int> bin_begin = {};
    std::vector<unsigned long long> channel_begin = {}, channel_first = {};
    int map_channel = 0, first_gaussian = 0;
};

// Used by one thread at a time. Tables stay on the device until others are given.
class DeviceSampler {
  public:
    explicit DeviceSampler(std::shared_ptr<const DeviceFunction> function);

    // Lower and upper end of each dimension; without them the domain is the unit cube. They change the volume by
    // `factor`, or, if that is 0, by different factors, which are wanted.
    void set_ranges(std::span<const double> ends, double factor);
    // Scrambled Sobol' points: a key for each replicate and dimension, 32 bit-reversed columns for each dimension.
    void set_sobol(std::span<const std::uint32_t> keys, std::span<const std::uint32_t> columns);
    // Strata of the unit cube, whose number begin.size() - 1 is the product of `strata`: box h has the points begin[h]
    // to begin[h + 1] - 1.
    void set_boxes(std::span<const std::uint64_t> begin, std::span<const int> strata);
    // An adaptive map, increments + 1 edges for each dimension.
    void set_map(std::span<const double> edges, int increments);

    // Compiles what mixtures need, unless that was done; set_mixture does it otherwise.
    void prepare_mixtures() { function_->prepare_mixtures(); }
    // A mixture density, whose points are Sobol' points: set_sobol then gives the keys of each replicate's channels.
    void set_mixture(const DeviceMixtureTables& tables);

    // Whether blocks of one component are summarised from here on.
    void set_summaries(bool on) { with_summaries_ = on; }

    // Component c of point i is values[c * count + i]. Null where it was not asked for: volume |dx/du| of the ranges,
    // jacobian |du/dy| of the adaptive map, density of a mixture of several channels (0: the point is outside the cube
    // and has neither values nor volume). Valid until the next call.
    struct Block {
        const double *values = nullptr, *volume = nullptr, *jacobian = nullptr, *density = nullptr;
        // Of each batch of device_batch points, of each replicate in turn; null where that was not asked for. Values and
        // volumes are then copied by fetch_values() alone.
        const DeviceSummary* summaries = nullptr;
        std::size_t count = 0, batches = 0;
    };
    // Random points first, first + 1, ... of the key. `placed`: in their boxes and by the map, if there are any.
    Block random(std::uint64_t key, std::uint32_t stream, std::uint64_t first, std::size_t count,
                 bool placed);
    // Points first, first + 1, ... first + each - 1 of every replicate, one replicate after the other; by the map, if
    // there is one.
    Block sobol(std::uint64_t first, std::size_t each);

    // Points first, first + 1, ... of the mixture's replicates in turn.
    Block mixture(std::uint64_t first, std::size_t count);

    // Copies values first, first + 1, ... of the last block, and the volumes there.
    void fetch_values(std::size_t first, std::size_t count);

    std::size_t replicates() const { return replicates_; }

  private:
    Block run(DeviceJob& job, bool mapped);

    std::shared_ptr<const DeviceFunction> function_;
    DeviceArray<double> ranges_, edges_, shares_, bins_, powers_, gaussians_;
    DeviceArray<unsigned int> keys_, columns_;
    DeviceArray<unsigned long long> box_begin_, channel_begin_, channel_first_;
    DeviceArray<int> strata_, bin_begin_;
    DeviceOutput<double> values_, volume_, jacobian_, density_;
    DeviceOutput<DeviceSummary> summaries_;
    DeviceMixture mixture_{};
    bool in_ranges_ = false, with_volume_ = false, with_summaries_ = false, mapped_ = false;
    std::size_t boxes_ = 0, replicates_ = 0;
    int increments_ = 0;
    double factor_ = 1;
};

} // namespace montelux
