#include "python/src/scene_lists.h"

#include "python/src/bindings.h"
#include "python/src/scene_values.h"
#include <cstdint>
#include <string>
#include <variant>

#include "montelux/mc/math/overloaded.h"

namespace montelux::python {
namespace {

std::size_t checked(std::int64_t i, std::size_t count, const char* what) {
    const std::int64_t at = i < 0 ? i + static_cast<std::int64_t>(count) : i;
    if (at < 0 || at >= static_cast<std::int64_t>(count))
        throw nb::index_error(
            (std::string(what) + " " + std::to_string(i) + " of " + std::to_string(count)).c_str());
    return static_cast<std::size_t>(at);
}

Light plain_light(const SceneRef& scene, const nb::object& o) {
    const Slot<Light>* given = light_slot(o);
    if (!given)
        throw Error("lights", "an object of type '" + std::string(nb::type_name(o.type()).c_str()) +
                                  "' was given; expected a light, such as PointLight()");
    const auto refuse_sky = [] {
        throw Error("lights", "a SkyLight or SunLight belongs to the sky of its scene file");
    };
    const auto refuse_picture = [] {
        throw Error("lights", "a light refers to a picture of its scene file");
    };
    std::visit(
        Overloaded{[](const AreaLight&) {
                       throw Error("lights", "an AreaLight belongs to a shape; set the light of that shape");
                   },
                   [](const ImageInfiniteLight&) {
                       throw Error(
                           "lights",
                           "an EnvironmentLight refers to a map of its scene; make one by add_environment()");
                   },
                   [&](const GoniometricLight&) { refuse_picture(); },
                   [&](const ProjectionLight&) { refuse_picture(); }, [&](const SkyLight&) { refuse_sky(); },
                   [&](const SunLight&) { refuse_sky(); }, [](const PointLight&) {},
                   [&](const SpotLight& l) {
                       if (l.picture != no_index) refuse_picture();
                   },
                   [](const DistantLight&) {}, [](const UniformInfiniteLight&) {},
                   []<typename L>(const L&) {
                       static_assert(sizeof(L) == 0, "say whether scene.lights takes this light from Python");
                   }},
        given->read());
    std::visit(
        [&](const auto& light) {
            if constexpr (requires { light.motion; })
                if (light.motion != no_index && given->scene() != scene)
                    throw Error("lights", "a light that moves belongs to its scene file");
        },
        given->read());
    return value_for(scene, *given);
}

} // namespace

void bind_scene_lists(nb::module_& m) {
    nb::class_<MaterialList>(m, "Materials", "The materials of a scene.")
        .def("__len__", [](const MaterialList& l) { return l.scene->read().scene.materials.size(); })
        .def("__getitem__",
             [](const MaterialList& l, std::int64_t i) {
                 const std::size_t at = checked(i, l.scene->read().scene.materials.size(), "material");
                 return as_python(Slot<Material>(l.scene, static_cast<Index>(at)));
             })
        .def("__setitem__",
             [](const MaterialList& l, std::int64_t i, const nb::object& o) {
                 const std::size_t at = checked(i, l.scene->read().scene.materials.size(), "material");
                 const Index from = material_index(l.scene, o, "materials");
                 std::vector<Material>& all = l.scene->edit().scene.materials;
                 const Material value = all[from];
                 if (const Slot<Material>* slot = material_slot(o); slot->scene() != l.scene) all.pop_back();
                 all[at] = value;
             })
        .def(
            "append",
            [](const MaterialList& l, const nb::object& o) {
                return as_python(Slot<Material>(l.scene, material_index(l.scene, o, "materials")));
            },
            "material"_a, "Adds a material, and returns the place it has in the scene.");
    nb::class_<LightList>(m, "Lights", "The lights of a scene; those of one shape are one AreaLight.")
        .def("__len__", [](const LightList& l) { return l.scene->read().scene.lights.size(); })
        .def("__getitem__",
             [](const LightList& l, std::int64_t i) {
                 const std::size_t at = checked(i, l.scene->read().scene.lights.size(), "light");
                 return as_python(Slot<Light>(l.scene, static_cast<Index>(at)));
             })
        .def("__setitem__",
             [](const LightList& l, std::int64_t i, const nb::object& o) {
                 const std::size_t at = checked(i, l.scene->read().scene.lights.size(), "light");
                 if (std::holds_alternative<AreaLight>(l.scene->read().scene.lights[at]))
                     throw Error("lights", "this light belongs to a shape; set the light of that shape");
                 const Light light = plain_light(l.scene, o);
                 l.scene->edit().scene.lights[at] = light;
             })
        .def("__delitem__",
             [](const LightList& l, std::int64_t i) {
                 const std::size_t at = checked(i, l.scene->read().scene.lights.size(), "light");
                 erase_light(l.scene->edit(), static_cast<Index>(at));
             })
        .def(
            "append",
            [](const LightList& l, const nb::object& o) {
                const Light light = plain_light(l.scene, o);
                std::vector<Light>& all = l.scene->edit().scene.lights;
                all.push_back(light);
                return as_python(Slot<Light>(l.scene, static_cast<Index>(all.size() - 1)));
            },
            "light"_a, "Adds a light, and returns the place it has in the scene.");
    nb::class_<ShapeList>(m, "Shapes", "The shapes of a scene.")
        .def("__len__", [](const ShapeList& l) { return l.scene->read().scene.shapes.size(); })
        .def("__getitem__", [](const ShapeList& l, std::int64_t i) {
            const std::size_t at = checked(i, l.scene->read().scene.shapes.size(), "shape");
            return Ref<Shape>(Slot<Shape>(l.scene, static_cast<Index>(at)));
        });
}

} // namespace montelux::python
