// VolumeState: a path through media between two of its vertices, as a plain value.
#pragma once

#include <type_traits>

#include "montelux/scene/medium/medium_model.h"
#include "montelux/transport/path_state.h"
#include "montelux/transport/segment_light.h"

namespace montelux {

// Densities and the throughput are relative to the density of the path as it was sampled: that of the first
// wavelength. Pharr, Jakob, Humphreys 2023, "Physically Based Rendering", 4th edition, section 14.2.3: rescaled
// path probabilities.
struct VolumeState : PathState {
    SampledSpectrum r_u{1}; // density of sampling the path, at each wavelength
    // The same if light sampling at the last scattering vertex had found what follows, without the density of
    // the light. PathState::bsdf_pdf is the density of the direction there.
    SampledSpectrum r_l{1};
    // The same if SegmentLight had found the last scattering vertex and light sampling what follows, without the
    // densities of the part, the distance and the light.
    SampledSpectrum r_s{1};
    SegmentLight segment;    // on which the last scattering vertex lies, if it is one in a medium
    Index medium = no_index; // around the ray
    MediumPoint body{};      // coefficients of the body that surrounds the ray, if they vary over its surface
    float distance = 0;      // from the camera to the ray's origin, until the first scattering event

    VolumeState(const CameraSample& camera, Index camera_medium) : PathState(camera), medium(camera_medium) {}

    // What the path carries to the film, weighted over the wavelengths by the balance heuristic.
    SampledSpectrum carried() const { return throughput / average(r_u); }

    // All are multiplied by `factor` when a step has this value and this density relative to its sampled one.
    void take(SampledSpectrum factor) {
        throughput *= factor;
        r_u *= factor;
        r_l *= factor;
        r_s *= factor;
    }
    // The light's share of a step begins anew at a scattering event.
    void scatter() {
        r_l = r_u;
        segment = {};
    }
    // A scattering event that the strategy of `found` could have found, whose density at the first wavelength
    // is `hero`; `reached`: r_s without it.
    void scatter(const SegmentLight& found, SampledSpectrum reached, float hero) {
        r_l = r_u;
        segment = found;
        r_s = reached / hero;
    }
    // Only ratios count: the range of floats must last for many steps. Returns the factor.
    float rescale() {
        const float largest = max_value(r_u);
        if (!(largest > 0x1p40f) && !(max_value(r_l) > 0x1p60f)) return 1;
        const float scale = 1 / largest;
        throughput *= scale;
        r_u *= scale;
        r_l *= scale;
        r_s *= scale;
        return scale;
    }
    // Leaves the first wavelength alone, which then stands for all four. What the other ones have found stays.
    // All four become the first, so that their densities remain equal.
    void terminate_secondary() {
        lambda.lambda = broadcast(lambda.lambda[0]);
        throughput = SampledSpectrum(4 * throughput[0], 0, 0, 0);
        r_u = SampledSpectrum(r_u[0]);
        r_l = SampledSpectrum(r_l[0]);
        r_s = SampledSpectrum(r_s[0]);
        body.sigma_a = SampledSpectrum(body.sigma_a[0]);
        body.sigma_s = SampledSpectrum(body.sigma_s[0]);
    }
};
static_assert(std::is_trivially_copyable_v<VolumeState>);

} // namespace montelux
