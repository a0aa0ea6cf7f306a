// SampleContext: one sample of one pixel, from its random numbers to its contribution to the film.
#pragma once

#include <cstdint>
#include <optional>

#include "montelux/film/film.h"
#include "montelux/film/pixel_filter.h"
#include "montelux/mc/random/sample_stream.h"
#include "montelux/render/sample_record.h"
#include "montelux/scene/render_settings.h"
#include "montelux/spectrum/rgb_colorspace.h"
#include "montelux/spectrum/sensor.h"
#include "montelux/spectrum/spectrum_table.h"
#include "montelux/transport/integrator.h"

namespace montelux {

// Everything that one sample needs, shared by all threads.
class SampleContext {
  public:
    struct Result {
        FilmSample film;
        // Why the sample is left out; `film` is then empty.
        std::optional<BadSample::Kind> bad;
        float clamped = 0; // luminance removed by the film's limit, filter weight applied
    };

    // All arguments must outlive the context.
    SampleContext(const SceneDescription& description, const SamplerSettings& sampler, const SceneView& scene,
                  const Camera& camera);

    // A pure function of the pixel and the index (the tracer counts rays).
    Result take(RayTracer& tracer, int x, int y, std::uint64_t index) const {
        return trace(tracer, x, y, index, nullptr);
    }
    // The same sample with every step of its path.
    SampleRecord record(RayTracer& tracer, int x, int y, std::uint64_t index) const;

  private:
    Result trace(RayTracer& tracer, int x, int y, std::uint64_t index, SampleRecord* record) const;

    const SamplerSettings& sampler_;
    float max_component_value_;
    SceneView scene_;
    const Camera& camera_;
    Integrator integrator_;
    PixelFilterSampler filter_;
    Sensor sensor_;
    Sensor albedo_sensor_;
    // Spectrum of the white light of albedos.
    const SpectrumTable& white_;
    float white_scale_;
};

} // namespace montelux
