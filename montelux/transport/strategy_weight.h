// The MIS weight of one way of many to find a path between a light and the camera.
#pragma once

#include <cstddef>
#include <vector>

#include "montelux/scene/render_settings.h"

namespace montelux {

// The densities by which a path v_0 ... v_{n-1} from a light (v_0) to the lens (v_{n-1}) can be found. Strategy s takes
// its first s vertices from the light's side and the others from the camera's (Veach 1997, section 10.2):
//
//   s = 0      the camera's path hits the light
//   s = 1      the camera's path, with next-event estimation at v_1, which has a density of its own
//   s >= 2     emission from v_0, joined to the camera's path between v_{s-1} and v_s
//   s = n - 1  ... joined to the lens; `light_paths` light paths for each that starts at a square pixel
//   s = n + i  merged at v_i: the light's path and the camera's path both reach v_i (Georgiev et al. 2012, "Light
//              Transport Simulation with Vertex Connection and Merging"). The density is that of strategy i with v_1 to
//              v_{i-1} (and v_0, by emission) of the light's side, times the probability that one of N light paths ends
//              within the radius r around v_i: about from_light[i] pi r^2 N.
//
// All are per area at vertices on surfaces, per volume at those in media, or per solid angle for v_0 at infinity; a
// density of a Dirac delta counts as 1, times the change from solid angle to area. So they are functions of the path alone, whatever strategy found it, and
// the weights of all strategies sum to 1.
struct PathDensities {
    // Of generating v_i from v_{i-1}; from_light[0]: of the emission's position (direction, of infinite lights) and
    // from_light[1]: of the other of the two.
    std::vector<double> from_light;
    std::vector<double> from_camera; // of generating v_i from v_{i+1}; [0] is 0 if the light cannot be hit
    std::vector<char> delta;         // v_i scatters by a Dirac delta
    double next_event = 0;           // of v_0, for s = 1
    double light_paths = 1;
    std::vector<double> media; // media_factors of each s < n (edge_density.h); empty without media
    // pi r^2 N at v_i; 0 where no strategy merges. Empty without merging.
    std::vector<double> merging;

    // The elements of the vectors are those of v_0 to v_{n-2}; no memory is allocated up to the greatest n so far.
    void reset(std::size_t n) {
        from_light.assign(n - 1, 0);
        from_camera.assign(n - 1, 0);
        delta.assign(n - 1, 0);
        media.clear();
        merging.clear();
        next_event = 0;
    }
    std::size_t vertices() const { return from_light.size() + 1; }
};

// The weight of strategy s < 2 n - 1 by the heuristic, in [0, 1]; `scratch` is memory. Paths of two vertices are found by s = 0
// alone.
double strategy_weight(const PathDensities& path, std::size_t s, Heuristic heuristic,
                       std::vector<double>& scratch);

// Density with which path tracing finds the path (s < 2) over that of strategy s, which is positive; 0: never.
double path_tracing_density(const PathDensities& path, std::size_t s, std::vector<double>& scratch);

} // namespace montelux
