// PrimarySampler: a picture as a function on primary sample space: from random numbers to light on the film.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "montelux/film/pixel_filter.h"
#include "montelux/film/splat_film.h"
#include "montelux/mc/random/primary_sample_stream.h"
#include "montelux/render/film_exposure.h"
#include "montelux/render/metropolis/film_importance.h"
#include "montelux/scene/camera/camera.h"
#include "montelux/scene/render_settings.h"
#include "montelux/transport/path_integrator.h"
#include "montelux/transport/volume_path_integrator.h"

namespace montelux {

// One point of the space: what a path brings to the film.
struct PrimarySample {
    Point2f film; // pixels
    Vec3f rgb;    // linear sRGB of the path, times the film's area in pixels: its value over its density
    double size =
        0; // the scalar that chains follow: mean magnitude of rgb, times the importance of the point
    float brightness = 0; // of all light of the path, followed or not: mean magnitude of its RGB
    float clamped = 0;    // luminance removed by the film's limit, times the film's area
    std::optional<BadSample::Kind> bad; // then nothing else is set
};

// The first two numbers choose a point of the film, uniformly over all that reach a pixel's filter; wavelengths, lens,
// time and path follow as those of SampleContext do. The value of a pixel is the integral over the space of rgb times the
// filter at the point. Shared by all threads.
class PrimarySampler {
  public:
    // `indirect_only`: without light after at most one scattering event, and without the background.
    // All arguments must outlive it.
    PrimarySampler(const SceneDescription& description, const SceneView& scene, const Camera& camera,
                   bool indirect_only);

    // For many points at once; allocated once and used again.
    struct Memory {
        std::vector<PathStart<PrimarySampleStream>> starts;
        std::vector<FilmContribution> paths;
        std::vector<float> weights; // of the camera's rays
        // Of indirect light alone.
        std::vector<SampleExtras> extras;
        std::vector<SampledSpectrum> indirect;
        PathBatch batch;
    };
    // Of the proposed states.
    void evaluate(RayTracer& tracer, std::span<PrimarySamples* const> states,
                  const FilmImportance& importance, Memory& memory, std::span<PrimarySample> results) const;
    // Adds a sample's rgb times `weight` and the filter to the pixels whose filters contain its point.
    void splat(SplatFilm& film, const PrimarySample& sample, double weight) const;
    // The pixel that a point lies in, or the nearest.
    Vec2<int> pixel_of(Point2f film) const;
    // The points that samples have.
    Point2f film_begin() const { return begin_; }
    Vec2f film_size() const { return size_; }

  private:
    const SceneView& scene_;
    const Camera& camera_;
    bool moves_; // the scene; otherwise samples have no time
    bool indirect_only_;
    std::variant<PathIntegrator, VolumePathIntegrator> integrator_;
    FilmExposure exposure_;
    PixelFilterSampler filter_;
    PixelBounds crop_;
    Point2f begin_;
    Vec2f size_;
    float area_;
};

} // namespace montelux
