// Directives that put something into the world, and how a scene ends.
#include <algorithm>
#include <filesystem>
#include <utility>

#include "montelux/formats/pbrt/curves.h"
#include "montelux/formats/pbrt/directives.h"
#include "montelux/mc/math/error.h"
#include "montelux/scene/light_tracing_support.h"
#include "montelux/scene/material/material_model.h"
#include "montelux/scene/setting_names.h"
#include "montelux/spectrum/rgb_colorspace.h"

namespace montelux::pbrt {

void Directives::material(std::string type, std::vector<Parameter> parameters, Location at) {
    require_world("Material", at);
    state_.material = {false, static_cast<Index>(materials_.size())};
    materials_.push_back({std::move(type), with_defaults(std::move(parameters), PluginKind::material), at});
}

void Directives::make_named_material(const std::string& name, std::vector<Parameter> parameters,
                                     Location at) {
    require_world("MakeNamedMaterial", at);
    ParameterList list = with_defaults(std::move(parameters), PluginKind::material);
    std::optional<std::string> type =
        ParameterReader(list, "named material", at, diagnostics_).string("type");
    if (!type)
        diagnostics_.error(at, "named material " + in_quotes(name) + " needs a parameter 'string type'");
    named_materials_.declare(name, static_cast<Index>(materials_.size()), at, diagnostics_);
    materials_.push_back({*type, std::move(list), at, name});
}

void Directives::named_material(const std::string& name, Location at) {
    require_world("NamedMaterial", at);
    state_.material = {true, named_materials_.refer(name)};
}

void Directives::texture(const std::string& name, std::string_view type, std::string plugin,
                         std::vector<Parameter> parameters, Location at) {
    require_world("Texture", at);
    textures_.declare(type, name,
                      {std::move(plugin), with_defaults(std::move(parameters), PluginKind::texture), at,
                       start_transform("a texture", at)});
}

void Directives::light_source(std::string name, std::vector<Parameter> parameters, Location at) {
    require_world("LightSource", at);
    Plugin plugin{std::move(name), with_defaults(std::move(parameters), PluginKind::light), at};
    lights_.read(plugin, state_.ctm->start, state_.ctm->end, *state_.color_space);
}

void Directives::area_light_source(std::string name, std::vector<Parameter> parameters, Location at) {
    require_world("AreaLightSource", at);
    Plugin plugin{std::move(name), with_defaults(std::move(parameters), PluginKind::light), at};
    state_.emission = std::make_shared<Emission>(lights_.read_area(plugin, *state_.color_space));
}

// Appends curves to the shape before them if they differ in nothing else; `is_plain`: they may be joined.
bool Directives::joins_open_curves(const Geometry& geometry, const ShapeSettings& settings, bool is_plain,
                                   Location at) {
    const auto* curves = std::get_if<Curves>(&geometry);
    Scene& scene = result_.scene;
    const auto next = static_cast<Index>(scene.shapes.size());
    if (curves == nullptr || !is_plain) {
        open_curves_.reset();
        return false;
    }
    OpenCurves open{next - 1,     state_.material,      state_.media,
                    curves->kind, settings.flip_normal, settings.alpha.value,
                    settings.name};
    if (open_curves_ == open) {
        try {
            check_geometry(geometry);
        } catch (const Error& e) {
            diagnostics_.error(at, e.what());
        }
        append(scene.curves.back(), *curves);
        return true;
    }
    open.shape = next;
    open_curves_ = open;
    return false;
}

void Directives::shape(const std::string& name, std::vector<Parameter> parameters, Location at) {
    require_world("Shape", at);
    const bool moves = is_moving();
    const Transform world_from_object = moves ? Transform() : state_.ctm->start;
    ParameterList list = with_defaults(std::move(parameters), PluginKind::shape);
    ParameterReader r(list, "shape " + in_quotes(name), at, diagnostics_);
    Geometry geometry =
        read_shape(r, name, world_from_object, state_.reverse_orientation, state_.emission != nullptr, files_,
                   subdivision_, displacements_, state_.ctm->start);

    ShapeSettings settings;
    // A quadric that is mirrored emits from its other side. pbrt forgets this where a shape moves, but there its
    // shapes that move do not emit.
    const bool emits = state_.emission != nullptr && !builder_.in_object();
    const bool mirrored = moves && emits && std::holds_alternative<Quadric>(geometry)
                              ? state_.ctm->start.swaps_handedness()
                              : world_from_object.swaps_handedness();
    settings.flip_normal = state_.reverse_orientation != mirrored;
    settings.emission = state_.emission.get();
    settings.name = r.string("name", "");
    if (settings.name.empty() && name == "plymesh")
        settings.name = std::filesystem::path(r.string("filename", "")).stem().string();
    const auto index = static_cast<Index>(result_.scene.shapes.size());
    bool alpha_varies = false;
    if (const Parameter* alpha = r.any("alpha", {ParameterType::texture, ParameterType::floating})) {
        alpha_varies = alpha->type == ParameterType::texture;
        if (alpha_varies)
            alpha_uses_.push_back({index, ParameterList({*alpha}), r.plugin(), at});
        else
            settings.alpha.value = r.number_of(*alpha);
    }
    r.finish();
    if (joins_open_curves(geometry, settings, !moves && !alpha_varies && !state_.emission, at)) return;
    material_uses_.push_back({index, state_.material, at});
    if (state_.media != MediaReference()) media_uses_.push_back({index, state_.media, at});
    if (moves)
        builder_.add_moving_shape(std::move(geometry), settings, state_.ctm->start, state_.ctm->end, at);
    else
        builder_.add_shape(std::move(geometry), settings, at);
}

void Directives::finish_options() {
    auto plugin = [](std::optional<Plugin>& given, const char* name) {
        return given ? std::move(*given) : Plugin{name, {}, {}};
    };
    FilmSettings& film = result_.film;
    read_film(plugin(film_, "rgb"), diagnostics_, film, result_.output_file);
    film.filter = read_filter(plugin(filter_, "gaussian"), diagnostics_);
    CameraSettings& camera = result_.scene.camera;
    read_camera(plugin(camera_, "perspective"), files_, diagnostics_, film, camera);
    const auto motion_time = [&](float t) {
        return static_cast<float>((static_cast<double>(t) - transform_start_) /
                                  (transform_end_ - transform_start_));
    };
    camera.shutter_open = motion_time(camera.shutter_open);
    camera.shutter_close = motion_time(camera.shutter_close);
    if (integrator_) integrator_at_ = integrator_->at;
    std::optional<std::uint32_t> samples;
    result_.integrator = read_integrator(plugin(integrator_, "volpath"), diagnostics_, samples);
    result_.sampler = read_sampler(plugin(sampler_, "zsobol"), diagnostics_, seed_.value_or(0));
    if (samples) result_.sampler.spp = *samples;
}

// Materials of a mix are made by a call from within.
constexpr std::size_t most_levels = 64;

Index Directives::material_index(const MaterialReference& reference, Location at, std::string_view by) {
    const Index declaration =
        reference.by_name ? named_materials_.resolve(reference.index, at, diagnostics_, by) : reference.index;
    Index& index = material_indices_[declaration];
    if (std::find(open_materials_.begin(), open_materials_.end(), declaration) != open_materials_.end())
        diagnostics_.error(at, "the material depends on itself");
    if (open_materials_.size() == most_levels)
        diagnostics_.error(at, "materials refer to one another more than " + std::to_string(most_levels) +
                                   " levels deep");
    if (index == no_index) {
        const FindMaterial find = [this](const std::string& name, Location place) {
            return material_index({true, named_materials_.refer(name)}, place, "this material's ");
        };
        open_materials_.push_back(declaration);
        const Material made = make_material(materials_[declaration], builder_, textures_, measured_brdfs_,
                                            spectra_, find, diagnostics_);
        open_materials_.pop_back();
        result_.scene.materials.push_back(made);
        result_.scene.material_names.push_back(materials_[declaration].name);
        index = static_cast<Index>(result_.scene.materials.size() - 1);
    }
    return index;
}

void Directives::finish_materials() {
    material_indices_.assign(materials_.size(), no_index);
    for (const MaterialUse& use : material_uses_)
        result_.scene.shapes[use.shape].material = material_index(use.material, use.at);
    // Unused textures are read as well, so that their errors are reported.
    for (Index i = 1; i < materials_.size(); ++i)
        if (material_indices_[i] == no_index) material_index({false, i}, materials_[i].at);
    for (const AlphaUse& use : alpha_uses_) {
        ParameterReader r(use.parameters, use.plugin, use.at, diagnostics_);
        result_.scene.shapes[use.shape].alpha = textures_.float_or(r, "alpha", 1);
    }
}

void Directives::make_named_medium(const std::string& name, std::vector<Parameter> parameters, Location at) {
    const ParameterList list = with_defaults(std::move(parameters), PluginKind::medium);
    named_media_.declare(name, media_.read(list, start_transform("a medium", at), *state_.color_space, at),
                         at, diagnostics_);
}

void Directives::medium_interface(const std::string& inside, const std::string& outside) {
    const auto refer = [&](const std::string& name) {
        return name.empty() ? no_index : named_media_.refer(name);
    };
    state_.media = {refer(inside), refer(outside)};
}

std::vector<Directives::Interior> Directives::interiors() const {
    std::vector<Interior> all;
    for (const Material& material : result_.scene.materials) {
        Interior interior;
        if (const auto* body = std::get_if<SubsurfaceMaterial>(&material))
            interior.medium = body->interior.index;
        visit_parts(material, [&](Index part) { // made before the whole
            const Interior& other = all[part];
            const bool differ =
                interior.medium != no_index && other.medium != no_index && interior.medium != other.medium;
            interior.ambiguous |= other.ambiguous || differ;
            if (interior.medium == no_index) interior.medium = other.medium;
        });
        all.push_back(interior);
    }
    return all;
}

void Directives::finish_media() {
    const auto resolve = [&](Index reference, Location at, std::string_view by) {
        return reference == no_index ? no_index : named_media_.resolve(reference, at, diagnostics_, by);
    };
    for (const MediaUse& use : media_uses_)
        result_.scene.shapes[use.shape].media = {resolve(use.media.inside, use.at, "this shape's "),
                                                 resolve(use.media.outside, use.at, "this shape's ")};
    const std::vector<Interior> interior_of = interiors();
    for (const MaterialUse& use : material_uses_) {
        Shape& shape = result_.scene.shapes[use.shape];
        const Interior interior = interior_of[shape.material];
        if (interior.ambiguous)
            diagnostics_.error(use.at,
                               "the material's parts have two interiors ('subsurface'); expected one");
        if (interior.medium != no_index) shape.media.inside = interior.medium;
    }
    result_.scene.camera.medium = resolve(camera_media_.media.outside, camera_media_.at, "the camera's ");
}

SceneDescription Directives::finish(Location end) {
    if (!in_world_) diagnostics_.error(end, "the file ends before WorldBegin");
    if (!blocks_.empty())
        diagnostics_.error(blocks_.back().at, blocks_.back().kind == Block::Kind::attribute
                                                  ? "this AttributeBegin has no AttributeEnd"
                                                  : "this ObjectBegin has no ObjectEnd");
    finish_materials();
    finish_media();
    textures_.warn_of_unused();
    builder_.finish(end, !result_.integrator.occlusion);
    if (IntegratorKind& method = result_.integrator.method; traces_light(method))
        if (const auto obstacle = light_tracing_obstacle(result_.scene, result_.integrator)) {
            diagnostics_.warn(integrator_at_, "integrator '" + std::string(name_of(method)) +
                                                  "': the scene is rendered with 'path': " + *obstacle);
            method = IntegratorKind::path;
        }
    return std::move(result_);
}

} // namespace montelux::pbrt
