#include "montelux/mc/integrate/adaptive/device_mixture.h"

#include <vector>

#include "montelux/mc/integrate/unit_points.h"
#include "montelux/mc/random/hash.h"

namespace montelux {

void set_mixture(DeviceSampler& sampler, const MixtureDensity& mixture, std::uint64_t key, int replicates,
                 std::uint64_t begin, std::uint64_t end) {
    std::vector<std::uint32_t> keys, columns;
    for (int r = 0; r < replicates; ++r)
        for (int k = 0; k < mixture.channels(); ++k) {
            const ScrambledSobol points(mixture.dimensions(), hash_key(key, k),
                                        static_cast<std::uint32_t>(r));
            keys.insert(keys.end(), points.keys().begin(), points.keys().end());
            if (columns.empty()) columns.assign(points.columns().begin(), points.columns().end());
        }
    sampler.set_sobol(keys, columns);

    DeviceMixtureTables tables;
    tables.map_channel = mixture.map_channel();
    tables.first_gaussian = mixture.first_gaussian();
    tables.channel_begin.push_back(0);
    for (int k = 0; k < mixture.channels(); ++k) {
        tables.shares.push_back(mixture.share(k));
        const std::uint64_t first = mixture.channel_points(k, begin), last = mixture.channel_points(k, end);
        tables.channel_first.push_back(first);
        tables.channel_begin.push_back(tables.channel_begin.back() + (last - first));
    }
    tables.bin_begin.push_back(0);
    for (const MonotoneMap& map : mixture.maps()) {
        for (const MonotoneMap::Bin& b : map.table())
            tables.bins.insert(tables.bins.end(), {b.u0, b.du, b.x0, b.dx, b.slope0, b.slope1});
        tables.bin_begin.push_back(tables.bin_begin.back() + map.bins());
        tables.powers.push_back(map.power());
    }
    for (const Gaussian& g : mixture.gaussians()) {
        tables.gaussians.push_back(g.log_norm());
        for (const auto part : {g.mean(), g.cholesky(), g.inverse()})
            tables.gaussians.insert(tables.gaussians.end(), part.begin(), part.end());
    }
    sampler.set_mixture(tables);
}

} // namespace montelux
