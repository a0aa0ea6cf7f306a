#include "montelux/mc/integrate/device_values.h"

#include <utility>
#include <vector>

#include "montelux/mc/math/error.h"
#include "montelux/mc/random/hash.h"

namespace montelux {

std::unique_ptr<DeviceValues> DeviceValues::of(const Evaluator& g) {
    if (!g.integrand().on_device().function) return nullptr;
    return std::unique_ptr<DeviceValues>(new DeviceValues(g));
}

DeviceValues::DeviceValues(const Evaluator& g) : g_(g), sampler_(g.integrand().on_device().function) {
    const Domain& domain = g.domain();
    if (domain.ranges().empty())
        throw Error("device", "points of a " + domain.description() +
                                  " are not drawn on a device; expected a box of ranges without densities");
    if (domain.is_unit_cube()) return;
    std::vector<double> ends;
    for (const Range& range : domain.ranges()) ends.insert(ends.end(), {range.lower, range.upper});
    sampler_.set_ranges(ends, domain.constant_volume());
}

void DeviceValues::begin(std::uint64_t count) const {
    for (const auto& before : g_.integrand().on_device().before) before(static_cast<std::size_t>(count));
}

void DeviceValues::summarise_above(double floor) {
    sampler_.set_summaries(true);
    floor_ = floor;
}

void DeviceValues::copy_what_sums_hide(std::uint64_t each) {
    static_assert(device_batch == batch_size);
    if (block_.summaries == nullptr) return;
    each_ = each;
    const LargestValues* known = g_.kept_largest();
    const auto hides = [&](const DeviceSummary& s) {
        if (s.finite == 0 || s.greatest > floor_ || -s.least > floor_) return true;
        if (known && known->learns(0, s.least, s.greatest)) return true;
        // What leaves the extreme values as they are leaves all as they are: scaling, clamping.
        ValueBuffer extremes(2, 1);
        extremes.component(0)[0] = s.raw_least;
        extremes.component(0)[1] = s.raw_greatest;
        for (const auto& after : g_.integrand().on_device().after) after(extremes);
        return extremes(0) != s.raw_least || extremes(1) != s.raw_greatest;
    };
    copied_.resize(block_.batches);
    std::size_t hiding = 0;
    for (std::size_t b = 0; b < block_.batches; ++b)
        hiding += copied_[b] = hides(block_.summaries[b]) ? 1 : 0;
    // A copy of everything is faster than many small ones.
    if (hiding > block_.batches / 16) return sampler_.fetch_values(0, block_.count);
    const std::uint64_t in_run = (each + batch_size - 1) / batch_size;
    for (std::size_t b = 0; b < block_.batches; ++b) {
        if (copied_[b] == 0) continue;
        const std::uint64_t first = b % in_run * batch_size;
        sampler_.fetch_values(static_cast<std::size_t>(b / in_run * each + first),
                              static_cast<std::size_t>(std::min(batch_size, each - first)));
    }
}

const DeviceSummary* DeviceValues::summary(std::uint64_t number) const {
    if (block_.summaries == nullptr) return nullptr;
    const std::uint64_t in_run = (each_ + batch_size - 1) / batch_size;
    const auto batch = static_cast<std::size_t>(number / each_ * in_run + number % each_ / batch_size);
    return copied_[batch] != 0 ? nullptr : &block_.summaries[batch];
}

void DeviceValues::draw_random(std::uint64_t seed, std::uint32_t stream, std::uint64_t first,
                               std::uint64_t count, bool placed) {
    begin(count);
    block_ = sampler_.random(hash_key(seed, stream), stream, first, static_cast<std::size_t>(count), placed);
    copy_what_sums_hide(count);
}

void DeviceValues::set_replicates(std::uint64_t seed, std::uint32_t first_replicate, int replicates) {
    std::vector<std::uint32_t> keys, columns;
    for (int r = 0; r < replicates; ++r) {
        const ScrambledSobol points(g_.dimensions(), seed, first_replicate + static_cast<std::uint32_t>(r));
        keys.insert(keys.end(), points.keys().begin(), points.keys().end());
        if (r == 0) columns.assign(points.columns().begin(), points.columns().end());
    }
    sampler_.set_sobol(keys, columns);
}

void DeviceValues::draw_sobol(std::uint64_t first, std::uint64_t each) {
    begin(each * static_cast<std::uint64_t>(sampler_.replicates()));
    block_ = sampler_.sobol(first, static_cast<std::size_t>(each));
    copy_what_sums_hide(each);
}

void DeviceValues::draw_mixture(std::uint64_t first, std::uint64_t count) {
    begin(count);
    block_ = sampler_.mixture(first, static_cast<std::size_t>(count));
}

void DeviceValues::read(std::uint64_t number, ValueBatch g, const std::function<void(PointBuffer&)>& points,
                        NonFiniteCount& non_finite) const {
    for (int c = 0; c < g.components(); ++c)
        std::copy_n(block_.values + static_cast<std::size_t>(c) * block_.count + number, g.count(),
                    g.component(c).data());
    for (const auto& after : g_.integrand().on_device().after) after(g);
    g_.complete(g, block_.volume ? block_.volume + number : nullptr, points, non_finite);
}

void DeviceValues::read_inside(std::uint64_t number, std::uint64_t count, ValueBuffer& g,
                               std::vector<double>& density, const std::function<void(PointBuffer&)>& points,
                               NonFiniteCount& non_finite) const {
    std::vector<std::size_t> inside;
    density.clear();
    for (std::size_t i = 0; i < count; ++i) {
        const double q = block_.density ? block_.density[number + i] : 1;
        if (!(q > 0)) continue;
        inside.push_back(i);
        density.push_back(q);
    }
    g.resize(inside.size(), g_.components());
    if (inside.empty()) return;
    const auto compact = [&](const double* from, double* to) {
        for (std::size_t j = 0; j < inside.size(); ++j) to[j] = from[number + inside[j]];
    };
    for (int c = 0; c < g.components(); ++c)
        compact(block_.values + static_cast<std::size_t>(c) * block_.count, g.view().component(c).data());
    std::vector<double> volume(block_.volume ? inside.size() : 0);
    if (block_.volume) compact(block_.volume, volume.data());
    for (const auto& after : g_.integrand().on_device().after) after(g);
    g_.complete(
        g, block_.volume ? volume.data() : nullptr,
        [&](PointBuffer& x) {
            PointBuffer all(count, x.dimensions());
            points(all);
            for (int d = 0; d < x.dimensions(); ++d)
                for (std::size_t j = 0; j < inside.size(); ++j) x(j, d) = all(inside[j], d);
        },
        non_finite);
}

} // namespace montelux
