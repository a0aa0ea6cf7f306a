#include "montelux/transport/edge_density.h"

namespace montelux {

void media_factors(std::span<const EdgeDensity> edges, bool first_alone, std::vector<double>& factors,
                   std::vector<double>& scratch) {
    const int wavelengths = first_alone ? 1 : 4;
    factors.assign(edges.size() + 1, 0);
    std::vector<double>& of_camera = scratch;
    of_camera.assign(edges.size() + 1, 1);
    for (int k = 0; k < wavelengths; ++k) {
        // All edges on the two sides of the joined one are walked.
        double camera = 1, light = 1;
        for (std::size_t s = edges.size(); s >= 1; --s) {
            of_camera[s] = camera;
            camera *= double(edges[s - 1].walked[k]);
        }
        factors[0] += camera / wavelengths;
        for (std::size_t s = 1; s <= edges.size(); ++s) {
            factors[s] += light * double(edges[s - 1].joined[k]) * of_camera[s] / wavelengths;
            light *= double(edges[s - 1].walked[k]);
        }
    }
}

} // namespace montelux
