// SampleRecord: one replayed sample of one pixel, step by step.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "montelux/film/film.h"
#include "montelux/film/pixel_filter.h"
#include "montelux/render/render_target.h"
#include "montelux/scene/render_settings.h"
#include "montelux/spectrum/wavelengths.h"
#include "montelux/transport/path_record.h"

namespace montelux {

struct SampleRecord {
    int x = 0, y = 0;
    std::uint64_t index = 0;

    FilterSample filter;           // where in the pixel, and the weight of the filter there
    Point2f film;                  // the same point on the film, in pixels
    Vec2f lens;                    // uniform numbers; 0.5 for a camera without a lens
    float time = 0;                // of motions, in [0, 1]; 0 where nothing moves
    SampledWavelengths lambda;     // as sampled
    SampledWavelengths lambda_end; // at the path's end: dispersion terminates all but the first
    PathRecord path;
    Vec3f sensor_rgb; // of the path's radiance, linear sRGB
    float clamp = 1;  // factor that limits the largest component to the film's limit
    Vec3f
        background; // the share of IntegratorSettings::background, filter weight applied where it may be negative
    Vec3f rgb;      // sensor_rgb times clamp times filter weight, plus the background

    // The contribution to the pixel, or why the sample is left out.
    FilmSample contribution;
    std::optional<BadSample::Kind> bad;
    std::vector<float> layer_values; // of the film's layers (FilmLayers), of a good sample
};

// Throws Error, naming the valid range, if the pixel is outside the crop or the index beyond the samples of
// the description. With adaptive allocation every index is valid.
void check_sample(const SceneDescription& description, int x, int y, std::uint64_t index,
                  const RenderTarget& target = {});

} // namespace montelux
