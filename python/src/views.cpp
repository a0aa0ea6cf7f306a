#include "python/src/bindings.h"
#include "python/src/names.h"
#include "python/src/scene_values.h"
#include <algorithm>
#include <string>

#include "montelux/image/image.h"
#include "montelux/mc/math/nearest_name.h"
#include "montelux/scene/setting_names.h"
#include "montelux/spectrum/camera_sensors.h"

namespace montelux::python {
namespace {

constexpr Names<SamplerKind, 6> sampler_kinds{"sampler", sampler_names};
constexpr Names<LightSampling, 3> light_samplings{"light_sampling", light_sampling_names};
constexpr Names<MicrofacetScattering, 2> microfacet_scatterings{"microfacet_scattering",
                                                                microfacet_scattering_names};
constexpr Names<ShadingTerminator, 2> shading_terminators{"shading_terminator", shading_terminator_names};
constexpr Names<Strategy, 6> strategies{"strategy", strategy_names};
constexpr Names<Heuristic, 2> heuristics{"heuristic", heuristic_names};
constexpr Names<EnvironmentSampling, 4> environment_samplings{"environment_sampling",
                                                              environment_sampling_names};
constexpr Names<EnvironmentLookup, 2> environment_lookups{"environment_lookup", environment_lookup_names};
constexpr Names<SphericalCamera::Mapping, 2> mappings{
    "mapping",
    {{{"equal_area", SphericalCamera::Mapping::equal_area},
      {"equirectangular", SphericalCamera::Mapping::equirectangular}}}};

template <typename T, typename M, typename Table>
void choice(nb::class_<Ref<T>>& c, const char* name, M T::*member, const Table& table, const char* doc) {
    attribute<T>(
        c, name, "str",
        [member, &table](const T& t, const auto&) {
            const std::string_view text = table.name(t.*member);
            return nb::str(text.data(), text.size());
        },
        [member, &table](T& t, nb::handle v, auto&, const std::string& what) {
            if (!nb::isinstance<nb::str>(v))
                throw Error(what, std::string(nb::repr(v).c_str()) + " was given; expected a name");
            t.*member = table.value(nb::cast<std::string>(v));
        },
        doc);
}

nb::object floats(std::initializer_list<float> values) {
    nb::list l;
    for (const float v : values) l.append(static_cast<double>(v));
    return nb::tuple(l);
}

// Common to all cameras.
template <typename T>
void placed(nb::class_<Ref<T>>& c) {
    c.def_prop_rw(
         "world_from_camera", [](const Ref<T>& r) { return matrix_array(r.read().world_from_camera); },
         [](Ref<T>& r, const nb::object& m) {
             const Transform t = transform_of(m, "camera.world_from_camera");
             r.edit([&](CameraSettings& s) { s.world_from_camera = t; });
         },
         "Where the camera is, shape (4, 4): camera space has x to the right, y up and z forward.")
        .def(
            "look_at",
            [](Ref<T>& r, const nb::object& eye, const nb::object& target, const nb::object& up) {
                auto vector = [](const nb::object& v, const char* what) {
                    const std::vector<double> x = numbers_of(v, 3, what);
                    return Vec3d{x[0], x[1], x[2]};
                };
                const auto t =
                    Transform::look_at(vector(eye, "look_at, eye"), vector(target, "look_at, target"),
                                       vector(up, "look_at, up"));
                if (!t)
                    throw Error("look_at",
                                "eye, target and up span no frame: the target is the eye, or lies along up");
                r.edit([&](CameraSettings& s) { s.world_from_camera = t->inverse(); });
            },
            "eye"_a, "target"_a, "up"_a = nb::make_tuple(0, 0, 1),
            "Stands at eye, looks at target, up is near up.");
}
template <typename T>
void projective(nb::class_<Ref<T>>& c) {
    placed(c);
    number(c, "lens_radius", &T::lens_radius, not_negative, "a number that is not negative",
           "0 is a pinhole.");
    number(c, "focal_distance", &T::focal_distance, positive, "a number above zero",
           "Where points are sharp.");
    attribute<T>(
        c, "frame_aspect_ratio", "float | None",
        [](const T& t, const auto&) -> nb::object {
            return t.frame_aspect_ratio ? nb::object(nb::float_(static_cast<double>(*t.frame_aspect_ratio)))
                                        : nb::none();
        },
        [](T& t, nb::handle v, auto&, const std::string& what) {
            t.frame_aspect_ratio.reset();
            if (v.is_none()) return;
            const double x = number_of(v, what);
            if (!positive(x)) throw Error(what, "expected a number above zero, or None");
            t.frame_aspect_ratio = static_cast<float>(x);
        },
        "Width over height, where it is not the film's; else None.");
    attribute<T>(
        c, "screen_window", "tuple[float, float, float, float] | None",
        [](const T& t, const auto&) -> nb::object {
            if (!t.screen_window) return nb::none();
            const ScreenWindow& w = *t.screen_window;
            return floats({w.x_min, w.x_max, w.y_min, w.y_max});
        },
        [](T& t, nb::handle v, auto&, const std::string& what) {
            t.screen_window.reset();
            if (v.is_none()) return;
            const std::vector<double> w = numbers_of(v, 4, what);
            if (w[0] == w[1] || w[2] == w[3]) throw Error(what, "the window has no area");
            t.screen_window = ScreenWindow{static_cast<float>(w[0]), static_cast<float>(w[1]),
                                           static_cast<float>(w[2]), static_cast<float>(w[3])};
        },
        "x_min, x_max, y_min, y_max of the part of the plane z = 1 that the film covers; or None.");
}

void set_resolution(FilmSettings& f, std::int64_t w, std::int64_t h) {
    // The crop keeps its place on the film.
    auto scaled = [](int v, int from, std::int64_t to) {
        return static_cast<int>(std::int64_t{v} * to / from);
    };
    PixelBounds b{scaled(f.crop.x0, f.width, w), scaled(f.crop.y0, f.height, h),
                  scaled(f.crop.x1, f.width, w), scaled(f.crop.y1, f.height, h)};
    b.x1 = std::max(b.x1, b.x0 + 1);
    b.y1 = std::max(b.y1, b.y0 + 1);
    f.crop = b;
    f.width = static_cast<int>(w);
    f.height = static_cast<int>(h);
}

void bind_film(nb::module_& m) {
    auto c = value_class<FilmSettings>(m, "Film", "Resolution, crop, pixel filter and sensor.");
    attribute<FilmSettings>(
        c, "resolution", "tuple[int, int]",
        [](const FilmSettings& f, const auto&) { return nb::make_tuple(f.width, f.height); },
        [](FilmSettings& f, nb::handle v, auto&, const std::string& what) {
            const std::vector<double> r = numbers_of(v, 2, what);
            for (const double n : r)
                if (!(n >= 1 && n <= Image::max_dimension && n == std::floor(n)))
                    throw Error(what, std::string(nb::repr(v).c_str()) +
                                          " was given; expected two whole numbers from 1 to " +
                                          std::to_string(Image::max_dimension));
            set_resolution(f, static_cast<std::int64_t>(r[0]), static_cast<std::int64_t>(r[1]));
        },
        "Width and height in pixels; a crop keeps its place.");
    auto side = [&](const char* name, int FilmSettings::*member, bool width, const char* doc) {
        attribute<FilmSettings>(
            c, name, "int", [member](const FilmSettings& f, const auto&) { return nb::int_(f.*member); },
            [width](FilmSettings& f, nb::handle v, auto&, const std::string& what) {
                const std::int64_t n = whole_number_of(v, 1, Image::max_dimension, what);
                set_resolution(f, width ? n : f.width, width ? f.height : n);
            },
            doc);
    };
    side("width", &FilmSettings::width, true, "Pixels of a row of the whole film.");
    side("height", &FilmSettings::height, false, "Rows of the whole film.");
    attribute<FilmSettings>(
        c, "crop", "tuple[int, int, int, int]",
        [](const FilmSettings& f, const auto&) {
            return nb::make_tuple(f.crop.x0, f.crop.y0, f.crop.x1, f.crop.y1);
        },
        [](FilmSettings& f, nb::handle v, auto&, const std::string& what) {
            const std::vector<double> b = numbers_of(v, 4, what);
            if (!(b[0] >= 0 && b[0] < b[2] && b[2] <= f.width && b[1] >= 0 && b[1] < b[3] &&
                  b[3] <= f.height))
                throw Error(what,
                            "expected pixels x0, y0, x1, y1 with 0 <= x0 < x1 <= " + std::to_string(f.width) +
                                " and 0 <= y0 < y1 <= " + std::to_string(f.height));
            f.crop = {static_cast<int>(b[0]), static_cast<int>(b[1]), static_cast<int>(b[2]),
                      static_cast<int>(b[3])};
        },
        "The pixels that are rendered: x0, y0, x1, y1 from the top left, the last two exclusive.");
    number(c, "iso", &FilmSettings::iso, positive, "a number above zero",
           "Sensitivity; 100 leaves values as they are.");
    number(c, "exposure_time", &FilmSettings::exposure_time, positive, "a number above zero", "Seconds.");
    number(c, "white_balance", &FilmSettings::white_balance, not_negative, "a number that is not negative",
           "Kelvin of the light that is to look white; 0: none, or 6500 K for a camera's sensor.");
    attribute<FilmSettings>(
        c, "sensor", "str", [](const FilmSettings& f, const auto&) { return nb::str(f.sensor.c_str()); },
        [](FilmSettings& f, nb::handle v, auto&, const std::string& what) {
            if (!nb::isinstance<nb::str>(v))
                throw Error(what, std::string(nb::repr(v).c_str()) + " was given; expected a name");
            const auto name = nb::cast<std::string>(v);
            const std::vector<std::string_view>& names = sensor_names();
            if (std::find(names.begin(), names.end(), name) == names.end())
                throw Error(what, "unknown sensor '" + name + "'" + did_you_mean(name, names));
            f.sensor = name;
        },
        "The sensor by its name in pbrt-v4, such as \"nikon_d850\"; \"cie1931\" is the standard observer.");
    number(
        c, "max_component_value", &FilmSettings::max_component_value, [](double x) { return x > 0; },
        "a number above zero", "Largest RGB value of a sample; infinite: none.");
    attribute<FilmSettings>(
        c, "layers", "str",
        [](const FilmSettings& f, const auto&) { return nb::cast(text_of(f.layers.set)); },
        [](FilmSettings& f, nb::handle v, auto&, const std::string& what) {
            std::string list;
            if (!nb::try_cast(v, list))
                throw Error(what,
                            std::string(nb::repr(v).c_str()) + " was given; expected names with commas");
            try {
                f.layers.set = parse_layers(list);
            } catch (const Error& e) {
                throw Error(what, e.what());
            }
        },
        "Names of the layers of a picture with commas, as of `montelux render --layers`: "
        "'default,position'.");
    auto flag = [&](const char* name, bool LayerSettings::*member, const char* doc) {
        attribute<FilmSettings>(
            c, name, "bool",
            [member](const FilmSettings& f, const auto&) { return nb::cast(f.layers.*member); },
            [member](FilmSettings& f, nb::handle v, auto&, const std::string& what) {
                if (!nb::isinstance<nb::bool_>(v))
                    throw Error(what,
                                std::string(nb::repr(v).c_str()) + " was given; expected True or False");
                f.layers.*member = nb::cast<bool>(v);
            },
            doc);
    };
    flag("layers_in_camera_space", &LayerSettings::in_camera_space,
         "Positions and normals of the layers are those of the camera, not of the world.");
    flag("half", &LayerSettings::half, "EXR files hold 16-bit floats where those suffice.");
    c.def_prop_rw(
        "filter",
        [](const Ref<FilmSettings>& r) {
            return r.scene() ? as_python(Slot<PixelFilter>(r.scene()))
                             : as_python(Slot<PixelFilter>(r.read().filter));
        },
        [](Ref<FilmSettings>& r, const nb::object& o) {
            const Slot<PixelFilter>* given = filter_slot(o);
            if (!given) throw Error("Film.filter", "expected a pixel filter, such as GaussianFilter()");
            const PixelFilter filter = given->read();
            r.edit([&](FilmSettings& f) { f.filter = filter; });
        },
        "The pixel filter.");
}

} // namespace

void bind_views(nb::module_& m) {
    auto perspective = value_class<PerspectiveCamera>(m, "PerspectiveCamera", "A pinhole or thin lens.");
    projective(perspective);
    number(
        perspective, "fov", &PerspectiveCamera::fov, [](double x) { return x > 0 && x < 180; },
        "an angle between 0 and 180 degrees", "Field of view in degrees, over the shorter axis.");
    auto orthographic = value_class<OrthographicCamera>(m, "OrthographicCamera", "Parallel rays.");
    projective(orthographic);
    auto spherical = value_class<SphericalCamera>(m, "SphericalCamera", "Every direction.");
    placed(spherical);
    choice(spherical, "mapping", &SphericalCamera::mapping, mappings, "'equal_area' or 'equirectangular'.");
    auto realistic = value_class<RealisticCamera>(
        m, "RealisticCamera", "A lens of spherical surfaces; lengths in metres. Pixels show irradiance.");
    placed(realistic);
    number(realistic, "focus_distance", &RealisticCamera::focus_distance, positive, "a number above zero",
           "Distance from the film at which points are sharp.");
    number(realistic, "film_diagonal", &RealisticCamera::film_diagonal, positive, "a number above zero",
           "Of the whole film.");
    attribute<RealisticCamera>(
        realistic, "surfaces", "list[tuple[float, float, float, float]]",
        [](const RealisticCamera& c, const auto&) {
            nb::list rows;
            for (const LensSurface& s : c.surfaces)
                rows.append(nb::make_tuple(s.radius, s.thickness, s.eta, s.aperture_radius));
            return nb::object(rows);
        },
        [](RealisticCamera& c, nb::handle v, auto&, const std::string& what) {
            std::vector<LensSurface> surfaces;
            for (const nb::handle row : v) {
                const std::vector<double> x = numbers_of(row, 4, what);
                surfaces.push_back({static_cast<float>(x[0]), static_cast<float>(x[1]),
                                    static_cast<float>(x[2]), static_cast<float>(x[3])});
            }
            c.surfaces = std::move(surfaces);
        },
        "From the scene to the film: radius of curvature (0: a stop; positive if the centre is on the film's "
        "side), "
        "thickness, index of refraction behind it, radius of the edge.");
    bind_film(m);
    auto sampler = value_class<SamplerSettings>(m, "Sampler", "Which points the samples are drawn from.");
    choice(sampler, "kind", &SamplerSettings::kind, sampler_kinds,
           "'independent', 'stratified', 'halton', 'hammersley', 'sobol' or 'sobol-blue-noise'.");
    attribute<SamplerSettings>(
        sampler, "seed", "int", [](const SamplerSettings& s, const auto&) { return nb::cast(s.seed); },
        [](SamplerSettings& s, nb::handle v, auto&, const std::string& what) {
            if (!nb::try_cast(v, s.seed))
                throw Error(what, std::string(nb::repr(v).c_str()) +
                                      " was given; expected a whole number in [0, 2**64)");
        },
        "Other seeds give other noise.");
    attribute<SamplerSettings>(
        sampler, "spp", "int", [](const SamplerSettings& s, const auto&) { return nb::cast(s.spp); },
        [](SamplerSettings& s, nb::handle v, auto&, const std::string& what) {
            s.spp = static_cast<std::uint32_t>(whole_number_of(v, 1, 1 << 30, what));
        },
        "Samples per pixel, unless render() is given a number.");
    auto integrator = value_class<IntegratorSettings>(m, "Integrator", "How light is followed.");
    attribute<IntegratorSettings>(
        integrator, "max_depth", "int",
        [](const IntegratorSettings& s, const auto&) { return nb::cast(s.max_depth); },
        [](IntegratorSettings& s, nb::handle v, auto&, const std::string& what) {
            s.max_depth = static_cast<int>(whole_number_of(v, 0, 1'000'000, what));
        },
        "Scattering events of a path at most.");
    choice(integrator, "strategy", &IntegratorSettings::strategy, strategies,
           "How the light at a vertex is found: 'uniform', 'bsdf', 'light' or 'mis'; 'mis-bsdf' and "
           "'mis-light' are the two terms that 'mis' is the sum of.");
    choice(integrator, "heuristic", &IntegratorSettings::heuristic, heuristics,
           "Weights of the strategy mis and its two terms: 'balance' or 'power'.");
    choice(integrator, "light_sampling", &IntegratorSettings::light_sampling, light_samplings,
           "How one light is chosen among many: by its importance for the point that is lit, in a 'tree'; in "
           "proportion to its 'power'; or 'uniform'.");
    choice(
        integrator, "environment_sampling", &IntegratorSettings::environment_sampling, environment_samplings,
        "How directions to environment maps are sampled: 'auto', 'tabulated', 'median-cut' or 'structured'.");
    flag(integrator, "equiangular", &IntegratorSettings::equiangular,
         "Where lights are sampled: in homogeneous media lamps are also looked for from points of the ray "
         "close to "
         "them.");
    flag(integrator, "environment_compensation", &IntegratorSettings::environment_compensation,
         "With the strategy mis and its terms, maps are not sampled where BSDFs find them as well.");
    choice(integrator, "environment_lookup", &IntegratorSettings::environment_lookup, environment_lookups,
           "What environment maps are between the centres of their texels: 'nearest' or 'bilinear'.");
    choice(integrator, "microfacet_scattering", &IntegratorSettings::microfacet_scattering,
           microfacet_scatterings,
           "Light that microfacets throw at one another: lost with 'single', followed with 'multiple'.");
    choice(integrator, "shading_terminator", &IntegratorSettings::shading_terminator, shading_terminators,
           "Coarse meshes with smooth normals are shadowed by their facets ('hard') or as the smooth surface "
           "that they "
           "stand for ('soft').");
}

} // namespace montelux::python
