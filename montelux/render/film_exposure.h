// FilmExposure: from the radiance of a sample to its linear sRGB on the film: sensor, limit, background.
#pragma once

#include <optional>

#include "montelux/film/film.h"
#include "montelux/scene/render_settings.h"
#include "montelux/spectrum/sensor.h"
#include "montelux/transport/integrator_model.h"

namespace montelux {

class FilmExposure {
  public:
    explicit FilmExposure(const SceneDescription& description);

    struct Exposed {
        Vec3f sensor_rgb;                   // before the limit
        float clamp = 1;                    // factor of the film's limit
        Vec3f background;                   // part of rgb
        Vec3f rgb;                          // filter weight applied
        std::optional<BadSample::Kind> bad; // why the sample is left out

        // Luminance removed by the film's limit.
        float clamped() const {
            return static_cast<float>(dot(Vec3d(sensor_rgb), luminance_weight)) * (1 - clamp);
        }
    };
    // `ray_weight`: of the camera's ray.
    Exposed operator()(const FilmContribution& path, float ray_weight, float filter_weight = 1) const;
    const Sensor& sensor() const { return sensor_; }

  private:
    float max_component_value_;
    Sensor sensor_;
    std::optional<Vec3f> background_; // IntegratorSettings::background
    bool signed_filter_;              // the pixel filter has negative lobes
};

} // namespace montelux
