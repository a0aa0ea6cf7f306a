#include "montelux/scene/light/area_light.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "montelux/mc/math/frame.h"
#include "montelux/mc/math/overloaded.h"
#include "montelux/mc/warp/hemisphere.h"
#include "montelux/scene/light/emissive_shape.h"
#include "montelux/scene/light/shadow_ray.h"
#include "montelux/scene/light/sphere_cone.h"
#include "montelux/scene/light/visible_mean.h"
#include "montelux/scene/shape/alpha.h"

namespace montelux {

namespace {

float sides(const AreaLight& light) { return light.two_sided ? 2.0f : 1.0f; }

// Radiance over AreaLight::spectrum.
float radiance_scale(const AreaLight& light, const LightContext& context, Index part) {
    if (!(light.primitive_flux > 0)) return light.scale;
    const Shape& shape = context.scene.shapes[light.shape];
    if (quadric_of(context.scene, shape) != nullptr) return light.scale;
    const float area = context.tables().area(context.light, part);
    return area > 0 ? light.scale * (light.primitive_flux / (sides(light) * area * pi_f)) : 0;
}

// Radiance over radiance_scale at a point of the surface, seen along w.
SampledSpectrum color_at(const AreaLight& light, const LightContext& context, Point3f p, Vec3f w, Hit hit,
                         const SampledWavelengths& lambda) {
    if (light.picture == no_index) return context.scene.sample(light.spectrum, lambda);
    hit.t = 0;
    hit.shape = light.shape;
    const Point2f uv = surface_point(context.scene, {p, w}, hit, true).uv;
    return context.tables().picture_radiance(light.picture, uv, lambda);
}

// As if the picture covered each part evenly.
double picture_brightness(const LightContext& context, Index picture) {
    const Image& image = context.tables().maps[picture];
    double sum = 0;
    for (std::size_t i = 0; i < image.sample_count(); ++i) sum += double(image.value_at(i));
    const Spectrum white(RgbIlluminantSpectrum(LightTablesView::map_color_space(), {1, 1, 1}));
    return visible_mean(white) * sum / static_cast<double>(image.sample_count());
}

// Whether the surface emits along a direction with that cosine to its normal.
bool shines(const AreaLight& light, float cosine) { return cosine > 0 || (light.two_sided && cosine < 0); }

float size_of(Vec3d p) {
    return static_cast<float>(std::max(std::abs(p.x), std::max(std::abs(p.y), std::abs(p.z))));
}

std::optional<LightSample> sample_sphere(const AreaLight& light, const LightContext& context,
                                         const WorldSphere& sphere, const SphereCone& cone, bool flipped,
                                         const ReferencePoint& from, Vec2f u,
                                         const SampledWavelengths& lambda) {
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
    // The near intersection.
    double t = cone.distance * (1 - one_minus_cos) -
               std::sqrt(std::max(0.0, sphere.radius * sphere.radius - cone.distance * cone.distance * sin2));
    Vec3d p = Vec3d(from.p) + t * Vec3d(s.wi);
    s.radiance = color_at(light, context, Vec3f(p), s.wi, {}, lambda) * light.scale;
    Vec3f n = Vec3f(normalize(p - sphere.center));
    s.shadow =
        shadow_ray(from, s.wi, Vec3f(p), n, coordinate_error(size_of(p) + static_cast<float>(sphere.radius)));
    return s;
}

std::optional<SphereCone> cone_of(const LightContext& context, Point3f from) {
    const auto& sphere = context.tables().sphere(context.light);
    return sphere ? SphereCone::seen_from(from, *sphere) : std::nullopt;
}

bool is_invisible(const LightContext& context, const Shape& shape) {
    return is_cut_out(shape) && constant_alpha(context.scene, shape).value_or(1) <= 0;
}

// Share of the light that leaves `point` along w, or arrives along it: holes do not emit. 1 for lights of
// alpha 0.
float share_there(const LightContext& context, const Shape& shape, const EmissivePoint& point, Vec3f w) {
    if (!is_cut_out(shape) || is_invisible(context, shape)) return 1;
    return std::clamp(alpha_at(context.scene, {point.p, w}, point.hit), 0.0f, 1.0f);
}

std::optional<LightSample> sample_surface(const AreaLight& light, const LightContext& context, Index part,
                                          const ReferencePoint& from, Vec2f u,
                                          const SampledWavelengths& lambda) {
    std::optional<LightSample> result;
    const auto point = sample_area(context, light.shape, part, u);
    if (!point) return result;
    const Vec3f d = point->p - from.p;
    const float d2 = length_squared(d);
    if (!(d2 > 0)) return result;
    const Vec3f wi = d / std::sqrt(d2);
    const float cosine = -dot(point->n, wi);
    if (!shines(light, cosine)) return result;
    const Shape& shape = context.scene.shapes[light.shape];
    const float share = share_there(context, shape, *point, wi);
    if (!(share > 0)) return result;
    LightSample& s = result.emplace();
    s.radiance = color_at(light, context, point->p, wi, point->hit, lambda) *
                 radiance_scale(light, context, part) * share;
    s.wi = wi;
    s.pdf = point->area_density * d2 / std::abs(cosine);
    s.invisible = is_invisible(context, shape);
    s.shadow = shadow_ray(from, wi, point->p, point->n, point->error);
    return result;
}

LightBounds triangle_bounds(const TriangleMesh& mesh, const LightTriangle& t, Index part) {
    LightBounds b;
    for (const Vec3d p : {Vec3d(t.p0), Vec3d(t.p0) + Vec3d(t.e1), Vec3d(t.p0) + Vec3d(t.e2)}) b.box.add(p);
    if (!(t.area > 0)) return b;
    b.axis = t.n;
    b.cos_theta_o = 1;
    if (mesh.normals.empty()) return b;
    // Where the vertices disagree the side changes within the triangle.
    int turned = 0;
    for (int k = 0; k < 3; ++k)
        turned += turns_normal(mesh.normals[mesh.indices[3 * std::size_t{part} + k]], t.n);
    if (turned == 3) b.axis = -t.n;
    b.two_sided = turned == 1 || turned == 2;
    return b;
}

LightBounds patch_bounds(const BilinearMesh& mesh, const Shape& shape, Index part) {
    LightBounds b;
    b.box = mesh.patch_bounds(part);
    // Normals lie between those of the corners (normal_of).
    const std::array<Normal3f, 4> normals = {
        patch_normal(mesh, shape, part, 0, 0), patch_normal(mesh, shape, part, 1, 0),
        patch_normal(mesh, shape, part, 0, 1), patch_normal(mesh, shape, part, 1, 1)};
    const Vec3f sum = normals[0] + normals[1] + normals[2] + normals[3];
    if (!(length(sum) > 0) || !mesh.normals.empty()) return b;
    const Vec3f axis = normalize(sum);
    float cosine = 1;
    for (const Normal3f n : normals) cosine = std::min(cosine, dot(axis, n));
    if (!(cosine > 0)) return b;
    b.axis = axis;
    b.cos_theta_o = cosine;
    return b;
}

LightBounds quadric_bounds(const Quadric& quadric, bool flip_normal) {
    LightBounds b;
    b.box = world_bounds(quadric);
    if (const auto normal = constant_normal(quadric)) {
        b.axis = Vec3f(flip_normal ? -*normal : *normal);
        b.cos_theta_o = 1;
    }
    return b;
}

} // namespace

Index AreaLight::part_count(const LightContext& context) const {
    if (!context.tables().is_in_world(shape)) return 0;
    const Shape& s = context.scene.shapes[shape];
    return visit_geometry(
        context.scene, s,
        Overloaded{[](const TriangleMesh& mesh) { return static_cast<Index>(mesh.triangle_count()); },
                   [](const BilinearMesh& mesh) { return static_cast<Index>(mesh.patch_count()); },
                   [](const Quadric&) { return Index{1}; }, [](const Curves&) { return Index{0}; }});
}

std::optional<LightSample> AreaLight::sample_li(const LightContext& context, Index part,
                                                const ReferencePoint& from, Vec2f u,
                                                const SampledWavelengths& lambda) const {
    const Shape& s = context.scene.shapes[shape];
    if (const auto cone = cone_of(context, from.p))
        return sample_sphere(*this, context, *context.tables().sphere(context.light), *cone, s.flip_normal,
                             from, u, lambda);
    return sample_surface(*this, context, part, from, u, lambda);
}

float AreaLight::pdf_li(const LightContext& context, const ReferencePoint& from, const LightHit& hit) const {
    if (const auto cone = cone_of(context, from.p)) return cone->pdf();
    const float density = area_density(context, shape, hit);
    Vec3f d = hit.p - from.p;
    float d2 = length_squared(d);
    float cosine = std::abs(dot(hit.n, d)) / std::sqrt(d2);
    return cosine > 0 ? density * d2 / cosine : 0;
}

SampledSpectrum AreaLight::radiance(const LightContext& context, const ReferencePoint&, const LightHit& hit,
                                    const SampledWavelengths& lambda) const {
    if (!shines(*this, -dot(hit.n, hit.wi))) return {};
    const Hit at{.b1 = hit.b.x, .b2 = hit.b.y, .primitive = hit.part};
    return color_at(*this, context, hit.p, hit.wi, at, lambda) * radiance_scale(*this, context, hit.part);
}

std::optional<EmissionSample> AreaLight::sample_le(const LightContext& context, Index part, Vec2f u_position,
                                                   Vec2f u_direction,
                                                   const SampledWavelengths& lambda) const {
    const auto point = sample_area(context, shape, part, u_position);
    if (!point) return std::nullopt;
    bool back = false;
    if (two_sided) {
        back = u_direction.x >= 0.5f;
        u_direction.x = 2 * u_direction.x - (back ? 1.0f : 0.0f);
    }
    const Vec3f local = sample_cosine_hemisphere(u_direction);
    if (!(local.z > 0)) return std::nullopt;
    const Normal3f n = back ? -point->n : point->n;
    const Vec3f w = normalize(Frame::from_normal(n).to_world(local));
    const float share = share_there(context, context.scene.shapes[shape], *point, w);
    if (!(share > 0)) return std::nullopt;
    EmissionSample s;
    s.radiance = color_at(*this, context, point->p, w, point->hit, lambda) *
                 (radiance_scale(*this, context, part) * share);
    s.ray = {offset_origin(point->p, n, point->error, w), w};
    s.n = n;
    s.cosine = local.z;
    s.pdf_position = point->area_density;
    s.pdf_direction = cosine_hemisphere_pdf(local.z) / sides(*this);
    return s;
}

EmissionPdf AreaLight::pdf_le(const LightContext& context, const LightHit& hit, Vec3f w) const {
    const float cosine = dot(hit.n, w);
    return {area_density(context, shape, hit),
            cosine_hemisphere_pdf(two_sided ? std::abs(cosine) : cosine) / sides(*this)};
}

void AreaLight::powers(const LightContext& context, std::span<double> parts) const {
    const Shape& s = context.scene.shapes[shape];
    const float alpha = constant_alpha(context.scene, s).value_or(1);
    const double brightness = picture == no_index ? visible_mean(context.scene.spectrum(spectrum))
                                                  : picture_brightness(context, picture);
    auto power = [&](double area, float factor) {
        if (alpha > 0 && alpha < 1) area *= double(alpha);
        return pi * area * (two_sided ? 2 : 1) * double(factor) * brightness;
    };
    const auto of_primitives = [&] {
        for (Index part = 0; part < parts.size(); ++part)
            parts[part] = power(double(context.tables().area(context.light, part)),
                                radiance_scale(*this, context, part));
    };
    visit_geometry(context.scene, s,
                   Overloaded{[&](const Quadric& quadric) { parts[0] = power(world_area(quadric), scale); },
                              [&](const TriangleMesh&) { of_primitives(); },
                              [&](const BilinearMesh&) { of_primitives(); }, [](const Curves&) {}});
}

std::optional<LightBounds> AreaLight::bounds(const LightContext& context, Index part) const {
    const Shape& s = context.scene.shapes[shape];
    LightBounds b = visit_geometry(
        context.scene, s,
        Overloaded{[&](const TriangleMesh& mesh) {
                       return triangle_bounds(mesh, context.tables().triangle(context.light, part), part);
                   },
                   [&](const Quadric& quadric) { return quadric_bounds(quadric, s.flip_normal); },
                   [&](const BilinearMesh& mesh) { return patch_bounds(mesh, s, part); },
                   [](const Curves&) { return LightBounds{}; }});
    b.cos_theta_e = 0;
    b.two_sided = b.two_sided || two_sided;
    return b;
}

} // namespace montelux
