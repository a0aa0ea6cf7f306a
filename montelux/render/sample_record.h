// One sample of one pixel, traced again and written down.
#pragma once

#include <cstdint>
#include <optional>

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
    Vec2f lens;                    // uniform numbers; the middle for a camera without a lens
    SampledWavelengths lambda;     // as sampled
    SampledWavelengths lambda_end; // as the path left them: dispersion ends all but the first
    PathRecord path;
    Vec3f sensor_rgb; // of the path's radiance, linear sRGB
    float clamp = 1;  // factor that holds the largest component to the film's limit
    Vec3f rgb;        // sensor_rgb times clamp times filter weight

    // What the render adds to the pixel, or why it does not.
    FilmSample contribution;
    std::optional<BadSample::Kind> bad;
};

// Throws Error, naming what was expected, where the pixel is not one of the crop or the index not one of the
// samples that the description asks for. With adaptive allocation a pixel may have any number of them.
void check_sample(const SceneDescription& description, int x, int y, std::uint64_t index,
                  const RenderTarget& target = {});

} // namespace montelux
