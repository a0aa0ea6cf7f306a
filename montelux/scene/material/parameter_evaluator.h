// ParameterEvaluator: a material's parameters at a point, and the parts of BSDFs made of them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "montelux/scene/bsdf/bsdf.h"
#include "montelux/scene/texture/evaluate.h"
#include "montelux/spectrum/cie.h"

namespace montelux {

// If an index of refraction depends on the wavelength, all wavelengths but the hero are terminated. `widen`: microfacet
// lobes become Ggx::widened ones.
class ParameterEvaluator {
  public:
    ParameterEvaluator(const SceneView& scene, Index material, const TextureContext& context,
                       SampledWavelengths& lambda, bool widen = false)
        : scene_(scene), material_(material), context_(context), lambda_(lambda), widen_(widen) {}

    float operator()(const FloatParameter& p) const { return evaluate(scene_, p, context_); }
    SampledSpectrum operator()(const SpectrumParameter& p) const {
        return evaluate(scene_, p, context_, lambda_);
    }
    SampledSpectrum reflectance(const SpectrumParameter& p) const { return clamp((*this)(p), 0, 1); }

    // Between 0 and 1.
    float share(const FloatParameter& p) const { return std::clamp((*this)(p), 0.0f, 1.0f); }

    Ggx roughness(const RoughnessParameter& r) const {
        float u = (*this)(r.u), v = (*this)(r.v);
        if (r.remap) {
            u = Ggx::alpha_from_roughness(u);
            v = Ggx::alpha_from_roughness(v);
        }
        return microfacets(u, v);
    }
    Ggx microfacets(float alpha_u, float alpha_v) const {
        // A lobe narrower than this along one axis would overflow floats.
        Ggx ggx{alpha_u, alpha_v};
        if (!ggx.is_smooth()) ggx = {std::max(alpha_u, 1e-4f), std::max(alpha_v, 1e-4f)};
        return widen_ ? ggx.widened() : ggx;
    }

    // Burley 2012: elongated with a constant product of both.
    MicrofacetNormals disney_microfacets(float roughness, float anisotropic) const {
        const float alpha = roughness * roughness, aspect = std::sqrt(1 - 0.9f * anisotropic);
        return {microfacets(std::max(alpha / aspect, 1e-3f), std::max(alpha * aspect, 1e-3f)),
                MicrofacetDistribution::ggx_separable};
    }
    // From white to the colour at luminance 1; white if the colour is black.
    SampledSpectrum tint(const SpectrumParameter& color, float strength) const {
        const float y = strength > 0 ? luminance(color) : 0;
        return y > 0 ? lerp(strength, SampledSpectrum(1), reflectance(color) / y) : SampledSpectrum(1);
    }
    // Of a reflectance under equal energy, by wavelengths that split the luminous efficiency into equal parts.
    float luminance(const SpectrumParameter& color) const {
        static const std::array<SampledWavelengths, 2> nodes = luminance_nodes();
        float sum = 0;
        for (const SampledWavelengths& lambda : nodes)
            sum += average(clamp(evaluate(scene_, color, context_, lambda), 0, 1));
        return sum / 2;
    }

    float refractive_index(SceneSpectrum eta) const {
        float value = scene_.sample(eta, lambda_)[0];
        if (!scene_.is_constant(eta)) lambda_.terminate_secondary();
        return value > 0 ? value : 1;
    }

    // `outside`: index of refraction of the outer medium. Fresnel's formulae take relative indices;
    // parameters are relative to vacuum.
    ConductorBsdf conductor(const MetalParameter& m, const RoughnessParameter& r, float outside) const {
        ConductorBsdf b;
        if (m.from_reflectance) {
            SampledSpectrum rho = clamp((*this)(m.reflectance), 0, 0.9999f);
            b.eta = SampledSpectrum(1);
            b.k = 2.0f * sqrt(rho) / sqrt(clamp_zero(1.0f - rho));
        } else {
            b.eta = (*this)(m.eta);
            b.k = (*this)(m.k);
        }
        b.eta /= outside;
        b.k /= outside;
        b.normals = roughness(r);
        return b;
    }

    template <typename Base>
    LayeredBsdf<Base> layered(const CoatingParameters& c, float eta, const Base& base, Ggx proxy) const {
        LayeredBsdf<Base> b;
        b.coat = {eta, roughness(c.roughness)};
        b.base = base;
        b.proxy = proxy;
        b.medium_albedo = reflectance(c.albedo);
        b.g = std::clamp((*this)(c.g), -0.999f, 0.999f);
        b.thickness = std::max((*this)(c.thickness), 1e-30f);
        b.max_depth = c.max_depth;
        b.sample_count = std::max(c.sample_count, 1);
        return b;
    }

    // From the texture coordinate v: -1 to 1 across a hair.
    float offset_across() const { return std::clamp(2 * context_.uv.y - 1, -1.0f, 1.0f); }

    SampledSpectrum hair_absorption(const HairColorParameter& c, float beta_n) const {
        if (c.source == HairColorParameter::absorption) return clamp_zero((*this)(c.sigma_a));
        if (c.source == HairColorParameter::reflectances)
            return HairBsdf::sigma_a_of_reflectance(reflectance(c.reflectance),
                                                    std::clamp(beta_n, 0.01f, 1.0f));
        // Absorption by one unit of eumelanin and pheomelanin (d'Eon et al. 2011), as in pbrt-v4.
        const float e = std::max((*this)(c.eumelanin), 0.0f), p = std::max((*this)(c.pheomelanin), 0.0f);
        const Vec3f rgb = e * Vec3f{0.419f, 0.697f, 1.37f} + p * Vec3f{0.187f, 0.4f, 1.05f};
        return RgbUnboundedSpectrum(RgbColorSpace::srgb(), rgb).sample(lambda_);
    }

    // nm
    Float4 wavelengths() const { return lambda_.lambda; }
    // For directions that depend on the wavelength: only the hero is left.
    float hero_wavelength() const {
        lambda_.terminate_secondary();
        return lambda_.lambda[0];
    }

    MeasuredBsdf measured(MeasuredBrdfIndex b) const {
        return {&scene_.measured_brdfs[b.index], lambda_.lambda};
    }

    // Of a PlasticMaterial.
    const PlasticTable& plastic_table() const { return scene_.plastic(material_); }
    // Null where the closed form of CoatingTable does not hold for the material.
    const CoatingTable* coating_table() const { return widen_ ? nullptr : scene_.coating(material_); }

  private:
    static std::array<SampledWavelengths, 2> luminance_nodes() {
        std::array<SampledWavelengths, 2> nodes{};
        double sum = 0;
        int found = 0;
        for (int i = 0; i < visible_samples && found < 8; ++i) {
            sum += static_cast<double>(cie_y[static_cast<std::size_t>(i)]) / cie_y_integral;
            if (sum < (found + 0.5) / 8) continue;
            nodes[static_cast<std::size_t>(found / 4)].lambda[found % 4] = lambda_min + static_cast<float>(i);
            ++found;
        }
        return nodes;
    }

    const SceneView& scene_;
    Index material_;
    const TextureContext& context_;
    SampledWavelengths& lambda_;
    bool widen_;
};

} // namespace montelux
