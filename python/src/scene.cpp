#include "python/src/bindings.h"
#include "python/src/images.h"
#include "python/src/scene_object.h"
#include "python/src/scene_values.h"
#include "python/src/shapes.h"
#include <algorithm>
#include <set>

#include "montelux/formats/load_scene.h"
#include "montelux/formats/measured_brdf_file.h"
#include "montelux/formats/pbrt/load_pbrt.h"
#include "montelux/image/image_read.h"
#include "montelux/image/texel_file.h"
#include "montelux/mc/math/overloaded.h"
#include "montelux/scene/build/scene_builder.h"

namespace montelux::python {
namespace {

// A list of slots of a scene, as Python sees it. Lights of one shape are one entry.
struct MaterialList {
    SceneRef scene;
};
struct LightList {
    SceneRef scene;
};
struct ShapeList {
    SceneRef scene;
};

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
        throw Error("lights", "a GoniometricLight or ProjectionLight refers to a picture of its scene file");
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
                   [&](const SunLight&) { refuse_sky(); }, [](const PointLight&) {}, [](const SpotLight&) {},
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

void bind_lists(nb::module_& m) {
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

void take(SceneObject& s, SceneDescription description, const Warnings& warnings, std::string name) {
    s.holder->description = std::make_shared<SceneDescription>(std::move(description));
    s.holder->has_camera = true;
    s.holder->name = std::move(name);
    s.holder->warnings = warnings.messages();
}

std::shared_ptr<TexelFile> texel_file(std::optional<std::size_t> texture_memory) {
    return texture_memory ? TexelFile::create(*texture_memory) : nullptr;
}

ImageTexture texture_of(const std::string& filter, const std::string& wrap, const std::vector<double>& uv,
                        const std::string& what) {
    ImageTexture t;
    const std::vector<std::pair<std::string, TextureFilter>> filters{{"point", TextureFilter::point},
                                                                     {"bilinear", TextureFilter::bilinear},
                                                                     {"trilinear", TextureFilter::trilinear},
                                                                     {"ewa", TextureFilter::ewa}};
    const std::vector<std::pair<std::string, TextureWrap>> wraps{
        {"repeat", TextureWrap::repeat}, {"black", TextureWrap::black}, {"clamp", TextureWrap::clamp}};
    auto pick = [&](const auto& table, const std::string& name, const char* kind) {
        for (const auto& [text, value] : table)
            if (text == name) return value;
        throw Error(what, "there is no " + std::string(kind) + " '" + name + "'");
    };
    t.filter = pick(filters, filter, "filter");
    t.wrap = pick(wraps, wrap, "wrap");
    if (uv.size() != 4) throw Error(what + ", uv", "expected four numbers: su, sv, du, dv");
    t.mapping.su = static_cast<float>(uv[0]);
    t.mapping.sv = static_cast<float>(uv[1]);
    t.mapping.du = static_cast<float>(uv[2]);
    t.mapping.dv = static_cast<float>(uv[3]);
    return t;
}

nb::object image_texture(const SceneObject& s, const nb::object& image, const std::string& filter,
                         const std::string& wrap, double scale, bool invert, const std::vector<double>& uv,
                         bool as_float) {
    ImageTexture t = texture_of(filter, wrap, uv, "image_texture");
    if (!(scale >= 0 && std::isfinite(scale)))
        throw Error("image_texture, scale", "expected a number that is not negative");
    t.scale = static_cast<float>(scale);
    t.invert = invert;
    Image picture = picture_of(image, "image_texture");
    Scene& now = s.holder->edit().scene;
    CallMessages messages("image_texture", &s.holder->warnings);
    t.image = SceneBuilder(now, messages).add_image(std::move(picture), "the picture");
    if (as_float) {
        now.float_textures.emplace_back(t);
        return nb::cast(FloatTextureHandle{s.holder, static_cast<Index>(now.float_textures.size() - 1)});
    }
    now.spectrum_textures.emplace_back(t);
    return nb::cast(SpectrumTextureHandle{s.holder, static_cast<Index>(now.spectrum_textures.size() - 1)});
}

NormalMapHandle normal_map(const SceneObject& s, const nb::object& image, const std::string& filter,
                           const std::string& wrap, const std::vector<double>& uv) {
    ImageTexture t = texture_of(filter, wrap, uv, "normal_map");
    Image picture = picture_of(image, "normal_map");
    if (picture.color_channels().size() != 3)
        throw Error("normal_map", "the picture has no channels R, G and B");
    if (picture.format() == PixelFormat::u8 || picture.format() == PixelFormat::u16)
        picture.set_encoding(ColorEncoding::linear());
    CallMessages messages("normal_map", &s.holder->warnings);
    t.image = SceneBuilder(s.holder->edit().scene, messages).add_image(std::move(picture), "the picture");
    std::vector<ImageTexture>& all = s.holder->edit().scene.normal_maps;
    all.push_back(t);
    return {s.holder, static_cast<Index>(all.size() - 1)};
}

MeasuredBrdfHandle measured_brdf(const SceneObject& s, const std::filesystem::path& path) {
    DiskFiles disk;
    const std::vector<std::uint8_t> bytes = read_unpacked(disk, path);
    std::vector<MeasuredBrdf>& all = s.holder->edit().scene.measured_brdfs;
    all.push_back(read_measured_brdf(bytes, path.string()));
    return {s.holder, static_cast<Index>(all.size() - 1)};
}

SpectrumTextureHandle checkerboard(const SceneObject& s, const nb::object& a, const nb::object& b, double su,
                                   double sv) {
    const Spectrum first = spectrum_of(a, RgbMeaning::albedo, "checkerboard_texture"),
                   second = spectrum_of(b, RgbMeaning::albedo, "checkerboard_texture");
    Scene& scene = s.holder->edit().scene;
    CheckerboardTexture<SpectrumParameter> t;
    t.values = {SpectrumParameter{add_spectrum(scene, first)},
                SpectrumParameter{add_spectrum(scene, second)}};
    t.mapping.su = static_cast<float>(su);
    t.mapping.sv = static_cast<float>(sv);
    std::vector<SpectrumTexture>& all = scene.spectrum_textures;
    all.emplace_back(t);
    return {s.holder, static_cast<Index>(all.size() - 1)};
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

} // namespace

void bind_scene(nb::module_& m) {
    nb::class_<SpectrumTextureHandle>(m, "SpectrumTexture", "A texture of colours, of one scene.")
        .def("__repr__", [](const SpectrumTextureHandle& t) {
            return "<SpectrumTexture " + std::to_string(t.index) + ">";
        });
    nb::class_<FloatTextureHandle>(m, "FloatTexture", "A texture of numbers, of one scene.")
        .def("__repr__",
             [](const FloatTextureHandle& t) { return "<FloatTexture " + std::to_string(t.index) + ">"; });
    nb::class_<NormalMapHandle>(m, "NormalMap", "Shading normals over surfaces, of one scene.")
        .def("__repr__",
             [](const NormalMapHandle& t) { return "<NormalMap " + std::to_string(t.index) + ">"; });
    nb::class_<MeasuredBrdfHandle>(m, "MeasuredBrdf", "The measurements of a surface, of one scene.")
        .def("__repr__",
             [](const MeasuredBrdfHandle& b) { return "<MeasuredBrdf " + std::to_string(b.index) + ">"; });
    bind_lists(m);
    nb::class_<SceneObject> c(m, "SceneBase", "What montelux.Scene is made of.");
    c.def(nb::init<>())
        .def(
            "_load",
            [](SceneObject& s, const std::filesystem::path& path, std::optional<std::size_t> texture_memory) {
                Warnings warnings;
                SceneDescription d;
                {
                    nb::gil_scoped_release unlocked;
                    d = load_scene(path, warnings, nullptr, nullptr, texel_file(texture_memory));
                }
                take(s, std::move(d), warnings, path.filename().string());
            },
            "path"_a, "texture_memory"_a.none())
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
            "given. transform: a matrix of shape (4, 4). light: an AreaLight or a spectrum. Returns the Shape.")
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
            "one for each end. kind: 'flat' faces each ray, 'cylinder' is shaded as one, 'ribbon' faces its "
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
