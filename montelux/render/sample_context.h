// SampleContext: one sample of one pixel, from its random numbers to its contribution to the film.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "montelux/film/film.h"
#include "montelux/film/pixel_filter.h"
#include "montelux/mc/random/sample_stream.h"
#include "montelux/render/film_exposure.h"
#include "montelux/render/layer_sampler.h"
#include "montelux/render/sample_record.h"
#include "montelux/scene/render_settings.h"
#include "montelux/spectrum/rgb_colorspace.h"
#include "montelux/spectrum/sensor.h"
#include "montelux/spectrum/spectrum_table.h"
#include "montelux/transport/guiding/guiding_trace.h"
#include "montelux/transport/integrator.h"
#include "montelux/transport/light_map.h"
#include "montelux/transport/manifold/casters.h"
#include "montelux/transport/merging_sample.h"

namespace montelux {

// Size of a pixel's footprint on textures, in pixels: pbrt-v4's value from 64 samples per pixel on. The pixel filter
// does the rest, and a sample must not depend on the number of others.
inline constexpr float footprint_scale = 0.125f;

// Everything that one sample needs, shared by all threads.
class SampleContext {
  public:
    struct Result {
        FilmSample film;
        // Why the sample is left out; `film` is then empty.
        std::optional<BadSample::Kind> bad;
        Vec3f narrower{};  // MergingSample::narrower as linear sRGB
        float clamped = 0; // luminance removed by the film's limit, filter weight applied; of splats, too
        float clamp = 1;   // factor of the film's limit
    };

    // A sample of a pixel, by its index.
    struct Key {
        int x = 0, y = 0;
        std::uint64_t index = 0;
    };
    // The memory for many samples at once; allocated once and used again.
    struct Batch;
    // What a light path brings to a point of the film: linear sRGB, to be weighted by the pixel filter.
    struct FilmSplat {
        Point2f film; // in pixels
        Vec3f rgb;
    };

    // All arguments must outlive the context. Throws Error as light_groups() does.
    SampleContext(const SceneDescription& description, const SamplerSettings& sampler, const SceneView& scene,
                  const Camera& camera)
        : SampleContext(description, sampler, scene, camera, description.integrator) {}
    // With an integrator other than the description's.
    SampleContext(const SceneDescription& description, const SamplerSettings& sampler, const SceneView& scene,
                  const Camera& camera, const IntegratorSettings& integrator);

    // Each result is a pure function of its key (the tracer counts rays); `results` has the size of `keys`. The
    // numbers of the film's layers (FilmLayers::values() for each sample) are in the batch.
    void take(RayTracer& tracer, std::span<const Key> keys, Batch& batch, std::span<Result> results) const;
    const FilmLayers& layers() const { return layers_.layers(); }
    // Of a spectral film; else 0.
    std::size_t buckets_per_pixel() const {
        return buckets_ ? static_cast<std::size_t>(buckets_->count()) : 0;
    }
    // Whether samples bring splats: Batch::film_splats, those of sample i in Batch::splats_of(i).
    bool makes_splats() const { return std::holds_alternative<BidirectionalIntegrator>(integrator_); }
    const PixelFilterSampler& filter() const { return filter_; }

    // Of a render whose paths merge. The samples of one index share wavelengths and time, so that all can merge.
    bool merges() const { return merges_; }
    // The light paths of samples, appended.
    void trace_light(RayTracer& tracer, std::span<const Key> keys, LightPaths& paths) const;
    // From now on samples merge with it. Not while samples are taken.
    void set_light_map(std::shared_ptr<const LightMap> map);
    // visible_pixel() of a sample.
    std::optional<double> visible_pixel(RayTracer& tracer, const Key& key) const;

    // From now on paths follow the guide; null: none does. Not while samples are taken.
    void set_guide(std::shared_ptr<const GuidingField> guide);
    const std::shared_ptr<const GuidingField>& guide() const { return guide_; }
    // Whether paths can follow a guide: those from the camera whose directions are drawn from BSDFs and phase functions.
    bool can_be_guided() const { return can_be_guided_; }
    // Of a sample that a guide learns from; 0 if it is bad.
    struct Lesson {
        float radiance = 0;         // mean over the wavelengths
        double unguided_square = 0; // of the radiance (UnguidedSquare)
    };
    // Samples that the film does not get. The records of the paths that keep(i) wants are appended.
    template <typename Keep>
    void teach(RayTracer& tracer, std::span<const Key> keys, Batch& batch, std::span<Lesson> lessons,
               const Keep& keep, std::vector<GuidingRecord>& records) const;
    // A path that a sample of an integrator that makes splats finds, and what it brings to the film.
    struct FilmPath {
        std::size_t s = 0, t = 0;      // vertices on the light's and on the camera's side
        const Point2f* film = nullptr; // of a splat; others count for the pixel of the sample
        Vec3f rgb;                  // linear sRGB as of the strategy alone, without the film's limit; filter
                                    // weight applied, but to splats
        double weight = 0;          // among the strategies that find the path
        double by_path_tracing = 0; // path_tracing_density
        Index light = no_index;     // where it begins; of a merged path not known
    };
    void find_paths(RayTracer& tracer, const Key& key, BidirectionalMemory& memory,
                    const std::function<void(const FilmPath&)>& visit) const;
    // One sample by itself, with every step of its path; the contribution is the same to the last bit.
    SampleRecord record(RayTracer& tracer, const Key& key) const;

  private:
    // Where a sample lies on film, lens and in time.
    struct FilmPoint {
        FilterSample filter;
        Point2f film;
        Vec2f lens;
        float time = 0;   // of motions
        float weight = 1; // of the camera's ray
    };
    void begin(std::span<const Key> keys, Batch& batch) const;
    // The paths that have begun.
    void trace(RayTracer& tracer, Batch& batch) const;
    void trace_for_guide(RayTracer& tracer, std::span<const Key> keys, Batch& batch) const;
    PathStart<SampleStream> begin(const Key& key, FilmPoint& point) const;
    SampleStream light_stream(const Key& key) const;
    Result finish(const FilmContribution& path, const SampledWavelengths& lambda, const FilmPoint& point,
                  SpectralSample* spectral, SampleRecord* record = nullptr) const;
    // Appends the splats of a sample to `out`; limits them, and finds out whether they are bad.
    void finish_splats(const SplatList& splats, const SampledWavelengths& lambda, Result& result,
                       std::vector<FilmSplat>& out) const;
    // Of a good sample.
    void sample_layers(const SampleExtras& extras, const FilmContribution& path, const FilmPoint& point,
                       float clamp, std::span<float> values) const;

    const SamplerSettings& sampler_;
    SceneView scene_;
    const Camera& camera_;
    bool moves_; // the scene; otherwise samples have no time
    bool normals_in_camera_space_;
    LayerSampler layers_;
    Integrator integrator_;
    std::shared_ptr<const GuidingField> guide_;
    std::shared_ptr<const LightMap> light_map_;
    std::shared_ptr<const Casters> casters_; // null: no manifold sampling
    bool merges_;
    PixelFilterSampler filter_;
    float most_splat_; // the filter's weight in a pixel, greatest at its centre, may exceed 1
    FilmExposure exposure_;
    Sensor albedo_sensor_;
    // Spectrum of the white light of albedos.
    const SpectrumTable& white_;
    std::optional<BucketLayout> buckets_; // of a spectral film
    float white_scale_;
    bool can_be_guided_;
};

struct SampleContext::Batch {
    std::vector<FilmPoint> points;
    std::vector<PathStart<SampleStream>> starts;
    std::vector<FilmContribution> paths;
    std::vector<SpectralSample>
        spectral; // of each sample, of a spectral film; 0 for samples that are left out
    IntegratorBatch integrator;
    std::vector<GuidingTrace> traces; // of samples that a guide learns from
    // Of integrators that make splats: those of each sample, and in RGB those of all samples, one after the other.
    std::vector<SplatList> splats;
    std::vector<FilmSplat> film_splats;
    std::vector<MergingSample> merging;
    std::vector<std::size_t> first_splat; // of each sample; at the end the total
    std::span<const FilmSplat> splats_of(std::size_t i) const {
        return std::span(film_splats).subspan(first_splat[i], first_splat[i + 1] - first_splat[i]);
    }
    // Empty unless the film has layers that need them.
    std::vector<SampleExtras> extras;
    std::vector<SampledSpectrum> parts; // of the radiance
    std::vector<float> layer_values;
};

template <typename Keep>
void SampleContext::teach(RayTracer& tracer, std::span<const Key> keys, Batch& batch,
                          std::span<Lesson> lessons, const Keep& keep,
                          std::vector<GuidingRecord>& records) const {
    trace_for_guide(tracer, keys, batch);
    for (std::size_t i = 0; i < keys.size(); ++i) {
        const SampledSpectrum& found = batch.paths[i].radiance;
        const bool good = all_finite(found) && !has_negative(found);
        lessons[i] = good ? Lesson{average(found), batch.traces[i].unguided_square(found)} : Lesson();
        if (good && keep(i)) batch.traces[i].finish(found, guide_.get(), records);
    }
}

} // namespace montelux
