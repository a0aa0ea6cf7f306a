#include "montelux/formats/mitsuba/scene_reader.h"

#include <optional>
#include <utility>

#include "montelux/formats/mitsuba/films.h"
#include "montelux/formats/mitsuba/integrators.h"
#include "montelux/formats/mitsuba/sensors.h"
#include "montelux/formats/mitsuba/shapes.h"
#include "montelux/formats/named_cameras.h"
#include "montelux/scene/build/quoted.h"
#include "montelux/scene/material/diffuse_material.h"

namespace montelux::mitsuba {

SceneReader::SceneReader(const SceneGraph& graph, SceneDescription& description, const LoadOptions& options)
    : graph_(graph), description_(description), options_(options),
      builder_(description.scene, graph.diagnostics), textures_(builder_), materials_(builder_, textures_),
      media_(builder_), lights_(builder_) {}

void SceneReader::read() {
    Plugin scene(graph_, 0);
    read_settings(scene);
    const std::vector<Plugin> emitters = scene.children("emitter");
    for (const Plugin& emitter : emitters)
        if (emitter.type() != "area") lights_.add(emitter);
    for (const Plugin& shape : scene.children("shape"))
        if (shape.type() != "shapegroup") add_shape(shape); // instances place groups
    for (const Plugin& emitter : emitters)
        if (emitter.type() == "area" && !lights_.is_on_shape(emitter))
            emitter.warn("no shape refers to the emitter 'area'");
    // Definitions, for references.
    for (const char* kind : {"bsdf", "texture", "medium", "phase", "volume", "film", "sampler", "rfilter"})
        static_cast<void>(scene.children(kind));
    scene.finish();
    if (description_.scene.shapes.empty()) scene.warn("the scene has no shapes");
    description_.has_lights = !description_.scene.lights.empty();
    description_.wants_studio = true; // adds only what the file lacks
    builder_.finish({}, false);
}

void SceneReader::read_settings(Plugin& scene) {
    description_.integrator.max_depth = unlimited_depth;
    description_.integrator.environment_lookup = EnvironmentLookup::bilinear;
    if (const std::optional<Plugin> integrator = scene.child("integrator"))
        read_integrator(*integrator, description_.integrator);
    const std::vector<Plugin> sensors = scene.children("sensor");
    description_.has_camera = !sensors.empty();
    for (const Plugin& sensor : sensors) description_.camera_names.push_back(sensor.id());
    std::size_t number = 0;
    if (options_.camera) {
        const std::optional<std::size_t> found = find_camera(description_.camera_names, *options_.camera);
        if (!found) scene.error(no_such_camera(description_.camera_names, *options_.camera));
        number = *found;
    }
    if (!sensors.empty()) return read_sensor(sensors[number], media_, description_);
    constexpr std::uint32_t samples_of_studio = 128;
    description_.film = standard_film();
    description_.sampler.spp = samples_of_studio;
}

void SceneReader::add_shape(Plugin shape) {
    if (!added_.insert(shape.index()).second) {
        shape.warn("the scene refers to " + shape.describe() + " several times; it is shown once");
        return;
    }
    if (shape.type() == "instance") {
        add_instance(std::move(shape));
    } else if (shape.type() == "merge") {
        for (const Plugin& part : shape.children("shape")) add_shape(part);
        shape.finish();
    } else if (shape.type() == "shapegroup") {
        shape.error("a shapegroup within another shape; expected an instance of it");
    } else {
        add_single(std::move(shape));
    }
}

SurfaceLook SceneReader::look_of(Plugin& shape, bool emits) {
    if (const std::optional<Plugin> bsdf = shape.child("bsdf")) return materials_.of(*bsdf);
    if (!emits) {
        if (!standard_) standard_ = materials_.standard();
        return *standard_;
    }
    if (!dark_) {
        std::vector<Material>& all = builder_.scene().materials;
        all.emplace_back(DiffuseMaterial{.reflectance = {builder_.add_spectrum(Spectrum(0.0f))}});
        dark_ = SurfaceLook{static_cast<Index>(all.size() - 1)};
    }
    return *dark_;
}

Index SceneReader::medium_of(Plugin& shape, std::string_view name) {
    const std::optional<Plugin> medium = shape.object(name);
    if (!medium) return no_index;
    if (medium->kind() != "medium")
        shape.error(in_quotes(name) + " is " + medium->describe() + "; expected a medium");
    return media_.of(*medium);
}

void SceneReader::add_single(Plugin shape) {
    PlacedGeometry read = read_geometry(shape);
    ShapeSettings settings;
    settings.flip_normal = read.flip_normal;
    settings.media = {medium_of(shape, "interior"), medium_of(shape, "exterior")};
    settings.name = shape.id();
    const std::optional<Plugin> emitter = shape.child("emitter");
    std::optional<Emission> emission;
    if (emitter) {
        if (builder_.in_object()) emitter->error("shapes of a shapegroup cannot emit light");
        emission = lights_.emission(*emitter);
        settings.emission = &*emission;
    }
    const SurfaceLook look = look_of(shape, emission.has_value());
    settings.material = look.material;
    settings.alpha = look.alpha;
    shape.skip("silhouette_sampling_weight"); // of differentiable rendering
    shape.finish();
    builder_.add_shape(std::move(read.geometry), settings, shape.at());
}

std::optional<std::string> SceneReader::group(Plugin shapegroup) {
    const auto [known, is_new] = groups_.try_emplace(shapegroup.index());
    if (!is_new) return known->second;
    const std::vector<Plugin> shapes = shapegroup.children("shape");
    for (const Plugin& shape : shapes)
        if (shape.type() == "instance") shape.error("an instance within a shapegroup is not supported");
    shapegroup.finish();
    if (shapes.empty()) {
        shapegroup.warn("the shapegroup is empty");
        return std::nullopt;
    }
    // Distinct from the names of other groups, whatever their ids are.
    const std::string name = shapegroup.id() + " " + std::to_string(shapegroup.index());
    builder_.begin_object(name, shapegroup.at());
    for (const Plugin& shape : shapes) add_shape(shape);
    builder_.end_object();
    return known->second = name;
}

void SceneReader::add_instance(Plugin instance) {
    if (builder_.in_object()) instance.error("an instance within a shapegroup is not supported");
    const std::optional<Plugin> shapegroup = instance.child("shape");
    if (!shapegroup || shapegroup->type() != "shapegroup")
        instance.error("an instance needs a shapegroup" +
                       (shapegroup ? "; this is " + shapegroup->describe() : std::string()));
    const Transform to_world = instance.transform("to_world");
    instance.finish();
    if (const std::optional<std::string> object = group(*shapegroup))
        builder_.add_instance(*object, to_world, instance.at());
}

} // namespace montelux::mitsuba
