// TintedBsdf: an interface whose reflected and transmitted light is multiplied by spectra.
#pragma once

#include <optional>

#include "montelux/scene/bsdf/bsdf_list.h"
#include "montelux/scene/bsdf/bsdf_types.h"
#include "montelux/scene/bsdf/conductor.h"
#include "montelux/scene/bsdf/dielectric.h"
#include "montelux/scene/bsdf/microfacet_normals.h"
#include "montelux/scene/bsdf/thin_dielectric.h"

namespace montelux {

template <typename Interface>
struct TintedBsdf {
    Interface interface;
    SampledSpectrum reflected{1}, transmitted{1}; // 0 to 1

    static constexpr const char* name = "tinted";
    static constexpr BsdfTraits traits = Interface::traits;
    template <typename Visit>
    void visit_fields(Visit&& visit) const {
        visit("reflected", reflected);
        if (traits.transmits) visit("transmitted", transmitted);
        visit("interface", interface);
    }

    bool is_specular() const { return interface.is_specular(); }
    bool has_specular() const { return interface.has_specular(); }
    bool has_diffuse() const { return interface.has_diffuse(); }
    float transmitted_eta(Vec3f wo) const requires(traits.transmits) { return interface.transmitted_eta(wo); }
    SampledSpectrum albedo(Vec3f wo) const {
        if constexpr (traits.transmits)
            return lerp(interface.reflectance(wo), transmitted, reflected);
        else
            return reflected * interface.albedo(wo);
    }

    template <typename Stream>
    BsdfEvaluation evaluate(Vec3f wo, Vec3f wi, TransportMode mode, Stream& stream) const {
        BsdfEvaluation e = interface.evaluate(wo, wi, mode, stream);
        e.f *= same_hemisphere(wo, wi) ? reflected : transmitted;
        return e;
    }
    template <typename Stream>
    std::optional<BsdfSample> sample(Vec3f wo, TransportMode mode, Stream& stream) const {
        std::optional<BsdfSample> s = interface.sample(wo, mode, stream);
        if (s) s->weight *= s->transmission ? transmitted : reflected;
        return s;
    }
};

// Of any distribution of normals.

} // namespace montelux
