// MeasuredBrdf: reflection as measured by a gonio-photometer, in an adaptive parameterization.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "montelux/mc/dist/interpolated_bilinear_2d.h"
#include "montelux/mc/math/vec.h"
#include "montelux/scene/bsdf/bsdf_types.h"

namespace montelux {

// Values on equidistant knots of the unit square, one table after the other: values[(table * rows + row) * columns +
// column].
struct BrdfTables {
    std::uint32_t columns = 0, rows = 0;
    std::vector<float> values;
};

// Dupuy and Jakob 2018, "An Adaptive Parameterization for Efficient Material Acquisition and Rendering". Directions in
// the frame of the surface: theta in radians from the normal, phi from the first tangent. A direction's place in a
// table of directions is column sqrt(2 theta / pi), row phi / (2 pi) + 1/2.
struct MeasuredBrdfData {
    std::vector<float> theta, phi;  // of wo, increasing; at most 2 phi: the surface is isotropic
    std::vector<float> wavelengths; // nm, increasing
    BrdfTables ndf;                 // density of microfacet normals
    BrdfTables sigma;               // projected area of the microfacets over wo
    // For each (phi, theta), theta first: the density of visible normals over directions (relative to phi of wo where
    // the surface is isotropic), up to a factor; and of the squares that it maps to those: the luminance up to a
    // factor.
    BrdfTables visible_normals, luminance;
    BrdfTables spectra; // for each (phi, theta, wavelength), the last first: 4 f cos(theta_i) sigma / ndf
};

class MeasuredBrdf {
  public:
    // Throws Error where the tables do not fit together or hold a value that makes no sense.
    explicit MeasuredBrdf(MeasuredBrdfData data);

    bool is_isotropic() const { return data_.phi.size() <= 2; }
    const MeasuredBrdfData& data() const { return data_; }
    // Memory of the tables.
    std::size_t bytes() const;

    // Wavelengths in nm. Both sides reflect.
    BsdfEvaluation evaluate(Vec3f wo, Vec3f wi, Float4 lambda) const;
    std::optional<BsdfSample> sample(Vec3f wo, Float4 lambda, Vec2f u) const;
    // Of 16 samples.
    SampledSpectrum albedo(Vec3f wo, Float4 lambda) const;

  private:
    struct Outgoing;
    Outgoing outgoing(Vec3f wo) const;
    SampledSpectrum spectrum(const Outgoing& o, Vec2f u, Float4 lambda) const;

    MeasuredBrdfData data_;
    InterpolatedBilinear2D visible_normals_, luminance_;
};

// The BRDF at four wavelengths.
struct MeasuredBsdf {
    const MeasuredBrdf* brdf = nullptr;
    Float4 lambda{}; // nm

    static constexpr const char* name = "measured";
    static constexpr BsdfTraits traits{.uses_tangents = true};
    template <typename Visit>
    void visit_fields(Visit&& visit) const {
        visit("wavelengths", SampledSpectrum(lambda));
    }

    bool is_specular() const { return false; }
    bool has_specular() const { return false; }
    bool has_diffuse() const { return false; }
    SampledSpectrum albedo(Vec3f wo) const { return brdf->albedo(wo, lambda); }

    template <typename Stream>
    BsdfEvaluation evaluate(Vec3f wo, Vec3f wi, TransportMode, Stream&) const {
        return brdf->evaluate(wo, wi, lambda);
    }
    template <typename Stream>
    std::optional<BsdfSample> sample(Vec3f wo, TransportMode, Stream& stream) const {
        return brdf->sample(wo, lambda, stream.next_2d());
    }
};

} // namespace montelux
