#include "montelux/scene/bsdf/tilted.h"

#include "montelux/scene/bsdf/bsdf_model.h"

namespace montelux {

namespace {

// The numbers that a BSDF may take, drawn already.
struct DrawnNumbers {
    float uc;
    Vec2f u;

    float next_1d() const { return uc; }
    Vec2f next_2d() const { return u; }
};

} // namespace

bool TiltedBsdf::is_specular() const {
    return std::visit([](const auto& b) { return b.is_specular(); }, base);
}
bool TiltedBsdf::has_specular() const {
    return std::visit([](const auto& b) { return b.has_specular(); }, base);
}
bool TiltedBsdf::has_diffuse() const {
    return std::visit([](const auto& b) { return b.has_diffuse(); }, base);
}
bool TiltedBsdf::is_stochastic() const {
    return std::visit([](const auto& b) { return b.traits.stochastic; }, base);
}
float TiltedBsdf::transmitted_eta(Vec3f wo) const { return montelux::transmitted_eta(base, wo); }
SampledSpectrum TiltedBsdf::albedo(Vec3f wo) const {
    return std::visit([&](const auto& b) { return b.albedo(wo); }, base);
}

// Flattened: with calls from here the compiler would inline less of the BSDFs elsewhere.
[[gnu::flatten]] BsdfEvaluation TiltedBsdf::evaluate(Vec3f wo, Vec3f wi, TransportMode mode, Vec2f u) const {
    if (!keeps_side(wo) || !keeps_side(wi)) return {};
    DrawnNumbers numbers{0, u};
    BsdfEvaluation e = std::visit([&](const auto& b) { return b.evaluate(wo, wi, mode, numbers); }, base);
    if (shadowing > 0) e.f *= unshadowed(mode == TransportMode::radiance ? wi : wo);
    return e;
}

[[gnu::flatten]] std::optional<BsdfSample> TiltedBsdf::sample(Vec3f wo, TransportMode mode, float uc,
                                                              Vec2f u) const {
    if (!keeps_side(wo)) return std::nullopt;
    DrawnNumbers numbers{uc, u};
    auto s = std::visit([&](const auto& b) { return b.sample(wo, mode, numbers); }, base);
    if (s && !keeps_side(s->wi)) return std::nullopt;
    if (s && shadowing > 0) s->weight *= unshadowed(mode == TransportMode::radiance ? s->wi : wo);
    return s;
}

} // namespace montelux
