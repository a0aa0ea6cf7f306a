#include "montelux/transport/bidirectional_integrator.h"

#include "montelux/mc/random/sample_stream.h"
#include "montelux/transport/bidirectional_sample.h"

namespace montelux {

BidirectionalMemory::BidirectionalMemory() = default;
BidirectionalMemory::~BidirectionalMemory() = default;

BidirectionalIntegrator::BidirectionalIntegrator(const IntegratorSettings& settings, const Camera& camera,
                                                 float footprint_scale, const PixelBounds& crop,
                                                 Vec2f filter_radius, bool volumes)
    : settings_(settings), camera_(&camera),
      footprint_scale_(footprint_scale), window_min_{static_cast<float>(crop.x0) + 0.5f - filter_radius.x,
                                                     static_cast<float>(crop.y0) + 0.5f - filter_radius.y},
      window_max_{static_cast<float>(crop.x1) - 0.5f + filter_radius.x,
                  static_cast<float>(crop.y1) - 0.5f + filter_radius.y},
      light_paths_(double(crop.width()) * double(crop.height())), volumes_(volumes) {}

template FilmContribution BidirectionalIntegrator::estimate(const SceneView&, RayTracer&, const CameraSample&,
                                                            SampleStream&, PathRecord*) const;
template void BidirectionalIntegrator::estimate(const SceneView&, RayTracer&,
                                                std::span<PathStart<SampleStream>>, BidirectionalMemory&,
                                                std::span<FilmContribution>) const;
template FilmContribution BidirectionalIntegrator::estimate(const SceneView&, RayTracer&, const CameraSample&,
                                                            SampleStream&, BidirectionalMemory&,
                                                            const PathObserver*) const;
template void BidirectionalIntegrator::trace_light(const SceneView&, RayTracer&, const CameraSample&,
                                                   SampleStream&, BidirectionalMemory&, LightPaths&) const;

} // namespace montelux
