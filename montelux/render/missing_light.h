// Light that path tracing cannot find, or finds so rarely that a render is likely to lack it.
#pragma once

#include <memory>
#include <optional>

#include "montelux/render/prepared_scene.h"
#include "montelux/scene/render_settings.h"

namespace montelux {

// Shares of the light of the whole picture.
struct MissingLight {
    double share = 0, error = 0; // an estimate with its standard error
    double never = 0;            // of it: what no path from the camera finds, however many there are
    Index light = no_index;      // from which most of it comes

    // Whether it is worth telling: two of its errors above a tenth of the target error, or above 0.1 % without one (0).
    bool matters(double target_error) const {
        constexpr double least = 1e-3, share_of_target = 0.1;
        return share - 2 * error > (target_error > 0 ? share_of_target * target_error : least);
    }
};

// An estimate by bidirectional paths that merge, at places spread over the film. Each path that they find has a density
// among those that begin at the camera (with next-event estimation). Where it is 0, path tracing lacks the light. Where
// it is so small that all paths of this kind together are expected less than once in `samples` samples of the render,
// the picture lacks their light unless chance brings a firefly. The latter is not looked for in `guided` renders, nor
// in media, where path tracing has further ways to a lamp (SegmentLight).
//
// Empty where nothing focuses light, for other integrators than path tracing by its usual strategy, and where it is not
// known: media that are bodies, cameras that light cannot be traced to, and other obstacles of light_tracing_obstacle
// but soft terminators, which change the amount of light little. `prepared` is of the description's scene. Takes one
// sample for 400 of the render, at least 8192 and at most 65,536: a function of its arguments.
std::optional<MissingLight> missing_light(const SceneDescription& description, const PreparedScene& prepared,
                                          double samples, bool guided = false);

} // namespace montelux
