#include "python/src/bindings.h"
#include "python/src/scene_values.h"
#include <array>
#include <numbers>
#include <string>

#include "montelux/scene/light/light.h"

namespace montelux::python {
namespace {

template <typename T>
void emission(nb::class_<Ref<T>>& c, const char* quantity) {
    const std::string doc =
        std::string(quantity) +
        ": a number, R, G, B (linear sRGB), a name or a Spectrum; setting it gives the light "
        "the luminance 1 for (1, 1, 1), and for any other spectrum that is no RGB.";
    attribute<T>(
        c, "spectrum", "typing.Any",
        [](const T& t, const Ref<T>& r) { return nb::cast(spectrum_of(t.spectrum, r.spectra())); },
        [](T& t, nb::handle v, Ref<T>& r, const std::string& what) {
            const Spectrum spectrum = spectrum_of(v, RgbMeaning::illuminant, what);
            t.scale = photometric_scale(spectrum, what);
            t.spectrum = r.add_spectrum(spectrum);
        },
        doc.c_str());
    number(c, "scale", &T::scale, not_negative, "a number that is not negative",
           "Multiplies the spectrum; `light.scale *= 2` makes it twice as bright.");
}

template <typename T>
void vector(nb::class_<Ref<T>>& c, const char* name, Vec3f T::*member, bool unit, const char* doc) {
    attribute<T>(
        c, name, "typing.Any", [member](const T& t, const auto&) { return vector_array(t.*member); },
        [member, unit](T& t, nb::handle v, auto&, const std::string& what) {
            const std::vector<double> x = numbers_of(v, 3, what);
            const Vec3d d{x[0], x[1], x[2]};
            if (unit && !(length(d) > 0)) throw Error(what, "expected a direction that is not zero");
            t.*member = Vec3f(unit ? d / length(d) : d);
        },
        doc);
}

void angle(nb::class_<Ref<SpotLight>>& c, const char* name, float SpotLight::*member, const char* doc) {
    constexpr double degree = std::numbers::pi / 180;
    attribute<SpotLight>(
        c, name, "float",
        [member](const SpotLight& t, const auto&) {
            return nb::float_(std::acos(static_cast<double>(t.*member)) / degree);
        },
        [member](SpotLight& t, nb::handle v, auto&, const std::string& what) {
            const double a = number_of(v, what);
            if (!(a >= 0 && a <= 180)) throw Error(what, "expected an angle from 0 to 180 degrees");
            t.*member = static_cast<float>(std::cos(a * degree));
        },
        doc);
}

template <typename T>
void portal(nb::class_<Ref<T>>& c) {
    attribute<T>(
        c, "portal", "typing.Any",
        [](const T& t, const auto&) -> nb::object {
            if (!t.portal) return nb::none();
            std::vector<double> rows;
            for (const Point3f& p : t.portal->corners())
                for (const float x : {p.x, p.y, p.z}) rows.push_back(static_cast<double>(x));
            return nb::cast(new_array(rows, 4, 3));
        },
        [](T& t, nb::handle v, auto&, const std::string& what) {
            if (v.is_none()) {
                t.portal.reset();
                return;
            }
            const Numbers n = numbers_of(v, what);
            if (n.shape != std::vector<std::size_t>{4, 3})
                throw Error(what, "expected the corners of a rectangle, shape (4, 3)");
            std::array<Point3f, 4> corners;
            for (std::size_t i = 0; i < 4; ++i)
                corners[i] = Point3f(Vec3d{n.values[3 * i], n.values[3 * i + 1], n.values[3 * i + 2]});
            try {
                t.portal = Portal(corners);
            } catch (const Error& e) {
                throw Error(what, e.what());
            }
        },
        "The rectangle that its light comes through, corners of shape (4, 3) in world space, from the side "
        "that cross(corners[3] - corners[0], corners[1] - corners[0]) points to; None for light from "
        "everywhere.");
}

} // namespace

void make_white(SceneSpectrum& spectrum, float& scale, std::vector<Spectrum>& spectra) {
    const Spectrum white = spectrum_of(nb::float_(1), RgbMeaning::illuminant, "");
    spectrum = add_spectrum(spectra, white);
    scale = photometric_scale(white, "");
}

template <>
SpotLight default_value(std::vector<Spectrum>& spectra) {
    SpotLight light;
    make_white(light.spectrum, light.scale, spectra);
    light.cos_falloff_start = static_cast<float>(std::cos(25 * std::numbers::pi / 180));
    light.cos_total_width = static_cast<float>(std::cos(30 * std::numbers::pi / 180));
    return light;
}

void bind_lights(nb::module_& m) {
    auto area =
        value_class<AreaLight>(m, "AreaLight", "The light of a shape; all primitives of a mesh together.");
    emission(area, "Radiance from the front");
    flag(area, "two_sided", &AreaLight::two_sided, "Whether the back shines as well.");
    auto point = value_class<PointLight>(m, "PointLight", "Radiant intensity from one point.");
    emission(point, "Intensity");
    vector(point, "position", &PointLight::position, false, "Position, shape (3,).");
    auto spot = value_class<SpotLight>(m, "SpotLight", "A cone of light.");
    emission(spot, "Intensity on the axis");
    vector(spot, "position", &SpotLight::position, false, "Position, shape (3,).");
    vector(spot, "axis", &SpotLight::axis, true, "Where it points, shape (3,).");
    angle(spot, "falloff_angle", &SpotLight::cos_falloff_start, "Full intensity within this angle, degrees.");
    angle(spot, "cone_angle", &SpotLight::cos_total_width, "Dark beyond this angle, degrees.");
    auto distant = value_class<DistantLight>(m, "DistantLight", "The sun: parallel light.");
    emission(distant, "Irradiance on a plane across the beam");
    vector(distant, "to_light", &DistantLight::to_light, true,
           "Direction from the scene to the light, shape (3,).");
    auto sky =
        value_class<UniformInfiniteLight>(m, "UniformInfiniteLight", "The same radiance from everywhere.");
    emission(sky, "Radiance");
    portal(sky);
    auto map = value_class<ImageInfiniteLight>(
        m, "EnvironmentLight",
        "Radiance from a map, equal-area or latitude-longitude; scenes make them by add_environment().");
    number(map, "scale", &ImageInfiniteLight::scale, not_negative, "a number that is not negative",
           "Multiplies the map.");
    attribute<ImageInfiniteLight>(
        map, "world_from_light", "typing.Any",
        [](const ImageInfiniteLight& t, const auto&) { return matrix_array(t.world_from_light); },
        [](ImageInfiniteLight& t, nb::handle v, auto&, const std::string& what) {
            t.world_from_light = transform_of(v, what);
        },
        "How the map is turned, shape (4, 4); its z axis is the centre of the picture.");
    portal(map);
    auto dome = value_class<SkyLight>(m, "SkyLight", "A clear sky without the sun, from a scene file.");
    number(dome, "scale", &SkyLight::scale, not_negative, "a number that is not negative",
           "Multiplies the sky; 683 is luminance in cd/m^2.");
    auto sun = value_class<SunLight>(m, "SunLight", "The sun's disc, from a scene file.");
    number(sun, "scale", &SunLight::scale, not_negative, "a number that is not negative",
           "Multiplies the sun; 683 is luminance in cd/m^2.");

    auto goniometric = value_class<GoniometricLight>(
        m, "GoniometricLight", "Intensity from one point by a map over directions, from a scene file.");
    emission(goniometric, "Intensity where the map is 1");
    auto projection =
        value_class<ProjectionLight>(m, "ProjectionLight", "A projected picture, from a scene file.");
    number(projection, "scale", &ProjectionLight::scale, not_negative, "a number that is not negative",
           "Multiplies the picture.");

    nb::list kinds;
    const auto add = [&]<typename L>(std::type_identity<L>) {
        const nb::handle kind = nb::type<Ref<L>>();
        if (!kind) throw Error(std::string(L::name), "this light has no class in python/src/lights.cpp");
        kinds.append(kind);
    };
    [&]<typename... L>(std::type_identity<std::variant<L...>>) {
        (add(std::type_identity<L>()), ...);
    }(std::type_identity<Light>());
    m.attr("LIGHTS") = nb::tuple(kinds);
}

} // namespace montelux::python
