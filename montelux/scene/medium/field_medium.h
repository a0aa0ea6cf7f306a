// FieldMedium: extinction and albedo, each on a grid with a place of its own or the same everywhere.
#pragma once

#include <cstdint>

#include "montelux/scene/medium/medium_grid.h"
#include "montelux/scene/medium/medium_model.h"

namespace montelux {

// A value in space.
struct MediumField {
    SceneSpectrum value{1};   // everywhere, if there is no grid
    Index scalars = no_index; // into Scene::scalar_grids
    Index colors = no_index;  // into Scene::color_grids; not both
    bool nearest = false;     // the nearest sample, instead of the interpolated ones
    GridWrap wrap = GridWrap::clamp;
    AffineMap unit_from_world{};

    bool is_grid() const { return scalars != no_index || colors != no_index; }
};

struct FieldMedium {
    static constexpr const char* name = "Field";
    static constexpr bool homogeneous = false;

    MediumBox box;            // outside there is nothing
    bool bounded = true;      // if not, the medium is everywhere, and its extinction has no grid
    MediumField extinction{}; // per unit of length in world space, times `scale`
    MediumField albedo{};     // the share that is scattered, 0 to 1
    float scale = 1;
    PhaseFunction phase{};

    // A field at the wavelengths of a path.
    struct SampledField {
        const MediumField* field;
        const ScalarGrid* scalars; // null: none
        const ColorGrid* colors;   // null: none
        SampledSpectrum value;

        SampledSpectrum at(Point3f p, const SampledWavelengths& lambda) const {
            if (!field->is_grid()) return value;
            const Point3f unit = field->unit_from_world.point(p);
            if (scalars != nullptr) {
                if (field->nearest) return SampledSpectrum(scalars->nearest(unit, field->wrap));
                return SampledSpectrum(
                    scalars->interpolate_wrapped<float>(unit, field->wrap, [](float v) { return v; }));
            }
            const auto sampled = [&](const ScaledPolynomial& s) { return s.sample(lambda); };
            if (field->nearest) return sampled(colors->nearest(unit, field->wrap));
            return colors->interpolate_wrapped<SampledSpectrum>(unit, field->wrap, sampled);
        }
    };
    struct Sampled {
        const FieldMedium* medium;
        const MediumTable* table;
        SampledField extinction, albedo;
        SampledWavelengths lambda;

        MediumPoint coefficients(Point3f p) const {
            const SampledSpectrum sigma_t = extinction.at(p, lambda) * medium->scale;
            const SampledSpectrum sigma_s = sigma_t * clamp(albedo.at(p, lambda), 0, 1);
            return {sigma_t - sigma_s, sigma_s, {}};
        }
        MajorantWalk majorants(const Ray& ray) const {
            const SampledSpectrum most =
                (medium->extinction.is_grid() ? SampledSpectrum(1) : extinction.value) * medium->scale;
            if (!medium->bounded) return {0, ray.t_max, most};
            return {table->unit_from_world.ray(ray), table->majorants, most};
        }
    };
    Sampled at(const SceneView& scene, Index medium, const SampledWavelengths& lambda) const;
    MediumTable table(const Scene& scene) const;
};

} // namespace montelux
