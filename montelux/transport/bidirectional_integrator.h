// BidirectionalIntegrator: paths from the camera and from lights, joined in all ways; or light paths alone.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "montelux/scene/film/film_settings.h"
#include "montelux/scene/render_settings.h"
#include "montelux/transport/edge_density.h"
#include "montelux/transport/integrator_model.h"
#include "montelux/transport/light_map.h"
#include "montelux/transport/merging_sample.h"
#include "montelux/transport/splat.h"
#include "montelux/transport/strategy_weight.h"
#include "montelux/transport/texture_footprint.h"

namespace montelux {

struct SubpathVertex;
struct PathObserver;

// The memory of a sample; allocated once and used again.
struct BidirectionalMemory {
    BidirectionalMemory();
    ~BidirectionalMemory();
    BidirectionalMemory(const BidirectionalMemory&) = delete;
    BidirectionalMemory& operator=(const BidirectionalMemory&) = delete;

    std::vector<SubpathVertex> camera, light; // z_1, z_2 ... and y_1, y_2 ...
    std::vector<EdgeDensity> edges;           // of the path in question, with media
    PathDensities densities;
    std::vector<double> scratch;
    SplatList ignored; // where the caller wants no splats
};

// Bidirectional path tracing (Veach 1997, "Robust Monte Carlo Methods for Light Transport Simulation", chapter 10;
// Lafortune, Willems 1993). A sample traces one path from its pixel and one from a light, and joins all their vertices;
// what reaches the lens is a Splat. Every strategy s >= 0, t >= 1 takes part, weighted by multiple importance sampling
// over all by their densities (strategy_weight.h). The one that joins a light to the lens is left to s = 0. Samples at
// vertices (s = 1) choose lights as PathIntegrator does, so that this is its special case without light paths.
//
// Depths, wavelengths and the order of events are those of PathIntegrator and VolumePathIntegrator: all estimate the
// same integral for each max_depth. Where one of the two subpaths has met a dispersive surface, the first wavelength
// stands for all.
//
// In media vertices scatter by phase functions, and have densities per volume: those of directions lack the cosine.
// Subpaths walk from vertex to vertex by delta tracking, and edges are joined by ratio tracking, both at the extinction
// of the first wavelength, as in VolumePathIntegrator; weights contain the densities of the null collisions on the way
// at each wavelength (edge_density.h). Light that media emit is found by the camera's path alone.
// Lafortune, Willems 1996, "Rendering Participating Media with Bidirectional Path Tracing"; Raab, Seibert, Keller 2008,
// "Unbiased Global Illumination with Participating Media"; Georgiev et al. 2013, "Joint Importance Sampling of
// Low-Order Volumetric Scattering".
//
// IntegratorKind::light_tracing takes the strategies t = 1 alone, and s = 0 for lights that the camera sees directly.
// It finds no light on its way from a mirror or smooth glass straight to the camera.
//
// Merging (vertex connection and merging: Georgiev et al. 2012; Hachisuka, Pantaleoni, Jensen 2012): each vertex of the
// camera's path on a surface is also joined to the vertices of a LightMap within its radius r, as if they were the same
// point. The light that the N paths of the map bring to the disc, over its area pi r^2, is an estimate of the
// irradiance: it is that of the disc's mean rather than of the point, which is the bias; it vanishes with r. These are
// the strategies n + i of PathDensities, for v_i with i >= 2 on surfaces that scatter there by no delta: light straight
// from a lamp is left to the other strategies. Vertices in media do not merge.
//
// For scenes and cameras without light_tracing_obstacle().
class BidirectionalIntegrator {
  public:
    static constexpr std::string_view name = "bidirectional";

    // The camera must outlive it. `film`: where splats count; `light_paths`: for each path that starts at a square
    // pixel. `volumes`: SceneView::has_media().
    BidirectionalIntegrator(const IntegratorSettings& settings, const Camera& camera, float footprint_scale,
                            const PixelBounds& crop, Vec2f filter_radius, bool volumes);

    using Batch = BidirectionalMemory;
    // Splats go to camera.splats, unless null.
    template <RandomStream Stream>
    FilmContribution estimate(const SceneView& scene, RayTracer& tracer, const CameraSample& camera,
                              Stream& stream, PathRecord* record = nullptr) const;
    template <RandomStream Stream>
    void estimate(const SceneView& scene, RayTracer& tracer, std::span<PathStart<Stream>> starts,
                  Batch& memory, std::span<FilmContribution> results) const;
    // From now on samples, which then have CameraSample::merging, merge with it; null: none does.
    void set_light_map(const LightMap* map) { map_ = map; }
    // Traces the light's path of a sample, the same as estimate() does, and appends it.
    template <RandomStream Stream>
    void trace_light(const SceneView& scene, RayTracer& tracer, const CameraSample& camera, Stream& stream,
                     Batch& memory, LightPaths& paths) const;
    // Of one sample; `observer`, unless null, sees each path found.
    template <RandomStream Stream>
    FilmContribution estimate(const SceneView& scene, RayTracer& tracer, const CameraSample& camera,
                              Stream& stream, Batch& memory, const PathObserver* observer) const;

  private:
    template <RandomStream Stream>
    friend class BidirectionalSample;
    template <RandomStream Stream>
    friend class BidirectionalStrategies;
    template <RandomStream Stream>
    friend class BidirectionalMerging;

    bool on_film(Point2f p) const {
        return p.x >= window_min_.x && p.x < window_max_.x && p.y >= window_min_.y && p.y < window_max_.y;
    }

    IntegratorSettings settings_;
    const Camera* camera_;
    float footprint_scale_;
    Vec2f window_min_, window_max_; // film points that some pixel's filter reaches
    double light_paths_;
    bool volumes_;
    const LightMap* map_ = nullptr;
};

} // namespace montelux
