#include "montelux/transport/bidirectional_integrator.h"

#include <string>

#include "montelux/mc/math/error.h"
#include "montelux/mc/math/overloaded.h"
#include "montelux/mc/random/sample_stream.h"
#include "montelux/scene/material/material_model.h"
#include "montelux/scene/setting_names.h"
#include "montelux/transport/bidirectional_sample.h"

namespace montelux {

namespace {

bool is_zero(const FloatParameter& p) { return p.is_constant() && p.value == 0; }

// Whether light may pass from one side of the material to the other; true where it is not known.
bool may_transmit(const SceneView& scene, Index index) {
    bool part = false;
    visit_parts(scene.materials[index], [&](Index i) { part = part || may_transmit(scene, i); });
    return part ||
           std::visit(Overloaded{[](const DiffuseMaterial&) { return false; },
                                 [](const ConductorMaterial&) { return false; },
                                 [](const CoatedDiffuseMaterial&) { return false; },
                                 [](const CoatedConductorMaterial&) { return false; },
                                 [](const MeasuredMaterial&) { return false; },
                                 [](const PlasticMaterial&) { return false; },
                                 [](const MixMaterial&) { return false; },
                                 [](const SidedMaterial&) { return false; },
                                 [](const PrincipledMaterial& m) {
                                     return !is_zero(m.transmission) || !is_zero(m.diffuse_transmission);
                                 },
                                 [](const DisneyMaterial& m) { return !is_zero(m.specular_transmission); },
                                 [](const auto&) { return true; }},
                      scene.materials[index]);
}

// Sides that transmit light by their own rules: the two directions of a path then mean different materials.
bool has_transmitting_sides(const SceneView& scene) {
    for (const Material& material : scene.materials) {
        const auto* sided = std::get_if<SidedMaterial>(&material);
        if (sided == nullptr) continue;
        for (const Index side : {sided->front.index, sided->back.index})
            if (side != no_index && may_transmit(scene, side)) return true;
    }
    return false;
}

} // namespace

void check_bidirectional(const IntegratorSettings& settings, const SceneView& scene, const Camera& camera) {
    const std::string where = "integrator " + std::string(name_of(settings.method));
    if (settings.occlusion) throw Error(where, "ambient occlusion is no light; choose 'path' for it");
    if (scene.has_media())
        throw Error(where, "participating media and interfaces cannot be rendered by it yet; choose 'path'");
    if (!camera.has_importance())
        throw Error(where,
                    "only perspective and orthographic cameras can be used, not spherical ones and lens "
                    "systems; choose 'path'");
    if (settings.strategy != Strategy::mis)
        throw Error(where, "it has strategies of its own; leave out the strategy '" +
                               std::string(name_of(settings.strategy)) + "' or choose 'path'");
    if (settings.regularize)
        throw Error(where,
                    "regularization depends on the direction of a path; leave it out or choose 'path'");
    if (!scene.curves.empty()) throw Error(where, "curves turn with the direction of a path; choose 'path'");
    if (scene.soft_terminator)
        throw Error(where,
                    "the soft shading terminator depends on the direction of a path; leave it out or choose "
                    "'path'");
    if (has_transmitting_sides(scene))
        throw Error(where,
                    "a material of one side that transmits light depends on the direction of a path; choose "
                    "'path'");
}

BidirectionalIntegrator::BidirectionalIntegrator(const IntegratorSettings& settings, const SceneView& scene,
                                                 const Camera& camera, float footprint_scale,
                                                 const PixelBounds& crop, Vec2f filter_radius)
    : settings_(settings), camera_(&camera),
      footprint_scale_(footprint_scale), window_min_{static_cast<float>(crop.x0) + 0.5f - filter_radius.x,
                                                     static_cast<float>(crop.y0) + 0.5f - filter_radius.y},
      window_max_{static_cast<float>(crop.x1) - 0.5f + filter_radius.x,
                  static_cast<float>(crop.y1) - 0.5f + filter_radius.y},
      light_paths_(double(crop.width()) * double(crop.height())) {
    check_bidirectional(settings, scene, camera);
}

template FilmContribution BidirectionalIntegrator::estimate(const SceneView&, RayTracer&, const CameraSample&,
                                                            SampleStream&, PathRecord*) const;
template void BidirectionalIntegrator::estimate(const SceneView&, RayTracer&,
                                                std::span<PathStart<SampleStream>>, BidirectionalMemory&,
                                                std::span<FilmContribution>) const;
template FilmContribution BidirectionalIntegrator::estimate(const SceneView&, RayTracer&, const CameraSample&,
                                                            SampleStream&, BidirectionalMemory&,
                                                            const PathObserver*) const;

} // namespace montelux
