// MicrofacetNormals: microfacet normals of a distribution that is chosen while the program runs.
#pragma once

#include "montelux/scene/bsdf/beckmann.h"
#include "montelux/scene/bsdf/ggx.h"
#include "montelux/scene/bsdf/microfacet_distribution.h"

namespace montelux {

struct MicrofacetNormals {
    float alpha_x = 0, alpha_y = 0;
    MicrofacetDistribution distribution = MicrofacetDistribution::ggx;

    MicrofacetNormals() = default;
    MicrofacetNormals(Ggx alpha, MicrofacetDistribution distribution_)
        : alpha_x(alpha.alpha_x), alpha_y(alpha.alpha_y), distribution(distribution_) {}

    // The functions of Ggx.
    bool is_smooth() const { return ggx().is_smooth(); }
    float d(Vec3f m) const { return is_beckmann() ? beckmann().d(m) : ggx().d(m); }
    InverseMasking inverse_masking(Vec3f wo, Vec3f wi) const {
        if (is_beckmann()) return beckmann().inverse_masking(wo, wi);
        if (distribution == MicrofacetDistribution::ggx) return ggx().inverse_masking(wo, wi);
        const float visible = 1 + ggx().lambda(wo);
        return {visible, visible * (1 + ggx().lambda(wi))};
    }
    Vec3f sample_visible(Vec3f w, Vec2f u) const {
        return is_beckmann() ? beckmann().sample_visible(w, u) : ggx().sample_visible(w, u);
    }

  private:
    bool is_beckmann() const { return distribution == MicrofacetDistribution::beckmann; }
    Ggx ggx() const { return {alpha_x, alpha_y}; }
    Beckmann beckmann() const { return {alpha_x, alpha_y}; }
};

} // namespace montelux
