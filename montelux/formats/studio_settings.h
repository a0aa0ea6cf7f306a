// StudioSettings: what a user asks of the light, ground, camera and background of a scene.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "montelux/mc/math/vec.h"
#include "montelux/scene/shape/bounds.h"

namespace montelux {

// Where the camera is, as seen from the centre of the scene's bounds. Degrees; azimuth 0 is the front (+z of scenes
// whose y axis points up, -y of those whose z axis does), and positive to the right of one who looks from there.
struct Orbit {
    double azimuth = 35, elevation = 18;
    double distance = 1; // in multiples of framing_distance
};

struct StudioSettings {
    // The file of an environment map, which replaces all infinite lights of the scene; "studio": the studio's own;
    // "none" removes them.
    std::optional<std::string> environment{};
    std::optional<Orbit> orbit{}; // a camera that frames the scene, in place of its own
    std::optional<bool> ground{}; // empty: where the studio lights the scene
    struct Background {
        bool transparent = false;
        Vec3f color{}; // linear sRGB; black where it is transparent
    };
    std::optional<Background> background{}; // empty: the light that is seen, or the studio's
    // What camera and ground are fitted to, not a wish of its own: the same for all frames of an animation. Empty: the
    // bounds of the scene.
    std::optional<Bounds3> bounds{};

    bool empty() const { return !environment && !orbit && !ground && !background; }
};

// "AZ,EL" or "AZ,EL,DIST"; empty for other text, elevations beyond 90 degrees, and distances that are not positive.
std::optional<Orbit> parse_orbit(std::string_view text);
inline constexpr std::string_view orbit_syntax =
    "AZ,EL or AZ,EL,DIST: azimuth and elevation in degrees, the latter from -90 to 90, and the distance in "
    "multiples of "
    "the one that frames the scene, for example 35,18 or 120,0,1.5";

// "transparent", "black", "grey", "white", "#rrggbb" (sRGB), or linear "r,g,b"; empty for other text.
std::optional<StudioSettings::Background> parse_background(std::string_view text);
inline constexpr std::string_view background_syntax =
    "transparent, black, grey, white, #rrggbb, or linear r,g,b, for example #30343c or 0.2,0.2,0.3";

} // namespace montelux
