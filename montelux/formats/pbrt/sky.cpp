#include <cmath>

#include "montelux/formats/pbrt/lights.h"
#include "montelux/mc/math/constants.h"
#include "montelux/mc/math/error.h"

namespace montelux::pbrt {
namespace {

// Position of the sun in the light's space, degrees.
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

SceneBuilder::SkyLights LightReader::sky(ParameterReader& r, const Transform& world_from_light) {
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
    SceneBuilder::SkyLights sky{settings, r.boolean("sundisc", true), r.number("scale", 1), 0,
                                world_from_light};
    if (sky.scale < 0) r.error("scale", "parameter 'scale' is negative");
    sky.illuminance = r.number("illuminance", -1);
    return sky;
}

} // namespace montelux::pbrt
