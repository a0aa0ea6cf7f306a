#include <cmath>

#include "montelux/formats/pbrt/lights.h"
#include "montelux/mc/math/constants.h"
#include "montelux/mc/math/error.h"
#include "montelux/scene/light/sky/sky_map.h"

namespace montelux::pbrt {
namespace {

// Rows of the map that directions are drawn by. Radiance does not depend on it.
constexpr int density_rows = 256;

// Where the sun stands in the light's space, degrees.
void read_sun(ParameterReader& r, SkySettings& settings) {
    const std::optional<float> elevation = r.number("elevation"), azimuth = r.number("azimuth");
    const std::optional<Vec3f> sun = r.vector3("sun");
    const char* name = sun ? "sun" : "elevation";
    if (sun) {
        if (elevation || azimuth)
            r.error(elevation ? "elevation" : "azimuth",
                    std::string(elevation ? "'elevation'" : "'azimuth'") +
                        " together with 'sun'; expected one or the other");
        const Vec3d d(*sun);
        if (!(length(d) > 0) || !std::isfinite(length(d)))
            r.error("sun", "parameter 'sun' is not a direction; expected a vector to the sun");
        settings.elevation = std::atan2(d.z, std::hypot(d.x, d.y)) * 180 / pi;
        settings.azimuth = std::atan2(d.y, d.x) * 180 / pi;
    } else {
        settings.elevation = static_cast<double>(elevation.value_or(45.0f));
        settings.azimuth = static_cast<double>(azimuth.value_or(0.0f));
    }
    if (!(settings.elevation <= highest_sun))
        r.error(name, "parameter 'elevation' is above 90 degrees, which is the zenith");
    if (!(settings.elevation >= lowest_sun))
        r.error(name,
                "the sun is more than 6 degrees below the horizon, which is night; expected an elevation "
                "from -6 to 90 degrees");
    if (!std::isfinite(settings.azimuth)) r.error("azimuth", "parameter 'azimuth' is not finite");
}

} // namespace

Light LightReader::sky(ParameterReader& r, const Transform& world_from_light) {
    SkySettings settings;
    read_sun(r, settings);
    const auto turbidity = static_cast<double>(r.number("turbidity", 2));
    if (!(turbidity >= least_turbidity && turbidity <= most_turbidity))
        r.error("turbidity",
                "parameter 'turbidity' is not in [1, 10]; 1 is pure air, 2 a clear day, 10 dense haze");
    settings.atmosphere.turbidity = turbidity;
    if (const Parameter* p =
            r.any("groundalbedo", {ParameterType::rgb, ParameterType::spectrum, ParameterType::floating})) {
        settings.ground_albedo = p->type == ParameterType::floating ? Spectrum(r.number_of(*p))
                                                                    : spectra_.read(*p, RgbMeaning::albedo);
        for (float lambda = lambda_min; lambda <= lambda_max; lambda += 10)
            if (!(settings.ground_albedo(lambda) >= 0 && settings.ground_albedo(lambda) <= 1))
                r.error("groundalbedo", "parameter 'groundalbedo' is not between 0 and 1");
    }
    const bool with_sun = r.boolean("sundisc", true);
    float scale = r.number("scale", 1);
    if (scale < 0) r.error("scale", "parameter 'scale' is negative");
    const float illuminance = r.number("illuminance", -1);

    const SkyModel model(settings);
    // Luminance in cd/m^2, as of all lights that are given in photometric units.
    scale *= static_cast<float>(luminous_efficacy);
    if (illuminance > 0) {
        const SpectrumTable from_sky = model.sky_irradiance(), from_sun = model.sun_irradiance();
        scale *= static_cast<float>(static_cast<double>(illuminance) /
                                    (luminous_efficacy * integrate_luminance([&](float lambda) {
                                         return from_sky(lambda) + (with_sun ? from_sun(lambda) : 0);
                                     })));
    }
    if (with_sun && model.sun_radiance().max_value() > 0)
        scene_.lights.push_back(SunLight{
            Spectrum(model.sun_radiance()), scale,
            SunDisc::of_radius(normalize(world_from_light.vector(model.sun_direction())), sun_angular_radius),
            normalize(world_from_light.normal(Vec3f(0, 0, 1)))});
    SkyLight light;
    light.sky = static_cast<Index>(scene_.skies.size());
    light.environment = static_cast<Index>(scene_.environments.size());
    light.scale = scale;
    light.world_from_light = world_from_light;
    scene_.environments.push_back(sky_density_map(model, density_rows));
    scene_.skies.push_back(model);
    return light;
}

} // namespace montelux::pbrt
