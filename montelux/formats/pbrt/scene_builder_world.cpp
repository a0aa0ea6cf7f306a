// What a SceneBuilder puts into the world, and how it ends.
#include <algorithm>
#include <utility>

#include "montelux/formats/nearest_name.h"
#include "montelux/formats/pbrt/float_range.h"
#include "montelux/formats/pbrt/scene_builder.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/math/overloaded.h"
#include "montelux/spectrum/rgb_colorspace.h"

namespace montelux::pbrt {

void SceneBuilder::material(std::string type, std::vector<Parameter> parameters, Location at) {
    require_world("Material", at);
    state_.material = {false, materials_.size()};
    materials_.push_back({std::move(type), with_defaults(std::move(parameters), PluginKind::material), at});
}

void SceneBuilder::make_named_material(const std::string& name, std::vector<Parameter> parameters,
                                       Location at) {
    require_world("MakeNamedMaterial", at);
    ParameterList list = with_defaults(std::move(parameters), PluginKind::material);
    std::optional<std::string> type =
        ParameterReader(list, "named material", at, diagnostics_).string("type");
    if (!type)
        diagnostics_.error(at, "named material " + in_quotes(name) + " needs a parameter 'string type'");
    if (!named_materials_.emplace(name, materials_.size()).second)
        diagnostics_.error(at, "material " + in_quotes(name) + " is defined twice");
    materials_.push_back({*type, std::move(list), at});
}

void SceneBuilder::named_material(const std::string& name, Location at) {
    require_world("NamedMaterial", at);
    auto [entry, is_new] = material_name_indices_.emplace(name, material_names_.size());
    if (is_new) material_names_.push_back(name);
    state_.material = {true, entry->second};
}

void SceneBuilder::texture(const std::string& name, std::string_view type, std::string plugin,
                           std::vector<Parameter> parameters, Location at) {
    require_world("Texture", at);
    textures_.declare(type, name,
                      {std::move(plugin), with_defaults(std::move(parameters), PluginKind::texture), at,
                       still_transform(at)});
}

void SceneBuilder::light_source(std::string name, std::vector<Parameter> parameters, Location at) {
    require_world("LightSource", at);
    Plugin plugin{std::move(name), with_defaults(std::move(parameters), PluginKind::light), at};
    result_.scene.lights.push_back(lights_.read(plugin, still_transform(at), *state_.color_space));
}

void SceneBuilder::area_light_source(std::string name, std::vector<Parameter> parameters, Location at) {
    require_world("AreaLightSource", at);
    Plugin plugin{std::move(name), with_defaults(std::move(parameters), PluginKind::light), at};
    state_.emission = std::make_shared<Emission>(lights_.read_area(plugin, *state_.color_space));
}

void SceneBuilder::shape(const std::string& name, std::vector<Parameter> parameters, Location at) {
    require_world("Shape", at);
    Scene& scene = result_.scene;
    const Transform& world_from_object = still_transform(at);
    ParameterList list = with_defaults(std::move(parameters), PluginKind::shape);
    ParameterReader r(list, "shape " + in_quotes(name), at, diagnostics_);
    Geometry geometry =
        read_shape(r, name, world_from_object, state_.reverse_orientation, files_, subdivided_);

    Shape shape;
    Index index = static_cast<Index>(scene.shapes.size());
    shape.flip_normal = state_.reverse_orientation != world_from_object.swaps_handedness();
    if (const Parameter* alpha = r.any("alpha", {ParameterType::texture, ParameterType::floating})) {
        if (alpha->type == ParameterType::texture)
            alpha_uses_.push_back({index, ParameterList({*alpha}), r.plugin(), at});
        else
            shape.alpha.value = r.number_of(*alpha);
    }
    r.finish();
    material_uses_.push_back({index, state_.material, at});
    add_lights(shape, index, geometry, at);
    if (auto* mesh = std::get_if<TriangleMesh>(&geometry.shape)) {
        shape.geometry = MeshIndex{static_cast<Index>(scene.meshes.size())};
        scene.meshes.push_back(std::move(*mesh));
    } else {
        shape.geometry = QuadricIndex{static_cast<Index>(scene.quadrics.size())};
        scene.quadrics.push_back(std::get<Quadric>(geometry.shape));
    }
    scene.shapes.push_back(shape);
    (open_object_ == no_index ? scene.world_shapes : scene.objects[open_object_].shapes).push_back(index);
}

void SceneBuilder::add_lights(Shape& shape, Index index, const Geometry& geometry, Location at) {
    if (!state_.emission) return;
    if (open_object_ != no_index) {
        diagnostics_.warn_once("area light in object", at,
                               "area lights inside object definitions do not shine, as in pbrt");
        return;
    }
    std::vector<Light>& lights = result_.scene.lights;
    const std::size_t count = geometry.primitive_count();
    if (count == 0) return;
    emissive_primitives_ += count;
    if (lights.size() >= no_index || emissive_primitives_ >= no_index)
        diagnostics_.error(at, "more than 2^32 emissive triangles");
    shape.light = static_cast<Index>(lights.size());
    lights.push_back(state_.emission->light(index, geometry));
}

void SceneBuilder::finish_options() {
    auto plugin = [](std::optional<Plugin>& given, const char* name) {
        return given ? std::move(*given) : Plugin{name, {}, {}};
    };
    FilmSettings& film = result_.film;
    read_film(plugin(film_, "rgb"), diagnostics_, film, result_.output_file);
    film.filter = read_filter(plugin(filter_, "gaussian"), diagnostics_);
    result_.scene.camera.model = read_camera(plugin(camera_, "perspective"), diagnostics_, film);
    result_.integrator = read_integrator(plugin(integrator_, "volpath"), diagnostics_);
    result_.sampler = read_sampler(plugin(sampler_, "zsobol"), diagnostics_, seed_.value_or(0));
}

Index SceneBuilder::material_index(const MaterialReference& reference, Location at) {
    std::size_t declaration = reference.index;
    if (reference.by_name) {
        const std::string& name = material_names_[reference.index];
        auto found = named_materials_.find(name);
        if (found == named_materials_.end()) {
            std::vector<std::string_view> names;
            for (const auto& entry : named_materials_) names.push_back(entry.first);
            if (names.size() > 10000) names.clear();
            diagnostics_.error(at, "this shape's material " + in_quotes(name) + " is not defined" +
                                       did_you_mean(name, names));
        }
        declaration = found->second;
    }
    Index& index = material_indices_[declaration];
    if (index == no_index) {
        result_.scene.materials.push_back(
            make_material(materials_[declaration], textures_, spectra_, diagnostics_));
        index = static_cast<Index>(result_.scene.materials.size() - 1);
    }
    return index;
}

void SceneBuilder::finish_materials() {
    material_indices_.assign(materials_.size(), no_index);
    for (const MaterialUse& use : material_uses_)
        result_.scene.shapes[use.shape].material = material_index(use.material, use.at);
    // Unused ones are read as well, so that what is wrong with them is told.
    for (std::size_t i = 1; i < materials_.size(); ++i) {
        if (material_indices_[i] != no_index) continue;
        if (is_supported_material(materials_[i], diagnostics_))
            material_index({false, i}, materials_[i].at);
        else
            diagnostics_.warn(materials_[i].at, "material " + in_quotes(materials_[i].type) +
                                                    " is not supported yet; no shape uses it");
    }
    for (const AlphaUse& use : alpha_uses_) {
        ParameterReader r(use.parameters, use.plugin, use.at, diagnostics_);
        result_.scene.shapes[use.shape].alpha = textures_.float_or(r, "alpha", 1);
    }
}

namespace {

Bounds3 bounds_of(const ObjectDefinition& object, const Scene& scene) {
    Bounds3 bounds;
    for (Index i : object.shapes) {
        visit_geometry(scene, scene.shapes[i],
                       Overloaded{[&](const TriangleMesh& mesh) {
                                      for (Point3f p : mesh.positions) bounds.add(Vec3d(p));
                                  },
                                  [&](const Quadric& quadric) {
                                      const Bounds3 b = world_bounds(quadric);
                                      bounds.add(b.lower);
                                      bounds.add(b.upper);
                                  }});
    }
    return bounds;
}

} // namespace

void SceneBuilder::finish_instances() {
    std::vector<Bounds3> bounds;
    for (const ObjectDefinition& object : result_.scene.objects)
        bounds.push_back(bounds_of(object, result_.scene));
    for (InstanceUse& use : instances_) {
        auto found = objects_.find(use.name);
        if (found == objects_.end()) {
            std::vector<std::string_view> names;
            for (const auto& entry : objects_) names.push_back(entry.first);
            if (names.size() > 10000) names.clear();
            diagnostics_.error(use.at, "object " + in_quotes(use.name) + " is not defined" +
                                           did_you_mean(use.name, names));
        }
        const Bounds3& b = bounds[found->second];
        for (int i = 0; i < 8 && !b.empty(); ++i) {
            if (!fits_float(use.world_from_object.point(b.corner(i))))
                diagnostics_.error(use.at, "the instance reaches to infinity in world space");
        }
        result_.scene.instances.push_back({found->second, use.world_from_object});
    }
}

SceneDescription SceneBuilder::finish(Location end) {
    if (!in_world_) diagnostics_.error(end, "the file ends before WorldBegin");
    if (!blocks_.empty())
        diagnostics_.error(blocks_.back().at, blocks_.back().kind == Block::Kind::attribute
                                                  ? "this AttributeBegin has no AttributeEnd"
                                                  : "this ObjectBegin has no ObjectEnd");
    finish_materials();
    finish_instances();
    textures_.warn_of_unused();
    if (result_.scene.lights.empty()) diagnostics_.warn(end, "the scene has no light; its picture is black");
    return std::move(result_);
}

} // namespace montelux::pbrt
