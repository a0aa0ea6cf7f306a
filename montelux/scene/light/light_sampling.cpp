#include "montelux/scene/light/light_sampling.h"

#include <algorithm>
#include <cmath>

#include "montelux/mc/warp/disk.h"
#include "montelux/mc/warp/sphere.h"
#include "montelux/mc/warp/triangle.h"
#include "montelux/scene/shape/alpha.h"
#include "montelux/scene/shape/surface_point.h"

namespace montelux {

namespace {

// From off the surface at the reference to just before the point on the light, also where rounding could not
// have moved that.
Ray shadow_ray(const ReferencePoint& from, Vec3f wi, Point3f to, Normal3f n, float error) {
    Point3f o = offset_origin(from.p, from.n, from.error, wi);
    Point3f end = offset_origin(to, n, error, -wi);
    return {o, end - o, 1 - 0x1p-18f};
}

Ray shadow_ray_to_infinity(const ReferencePoint& from, Vec3f wi) {
    return {offset_origin(from.p, from.n, from.error, wi), wi};
}

std::optional<LightSample> from_area_point(const AreaLight& light, const ReferencePoint& from, Point3f p,
                                           Normal3f n, float error, float area_density,
                                           const SampledWavelengths& lambda) {
    Vec3f d = p - from.p;
    float d2 = length_squared(d);
    if (!(d2 > 0)) return std::nullopt;
    LightSample s;
    s.wi = d / std::sqrt(d2);
    float cosine = -dot(n, s.wi);
    if (!(cosine > 0) && !light.two_sided) return std::nullopt;
    cosine = std::abs(cosine);
    if (cosine == 0) return std::nullopt;
    s.radiance = light.spectrum.sample(lambda) * light.scale;
    s.pdf = area_density * d2 / cosine;
    s.shadow = shadow_ray(from, s.wi, p, n, error);
    return s;
}

float size_of(Vec3d p) {
    return static_cast<float>(std::max(std::abs(p.x), std::max(std::abs(p.y), std::abs(p.z))));
}

// A point outside a sphere sees it as a cone: uniform over its solid angle.
struct SphereCone {
    Vec3f axis;
    double distance;
    double sin2_max;
    // 1 - cos(theta_max) without cancellation.
    double one_minus_cos_max() const { return sin2_max / (1 + std::sqrt(std::max(0.0, 1 - sin2_max))); }
    float pdf() const { return static_cast<float>(inv_two_pi / one_minus_cos_max()); }
};
std::optional<SphereCone> cone_of(const WorldSphere& sphere, Point3f from) {
    Vec3d axis = sphere.center - Vec3d(from);
    double d2 = dot(axis, axis), r2 = sphere.radius * sphere.radius;
    if (d2 <= r2 * 1.0001) return std::nullopt;
    double d = std::sqrt(d2);
    return SphereCone{Vec3f(axis / d), d, r2 / d2};
}

std::optional<LightSample> sample_sphere(const AreaLight& light, const WorldSphere& sphere,
                                         const SphereCone& cone, bool flipped, const ReferencePoint& from,
                                         Vec2f u, const SampledWavelengths& lambda) {
    // Inside out: the visible side is dark.
    if (flipped && !light.two_sided) return std::nullopt;
    double one_minus_cos = double(u.x) * cone.one_minus_cos_max();
    double sin2 = one_minus_cos * (2 - one_minus_cos);
    float sin_theta = static_cast<float>(std::sqrt(sin2)), cos_theta = static_cast<float>(1 - one_minus_cos);
    float phi = two_pi_f * u.y;
    LightSample s;
    s.wi = Frame::from_normal(cone.axis).to_world(
        {sin_theta * std::cos(phi), sin_theta * std::sin(phi), cos_theta});
    s.pdf = cone.pdf();
    s.radiance = light.spectrum.sample(lambda) * light.scale;
    // The near intersection.
    double t = cone.distance * (1 - one_minus_cos) -
               std::sqrt(std::max(0.0, sphere.radius * sphere.radius - cone.distance * cone.distance * sin2));
    Vec3d p = Vec3d(from.p) + t * Vec3d(s.wi);
    Vec3f n = Vec3f(normalize(p - sphere.center));
    s.shadow =
        shadow_ray(from, s.wi, Vec3f(p), n, coordinate_error(size_of(p) + static_cast<float>(sphere.radius)));
    return s;
}

float spot_falloff(const SpotLight& light, Vec3f w) {
    float c = dot(w, light.axis);
    if (c >= light.cos_falloff_start) return 1;
    if (c <= light.cos_total_width) return 0;
    float t = (c - light.cos_total_width) / (light.cos_falloff_start - light.cos_total_width);
    return t * t * (3 - 2 * t);
}

std::optional<LightSample> sample_point(Point3f position, SampledSpectrum intensity,
                                        const ReferencePoint& from) {
    Vec3f d = position - from.p;
    float d2 = length_squared(d);
    if (!(d2 > 0)) return std::nullopt;
    LightSample s;
    s.wi = d / std::sqrt(d2);
    s.radiance = intensity / d2;
    s.pdf = 1;
    s.delta = s.invisible = true;
    Point3f o = offset_origin(from.p, from.n, from.error, s.wi);
    s.shadow = {o, position - o, 1};
    return s;
}

Vec3f in_light_space(const Transform& world_from_light, Vec3f wi) {
    return normalize(Vec3f(world_from_light.inverse_vector(Vec3d(wi))));
}
Vec2f map_point(const EnvironmentGrid& grid, const ImageInfiniteLight& light, Vec3f wi) {
    return grid.locate(in_light_space(light.world_from_light, wi));
}

// Solid angle in the light's space over that in the world: 1 unless the transformation scales unevenly.
float solid_angle_change(const Transform& world_from_light, Vec3f wi) {
    const double l = length(world_from_light.inverse_vector(Vec3d(wi)));
    return static_cast<float>(std::abs(world_from_light.inverse_matrix().linear_determinant()) / (l * l * l));
}

bool is_hidden(const SunLight& light, Vec3f wi) { return dot(wi, light.up) < 0; }

std::optional<LightSample> sample_sun(const SunLight& light, const ReferencePoint& from, Vec2f u,
                                      const SampledWavelengths& lambda) {
    const Vec3f wi = light.disc.sample(u);
    if (is_hidden(light, wi)) return std::nullopt;
    return LightSample{.radiance = light.spectrum.sample(lambda) * light.scale,
                       .wi = wi,
                       .pdf = light.disc.pdf(),
                       .shadow = shadow_ray_to_infinity(from, wi)};
}

std::optional<LightSample> sample_sky(const SkyLight& light, const SkyModel& sky,
                                      const EnvironmentSampler& density, const ReferencePoint& from, Vec2f u,
                                      const SampledWavelengths& lambda) {
    const EnvironmentPoint s = density.sample(u);
    if (!(s.pdf > 0)) return std::nullopt;
    const Vec3f w = density.grid().direction(s.grid);
    const Vec3f wi = normalize(light.world_from_light.vector(w));
    return LightSample{.radiance = sky.radiance(w, lambda) * light.scale,
                       .wi = wi,
                       .pdf = s.pdf * solid_angle_change(light.world_from_light, wi),
                       .shadow = shadow_ray_to_infinity(from, wi)};
}

std::optional<LightSample> sample_uniform_sky(const UniformInfiniteLight& light, const ReferencePoint& from,
                                              Vec2f u, const SampledWavelengths& lambda) {
    LightSample s;
    if (light.portal) {
        const auto seen = light.portal->seen_from(from.p);
        if (!seen) return std::nullopt;
        s.wi = seen->sample(u);
        s.pdf = seen->pdf();
    } else {
        s.wi = sample_uniform_sphere(u);
        s.pdf = inv_four_pi_f;
    }
    s.radiance = light.spectrum.sample(lambda) * light.scale;
    s.shadow = shadow_ray_to_infinity(from, s.wi);
    return s;
}

std::optional<LightSample> sample_through_portal(const Scene& scene, const LightTables& tables,
                                                 const ImageInfiniteLight& light, const PortalSampler& portal,
                                                 const ReferencePoint& from, Vec2f u,
                                                 const SampledWavelengths& lambda) {
    const auto s = portal.sample(from.p, u);
    if (!s) return std::nullopt;
    const Vec2f place = map_point(portal.grid(), light, s->wi);
    return LightSample{.radiance =
                           tables.map_radiance(scene, light, portal.grid(), place, lambda) * light.scale,
                       .wi = s->wi,
                       .pdf = s->pdf,
                       .shadow = shadow_ray_to_infinity(from, s->wi)};
}

// A point on an area light and the density of its choice.
std::optional<LightSample> sample_area_light(const Scene& scene, const SceneTables& scene_tables, Index index,
                                             const AreaLight& light, const ReferencePoint& from, Vec2f u,
                                             const SampledWavelengths& lambda) {
    const LightTables& tables = scene_tables.lights();
    const Shape& shape = scene.shapes[light.shape];
    Hit hit{.t = 0, .shape = light.shape, .primitive = light.primitive};
    Point3f p;
    std::optional<LightSample> s;
    if (shape.mesh != no_index) {
        const LightTriangle& t = tables.triangle(index);
        if (!(t.area > 0)) return std::nullopt;
        const Vec3f b = sample_uniform_triangle(u);
        hit.b1 = b.y;
        hit.b2 = b.z;
        p = t.p0 + b.y * t.e1 + b.z * t.e2;
        s = from_area_point(light, from, p, t.n, t.error, 1 / t.area, lambda);
    } else if (const auto& disk = tables.disk(index)) {
        const Vec2f d = sample_uniform_disk_concentric(u);
        p = disk->center + d.x * disk->s + d.y * disk->t;
        const Vec3f reach = abs(disk->center) + abs(disk->s) + abs(disk->t);
        s = from_area_point(light, from, p, shape.flip_normal ? -disk->n : disk->n,
                            coordinate_error(disk->n, reach), 1 / disk->area, lambda);
    } else {
        if (const auto& sphere = tables.sphere(index))
            if (auto cone = cone_of(*sphere, from.p))
                return sample_sphere(light, *sphere, *cone, shape.flip_normal, from, u, lambda);
        const QuadricAreaSample q = sample_area(scene.quadrics[shape.quadric], u);
        p = Vec3f(q.point.p);
        const Normal3f n(shape.flip_normal ? -q.point.n : q.point.n);
        s = from_area_point(light, from, p, n, coordinate_error(n, abs(p)), static_cast<float>(q.pdf),
                            lambda);
    }
    if (!s || !is_cut_out(shape)) return s;
    if (constant_alpha(scene, shape).value_or(1) <= 0) {
        s->invisible = true;
        return s;
    }
    const float alpha = alpha_at(scene, scene_tables, {p, s->wi}, hit);
    if (!(alpha > 0)) return std::nullopt;
    s->radiance *= std::min(alpha, 1.0f);
    return s;
}

} // namespace

SampledSpectrum emitted_radiance(const AreaLight& light, Normal3f n, Vec3f w,
                                 const SampledWavelengths& lambda) {
    if (!light.two_sided && !(dot(n, w) > 0)) return {};
    return light.spectrum.sample(lambda) * light.scale;
}

SampledSpectrum infinite_radiance(const Scene& scene, const LightTables& tables, Index index, Point3f p,
                                  Vec3f wi, const SampledWavelengths& lambda) {
    const Light& any = scene.lights[index];
    if (const auto* light = std::get_if<UniformInfiniteLight>(&any)) {
        if (light->portal && !light->portal->lets_through(p, wi)) return {};
        return light->spectrum.sample(lambda) * light->scale;
    }
    if (const auto* light = std::get_if<ImageInfiniteLight>(&any)) {
        if (light->portal && !light->portal->lets_through(p, wi)) return {};
        const EnvironmentGrid& grid =
            light->portal ? tables.portal(index).grid() : tables.environment(index).grid();
        return tables.map_radiance(scene, *light, grid, map_point(grid, *light, wi), lambda) * light->scale;
    }
    if (const auto* light = std::get_if<SkyLight>(&any))
        return scene.skies[light->sky].radiance(in_light_space(light->world_from_light, wi), lambda) *
               light->scale;
    if (const auto* light = std::get_if<SunLight>(&any))
        if (light->disc.contains(wi) && !is_hidden(*light, wi))
            return light->spectrum.sample(lambda) * light->scale;
    return {};
}

std::optional<LightSample> sample_light(const Scene& scene, const SceneTables& scene_tables, Index index,
                                        const ReferencePoint& from, Vec2f u,
                                        const SampledWavelengths& lambda) {
    const LightTables& tables = scene_tables.lights();
    const Light& any = scene.lights[index];
    if (const auto* light = std::get_if<AreaLight>(&any))
        return sample_area_light(scene, scene_tables, index, *light, from, u, lambda);
    if (const auto* light = std::get_if<PointLight>(&any))
        return sample_point(light->position, light->spectrum.sample(lambda) * light->scale, from);
    if (const auto* light = std::get_if<SpotLight>(&any)) {
        float falloff = spot_falloff(*light, normalize(from.p - light->position));
        if (falloff == 0) return std::nullopt;
        return sample_point(light->position, light->spectrum.sample(lambda) * (light->scale * falloff), from);
    }
    if (const auto* light = std::get_if<DistantLight>(&any))
        return LightSample{.radiance = light->spectrum.sample(lambda) * light->scale,
                           .wi = light->to_light,
                           .pdf = 1,
                           .delta = true,
                           .invisible = true,
                           .shadow = shadow_ray_to_infinity(from, light->to_light)};
    if (const auto* light = std::get_if<UniformInfiniteLight>(&any))
        return sample_uniform_sky(*light, from, u, lambda);
    if (const auto* light = std::get_if<SkyLight>(&any))
        return sample_sky(*light, scene.skies[light->sky], tables.environment(index), from, u, lambda);
    if (const auto* light = std::get_if<SunLight>(&any)) return sample_sun(*light, from, u, lambda);
    const auto& light = std::get<ImageInfiniteLight>(any);
    if (light.portal)
        return sample_through_portal(scene, tables, light, tables.portal(index), from, u, lambda);
    const EnvironmentSampler& environment = tables.environment(index);
    EnvironmentPoint s = environment.sample(u);
    if (!(s.pdf > 0)) return std::nullopt;
    Vec3f wi = light.world_from_light.vector(environment.grid().direction(s.grid));
    wi = normalize(wi);
    return LightSample{.radiance = tables.map_radiance(scene, light, environment.grid(), s.grid, lambda) *
                                   light.scale,
                       .wi = wi,
                       .pdf = s.pdf * solid_angle_change(light.world_from_light, wi),
                       .shadow = shadow_ray_to_infinity(from, wi)};
}

float area_light_pdf(const Scene& scene, const LightTables& tables, Index index, const ReferencePoint& from,
                     Point3f p, Normal3f n) {
    const auto& light = std::get<AreaLight>(scene.lights[index]);
    const Shape& shape = scene.shapes[light.shape];
    float area_density;
    if (shape.mesh != no_index) {
        area_density = 1 / tables.triangle(index).area;
    } else if (const auto& disk = tables.disk(index)) {
        area_density = 1 / disk->area;
    } else {
        if (const auto& sphere = tables.sphere(index))
            if (auto cone = cone_of(*sphere, from.p)) return cone->pdf();
        area_density = static_cast<float>(area_pdf(scene.quadrics[shape.quadric], Vec3d(p)));
    }
    Vec3f d = p - from.p;
    float d2 = length_squared(d);
    float cosine = std::abs(dot(n, d)) / std::sqrt(d2);
    return cosine > 0 ? area_density * d2 / cosine : 0;
}

float infinite_light_pdf(const Scene& scene, const LightTables& tables, Index index, Point3f p, Vec3f wi) {
    if (const auto* sun = std::get_if<SunLight>(&scene.lights[index]))
        return sun->disc.contains(wi) ? sun->disc.pdf() : 0;
    if (const auto* sky = std::get_if<SkyLight>(&scene.lights[index])) {
        const EnvironmentSampler& density = tables.environment(index);
        return density.pdf(density.grid().locate(in_light_space(sky->world_from_light, wi))) *
               solid_angle_change(sky->world_from_light, wi);
    }
    if (const auto* light = std::get_if<UniformInfiniteLight>(&scene.lights[index])) {
        if (!light->portal) return inv_four_pi_f;
        if (!light->portal->lets_through(p, wi)) return 0;
        const auto seen = light->portal->seen_from(p);
        return seen ? seen->pdf() : 0;
    }
    const auto* light = std::get_if<ImageInfiniteLight>(&scene.lights[index]);
    if (light == nullptr) return inv_four_pi_f;
    if (light->portal) return tables.portal(index).pdf(p, wi);
    const EnvironmentSampler& environment = tables.environment(index);
    return environment.pdf(map_point(environment.grid(), *light, wi)) *
           solid_angle_change(light->world_from_light, wi);
}

} // namespace montelux
