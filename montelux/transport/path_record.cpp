#include "montelux/transport/path_record.h"

#include <cmath>

namespace montelux {

namespace {

using Quantity = BadOrigin::Quantity;

// Finds values that are not finite or, if all are finite, negative ones.
class BadSearch {
  public:
    BadSearch(const PathRecord& record, bool negative) : record_(record), negative_(negative) {}

    std::optional<BadOrigin> first() const {
        for (std::size_t i = 0; i < record_.vertices.size(); ++i) {
            const PathVertex& v = record_.vertices[i];
            for (const RayLight& on_ray : record_.on_rays)
                if (on_ray.vertex == i && bad(on_ray.light.contribution)) return in_direct(i, on_ray.light);
            for (const FoundLight& light : v.found)
                if (bad(light.contribution)) return in_found(i, light);
            if (v.direct && bad(v.direct->contribution)) return in_direct(i, *v.direct);
        }
        if (record_.end == PathEnd::bad_throughput && bad(record_.vertices.back().continued))
            return in_throughput(record_.vertices.size());
        return std::nullopt;
    }

  private:
    bool bad(SampledSpectrum s) const { return negative_ ? has_negative(s) : !all_finite(s); }
    bool bad(float x) const { return negative_ ? x < 0 : !std::isfinite(x); }

    // Throughput of the path that arrives at this vertex.
    BadOrigin in_throughput(std::size_t vertex) const {
        std::size_t i = 0;
        for (; i + 1 < vertex; ++i) {
            const PathVertex& v = record_.vertices[i];
            if (bad(v.continued) || (v.scattering && bad(v.scattering->sample.weight))) break;
        }
        const std::optional<Scattering>& scattering = record_.vertices[i].scattering;
        const bool factor = scattering && bad(scattering->sample.weight);
        return {factor ? Quantity::bsdf_weight : Quantity::throughput, i};
    }
    BadOrigin in_found(std::size_t i, const FoundLight& light) const {
        if (bad(record_.vertices[i].throughput)) return in_throughput(i);
        if (bad(light.radiance)) return {Quantity::found_radiance, i};
        if (bad(light.bsdf_pdf) || bad(light.light_pdf) || bad(light.weight))
            return {Quantity::found_density, i};
        return {Quantity::product, i};
    }
    BadOrigin in_direct(std::size_t i, const DirectLight& light) const {
        if (bad(record_.vertices[i].throughput)) return in_throughput(i);
        if (bad(light.radiance)) return {Quantity::direct_radiance, i};
        if (bad(light.f)) return {Quantity::bsdf_value, i};
        if (bad(light.light_pdf) || light.light_pdf == 0 || bad(light.bsdf_pdf) || bad(light.weight))
            return {Quantity::direct_density, i};
        return {Quantity::product, i};
    }

    const PathRecord& record_;
    bool negative_;
};

} // namespace

std::optional<BadOrigin> origin_of_bad(const PathRecord& record) {
    const bool finite = all_finite(record.radiance);
    if (finite && !has_negative(record.radiance)) return std::nullopt;
    if (auto found = BadSearch(record, finite).first()) return found;
    return BadOrigin{Quantity::sum, record.vertices.empty() ? 0 : record.vertices.size() - 1};
}

} // namespace montelux
