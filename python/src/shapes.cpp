#include "python/src/shapes.h"

#include "python/src/bindings.h"
#include "python/src/scene_values.h"
#include <algorithm>
#include <optional>
#include <utility>

#include "montelux/mc/math/overloaded.h"
#include "montelux/scene/build/check_references.h"
#include "montelux/scene/build/scene_builder.h"

namespace montelux::python {
namespace {

using ShapeRef = Ref<Shape>;

std::string kind_of(const ShapeRef& r) {
    return visit_geometry(r.scene()->read().scene, r.value(),
                          Overloaded{[](const TriangleMesh&) { return "mesh"; },
                                     [](const Quadric& quadric) {
                                         return std::visit(
                                             Overloaded{[](const Sphere&) { return "sphere"; },
                                                        [](const Disk&) { return "disk"; },
                                                        [](const Cylinder&) { return "cylinder"; }},
                                             quadric);
                                     },
                                     [](const Curves&) { return "curves"; },
                                     [](const BilinearMesh&) { return "bilinear mesh"; }});
}

nb::object light_of(const ShapeRef& r) {
    const Shape& s = r.value();
    if (s.light == no_index) return nb::none();
    return as_python(Slot<Light>(r.scene(), s.light));
}

// From an AreaLight or a spectrum, which is added to the scene.
AreaLight area_light_of(const SceneRef& scene, const nb::object& emission) {
    if (nb::isinstance<Ref<AreaLight>>(emission)) {
        const AreaLight light =
            std::get<AreaLight>(value_for<Light>(scene, nb::cast<const Ref<AreaLight>&>(emission)));
        if (light.picture != no_index)
            throw Error("Shape.light", "an AreaLight with a picture belongs to the shape of its scene file");
        return light;
    }
    const Spectrum spectrum = spectrum_of(emission, RgbMeaning::illuminant, "Shape.light");
    const float scale = photometric_scale(spectrum, "Shape.light");
    return {add_spectrum(scene->edit().scene, spectrum), scale};
}

void add_light(SceneDescription& d, Index shape, AreaLight light) {
    CallMessages messages("Shape.light");
    light.shape = shape;
    d.scene.shapes[shape].light = SceneBuilder(d.scene, messages).add_light(light);
}

void check_can_shine(const Scene& scene, Index shape) {
    if (std::holds_alternative<CurvesIndex>(scene.shapes[shape].geometry))
        throw Error("Shape.light", "curves do not emit light");
    for (const ObjectDefinition& o : scene.objects)
        if (!o.shines && std::ranges::find(o.shapes, shape) != o.shapes.end())
            throw Error("Shape.light", "shapes inside object definitions do not shine");
}

// None removes the light; an AreaLight or a spectrum sets it. One that is there is replaced in its place: other lights
// keep theirs, and it keeps its group.
void set_light(const SceneRef& holder, Index shape, const nb::object& emission) {
    std::optional<AreaLight> light;
    if (!emission.is_none()) {
        check_can_shine(holder->read().scene, shape);
        light = area_light_of(holder, emission);
    }
    SceneDescription& d = holder->edit();
    const Index before = d.scene.shapes[shape].light;
    if (light && before != no_index) {
        light->shape = shape;
        check_light(d.scene, *light);
        d.scene.lights[before] = *light;
    } else if (light) {
        add_light(d, shape, *light);
    } else if (before != no_index) {
        erase_light(d, before);
    }
}

nb::object added(const SceneRef& holder, const char* call, Geometry geometry, bool flip_normal,
                 const nb::object& material, const nb::object& emission) {
    // Before the material is added to the scene.
    try {
        check_geometry(geometry);
    } catch (const Error& e) {
        throw Error(call, e.what());
    }
    std::optional<AreaLight> light;
    if (!emission.is_none()) light = area_light_of(holder, emission);
    ShapeSettings settings;
    settings.material = material_index(holder, material, "material of a shape");
    settings.flip_normal = flip_normal;
    CallMessages messages(call);
    SceneDescription& d = holder->edit();
    const Index index = SceneBuilder(d.scene, messages).add_shape(std::move(geometry), settings);
    if (light) add_light(d, index, *light);
    return nb::cast(ShapeRef(Slot<Shape>(holder, index)));
}

// Rows of n numbers.
Numbers rows(const nb::object& given, std::size_t n, const std::string& what) {
    Numbers numbers = numbers_of(given, what);
    if (numbers.shape.size() != 2 || numbers.shape[1] != n)
        throw Error(what, "expected an array of shape (n, " + std::to_string(n) + ")");
    return numbers;
}

// Of a mesh; None for other shapes, and where there are none.
nb::object positions_of(const ShapeRef& r, std::vector<Point3f> TriangleMesh::*positions) {
    const TriangleMesh* mesh = mesh_of(r.scene()->read().scene, r.value());
    if (mesh == nullptr || (mesh->*positions).empty()) return nb::none();
    std::vector<double> rows;
    for (const Point3f& p : mesh->*positions)
        rows.insert(rows.end(),
                    {static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)});
    return new_array(rows, rows.size() / 3, 3);
}

} // namespace

void erase_light(SceneDescription& d, Index light) {
    d.scene.lights.erase(d.scene.lights.begin() + light);
    std::vector<std::string>& groups = d.scene.light_groups;
    if (light < groups.size()) groups.erase(groups.begin() + light);
    for (Shape& s : d.scene.shapes) {
        if (s.light == no_index || s.light < light) continue;
        s.light = s.light == light ? no_index : s.light - 1;
    }
}

Index material_index(const SceneRef& scene, const nb::object& material, const std::string& what) {
    const Slot<Material>* slot = material_slot(material);
    if (!slot)
        throw Error(what, "an object of type '" + std::string(nb::type_name(material.type()).c_str()) +
                              "' was given; expected a material, such as Diffuse()");
    if (slot->scene() == scene) return slot->first();
    const auto refers_to_its_scene = [](const Material& m) {
        bool has_parts = false;
        visit_parts(m, [&](Index) { has_parts = true; });
        return has_parts || is_textured(m);
    };
    if (slot->scene() ? refers_to_its_scene(slot->read()) : slot->textures_of && slot->textures_of != scene)
        throw Error(what, "its textures or materials belong to another scene");
    const Material value = value_for(scene, *slot);
    SceneDescription& d = scene->edit();
    d.scene.materials.push_back(value);
    return static_cast<Index>(d.scene.materials.size() - 1);
}

nb::object add_mesh(const SceneRef& scene, const nb::object& positions, const nb::object& triangles,
                    const nb::object& material, const MeshAttributes& attributes) {
    const Transform world = transform_of(attributes.transform, "add_mesh, transform");
    // Points, or normals, in world space; None: none.
    const auto vectors = [&](const nb::object& given, const char* what, bool are_points) {
        std::vector<Vec3f> result;
        if (given.is_none()) return result;
        const Numbers numbers = rows(given, 3, std::string("add_mesh, ") + what);
        for (std::size_t i = 0; i < numbers.shape[0]; ++i) {
            const Vec3d v{numbers.values[3 * i], numbers.values[3 * i + 1], numbers.values[3 * i + 2]};
            result.push_back(Vec3f(are_points ? world.point(v) : world.normal(v)));
        }
        return result;
    };
    TriangleMesh mesh;
    mesh.positions = vectors(positions, "positions", true);
    mesh.normals = vectors(attributes.normals, "normals", false);
    mesh.end_positions = vectors(attributes.end_positions, "end_positions", true);
    mesh.end_normals = vectors(attributes.end_normals, "end_normals", false);
    if (!attributes.end_positions.is_none() && mesh.end_positions.empty())
        throw Error("add_mesh, end_positions", "expected one per position");
    for (const double v : rows(triangles, 3, "add_mesh, triangles").values) {
        if (!(v >= 0 && v < double{no_index} && v == std::floor(v)))
            throw Error("add_mesh, triangles",
                        "the index " + std::to_string(v) + " was given; expected whole numbers from 0 on");
        mesh.indices.push_back(static_cast<Index>(v));
    }
    if (mesh.indices.empty()) throw Error("add_mesh, triangles", "expected at least one triangle");
    if (!attributes.uvs.is_none()) {
        const Numbers given = rows(attributes.uvs, 2, "add_mesh, uvs");
        for (std::size_t i = 0; i < given.shape[0]; ++i)
            mesh.uvs.push_back(
                {static_cast<float>(given.values[2 * i]), static_cast<float>(given.values[2 * i + 1])});
    }
    return added(scene, "add_mesh", std::move(mesh), world.swaps_handedness(), material, attributes.light);
}

nb::object add_sphere(const SceneRef& scene, double radius, const nb::object& centre,
                      const nb::object& material, const nb::object& transform, const nb::object& emission) {
    if (!positive(radius)) throw Error("add_sphere, radius", "expected a number above zero");
    const std::vector<double> c = numbers_of(centre, 3, "add_sphere, centre");
    const Transform world =
        transform_of(transform, "add_sphere, transform") * Transform::translate({c[0], c[1], c[2]});
    Sphere sphere;
    sphere.radius = static_cast<float>(radius);
    sphere.z_min = -sphere.radius;
    sphere.z_max = sphere.radius;
    sphere.world_from_object = world;
    return added(scene, "add_sphere", sphere, world.swaps_handedness(), material, emission);
}

nb::object add_disk(const SceneRef& scene, double radius, double inner_radius, double height,
                    const nb::object& material, const nb::object& transform, const nb::object& emission) {
    if (!positive(radius)) throw Error("add_disk, radius", "expected a number above zero");
    if (!(inner_radius >= 0 && inner_radius <= radius))
        throw Error("add_disk, inner_radius", "expected a number between 0 and the radius");
    Disk disk;
    disk.height = static_cast<float>(height);
    disk.radius = static_cast<float>(radius);
    disk.inner_radius = static_cast<float>(inner_radius);
    disk.world_from_object = transform_of(transform, "add_disk, transform");
    return added(scene, "add_disk", disk, disk.world_from_object.swaps_handedness(), material, emission);
}

nb::object add_cylinder(const SceneRef& scene, double radius, double z_min, double z_max,
                        const nb::object& material, const nb::object& transform, const nb::object& emission) {
    if (!positive(radius)) throw Error("add_cylinder, radius", "expected a number above zero");
    if (!(z_min < z_max)) throw Error("add_cylinder, z_max", "expected a number above z_min");
    Cylinder cylinder;
    cylinder.radius = static_cast<float>(radius);
    cylinder.z_min = static_cast<float>(z_min);
    cylinder.z_max = static_cast<float>(z_max);
    cylinder.world_from_object = transform_of(transform, "add_cylinder, transform");
    return added(scene, "add_cylinder", cylinder, cylinder.world_from_object.swaps_handedness(), material,
                 emission);
}

nb::object add_curves(const SceneRef& scene, const nb::object& points, const nb::object& width,
                      const nb::object& material, const std::string& kind, const std::string& basis,
                      int degree, const nb::object& normals, const nb::object& transform) {
    const auto strands_of = [](const nb::object& given, const std::string& what) {
        Numbers numbers = numbers_of(given, what);
        if (numbers.shape.size() == 2) numbers.shape.insert(numbers.shape.begin(), 1);
        if (numbers.shape.size() != 3 || numbers.shape[2] != 3)
            throw Error(what, "expected an array of shape (n, 3), or (strands, n, 3)");
        return numbers;
    };
    const auto vectors_of = [](const Numbers& numbers, std::size_t strand) {
        std::vector<Vec3f> v;
        const std::size_t n = numbers.shape[1];
        for (std::size_t i = strand * n; i < (strand + 1) * n; ++i)
            v.push_back(
                Vec3f(Vec3d{numbers.values[3 * i], numbers.values[3 * i + 1], numbers.values[3 * i + 2]}));
        return v;
    };
    Curves curves;
    if (kind == "cylinder")
        curves.kind = Curves::Kind::cylinder;
    else if (kind == "tube")
        curves.kind = Curves::Kind::tube;
    else if (kind == "ribbon")
        curves.kind = Curves::Kind::ribbon;
    else if (kind != "flat")
        throw Error("add_curves, kind", "expected 'flat', 'cylinder', 'tube' or 'ribbon'");
    if (basis != "bezier" && basis != "bspline")
        throw Error("add_curves, basis", "expected 'bezier' or 'bspline'");
    const Transform world = transform_of(transform, "add_curves, transform");
    const Numbers p = strands_of(points, "add_curves, points");
    const Numbers ends = numbers_of(width, "add_curves, width");
    if (ends.values.empty() || ends.values.size() > 2 ||
        !(ends.values.front() >= 0 && ends.values.back() >= 0))
        throw Error("add_curves, width", "expected a number or two, for the ends, from zero on");
    std::optional<Numbers> n;
    if (!normals.is_none()) {
        n = strands_of(normals, "add_curves, normals");
        if (n->shape[0] != p.shape[0]) throw Error("add_curves, normals", "expected those of each strand");
    }
    for (std::size_t i = 0; i < p.shape[0]; ++i) {
        const std::vector<Vec3f> of_points = vectors_of(p, i),
                                 of_normals = n ? vectors_of(*n, i) : std::vector<Vec3f>();
        try {
            append(curves,
                   {.points = of_points,
                    .basis = basis == "bspline" ? CurveBasis::bspline : CurveBasis::bezier,
                    .degree = degree,
                    .width0 = static_cast<float>(ends.values.front()),
                    .width1 = static_cast<float>(ends.values.back()),
                    .normals = of_normals},
                   world);
        } catch (const Error& e) {
            throw Error("add_curves", e.what());
        }
    }
    return added(scene, "add_curves", std::move(curves), world.swaps_handedness(), material, nb::none());
}

void bind_shapes(nb::module_& m) {
    nb::class_<ShapeRef> c(m, "Shape", "A shape of a scene: its material, its light, its side.");
    c.def_prop_ro("kind", &kind_of, "'mesh', 'bilinear mesh', 'sphere', 'disk', 'cylinder' or 'curves'.")
        .def_prop_rw(
            "material",
            [](const ShapeRef& r) -> nb::object {
                if (r.value().material == no_index) return nb::none();
                return as_python(Slot<Material>(r.scene(), r.value().material));
            },
            [](ShapeRef& r, const nb::object& given) {
                const Index i = material_index(r.scene(), given, "Shape.material");
                r.change([&](Shape& s) { s.material = i; });
            },
            "The material; one that is not of the scene is added to it.")
        .def_prop_rw(
            "light", &light_of, [](ShapeRef& r, const nb::object& e) { set_light(r.scene(), r.first(), e); },
            nb::for_setter(nb::arg("emission").none()),
            "The AreaLight of all its primitives, or None; set an AreaLight, a spectrum or None.")
        .def_prop_ro(
            "positions", [](const ShapeRef& r) { return positions_of(r, &TriangleMesh::positions); },
            "Vertices of a mesh, shape (n, 3); else None.")
        .def_prop_ro(
            "end_positions", [](const ShapeRef& r) { return positions_of(r, &TriangleMesh::end_positions); },
            "Those at the end of the motion, of a mesh that deforms; else None.")
        .def(
            "__eq__",
            [](const ShapeRef& a, nb::handle b) {
                return nb::isinstance<ShapeRef>(b) && a.same_place(nb::cast<const ShapeRef&>(b));
            },
            nb::arg("other").none())
        .def("__hash__", [](const ShapeRef& a) { return static_cast<std::int64_t>(a.first()); })
        .def("__repr__", [](const ShapeRef& r) { return "<Shape: " + kind_of(r) + ">"; });
    flag(c, "flip_normal", &Shape::flip_normal, "Whether the side that shines is turned around.");
    attribute<Shape>(
        c, "alpha", "typing.Any",
        [](const Shape& s, const ShapeRef& r) { return number_or_texture(s.alpha, r.scene()); },
        [](Shape& s, nb::handle v, ShapeRef& r, const std::string& what) {
            s.alpha = float_parameter_of(v, r, what);
        },
        "Cut-out: the probability that a point is present; a number or a texture.");
}

} // namespace montelux::python
