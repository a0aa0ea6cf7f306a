// RgbGridMedium: coloured coefficients on grids.
#pragma once

#include "montelux/scene/medium/medium_grid.h"
#include "montelux/scene/medium/medium_model.h"

namespace montelux {

struct RgbGridMedium {
    static constexpr const char* name = "RgbGrid";
    static constexpr bool homogeneous = false;

    MediumBox box;
    Index sigma_a = no_index, sigma_s = no_index; // into Scene::color_grids; 1 everywhere if no_index
    float scale = 1;
    Index le = no_index;        // into Scene::color_grids; emitted radiance, times the two next
    SceneSpectrum illuminant{}; // white of the colours' space
    float le_scale = 1;
    PhaseFunction phase{};

    struct Sampled {
        const RgbGridMedium* medium;
        const MediumTable* table;
        const ColorGrid *sigma_a, *sigma_s, *le; // null: none
        SampledWavelengths lambda;
        SampledSpectrum white; // the illuminant, scaled

        MediumPoint coefficients(Point3f p) const {
            const Point3f unit = table->unit_from_world.point(p);
            MediumPoint result;
            result.sigma_a = coefficient(sigma_a, unit);
            result.sigma_s = coefficient(sigma_s, unit);
            if (le != nullptr) result.emission = result.sigma_a * (*le)(unit, lambda) * white;
            return result;
        }
        MajorantWalk majorants(const Ray& ray) const {
            return {table->unit_from_world.ray(ray), table->majorants, SampledSpectrum(1)};
        }

      private:
        SampledSpectrum coefficient(const ColorGrid* grid, Point3f unit) const {
            return (grid != nullptr ? (*grid)(unit, lambda) : SampledSpectrum(1)) * medium->scale;
        }
    };
    Sampled at(const SceneView& scene, Index medium, const SampledWavelengths& lambda) const;
    MediumTable table(const Scene& scene) const;
};

} // namespace montelux
