#include "montelux/scene/light/projection_light.h"

#include <algorithm>

#include "montelux/scene/light/light_context.h"
#include "montelux/scene/light/point_light.h"
#include "montelux/scene/light/turned_map.h"
#include "montelux/scene/light/visible_mean.h"

namespace montelux {

namespace {

const ProjectionTable& table_of(const LightContext& context) {
    return context.tables().projection(context.light);
}

// `w`: in the light's space, of any length.
SampledSpectrum intensity(const LightContext& context, const ProjectionLight& light, Vec2f texels, Vec3f w,
                          const SampledWavelengths& lambda) {
    const auto width = static_cast<std::size_t>(table_of(context).screen().width());
    if (light.profile == ProjectionProfile::irradiance) {
        const auto height = static_cast<float>(table_of(context).screen().height());
        const Point2f uv{texels.x / static_cast<float>(width), 1 - texels.y / height};
        return context.tables().picture_color(light.environment, uv, light.picture_lookup, lambda) *
               LightTablesView::white_of_picture(light.equal_energy, lambda) *
               (light.scale * intensity_of_white(light.profile, normalize(w).z));
    }
    const auto x = static_cast<std::size_t>(texels.x), y = static_cast<std::size_t>(texels.y);
    return context.tables().texel_radiance(light.environment, y * width + x, lambda) * light.scale;
}

} // namespace

ProjectionLight ProjectionLight::moved(const Transform& world_from_own) const {
    ProjectionLight light = *this;
    light.world_from_light = world_from_own * world_from_light;
    light.motion = no_index;
    return light;
}

Index ProjectionLight::part_count(const LightContext&) const { return 1; }

std::optional<LightSample> ProjectionLight::sample_li(const LightContext& context, Index,
                                                      const ReferencePoint& from, Vec2f,
                                                      const SampledWavelengths& lambda) const {
    const Vec3d to = Vec3d(from.p) - world_from_light.point(Vec3d());
    const Vec3f own(world_from_light.inverse_vector(to));
    const auto texels = table_of(context).screen().locate(own);
    if (!texels) return std::nullopt;
    const SampledSpectrum i = intensity(context, *this, *texels, own, lambda);
    if (is_black(i)) return std::nullopt;
    return sample_position(position(), i, from);
}

float ProjectionLight::pdf_li(const LightContext&, const ReferencePoint&, const LightHit&) const { return 0; }

SampledSpectrum ProjectionLight::radiance(const LightContext&, const ReferencePoint&, const LightHit&,
                                          const SampledWavelengths&) const {
    return {};
}

std::optional<EmissionSample> ProjectionLight::sample_le(const LightContext& context, Index, Vec2f, Vec2f u,
                                                         const SampledWavelengths& lambda) const {
    const auto d = table_of(context).sample(u);
    if (!d) return std::nullopt;
    const Vec3f w = normalize(world_from_light.vector(d->w));
    EmissionSample s;
    s.radiance = intensity(context, *this, d->texels, d->w, lambda);
    s.ray = {position(), w};
    s.pdf_position = 1;
    s.pdf_direction = d->pdf * solid_angle_change(world_from_light, w);
    return s;
}

EmissionPdf ProjectionLight::pdf_le(const LightContext& context, const LightHit&, Vec3f w) const {
    return {0, table_of(context).pdf(Vec3f(world_from_light.inverse_vector(Vec3d(w)))) *
                   solid_angle_change(world_from_light, w)};
}

// Exact for grey pictures, unless the transformation scales unevenly.
void ProjectionLight::powers(const LightContext& context, std::span<double> parts) const {
    const Spectrum illuminant(RgbIlluminantSpectrum(LightTablesView::map_color_space(), {1, 1, 1}));
    const Spectrum white = equal_energy ? Spectrum(1.0f) : illuminant;
    parts[0] = double(scale) * visible_mean(white) * table_of(context).flux();
}

// The cone around the corners: a linear transformation keeps the rectangle convex.
std::optional<LightBounds> ProjectionLight::bounds(const LightContext& context, Index) const {
    LightBounds b;
    b.box.add(Vec3d(position()));
    const ProjectionScreen& screen = table_of(context).screen();
    const auto w = static_cast<float>(screen.width()), h = static_cast<float>(screen.height());
    b.axis = normalize(world_from_light.vector(Vec3f(0, 0, 1)));
    b.cos_theta_o = 1;
    float widest = 1;
    for (const Vec2f corner : {Vec2f{0, 0}, Vec2f{w, 0}, Vec2f{0, h}, Vec2f{w, h}})
        widest = std::min(widest, dot(b.axis, normalize(world_from_light.vector(screen.direction(corner)))));
    b.cos_theta_e = widest - 1e-5f;
    return b;
}

} // namespace montelux
