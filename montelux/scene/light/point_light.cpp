#include "montelux/scene/light/point_light.h"

#include <cmath>

#include "montelux/mc/warp/sphere.h"
#include "montelux/scene/light/light_context.h"
#include "montelux/scene/light/visible_mean.h"

namespace montelux {

std::optional<LightSample> sample_position(Point3f position, SampledSpectrum intensity,
                                           const ReferencePoint& from) {
    std::optional<LightSample> result;
    Vec3f d = position - from.p;
    float d2 = length_squared(d);
    if (!(d2 > 0)) return result;
    LightSample& s = result.emplace();
    s.wi = d / std::sqrt(d2);
    s.radiance = intensity / d2;
    s.pdf = 1;
    s.delta = s.invisible = true;
    Point3f o = offset_origin(from.p, from.n, from.error, s.wi);
    s.shadow = {o, position - o, 1};
    return result;
}

PointLight PointLight::moved(const Transform& world_from_own) const {
    return {spectrum, scale, world_from_own.point(position)};
}

Index PointLight::part_count(const LightContext&) const { return 1; }

std::optional<LightSample> PointLight::sample_li(const LightContext& context, Index,
                                                 const ReferencePoint& from, Vec2f,
                                                 const SampledWavelengths& lambda) const {
    return sample_position(position, context.scene.sample(spectrum, lambda) * scale, from);
}

float PointLight::pdf_li(const LightContext&, const ReferencePoint&, const LightHit&) const { return 0; }

SampledSpectrum PointLight::radiance(const LightContext&, const ReferencePoint&, const LightHit&,
                                     const SampledWavelengths&) const {
    return {};
}

std::optional<EmissionSample> PointLight::sample_le(const LightContext& context, Index, Vec2f, Vec2f u,
                                                    const SampledWavelengths& lambda) const {
    EmissionSample s;
    s.radiance = context.scene.sample(spectrum, lambda) * scale;
    s.ray = {position, sample_uniform_sphere(u)};
    s.pdf_position = 1;
    s.pdf_direction = inv_four_pi_f;
    return s;
}

EmissionPdf PointLight::pdf_le(const LightContext&, const LightHit&, Vec3f) const {
    return {0, inv_four_pi_f};
}

void PointLight::powers(const LightContext& context, std::span<double> parts) const {
    parts[0] = 4 * pi * (double(scale) * visible_mean(context.scene.spectrum(spectrum)));
}

std::optional<LightBounds> PointLight::bounds(const LightContext&, Index) const {
    LightBounds b;
    b.box.add(Vec3d(position));
    return b;
}

} // namespace montelux
