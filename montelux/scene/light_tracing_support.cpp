#include "montelux/scene/light_tracing_support.h"

#include <algorithm>
#include <variant>

#include "montelux/mc/math/overloaded.h"
#include "montelux/scene/material/material_model.h"
#include "montelux/scene/view.h"

namespace montelux {

namespace {

bool is_zero(const FloatParameter& p) { return p.is_constant() && p.value == 0; }

// Whether light may pass from one side of the material to the other; true where it is not known.
bool may_transmit(const Scene& scene, Index index) {
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
bool has_transmitting_sides(const Scene& scene) {
    for (const Material& material : scene.materials) {
        const auto* sided = std::get_if<SidedMaterial>(&material);
        if (sided == nullptr) continue;
        for (const Index side : {sided->front.index, sided->back.index})
            if (side != no_index && may_transmit(scene, side)) return true;
    }
    return false;
}

bool is_body(const Medium& medium) {
    const auto* m = std::get_if<HomogeneousMedium>(&medium);
    return m != nullptr && m->is_body;
}

bool is_zero(SceneSpectrum s) { return s.is_constant() && s.constant == 0; }

// True where it is not known.
bool may_shine(const Medium& medium) {
    return std::visit(
        Overloaded{[](const HomogeneousMedium& m) { return !is_zero(m.le) && m.le_scale != 0; },
                   [](const GridMedium& m) {
                       return m.le_scale != 0 && (!is_zero(m.le) || m.temperature != no_index);
                   },
                   [](const RgbGridMedium& m) { return m.le != no_index && m.le_scale != 0; },
                   [](const SparseGridMedium& m) { return m.temperature != no_index && m.le_scale != 0; },
                   [](const CloudMedium&) { return false; }, [](const FieldMedium&) { return false; }},
        medium);
}

std::optional<std::string> obstacle_of_media(const Scene& scene, const IntegratorSettings& settings) {
    const std::vector<Medium>& media = scene.media;
    if (std::any_of(media.begin(), media.end(), is_body))
        return "translucent bodies count all that happens in them as one scattering event";
    if (settings.method == IntegratorKind::light_tracing &&
        std::any_of(media.begin(), media.end(), may_shine))
        return "light that media emit is found by paths from the camera alone: choose 'bidirectional'";
    return std::nullopt;
}

} // namespace

std::optional<std::string> light_tracing_obstacle(const Scene& scene, const IntegratorSettings& settings) {
    const CameraModel& camera = scene.camera.model;
    if (settings.occlusion) return "ambient occlusion is no light";
    if (auto obstacle = obstacle_of_media(scene, settings)) return obstacle;
    if (!std::holds_alternative<PerspectiveCamera>(camera) &&
        !std::holds_alternative<OrthographicCamera>(camera))
        return "spherical cameras and lens systems cannot be used";
    if (!scene.curves.empty()) return "curves turn with the direction of a path";
    if (has_transmitting_sides(scene))
        return "a material of one side that transmits light depends on the direction of a path";
    if (settings.strategy != Strategy::mis) return "it has strategies of its own";
    if (settings.regularize) return "regularization depends on the direction of a path";
    if (settings.shading_terminator == ShadingTerminator::soft)
        return "the soft shading terminator depends on the direction of a path";
    return std::nullopt;
}

} // namespace montelux
