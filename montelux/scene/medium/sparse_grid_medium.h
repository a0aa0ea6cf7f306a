// SparseGridMedium: a density on a sparse grid, with emission by a temperature.
#pragma once

#include "montelux/scene/medium/medium_model.h"
#include "montelux/scene/medium/sparse_grid.h"

namespace montelux {

// pbrt-v4's medium 'nanovdb'. The space of `box` is the grid space of the density, in which voxels have integer
// coordinates; the box contains all points where the interpolated density is not 0.
struct SparseGridMedium {
    static constexpr const char* name = "SparseGrid";
    static constexpr bool homogeneous = false;

    MediumBox box;
    Index density = no_index;             // into Scene::sparse_grids; its background is 0
    SceneSpectrum sigma_a{1}, sigma_s{1}; // times density times `scale`
    float scale = 1;
    // Emitted radiance: `le_scale` times that of a black body relative to its peak, at
    // (temperature - offset) * scale kelvins if that is above 100.
    Index temperature = no_index;             // into Scene::sparse_grids
    Transform temperature_space_from_density; // from grid space to grid space
    float le_scale = 1;
    float temperature_offset = 0, temperature_scale = 1;
    PhaseFunction phase{};

    struct Sampled {
        const SparseGridMedium* medium;
        const MediumTable* table;
        const SparseGrid *density, *temperature; // null: none
        AffineMap temperature_from_density;
        SampledWavelengths lambda;
        SampledSpectrum sigma_a, sigma_s;

        MediumPoint coefficients(Point3f p) const {
            // By the unit cube, as the majorants: rounding then moves both alike.
            const Point3f voxel = medium->box.at(table->unit_from_world.point(p));
            const float d = (*density)(voxel);
            MediumPoint result{sigma_a * d, sigma_s * d, {}};
            if (temperature != nullptr && d > 0) result.emission = result.sigma_a * emitted(voxel);
            return result;
        }
        MajorantWalk majorants(const Ray& ray) const {
            return {table->unit_from_world.ray(ray), table->majorants, sigma_a + sigma_s};
        }

      private:
        SampledSpectrum emitted(Point3f voxel) const {
            const float value = (*temperature)(temperature_from_density.point(voxel));
            const float kelvins = (value - medium->temperature_offset) * medium->temperature_scale;
            if (!(kelvins > 100)) return {};
            return BlackbodySpectrum(kelvins).sample(lambda) * medium->le_scale;
        }
    };
    Sampled at(const SceneView& scene, Index medium, const SampledWavelengths& lambda) const;
    MediumTable table(const Scene& scene) const;
};

} // namespace montelux
