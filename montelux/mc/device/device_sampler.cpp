#include "montelux/mc/device/device_sampler.h"

#include <utility>
#include <vector>

namespace montelux {

DeviceSampler::DeviceSampler(std::shared_ptr<const DeviceFunction> function)
    : function_(std::move(function)), ranges_(function_->device()), edges_(function_->device()),
      shares_(function_->device()), bins_(function_->device()), powers_(function_->device()),
      gaussians_(function_->device()), keys_(function_->device()), columns_(function_->device()),
      box_begin_(function_->device()), channel_begin_(function_->device()),
      channel_first_(function_->device()), strata_(function_->device()), bin_begin_(function_->device()),
      values_(function_->device()), volume_(function_->device()), jacobian_(function_->device()),
      density_(function_->device()), summaries_(function_->device()) {}

void DeviceSampler::set_ranges(std::span<const double> ends, double factor) {
    ranges_.assign(ends);
    in_ranges_ = true;
    with_volume_ = factor == 0;
    factor_ = factor;
}

void DeviceSampler::set_sobol(std::span<const std::uint32_t> keys, std::span<const std::uint32_t> columns) {
    keys_.assign(keys);
    columns_.assign(columns);
    replicates_ = keys.size() / static_cast<std::size_t>(function_->dimensions());
}

void DeviceSampler::set_boxes(std::span<const std::uint64_t> begin, std::span<const int> strata) {
    const std::vector<unsigned long long> words(begin.begin(), begin.end());
    box_begin_.assign(words);
    strata_.assign(strata);
    boxes_ = begin.size() - 1;
}

void DeviceSampler::set_map(std::span<const double> edges, int increments) {
    edges_.assign(edges);
    increments_ = increments;
    mapped_ = true;
}

void DeviceSampler::set_mixture(const DeviceMixtureTables& tables) {
    prepare_mixtures();
    mixture_ = {.channels = static_cast<int>(tables.shares.size()),
                .map_channel = tables.map_channel,
                .first_gaussian = tables.first_gaussian,
                .shares = shares_.assign(tables.shares),
                .bin_begin = bin_begin_.assign(tables.bin_begin),
                .bins = bins_.assign(tables.bins),
                .powers = powers_.assign(tables.powers),
                .gaussians = gaussians_.assign(tables.gaussians),
                .channel_begin = channel_begin_.assign(tables.channel_begin),
                .channel_first = channel_first_.assign(tables.channel_first)};
}

DeviceSampler::Block DeviceSampler::random(std::uint64_t key, std::uint32_t stream, std::uint64_t first,
                                           std::size_t count, bool placed) {
    DeviceJob job{};
    job.kind = device_random_points;
    job.count = job.points_each = count;
    job.first = first;
    job.key = key;
    job.stream = stream;
    if (placed && boxes_ > 0) {
        job.box_begin = box_begin_.data();
        job.boxes = boxes_;
        job.strata = strata_.data();
    }
    return run(job, placed && mapped_);
}

DeviceSampler::Block DeviceSampler::sobol(std::uint64_t first, std::size_t each) {
    DeviceJob job{};
    job.kind = device_sobol_points;
    job.count = each * replicates_;
    job.first = first;
    job.points_each = each;
    job.sobol_keys = keys_.data();
    job.sobol_columns = columns_.data();
    return run(job, mapped_);
}

DeviceSampler::Block DeviceSampler::mixture(std::uint64_t first, std::size_t count) {
    DeviceJob job{};
    job.kind = device_mixture_points;
    job.count = count;
    job.first = first;
    job.sobol_keys = keys_.data();
    job.sobol_columns = columns_.data();
    job.mixture = mixture_;
    if (mixture_.channels > 1) job.density = density_.reserve(count);
    return run(job, false);
}

DeviceSampler::Block DeviceSampler::run(DeviceJob& job, bool mapped) {
    const auto n = static_cast<std::size_t>(job.count);
    const std::size_t all = n * static_cast<std::size_t>(function_->components());
    if (n == 0) return {};
    if (in_ranges_) job.ranges = ranges_.data();
    if (mapped) {
        job.edges = edges_.data();
        job.increments = increments_;
        job.jacobian = jacobian_.reserve(n);
    }
    if (with_volume_) job.volume = volume_.reserve(n);
    job.values = values_.reserve(all);
    Block block{.count = n};
    if (with_summaries_ && function_->components() == 1 && job.points_each > 0) {
        block.batches = n / static_cast<std::size_t>(job.points_each) *
                        static_cast<std::size_t>((job.points_each + device_batch - 1) / device_batch);
        job.batches = block.batches;
        job.summaries = summaries_.reserve(block.batches);
        job.factor = factor_;
    }
    function_->run(job);
    if (job.summaries != nullptr) {
        block.summaries = summaries_.fetch(block.batches);
        block.values = values_.reserve_copies(n);
        if (with_volume_) block.volume = volume_.reserve_copies(n);
    } else {
        block.values = values_.fetch(all);
        if (with_volume_) block.volume = volume_.fetch(n);
    }
    if (mapped) block.jacobian = jacobian_.fetch(n);
    if (job.density != nullptr) block.density = density_.fetch(n);
    return block;
}

void DeviceSampler::fetch_values(std::size_t first, std::size_t count) {
    values_.fetch_part(first, count);
    if (with_volume_) volume_.fetch_part(first, count);
}

} // namespace montelux
