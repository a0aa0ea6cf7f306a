// The sun in the sky of a place at a time.
#pragma once

#include "montelux/formats/mitsuba/plugin.h"

namespace montelux::mitsuba {

struct PlaceAndTime {
    double latitude = 35.6894, longitude = 139.6917; // degrees, to the north and to the east
    double timezone = 9;                             // hours ahead of universal time
    int year = 2010, month = 7, day = 10;            // Gregorian
    double hour = 15, minute = 0, second = 0;
};

// A unit vector: z up, x to the south and y to the west, as in Mitsuba's sky. Blanco-Muriel et al. 2001, "Computing the
// Solar Vector", Solar Energy 70(5): within half a minute of arc from 1999 to 2015.
Vec3d sun_position(const PlaceAndTime& at);

// By the properties of the emitter 'sunsky'.
Vec3d read_sun_position(Plugin& emitter);

} // namespace montelux::mitsuba
