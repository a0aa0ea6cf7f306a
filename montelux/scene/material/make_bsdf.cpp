#include "montelux/scene/material/make_bsdf.h"

#include "montelux/scene/texture/evaluate.h"

namespace montelux {

namespace {

struct Evaluator {
    const SceneView& scene;
    const TextureContext& context;
    SampledWavelengths& lambda;

    float operator()(const FloatParameter& p) const { return evaluate(scene, p, context); }
    SampledSpectrum operator()(const SpectrumParameter& p) const {
        return evaluate(scene, p, context, lambda);
    }
    SampledSpectrum reflectance(const SpectrumParameter& p) const { return clamp((*this)(p), 0, 1); }

    Ggx roughness(const RoughnessParameter& r) const {
        float u = (*this)(r.u), v = (*this)(r.v);
        if (r.remap) {
            u = Ggx::alpha_from_roughness(u);
            v = Ggx::alpha_from_roughness(v);
        }
        // A lobe narrower than this along one axis alone would overflow floats.
        Ggx ggx{u, v};
        if (!ggx.is_smooth()) ggx = {std::max(u, 1e-4f), std::max(v, 1e-4f)};
        return ggx;
    }

    float refractive_index(const Spectrum& eta) const {
        float value = eta.sample(lambda)[0];
        if (!eta.is_constant()) lambda.terminate_secondary();
        return value > 0 ? value : 1;
    }

    ConductorBsdf conductor(const ConductorMaterial& m, float outside) const {
        ConductorBsdf b;
        if (m.from_reflectance) {
            // eta = 1 and the k that gives this reflectance at normal incidence.
            SampledSpectrum r = clamp((*this)(m.reflectance), 0, 0.9999f);
            b.eta = SampledSpectrum(1);
            b.k = 2.0f * sqrt(r) / sqrt(clamp_zero(1.0f - r));
        } else {
            b.eta = (*this)(m.eta);
            b.k = (*this)(m.k);
        }
        // The indices are relative to vacuum; Fresnel's formulae want them relative to what light comes
        // through.
        b.eta /= outside;
        b.k /= outside;
        b.ggx = roughness(m.roughness);
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
};

bool differs(const RoughnessParameter& r) {
    return r.u.texture != r.v.texture || (r.u.is_constant() && r.u.value != r.v.value);
}

} // namespace

bool is_anisotropic(const Material& material) {
    return std::visit(
        [](const auto& m) {
            if constexpr (requires { m.conductor; })
                return differs(m.conductor.roughness) || differs(m.coating.roughness);
            else if constexpr (requires { m.coating; })
                return differs(m.coating.roughness);
            else if constexpr (requires { m.roughness; })
                return differs(m.roughness);
            else
                return false;
        },
        material);
}

Bsdf make_bsdf(const SceneView& scene, Index index, const TextureContext& context,
               SampledWavelengths& lambda) {
    Evaluator at{scene, context, lambda};
    return std::visit(
        [&](const auto& m) -> Bsdf {
            using M = std::decay_t<decltype(m)>;
            if constexpr (std::is_same_v<M, DiffuseMaterial>) {
                return DiffuseBsdf{at.reflectance(m.reflectance)};
            } else if constexpr (std::is_same_v<M, ConductorMaterial>) {
                return at.conductor(m, 1);
            } else if constexpr (std::is_same_v<M, DielectricMaterial>) {
                float eta = at.refractive_index(m.eta);
                return DielectricBsdf{eta, at.roughness(m.roughness)};
            } else if constexpr (std::is_same_v<M, ThinDielectricMaterial>) {
                return ThinDielectricBsdf{at.refractive_index(m.eta)};
            } else if constexpr (std::is_same_v<M, CoatedDiffuseMaterial>) {
                SampledSpectrum rho = at.reflectance(m.reflectance);
                if (const CoatingTable* table = scene.coating(index))
                    return CoatedDiffuseBsdf{table, table->base_albedo(rho)};
                float eta = at.refractive_index(m.coating.eta);
                return at.layered(m.coating, eta, DiffuseBsdf{rho}, Ggx{0.7f, 0.7f});
            } else {
                float eta = at.refractive_index(m.coating.eta);
                ConductorBsdf base = at.conductor(m.conductor, eta);
                Ggx coat = at.roughness(m.coating.roughness);
                // Light passes the coat twice: the lobes' widths add.
                auto widen = [](float a, float b) { return std::max(std::sqrt(a * a + 2 * b * b), 2e-3f); };
                Ggx proxy{widen(base.ggx.alpha_x, coat.alpha_x), widen(base.ggx.alpha_y, coat.alpha_y)};
                return at.layered(m.coating, eta, base, proxy);
            }
        },
        scene.materials[index]);
}

} // namespace montelux
