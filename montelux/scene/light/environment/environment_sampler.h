// EnvironmentSampler: samples directions to an environment map by the density that the settings choose.
#pragma once

#include <memory>
#include <string>
#include <variant>

#include "montelux/scene/light/environment/bilinear_environment.h"
#include "montelux/scene/light/environment/environment_settings.h"
#include "montelux/scene/light/environment/median_cut_environment.h"
#include "montelux/scene/light/environment/structured_environment.h"
#include "montelux/scene/light/environment/sun.h"
#include "montelux/scene/light/environment/tabulated_environment.h"

namespace montelux {

class EnvironmentSampler {
  public:
    // The map has the channels R, G and B. Negative values count as 0; all must be finite. Throws Error for a
    // number of parts that the density does not support.
    EnvironmentSampler(const Image& map, EnvironmentLayout layout, const EnvironmentSettings& settings = {});

    const EnvironmentGrid& grid() const { return *grid_; }
    EnvironmentPoint sample(Vec2f u) const {
        return std::visit([&](const auto& d) { return d.sample(u); }, density_);
    }
    // Per solid angle. Without compensation it is positive wherever the map is.
    float pdf(Vec2f grid) const {
        return std::visit([&](const auto& d) { return d.pdf(grid); }, density_);
    }

    using Density = std::variant<TabulatedEnvironment, WithSun<MedianCutEnvironment>,
                                 WithSun<StructuredEnvironment>, BilinearEnvironment>;
    const Density& density() const { return density_; }
    // The chosen density, if the settings leave it open.
    EnvironmentSampling sampling() const;
    bool compensated() const { return compensated_; }
    EnvironmentLookup lookup() const { return lookup_; }
    const Sun* sun() const;
    // The density without the sun; null for another kind.
    const MedianCutEnvironment* median_cut() const;
    const StructuredEnvironment* structured() const;
    // Mean of R, G and B over the sphere.
    double mean_radiance() const { return mean_radiance_; }
    // Memory of the density.
    std::size_t bytes() const;
    // For messages: "tabulated, compensated; 1024 x 1024 texels, equal-area, 4.5 MiB".
    std::string description() const;

  private:
    Density make_density(const Image& map, const EnvironmentSettings& settings);

    std::unique_ptr<const EnvironmentGrid> grid_; // densities point to it
    double mean_radiance_ = 0;
    bool compensated_ = false;
    EnvironmentLookup lookup_;
    Density density_;
};

} // namespace montelux
