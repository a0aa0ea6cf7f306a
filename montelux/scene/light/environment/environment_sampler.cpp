#include "montelux/scene/light/environment/environment_sampler.h"

#include <bit>
#include <cstdio>

#include "montelux/mc/math/error.h"

namespace montelux {

namespace {

constexpr int most_parts = 1 << 16;

// Levels of cuts for a number of regions.
int median_cut_levels(int regions) {
    if (regions == 0) return MedianCutEnvironment::default_levels;
    if (regions < 0 || regions > most_parts || !std::has_single_bit(static_cast<unsigned>(regions)))
        throw Error("environment sampling",
                    std::to_string(regions) + " regions were asked for; expected a power of two from 1 to " +
                        std::to_string(most_parts));
    return std::bit_width(static_cast<unsigned>(regions)) - 1;
}

int structured_strata(int strata) {
    if (strata == 0) return StructuredEnvironment::default_strata;
    if (strata < 0 || strata > most_parts)
        throw Error("environment sampling", std::to_string(strata) +
                                                " strata were asked for; expected 1 to " +
                                                std::to_string(most_parts));
    return strata;
}

} // namespace

EnvironmentSampler::EnvironmentSampler(const Image& map, EnvironmentLayout layout,
                                       const EnvironmentSettings& settings)
    : grid_(std::make_unique<const EnvironmentGrid>(layout, map.width(), map.height())),
      lookup_(settings.lookup), density_(make_density(map, settings)) {}

EnvironmentSampler::Density EnvironmentSampler::make_density(const Image& map,
                                                             const EnvironmentSettings& settings) {
    std::vector<float> light = texel_light(map, *grid_);
    const bool bilinear = settings.lookup == EnvironmentLookup::bilinear;
    std::vector<float> blended;
    if (bilinear) blended = blended_light(light, *grid_);
    mean_radiance_ = sum_of(bilinear ? blended : light) / (4 * pi);
    const bool cut = settings.sampling == EnvironmentSampling::median_cut ||
                     settings.sampling == EnvironmentSampling::structured;
    if (bilinear && cut) light = std::move(blended);
    if (settings.compensated) compensated_ = compensate(light, *grid_);
    if (settings.sampling == EnvironmentSampling::median_cut) {
        auto sun = Sun::take_from(light, *grid_);
        return WithSun(std::move(sun),
                       MedianCutEnvironment(*grid_, light, median_cut_levels(settings.parts)));
    }
    if (settings.sampling == EnvironmentSampling::structured) {
        auto sun = Sun::take_from(light, *grid_);
        return WithSun(std::move(sun),
                       StructuredEnvironment(*grid_, light, structured_strata(settings.parts)));
    }
    if (settings.parts != 0)
        throw Error("environment sampling",
                    std::to_string(settings.parts) +
                        " parts were asked for, but a tabulated density has none; expected 0");
    if (bilinear) return BilinearEnvironment(*grid_, light);
    return TabulatedEnvironment(*grid_, light);
}

EnvironmentSampling EnvironmentSampler::sampling() const {
    constexpr EnvironmentSampling kinds[] = {EnvironmentSampling::tabulated, EnvironmentSampling::median_cut,
                                             EnvironmentSampling::structured, EnvironmentSampling::tabulated};
    return kinds[density_.index()];
}

const Sun* EnvironmentSampler::sun() const {
    if (const auto* d = std::get_if<WithSun<MedianCutEnvironment>>(&density_)) return d->sun();
    if (const auto* d = std::get_if<WithSun<StructuredEnvironment>>(&density_)) return d->sun();
    return nullptr;
}

const MedianCutEnvironment* EnvironmentSampler::median_cut() const {
    const auto* d = std::get_if<WithSun<MedianCutEnvironment>>(&density_);
    return d ? &d->rest() : nullptr;
}

const StructuredEnvironment* EnvironmentSampler::structured() const {
    const auto* d = std::get_if<WithSun<StructuredEnvironment>>(&density_);
    return d ? &d->rest() : nullptr;
}

std::size_t EnvironmentSampler::bytes() const {
    return std::visit(
        [](const auto& density) {
            if constexpr (requires { density.rest(); })
                return density.rest().bytes();
            else
                return density.bytes();
        },
        density_);
}

std::string EnvironmentSampler::description() const {
    std::string text = "tabulated";
    if (const auto* m = std::get_if<WithSun<MedianCutEnvironment>>(&density_))
        text = "median-cut, " + std::to_string(m->rest().regions().size()) + " regions";
    else if (const auto* s = std::get_if<WithSun<StructuredEnvironment>>(&density_))
        text = "structured, " + std::to_string(s->rest().strata()) + " strata";
    char numbers[160];
    if (const Sun* s = sun()) {
        std::snprintf(numbers, sizeof numbers, ", a sun of %zu texels with %.1f %% of the light", s->texels(),
                      100 * s->share());
        text += numbers;
    }
    std::snprintf(numbers, sizeof numbers, "%s; %d x %d texels, %s%s, %.1f MiB",
                  compensated_ ? ", compensated" : "", grid_->width(), grid_->height(),
                  name_of(grid_->layout()).data(), lookup_ == EnvironmentLookup::bilinear ? ", bilinear" : "",
                  static_cast<double>(bytes()) / (1 << 20));
    return text + numbers;
}

} // namespace montelux
