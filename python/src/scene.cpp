#include "python/src/bindings.h"
#include "python/src/images.h"
#include "python/src/scene_lists.h"
#include "python/src/scene_object.h"
#include "python/src/scene_textures.h"
#include "python/src/scene_values.h"
#include "python/src/shapes.h"
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "montelux/formats/load_scene.h"
#include "montelux/formats/pbrt/load_pbrt.h"
#include "montelux/formats/studio.h"
#include "montelux/image/texel_file.h"
#include "montelux/scene/build/scene_builder.h"

namespace montelux::python {
namespace {

void take(SceneObject& s, SceneDescription description, const Warnings& warnings, std::string name) {
    s.holder->description = std::make_shared<SceneDescription>(std::move(description));
    s.holder->has_camera = true;
    s.holder->name = std::move(name);
    s.holder->warnings = warnings.messages();
}

std::shared_ptr<TexelFile> texel_file(std::optional<std::size_t> texture_memory) {
    return texture_memory ? TexelFile::create(*texture_memory) : nullptr;
}

nb::object add_environment(const SceneObject& s, const nb::object& image, double scale,
                           const nb::object& world_from_light) {
    const Image map = light_map(image, "add_environment");
    const EnvironmentLayout layout = map_layout("auto", map, "add_environment");
    if (!not_negative(scale)) throw Error("add_environment, scale", "expected a number that is not negative");
    ImageInfiniteLight light;
    light.layout = layout;
    light.scale = static_cast<float>(scale) *
                  photometric_scale(Spectrum(RgbColorSpace::srgb().illuminant()), "add_environment");
    light.world_from_light = transform_of(world_from_light, "add_environment, world_from_light");
    CallMessages messages("add_environment", &s.holder->warnings);
    SceneBuilder builder(s.holder->edit().scene, messages);
    light.environment = builder.add_environment(map, "the map");
    return as_python(Slot<Light>(s.holder, builder.add_light(light)));
}

// Texts as of the program's options.
StudioSettings studio_settings(std::optional<std::string> environment,
                               const std::optional<std::string>& orbit, std::optional<bool> ground,
                               const std::optional<std::string>& background) {
    StudioSettings settings;
    settings.environment = std::move(environment);
    settings.ground = ground;
    const auto refuse = [](const char* name, const std::string& given, std::string_view syntax) {
        throw Error(std::string("montelux.load, ") + name,
                    "'" + given + "' was given; expected " + std::string(syntax));
    };
    if (orbit && !(settings.orbit = parse_orbit(*orbit))) refuse("orbit", *orbit, orbit_syntax);
    if (background && !(settings.background = parse_background(*background)))
        refuse("background", *background, background_syntax);
    return settings;
}

} // namespace

void bind_scene(nb::module_& m) {
    nb::class_<SceneObject> c(m, "SceneBase", "What montelux.Scene is made of.");
    c.def(
         "__init__",
         [](SceneObject* s, std::optional<std::size_t> texture_memory) {
             std::shared_ptr<TexelFile> file = texel_file(texture_memory);
             new (s) SceneObject;
             s->holder->edit().scene.texel_file = std::move(file);
         },
         nb::kw_only(), "texture_memory"_a.none() = nb::none())
        .def(
            "_load",
            [](SceneObject& s, const std::filesystem::path& path, std::optional<std::size_t> texture_memory,
               std::optional<std::string> environment, const std::optional<std::string>& orbit,
               std::optional<bool> ground, const std::optional<std::string>& background,
               const std::optional<std::string>& camera, const std::optional<std::string>& variant,
               std::optional<double> time, double shutter,
               const std::map<std::string, std::string>& definitions) {
                Warnings warnings;
                SceneDescription d;
                {
                    nb::gil_scoped_release unlocked;
                    const StudioSettings studio =
                        studio_settings(std::move(environment), orbit, ground, background);
                    d = load_scene(path, warnings,
                                   {.texel_file = texel_file(texture_memory),
                                    .camera = camera,
                                    .variant = variant,
                                    .time = time,
                                    .definitions = definitions,
                                    .shutter = shutter});
                    DiskFiles files;
                    add_studio(d, studio, files, warnings);
                }
                take(s, std::move(d), warnings, path.filename().string());
            },
            "path"_a, "texture_memory"_a.none(), "environment"_a.none(), "orbit"_a.none(), "ground"_a.none(),
            "background"_a.none(), "camera"_a.none(), "variant"_a.none(), "time"_a.none(), "shutter"_a,
            "definitions"_a)
        .def(
            "_parse",
            [](SceneObject& s, const std::string& text, const std::string& name,
               const std::filesystem::path& folder, std::optional<std::size_t> texture_memory) {
                Warnings warnings;
                SceneDescription d;
                {
                    nb::gil_scoped_release unlocked;
                    d = parse_pbrt(text, name, folder, warnings, texel_file(texture_memory));
                }
                take(s, std::move(d), warnings, name);
            },
            "text"_a, "name"_a, "folder"_a, "texture_memory"_a.none())
        .def_prop_rw(
            "name", [](const SceneObject& s) { return s.holder->name; },
            [](SceneObject& s, const std::string& name) { s.holder->name = name; },
            "Its name, in files and messages.")
        .def_prop_ro(
            "texture_memory",
            [](const SceneObject& s) {
                const std::shared_ptr<TexelFile>& file = s.holder->read().scene.texel_file;
                return file ? std::optional(file->limit()) : std::nullopt;
            },
            "About this many bytes of the image textures are in memory, the others in a temporary file; "
            "None: "
            "all are in memory. An argument of Scene, montelux.load and montelux.parse.")
        .def_prop_ro(
            "warnings", [](const SceneObject& s) { return s.holder->warnings; },
            "Warnings about ignored features of the file, as sentences.")
        .def_prop_rw(
            "camera",
            [](const SceneObject& s) {
                return s.holder->has_camera ? as_python(Slot<CameraSettings>(s.holder)) : nb::none();
            },
            [](SceneObject& s, const nb::object& o) {
                const Slot<CameraSettings>* given = camera_slot(o);
                if (!given)
                    throw Error("Scene.camera",
                                std::string(nb::repr(o).c_str()) +
                                    " was given; expected a camera, such as PerspectiveCamera()");
                const CameraSettings settings = given->read();
                s.holder->edit().scene.camera = settings;
                s.holder->has_camera = true;
            },
            nb::for_setter(nb::arg("camera").none()), "The camera; None where there is none yet.")
        .def_prop_rw(
            "film", [](const SceneObject& s) { return Ref<FilmSettings>(Slot<FilmSettings>(s.holder)); },
            [](SceneObject& s, const Ref<FilmSettings>& film) {
                const FilmSettings settings = film.value();
                s.holder->edit().film = settings;
            },
            "Resolution, crop, pixel filter and sensor.")
        .def_prop_ro(
            "sampler",
            [](const SceneObject& s) { return Ref<SamplerSettings>(Slot<SamplerSettings>(s.holder)); },
            "Which points the samples are drawn from.")
        .def_prop_ro(
            "integrator",
            [](const SceneObject& s) { return Ref<IntegratorSettings>(Slot<IntegratorSettings>(s.holder)); },
            "How light is followed.")
        .def_prop_ro(
            "materials", [](const SceneObject& s) { return MaterialList{s.holder}; }, "The materials.")
        .def_prop_ro(
            "lights", [](const SceneObject& s) { return LightList{s.holder}; },
            "The lights; those of one shape are one AreaLight.")
        .def_prop_ro(
            "shapes", [](const SceneObject& s) { return ShapeList{s.holder}; }, "The shapes.")
        .def(
            "add_mesh",
            [](const SceneObject& s, const nb::object& positions, const nb::object& triangles,
               const nb::object& material, const nb::object& normals, const nb::object& uvs,
               const nb::object& end_positions, const nb::object& end_normals, const nb::object& transform,
               const nb::object& light) {
                return add_mesh(s.holder, positions, triangles, material,
                                {normals, uvs, end_positions, end_normals, transform, light});
            },
            "positions"_a, "triangles"_a, "material"_a, nb::kw_only(), "normals"_a = nb::none(),
            "uvs"_a = nb::none(), "end_positions"_a = nb::none(), "end_normals"_a = nb::none(),
            "transform"_a = nb::none(), "light"_a = nb::none(),
            "Triangles: positions of shape (n, 3), triangles of shape (m, 3) indices into them; normals (n, "
            "3) and uvs (n, 2) are one per position. end_positions: of a mesh that deforms while the shutter "
            "is open, from positions (at time 0) on straight lines; end_normals with them, if normals are "
            "given. transform: a matrix of shape (4, 4). light: an AreaLight or a "
            "spectrum. Returns the Shape.")
        .def(
            "add_sphere",
            [](const SceneObject& s, double radius, const nb::object& material, const nb::object& centre,
               const nb::object& transform, const nb::object& light) {
                return add_sphere(s.holder, radius, centre, material, transform, light);
            },
            "radius"_a, "material"_a, nb::kw_only(), "centre"_a = nb::make_tuple(0, 0, 0),
            "transform"_a = nb::none(), "light"_a = nb::none(), "A sphere; see add_mesh.")
        .def(
            "add_disk",
            [](const SceneObject& s, double radius, const nb::object& material, double inner_radius,
               double height, const nb::object& transform, const nb::object& light) {
                return add_disk(s.holder, radius, inner_radius, height, material, transform, light);
            },
            "radius"_a, "material"_a, nb::kw_only(), "inner_radius"_a = 0., "height"_a = 0.,
            "transform"_a = nb::none(), "light"_a = nb::none(),
            "The points of the plane z = height between two radii; its front is +z. See add_mesh.")
        .def(
            "add_cylinder",
            [](const SceneObject& s, double radius, const nb::object& material, double z_min, double z_max,
               const nb::object& transform, const nb::object& light) {
                return add_cylinder(s.holder, radius, z_min, z_max, material, transform, light);
            },
            "radius"_a, "material"_a, nb::kw_only(), "z_min"_a = -1., "z_max"_a = 1.,
            "transform"_a = nb::none(), "light"_a = nb::none(),
            "An open cylinder around the z axis; its front is outside. See add_mesh.")
        .def(
            "add_curves",
            [](const SceneObject& s, const nb::object& points, const nb::object& width,
               const nb::object& material, const std::string& kind, const std::string& basis, int degree,
               const nb::object& normals, const nb::object& transform) {
                return add_curves(s.holder, points, width, material, kind, basis, degree, normals, transform);
            },
            "points"_a, "width"_a, "material"_a, nb::kw_only(), "kind"_a = "flat", "basis"_a = "bezier",
            "degree"_a = 3, "normals"_a = nb::none(), "transform"_a = nb::none(),
            "Hair, fur, grass: strands of control points, an array of shape (strands, n, 3), with a width or "
            "one for each end. kind: 'flat' faces each ray, 'cylinder' is shaded as one, 'tube' has "
            "Mitsuba's texture coordinates, too, 'ribbon' faces its "
            "normals, of shape (strands, segments + 1, 3). basis: 'bezier' or 'bspline', of degree 2 or 3. "
            "See "
            "add_mesh.")
        .def("add_environment", &add_environment, "image"_a, nb::kw_only(), "scale"_a = 1.,
             "world_from_light"_a = nb::none(),
             "Light from everywhere, by a map, square (equal-area) or twice as wide as high "
             "(latitude-longitude): a "
             "file, or an array of shape (n, n, 3) or (n, 2 n, 3), "
             "linear "
             "sRGB. Returns the EnvironmentLight.")
        .def("image_texture", &image_texture, "image"_a, nb::kw_only(), "filter"_a = "bilinear",
             "wrap"_a = "repeat", "scale"_a = 1., "invert"_a = false,
             "uv"_a = std::vector<double>{1, 1, 0, 0}, "as_float"_a = false,
             "A texture of a picture: a file, or an array of shape (h, w, 3) or (h, w), linear numbers or "
             "uint8 in "
             "sRGB. uv: su, sv, du, dv of (s, t) = (su u + du, sv v + dv). as_float: of numbers, for "
             "roughnesses, bumps and "
             "cut-outs.")
        .def("normal_map", &normal_map, "image"_a, nb::kw_only(), "filter"_a = "bilinear",
             "wrap"_a = "repeat", "uv"_a = std::vector<double>{1, 1, 0, 0},
             "Shading normals of a picture whose R, G, B are (n + 1) / 2 along dp/du, dp/dv and the normal, "
             "linear whatever the file says; for the normal_map of materials. See image_texture.")
        .def("measured_brdf", &measured_brdf, "path"_a,
             "Measurements of a surface in the format of Dupuy and Jakob's database (.bsdf), for the "
             "material Measured.")
        .def("checkerboard_texture", &checkerboard, "a"_a, "b"_a, "su"_a = 1., "sv"_a = 1.,
             "Unit cells of two colours in (su u, sv v).");
}

} // namespace montelux::python
