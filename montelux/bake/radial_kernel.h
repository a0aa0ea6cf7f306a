// Weights over directions that depend only on the angle to one direction: the GGX lobe seen along its normal,
// and the cosine of diffuse light.
#pragma once

#include <algorithm>

namespace montelux {

// k(d) = norm max(0, 1 - d) / (a + b d)^2 with d = 1 - cos(theta): falls with the angle, is 0 below the
// horizon and integrates to 1 over the sphere.
struct RadialKernel {
    float norm = 0, a = 1, b = 0;

    // D(h) n.l, the GGX lobe for n = v = r (Karis 2013): with cos^2(theta_h) = (1 + n.l) / 2 its D = alpha^2
    // / (pi (d/2 + alpha^2 (1 - d/2))^2). alpha in (0, 1].
    static RadialKernel ggx(double alpha);
    // Irradiance over pi.
    static RadialKernel cosine();

    float operator()(float d) const {
        const float t = a + b * d;
        return norm * std::max(0.0f, 1 - d) / (t * t);
    }
};

} // namespace montelux
