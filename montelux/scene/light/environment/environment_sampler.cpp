#include "montelux/scene/light/environment/environment_sampler.h"

#include <cstdio>

namespace montelux {

EnvironmentSampler::EnvironmentSampler(const Image& map, EnvironmentLayout layout,
                                       const EnvironmentSettings& settings)
    : grid_(std::make_unique<const EnvironmentGrid>(layout, map.width(), map.height())),
      density_(make_density(map, settings)) {}

EnvironmentSampler::Density EnvironmentSampler::make_density(const Image& map,
                                                             const EnvironmentSettings& settings) {
    std::vector<float> light = texel_light(map, *grid_);
    mean_radiance_ = sum_of(light) / (4 * pi);
    if (settings.compensated) compensated_ = compensate(light, *grid_);
    if (settings.sampling == EnvironmentSampling::median_cut) {
        auto sun = Sun::take_from(light, *grid_);
        return WithSun(std::move(sun), MedianCutEnvironment(*grid_, light));
    }
    if (settings.sampling == EnvironmentSampling::structured) {
        auto sun = Sun::take_from(light, *grid_);
        return WithSun(std::move(sun), StructuredEnvironment(*grid_, light));
    }
    return TabulatedEnvironment(*grid_, light);
}

EnvironmentSampling EnvironmentSampler::sampling() const {
    constexpr EnvironmentSampling kinds[] = {EnvironmentSampling::tabulated, EnvironmentSampling::median_cut,
                                             EnvironmentSampling::structured};
    return kinds[density_.index()];
}

const Sun* EnvironmentSampler::sun() const {
    if (const auto* d = std::get_if<WithSun<MedianCutEnvironment>>(&density_)) return d->sun();
    if (const auto* d = std::get_if<WithSun<StructuredEnvironment>>(&density_)) return d->sun();
    return nullptr;
}

std::string EnvironmentSampler::description() const {
    std::size_t bytes = 0;
    std::string text;
    if (const auto* t = std::get_if<TabulatedEnvironment>(&density_)) {
        text = "tabulated";
        bytes = t->bytes();
    } else if (const auto* m = std::get_if<WithSun<MedianCutEnvironment>>(&density_)) {
        text = "median-cut, " + std::to_string(m->rest().regions().size()) + " regions";
        bytes = m->rest().bytes();
    } else if (const auto* s = std::get_if<WithSun<StructuredEnvironment>>(&density_)) {
        text = "structured, " + std::to_string(s->rest().strata()) + " strata";
        bytes = s->rest().bytes();
    }
    char numbers[160];
    if (const Sun* s = sun()) {
        std::snprintf(numbers, sizeof numbers, ", a sun of %zu texels with %.1f %% of the light", s->texels(),
                      100 * s->share());
        text += numbers;
    }
    std::snprintf(numbers, sizeof numbers, "%s; %d x %d texels, %s, %.1f MiB",
                  compensated_ ? ", compensated" : "", grid_->width(), grid_->height(),
                  grid_->layout() == EnvironmentLayout::equal_area ? "equal-area" : "latitude-longitude",
                  static_cast<double>(bytes) / (1 << 20));
    return text + numbers;
}

} // namespace montelux
