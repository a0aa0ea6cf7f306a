#include "python/src/bindings.h"
#include "python/src/images.h"
#include "python/src/names.h"
#include "python/src/scene_values.h"
#include <array>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "montelux/scene/build/float_range.h"
#include "montelux/scene/camera/aperture_picture.h"
#include "montelux/scene/setting_names.h"
#include "montelux/scene/shape/motion.h"

namespace montelux::python {
namespace {

constexpr Names<SamplerKind, 6> sampler_kinds{"sampler", sampler_names};
constexpr Names<Guiding, 3> guidings{"guiding", guiding_names};
constexpr Names<LightSampling, 3> light_samplings{"light_sampling", light_sampling_names};
constexpr Names<MicrofacetScattering, 2> microfacet_scatterings{"microfacet_scattering",
                                                                microfacet_scattering_names};
constexpr Names<ShadingTerminator, 2> shading_terminators{"shading_terminator", shading_terminator_names};
constexpr Names<IntegratorKind, 5> integrator_kinds{"method", integrator_names};
constexpr Names<Strategy, 6> strategies{"strategy", strategy_names};
constexpr Names<Heuristic, 2> heuristics{"heuristic", heuristic_names};
constexpr Names<EnvironmentSampling, 4> environment_samplings{"environment_sampling",
                                                              environment_sampling_names};
constexpr Names<EnvironmentLookup, 2> environment_lookups{"environment_lookup", environment_lookup_names};
constexpr Names<SphericalCamera::Mapping, 2> mappings{
    "mapping",
    {{{"equal_area", SphericalCamera::Mapping::equal_area},
      {"equirectangular", SphericalCamera::Mapping::equirectangular}}}};

nb::object floats(std::initializer_list<float> values) {
    nb::list l;
    for (const float v : values) l.append(static_cast<double>(v));
    return nb::tuple(l);
}

// A camera that stands still.
void place(CameraSettings& s, const Transform& world_from_camera) {
    s.world_from_camera = world_from_camera;
    s.motion.reset();
}

// From where the camera is to the matrix `end`, which may be None.
std::optional<Motion> motion_to(const nb::object& end, const Transform& start) {
    if (end.is_none()) return std::nullopt;
    const std::string what = "camera.end_world_from_camera";
    const Transform t = transform_of(end, what);
    for (const Transform& of : {start, t})
        if (of.matrix().m[3] != std::array<double, 4>{0, 0, 0, 1} || !fits_float(of))
            throw Error(what, "a moving camera needs rotations, scales and translations; the last row of its "
                              "matrices is 0 0 0 1");
    try {
        return Motion(start, t);
    } catch (const Error& e) {
        throw Error(what, e.what());
    }
}

// Common to all cameras.
template <typename T>
void placed(nb::class_<Ref<T>>& c) {
    c.def_prop_rw(
         "world_from_camera", [](const Ref<T>& r) { return matrix_array(r.read().world_from_camera); },
         [](Ref<T>& r, const nb::object& m) {
             const Transform t = transform_of(m, "camera.world_from_camera");
             r.edit([&](CameraSettings& s) { place(s, t); });
         },
         "Where the camera is, shape (4, 4): camera space has x to the right, y up and z forward. Setting it "
         "makes "
         "a moving camera stand still.")
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
                r.edit([&](CameraSettings& s) { place(s, t->inverse()); });
            },
            "eye"_a, "target"_a, "up"_a = nb::make_tuple(0, 0, 1),
            "Stands at eye, looks at target, up is near up.")
        .def_prop_rw(
            "end_world_from_camera",
            [](const Ref<T>& r) -> nb::object {
                const std::optional<Motion>& motion = r.read().motion;
                return motion ? nb::object(matrix_array(motion->end())) : nb::none();
            },
            [](Ref<T>& r, const nb::object& m) {
                const std::optional<Motion> motion = motion_to(m, r.read().world_from_camera);
                r.edit([&](CameraSettings& s) { s.motion = motion; });
            },
            nb::for_setter(nb::arg("value").none()),
            "Of a camera that moves, where it is at time 1; world_from_camera is at time 0. None: it stands "
            "still.")
        .def_prop_rw(
            "shutter",
            [](const Ref<T>& r) {
                return floats({r.read().shutter_open, r.read().shutter_close});
            },
            [](Ref<T>& r, const nb::object& times) {
                const std::vector<double> t = numbers_of(times, 2, "camera.shutter");
                const auto open = static_cast<float>(t[0]), close = static_cast<float>(t[1]);
                if (!(open <= close && std::isfinite(open) && std::isfinite(close)))
                    throw Error("camera.shutter",
                                std::string(nb::repr(times).c_str()) +
                                    " was given; expected (open, close) with open <= close");
                r.edit([&](CameraSettings& s) {
                    s.shutter_open = open;
                    s.shutter_close = close;
                });
            },
            nb::for_getter(nb::sig("def shutter(self, /) -> tuple[float, float]")),
            nb::for_setter(nb::sig("def shutter(self, value: tuple[float, float], /) -> None")),
            "When it opens and closes, in the time of motions: all begin at 0 and end at 1. The exposure "
            "does not "
            "change; that is film.exposure_time.");
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

// The name of a shape, a file, or an array.
AperturePicture aperture_picture_of(nb::handle v, const std::string& what) {
    if (nb::isinstance<nb::str>(v)) {
        const auto name = nb::cast<std::string>(v);
        if (std::optional<AperturePicture> known = find_aperture(name)) return *std::move(known);
        std::error_code ignored;
        if (!std::filesystem::exists(name, ignored))
            throw Error(what, unknown_name(name, "shape or file", aperture_names()) + ", a file or an array");
    }
    const Image picture = picture_of(nb::borrow(v), what);
    try {
        return aperture_of(picture);
    } catch (const Error& e) {
        throw Error(what, e.what());
    }
}

void bind_aperture(nb::class_<Ref<RealisticCamera>>& c) {
    attribute<RealisticCamera>(
        c, "aperture", "typing.Any",
        [](const RealisticCamera& camera, const auto&) -> nb::object {
            if (!camera.aperture) return nb::none();
            const AperturePicture& a = *camera.aperture;
            return new_array(std::vector<double>(a.values.begin(), a.values.end()),
                             static_cast<std::size_t>(a.height), static_cast<std::size_t>(a.width));
        },
        [](RealisticCamera& camera, nb::handle v, auto&, const std::string& what) {
            camera.aperture.reset();
            if (!v.is_none()) camera.aperture = aperture_picture_of(v, what);
        },
        "What the stops let through: 'gaussian', 'square', 'pentagon', 'star', a picture file, or an array "
        "of "
        "shape (h, w) or (h, w, 3), over the square around the stop; None: they are round. Read, it is an "
        "array "
        "whose mean is that of the disc, pi / 4, so that the exposure stays.");
}

void bind_occlusion(nb::module_& m) {
    auto c = value_class<OcclusionSettings>(
        m, "Occlusion",
        "Ambient occlusion: the share of the hemisphere over the first surface that nothing hides; 1 is "
        "white. "
        "Lights, materials and media have no effect, and the background is black.");
    flag(c, "cosine", &OcclusionSettings::cosine,
         "Directions are sampled by their cosine; False: evenly, which changes the noise alone.");
    number(
        c, "max_distance", &OcclusionSettings::max_distance,
        [](double x) { return static_cast<float>(x) > 0; }, "a number above zero",
        "Shapes farther away hide nothing; infinite: all hide.");
}

void bind_merging(nb::module_& m) {
    auto c = value_class<MergingSettings>(
        m, "Merging",
        "Camera paths also end at the light paths that pass near them, which finds caustics in mirrors and "
        "under "
        "water. The picture is consistent, not unbiased: its errors cover noise alone.");
    number(
        c, "radius", &MergingSettings::radius, [](double x) { return x >= 0 && x < 1e30; },
        "a number from 0 on, in units of the scene",
        "How near, in the first pass; later ones come closer. 0: chosen by the size of a pixel.");
    attribute<MergingSettings>(
        c, "memory", "int", [](const MergingSettings& s, const auto&) { return nb::cast(s.memory); },
        [](MergingSettings& s, nb::handle v, auto&, const std::string& what) {
            s.memory = static_cast<std::size_t>(whole_number_of(v, 1, 1 << 20, what));
        },
        "MiB that the light paths of a pass may take; where it is too little, fewer of them merge.");
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
    number(orthographic, "scale", &OrthographicCamera::scale, positive, "a number above zero",
           "Half the height of the view, or half its width where that is shorter; times a screen_window.");
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
    bind_aperture(realistic);
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
    bind_occlusion(m);
    bind_merging(m);
    auto integrator = value_class<IntegratorSettings>(m, "Integrator", "How light is followed.");
    attribute<IntegratorSettings>(
        integrator, "max_depth", "int",
        [](const IntegratorSettings& s, const auto&) { return nb::cast(s.max_depth); },
        [](IntegratorSettings& s, nb::handle v, auto&, const std::string& what) {
            s.max_depth = static_cast<int>(whole_number_of(v, 0, 1'000'000, what));
        },
        "Scattering events of a path at most.");
    choice(integrator, "method", &IntegratorSettings::method, integrator_kinds,
           "How paths are found: from the camera ('path'), from the camera and from lights "
           "('bidirectional'), from lights alone ('light-tracing'), by Markov chains that stay near bright "
           "paths ('metropolis'), or as a pilot chooses ('auto').");
    number(
        integrator, "large_step_probability", &IntegratorSettings::large_step_probability,
        [](double x) { return x >= 0 && x <= 1; }, "a number from 0 to 1",
        "Of 'metropolis': share of the steps that start a path anew; 0: chosen by a pilot.");
    choice(integrator, "strategy", &IntegratorSettings::strategy, strategies,
           "How the light at a vertex is found: 'uniform', 'bsdf', 'light' or 'mis'; 'mis-bsdf' and "
           "'mis-light' are the two terms that 'mis' is the sum of.");
    choice(integrator, "heuristic", &IntegratorSettings::heuristic, heuristics,
           "Weights of the strategy mis and its two terms: 'balance' or 'power'.");
    choice(integrator, "light_sampling", &IntegratorSettings::light_sampling, light_samplings,
           "How one light is chosen among many: by its importance for the point that is lit, in a 'tree'; in "
           "proportion to its 'power'; or 'uniform'.");
    flag(integrator, "manifold_sampling", &IntegratorSettings::manifold_sampling,
         "Of 'path': caustics of single smooth mirrors and interfaces are found by specular manifold "
         "sampling; for small lamps.");
    choice(integrator, "guiding", &IntegratorSettings::guiding, guidings,
           "Whether paths learn where light comes from, and follow it: 'auto' (where that pays), 'on' or "
           "'off'.");
    attribute<IntegratorSettings>(
        integrator, "guiding_memory", "int",
        [](const IntegratorSettings& s, const auto&) { return nb::cast(s.guiding_memory); },
        [](IntegratorSettings& s, nb::handle v, auto&, const std::string& what) {
            s.guiding_memory = static_cast<std::size_t>(whole_number_of(v, 16, 1 << 20, what));
        },
        "MiB that learning may take.");
    choice(
        integrator, "environment_sampling", &IntegratorSettings::environment_sampling, environment_samplings,
        "How directions to environment maps are sampled: 'auto', 'tabulated', 'median-cut' or 'structured'.");
    flag(integrator, "regularize", &IntegratorSettings::regularize,
         "Widens the reflections of surfaces that a path meets after an event that was not specular: fewer "
         "fireflies, and a bias that standard errors do not contain.");
    flag(integrator, "count_passages", &IntegratorSettings::count_passages,
         "In scenes with media: a straight passage through a thin pane is one of the max_depth events.");
    flag(integrator, "equiangular", &IntegratorSettings::equiangular,
         "Where lights are sampled: in media lamps are also looked for from points of the ray "
         "close to "
         "them.");
    optional_part(
        integrator, "merging", &IntegratorSettings::merging, "Merging",
        "Of 'bidirectional': vertices of camera paths merge with those of light paths. None: they do not.");
    optional_part(
        integrator, "occlusion", &IntegratorSettings::occlusion, "Occlusion",
        "Ambient occlusion instead of light; the other attributes then have no effect. None: light.");
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
