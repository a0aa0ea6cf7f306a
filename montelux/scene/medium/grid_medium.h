// GridMedium: a density on a grid, with emission by a temperature or a spectrum.
#pragma once

#include "montelux/scene/medium/medium_grid.h"
#include "montelux/scene/medium/medium_model.h"

namespace montelux {

struct GridMedium {
    static constexpr const char* name = "UniformGrid";
    static constexpr bool homogeneous = false;

    MediumBox box;
    Index density = no_index;             // into Scene::scalar_grids
    SceneSpectrum sigma_a{1}, sigma_s{1}; // times density times `scale`
    float scale = 1;
    // Emitted radiance: `le` times `le_scale` times, if given, the value of a grid. With temperatures: that of a
    // black body relative to its peak, at (temperature - offset) * scale kelvins if that is above 100.
    SceneSpectrum le{};
    float le_scale = 1;
    Index le_grid = no_index;     // into Scene::scalar_grids
    Index temperature = no_index; // into Scene::scalar_grids
    float temperature_offset = 0, temperature_scale = 1;
    PhaseFunction phase{};

    struct Sampled {
        const GridMedium* medium;
        const MediumTable* table;
        const ScalarGrid *density, *le_grid, *temperature; // null: none
        SampledWavelengths lambda;
        SampledSpectrum sigma_a, sigma_s, le;

        MediumPoint coefficients(Point3f p) const {
            const Point3f unit = table->unit_from_world.point(p);
            const float d = (*density)(unit);
            return {sigma_a * d, sigma_s * d, sigma_a * d * emitted(unit)};
        }
        MajorantWalk majorants(const Ray& ray) const {
            return {table->unit_from_world.ray(ray), table->majorants, sigma_a + sigma_s};
        }

      private:
        SampledSpectrum emitted(Point3f unit) const {
            const float factor = le_grid != nullptr ? (*le_grid)(unit) : 1;
            if (temperature == nullptr) return le * factor;
            const float kelvins =
                ((*temperature)(unit)-medium->temperature_offset) * medium->temperature_scale;
            if (!(kelvins > 100)) return {};
            return BlackbodySpectrum(kelvins).sample(lambda) * (medium->le_scale * factor);
        }
    };
    Sampled at(const SceneView& scene, Index medium, const SampledWavelengths& lambda) const;
    MediumTable table(const Scene& scene) const;
};

} // namespace montelux
