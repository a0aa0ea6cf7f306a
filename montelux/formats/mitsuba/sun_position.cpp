#include "montelux/formats/mitsuba/sun_position.h"

#include <algorithm>
#include <cmath>

#include "montelux/mc/math/constants.h"

namespace montelux::mitsuba {
namespace {

// Days since noon of the first of January 2000, universal time, of which `hours` have gone by since midnight. Fliegel and
// Van Flandern 1968, "A Machine Algorithm for Processing Calendar Dates", Comm. ACM 11(10).
double days_since_2000(int year, int month, int day, double hours) {
    const int early = (month - 14) / 12; // -1 in January and February
    const int julian = 1461 * (year + 4800 + early) / 4 + 367 * (month - 2 - 12 * early) / 12 -
                       3 * ((year + 4900 + early) / 100) / 4 + day - 32075;
    return julian - 0.5 + hours / 24 - 2451545;
}

} // namespace

Vec3d sun_position(const PlaceAndTime& at) {
    const double hours = at.hour - at.timezone + (at.minute + at.second / 60) / 60;
    const double days = days_since_2000(at.year, at.month, at.day, hours);
    // Along the ecliptic, radians.
    const double node = 2.1429 - 0.0010394594 * days, mean = 4.8950630 + 0.017202791698 * days,
                 anomaly = 6.2400600 + 0.0172019699 * days;
    const double longitude = mean + 0.03341607 * std::sin(anomaly) + 0.00034894 * std::sin(2 * anomaly) -
                             0.0001134 - 0.0000203 * std::sin(node);
    const double obliquity = 0.4090928 - 6.2140e-9 * days + 0.0000396 * std::cos(node);
    const double right_ascension = std::atan2(std::cos(obliquity) * std::sin(longitude), std::cos(longitude));
    const double declination = std::asin(std::sin(obliquity) * std::sin(longitude));
    const double sidereal_hours = 6.6974243242 + 0.0657098283 * days + hours;
    const double hour_angle = (sidereal_hours * 15 + at.longitude) * pi / 180 - right_ascension;
    const double latitude = at.latitude * pi / 180;
    const double up = std::cos(latitude) * std::cos(hour_angle) * std::cos(declination) +
                      std::sin(declination) * std::sin(latitude);
    const double south = std::sin(latitude) * std::cos(hour_angle) * std::cos(declination) -
                         std::sin(declination) * std::cos(latitude);
    const double west = std::sin(hour_angle) * std::cos(declination);
    // Seen from the surface instead of the centre of the earth: the parallax lowers it.
    constexpr double earth_radius = 6371.01, sun_distance = 149597890; // km
    const double zenith = std::acos(std::clamp(up, -1.0, 1.0));
    const double seen = zenith + earth_radius / sun_distance * std::sin(zenith);
    const double sideways = std::hypot(south, west);
    const double level = sideways > 0 ? std::sin(seen) / sideways : 0;
    return {level * south, level * west, std::cos(seen)};
}

Vec3d read_sun_position(Plugin& emitter) {
    PlaceAndTime at;
    const auto whole = [&](std::string_view name, int otherwise, int least, int most) {
        return static_cast<int>(emitter.integer(name, otherwise, least, most));
    };
    at.latitude = emitter.number("latitude", at.latitude, -90, 90);
    at.longitude = emitter.number("longitude", at.longitude, -360, 360);
    at.timezone = emitter.number("timezone", at.timezone, -24, 24);
    at.year = whole("year", at.year, -4000, 10000);
    at.month = whole("month", at.month, 1, 12);
    at.day = whole("day", at.day, 1, 31);
    at.hour = emitter.number("hour", at.hour, 0, 24);
    at.minute = emitter.number("minute", at.minute, 0, 60);
    at.second = emitter.number("second", at.second, 0, 60);
    return sun_position(at);
}

} // namespace montelux::mitsuba
