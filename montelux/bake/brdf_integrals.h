// The integrals tabulated for image-based lighting: GGX in two terms, its mean albedo, Charlie sheen.
#pragma once

#include <vector>

#include "montelux/mc/math/quadrature.h"

namespace montelux {

// Of the GGX reflection lobe with height-correlated Smith masking and shadowing and Schlick's Fresnel term
// F0 + (1 - F0) (1 - v.h)^5: its albedo is F0 * scale + bias. Karis 2013, "Real Shading in Unreal Engine 4";
// Walter et al. 2007; Heitz 2014.
struct SplitSumTerms {
    double scale = 0, bias = 0;
    // Distance to the rule with half as many nodes, the larger of both terms: the error is far smaller.
    double error = 0;
};

struct AlbedoTerm {
    double value = 0;
    double error = 0; // as above
};

// Deterministic product rules over the polar angle and the azimuth of the half vector, in double precision,
// whose limits follow the horizon: below 1e-7 from the value for n.v and alpha down to 1/512 and (1/512)^2.
class BrdfIntegrals {
  public:
    BrdfIntegrals();

    // n_dot_v in (0, 1]; alpha in (0, 1].
    SplitSumTerms ggx(double n_dot_v, double alpha) const;
    // 2 integral_0^1 (scale + bias)(mu) mu dmu: the mean albedo for F = 1. Kulla and Conty 2017, "Revisiting
    // Physically Based Shading at Imageworks", need it for multiple scattering.
    AlbedoTerm ggx_average_albedo(double alpha) const;
    // Albedo of the sheen of Estevez and Kulla 2017, "Production Friendly Microfacet Sheen BRDF", D =
    // (2 + 1/alpha) sin^(1/alpha)(theta) / (2 pi), with the visibility 1 / (4 (n.l + n.v - n.l n.v)) of
    // Neubelt and Pettineo 2013 that Filament uses. It is above 1 for grazing view and small alpha, as that
    // model is.
    AlbedoTerm charlie_sheen(double n_dot_v, double alpha) const;

  private:
    std::vector<QuadratureNode> polar_, azimuth_;
    std::vector<QuadratureNode> fine_polar_, fine_azimuth_; // sheen: lobes as narrow as they are one-sided
};

} // namespace montelux
