// PrincipledBsdf: clear coat over sheen over a mixture of metal, diffuse base and glass.
#pragma once

#include <optional>

#include "montelux/mc/math/frame.h"
#include "montelux/scene/bsdf/bsdf_types.h"
#include "montelux/scene/bsdf/principled_interface.h"
#include "montelux/scene/bsdf/sheen.h"

namespace montelux {

// The layers of glTF 2.0, appendix B, and of its extensions for coat, sheen and transmission. What a layer leaves
// to those below is 1 - max(E(wo), E(wi)) for its albedo E: reciprocal, and never more than there was. A solid's
// coat and sheen lie on its outside.
struct PrincipledLayers {
    PrincipledInterface interface;
    SampledSpectrum diffuse;      // reflectance below the interface, with its share of the material
    SampledSpectrum transmitting; // the same for diffuse transmission

    SampledSpectrum sheen_color;
    Sheen sheen;

    float coat = 0; // weight
    Ggx coat_ggx;
    Vec2f coat_tilt{};                      // x and y of the coat's normal
    static constexpr float coat_f0 = 0.04f; // index 1.5

    // The coat's own normal in this frame. Where it faces away from wo or wi there is no coat.
    void set_coat_normal(Normal3f n);

    // What lies below differs from what lies above.
    bool is_solid() const { return !interface.thin && (interface.is_clear() || !is_black(transmitting)); }
    bool is_specular() const;
    bool has_specular() const;
    // Diffuse transmission alone has no index of refraction.
    float transmitted_eta(Vec3f wo) const {
        if (interface.thin || !interface.is_clear()) return 1;
        return wo.z > 0 ? interface.eta : 1 / interface.eta;
    }
    SampledSpectrum albedo(Vec3f wo) const;
    BsdfEvaluation evaluate(Vec3f wo, Vec3f wi, TransportMode mode) const;
    std::optional<BsdfSample> sample(Vec3f wo, TransportMode mode, float uc, Vec2f u) const;

  private:
    struct Shares;
    Shares shares(Vec3f wo) const;
    BsdfEvaluation evaluate(const Shares& shares, Vec3f wo, Vec3f wi, TransportMode mode) const;
    std::optional<BsdfSample> sample_interface(const Shares& shares, Vec3f wo, TransportMode mode, float uc,
                                               Vec2f u) const;
    SampledSpectrum lambertian_reflectance(Vec3f wo) const;
    // What upper layers leave.
    float below_coat(const Shares& shares, Vec3f wi) const;
    SampledSpectrum below_sheen(const Shares& shares, Vec3f wi) const;
    SampledSpectrum below_interface(const Shares& shares, Vec3f wi) const;
    bool is_outside(Vec3f w) const { return w.z > 0 || !is_solid(); }
    bool is_coat_tilted() const { return coat_tilt.x != 0 || coat_tilt.y != 0; }
    Frame coat_frame() const;
    // In the frame of the coat; zero where it faces away.
    Vec3f in_coat(Vec3f w) const;
    Vec3f from_coat(Vec3f w) const;
    float coat_albedo(Vec3f w) const;
    SampledSpectrum sheen_albedo(Vec3f w) const;
    Vec3f turned(Vec3f w) const;
    Vec3f turned_back(Vec3f w) const;
};

// `may_transmit` is a property of the type: paths treat an opaque surface differently.
template <bool may_transmit>
struct PrincipledBsdf {
    PrincipledLayers layers;

    static constexpr const char* name = may_transmit ? "principled, transmitting" : "principled";
    static constexpr BsdfTraits traits{.transmits = may_transmit, .uses_tangents = true};
    template <typename Visit>
    void visit_fields(Visit&& visit) const {
        const PrincipledInterface& i = layers.interface;
        visit("surface", i.ggx);
        visit("eta", i.eta);
        visit("dielectric", i.dielectric);
        visit("specular", i.specular);
        visit("dielectric f0", i.dielectric_f0);
        visit("metal", i.metal);
        visit("metal f0", i.metal_f0);
        visit("clear", i.clear);
        visit("tint", i.tint);
        visit("film", i.film_share);
        visit("diffuse", layers.diffuse);
        visit("diffuse transmission", layers.transmitting);
        visit("sheen", layers.sheen_color);
        visit("sheen alpha", layers.sheen.alpha);
        visit("coat", layers.coat);
        visit("coat surface", layers.coat_ggx);
        visit("coat normal x", layers.coat_tilt.x);
        visit("coat normal y", layers.coat_tilt.y);
    }

    bool is_specular() const { return layers.is_specular(); }
    bool has_specular() const { return layers.has_specular(); }
    bool has_diffuse() const {
        return !is_black(layers.diffuse) || !is_black(layers.transmitting) || !is_black(layers.sheen_color);
    }
    float transmitted_eta(Vec3f wo) const requires may_transmit { return layers.transmitted_eta(wo); }
    SampledSpectrum albedo(Vec3f wo) const { return layers.albedo(wo); }

    template <typename Stream>
    BsdfEvaluation evaluate(Vec3f wo, Vec3f wi, TransportMode mode, Stream&) const {
        return layers.evaluate(wo, wi, mode);
    }
    template <typename Stream>
    std::optional<BsdfSample> sample(Vec3f wo, TransportMode mode, Stream& stream) const {
        const float uc = stream.next_1d();
        const Vec2f u = stream.next_2d();
        return layers.sample(wo, mode, uc, u);
    }
};

} // namespace montelux
