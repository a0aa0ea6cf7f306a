// The angle between the surface's normal and a microfacet normal of the GGX (Trowbridge-Reitz) distribution.
#pragma once

#include <cmath>

#include "montelux/mc/dist/distribution_1d.h"
#include "montelux/mc/dist/parameters.h"
#include "montelux/mc/math/constants.h"

namespace montelux {

// Walter et al. 2007, "Microfacet Models for Refraction through Rough Surfaces", equations 33 and 35. Facet
// normals follow D cos(theta) per steradian, D = a^2 / (pi ((a^2 - 1) cos^2(theta) + 1)^2); over the
// azimuth, p = 2 pi D cos(theta) sin(theta) per radian on [0, pi/2], P = tan^2 / (tan^2 + a^2), and
// cos(X) = sqrt((1 - xi) / (xi (a^2 - 1) + 1)), that is tan(X) = a sqrt(xi / (1 - xi)), which keeps its
// digits at both ends. `alpha` is the roughness a.
class GgxAngleDistribution : public SampledByInversion<GgxAngleDistribution> {
  public:
    explicit GgxAngleDistribution(double alpha) : alpha_(alpha) {
        require_parameters(alpha > 0 && std::isfinite(alpha), "GgxAngleDistribution", {{"alpha", alpha}},
                           "a finite roughness above zero");
    }
    double lower() const { return 0; }
    double upper() const { return pi / 2; }
    double pdf(double theta) const {
        if (!(theta >= 0 && theta <= pi / 2)) return 0;
        double s = std::sin(theta), ac = alpha_ * std::cos(theta), sum = s * s + ac * ac;
        return 2 * alpha_ * s * ac / (sum * sum);
    }
    double cdf(double theta) const {
        if (!(theta > 0)) return 0;
        if (!(theta < pi / 2)) return 1;
        double s = std::sin(theta), ac = alpha_ * std::cos(theta);
        return s * s / (s * s + ac * ac);
    }
    double cdf_complement(double theta) const {
        if (!(theta > 0)) return 1;
        if (!(theta < pi / 2)) return 0;
        double s = std::sin(theta), ac = alpha_ * std::cos(theta);
        return ac * ac / (s * s + ac * ac);
    }
    double quantile(double xi) const { return angle(xi, 1 - xi); }
    // tan^2(X), for directions without trigonometry; infinite at 1.
    double squared_tangent_quantile(double xi) const { return alpha_ * alpha_ * xi / (1 - xi); }
    double quantile_complement(double q) const { return angle(1 - q, q); }

  private:
    double angle(double p, double q) const { return std::atan2(alpha_ * std::sqrt(p), std::sqrt(q)); }

    double alpha_;
};

} // namespace montelux
