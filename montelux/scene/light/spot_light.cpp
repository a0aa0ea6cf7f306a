#include "montelux/scene/light/spot_light.h"

#include <algorithm>
#include <cmath>

#include "montelux/mc/math/frame.h"
#include "montelux/mc/warp/cone.h"
#include "montelux/scene/light/light_context.h"
#include "montelux/scene/light/point_light.h"
#include "montelux/scene/light/visible_mean.h"

namespace montelux {

namespace {

double mean_of(const Image& picture) {
    double sum = 0;
    for (std::size_t i = 0; i < picture.sample_count(); ++i) sum += double(picture.value_at(i));
    return sum / static_cast<double>(picture.sample_count());
}

} // namespace

float SpotLight::falloff(Vec3f w) const {
    float c = dot(w, axis);
    if (c >= cos_falloff_start) return 1;
    if (c <= cos_total_width) return 0;
    if (profile == SpotFalloff::linear) {
        const float end = std::acos(cos_total_width), start = std::acos(cos_falloff_start);
        return std::clamp((end - std::acos(c)) / (end - start), 0.0f, 1.0f);
    }
    float t = (c - cos_total_width) / (cos_falloff_start - cos_total_width);
    return t * t * (3 - 2 * t);
}

SampledSpectrum SpotLight::intensity(const LightContext& context, Vec3f w,
                                     const SampledWavelengths& lambda) const {
    const float share = falloff(w);
    if (share == 0) return {};
    SampledSpectrum result = context.scene.sample(spectrum, lambda) * (scale * share);
    if (picture == no_index) return result;
    const float depth = 2 * dot(w, axis);
    const Point2f place{0.5f + dot(w, picture_x) / depth, 0.5f + dot(w, picture_y) / depth};
    return result * context.tables().picture_color(picture, {place.x, 1 - place.y}, picture_lookup, lambda);
}

SpotLight SpotLight::moved(const Transform& world_from_own) const {
    SpotLight light = *this;
    light.position = world_from_own.point(position);
    light.axis = normalize(world_from_own.vector(axis));
    for (Vec3f* side : {&light.picture_x, &light.picture_y})
        if (const float size = length(*side); size > 0)
            *side = size * normalize(world_from_own.vector(*side));
    light.motion = no_index;
    return light;
}

Index SpotLight::part_count(const LightContext&) const { return 1; }

std::optional<LightSample> SpotLight::sample_li(const LightContext& context, Index,
                                                const ReferencePoint& from, Vec2f,
                                                const SampledWavelengths& lambda) const {
    const SampledSpectrum i = intensity(context, normalize(from.p - position), lambda);
    if (is_black(i)) return std::nullopt;
    return sample_position(position, i, from);
}

float SpotLight::pdf_li(const LightContext&, const ReferencePoint&, const LightHit&) const { return 0; }

SampledSpectrum SpotLight::radiance(const LightContext&, const ReferencePoint&, const LightHit&,
                                    const SampledWavelengths&) const {
    return {};
}

// Uniform over the cone: at least half of the flux is where the density would have to be highest.
std::optional<EmissionSample> SpotLight::sample_le(const LightContext& context, Index, Vec2f, Vec2f u,
                                                   const SampledWavelengths& lambda) const {
    const float versine = 1 - cos_total_width;
    if (!(versine > 0)) return std::nullopt;
    const Vec3f w =
        normalize(Frame::from_normal(normalize(axis)).to_world(sample_uniform_cone_from_versine(u, versine)));
    EmissionSample s;
    s.radiance = intensity(context, w, lambda);
    s.ray = {position, w};
    s.pdf_position = 1;
    s.pdf_direction = uniform_cone_pdf_from_versine(versine);
    return s;
}

EmissionPdf SpotLight::pdf_le(const LightContext&, const LightHit&, Vec3f w) const {
    if (!(dot(w, axis) > cos_total_width)) return {};
    return {0, uniform_cone_pdf_from_versine(1 - cos_total_width)};
}

void SpotLight::powers(const LightContext& context, std::span<double> parts) const {
    const double flux = double(scale) * visible_mean(context.scene.spectrum(spectrum));
    // The integral of the falloff over the cosine.
    double share =
        (1 - double(cos_falloff_start)) + 0.5 * (double(cos_falloff_start) - double(cos_total_width));
    if (profile == SpotFalloff::linear && cos_falloff_start > cos_total_width) {
        const double end = std::acos(double(cos_total_width)), start = std::acos(double(cos_falloff_start));
        share = 1 - (std::sin(end) - std::sin(start)) / (end - start);
    }
    // As if the picture were even.
    const double mean = picture == no_index ? 1 : mean_of(context.tables().maps[picture]);
    parts[0] = 2 * pi * flux * share * mean;
}

std::optional<LightBounds> SpotLight::bounds(const LightContext&, Index) const {
    LightBounds b;
    b.box.add(Vec3d(position));
    b.axis = normalize(axis);
    b.cos_theta_o = 1;
    b.cos_theta_e = cos_total_width;
    return b;
}

} // namespace montelux
