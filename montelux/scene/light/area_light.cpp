#include "montelux/scene/light/area_light.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "montelux/mc/math/frame.h"
#include "montelux/mc/math/overloaded.h"
#include "montelux/mc/warp/hemisphere.h"
#include "montelux/mc/warp/triangle.h"
#include "montelux/scene/light/emissive_shape.h"
#include "montelux/scene/light/motion_bounds.h"
#include "montelux/scene/light/shadow_ray.h"
#include "montelux/scene/light/sphere_cone.h"
#include "montelux/scene/light/visible_mean.h"
#include "montelux/scene/shape/alpha.h"

namespace montelux {

namespace {

float sides(const AreaLight& light) { return light.two_sided ? 2.0f : 1.0f; }

Ray ray_at(const LightContext& context, Point3f p, Vec3f w) { return {.o = p, .d = w, .time = context.time}; }

// Of a triangle or a patch, in the world.
float primitive_area(const AreaLight& light, const LightContext& context, Index part) {
    const Index instance = context.tables().instance(context.light);
    if (!light.moves(context)) return context.tables().area(context.light, part);
    const Shape& shape = context.scene.shapes[light.shape];
    const TriangleMesh* mesh = mesh_of(context.scene, shape);
    if (mesh == nullptr) {
        const EmitterPlace place(context, instance);
        const auto at = [&](Vec3d p) { return place.world_from_shape().point(p); };
        const auto [p00, p10, p01, p11] = bilinear_mesh_of(context.scene, shape)->patch(part);
        return static_cast<float>(area_of({at(p00), at(p10), at(p01), at(p11)}));
    }
    const LightTriangle t = light_triangle(*mesh, shape, part, context.time);
    if (instance == no_index || !(t.area > 0)) return t.area;
    const EmitterPlace place(context, instance);
    return t.area * place.area_scale(normalize(place.world_from_shape().normal(t.n)));
}

// Radiance over AreaLight::spectrum.
float radiance_scale(const AreaLight& light, const LightContext& context, Index part) {
    if (!(light.primitive_flux > 0)) return light.scale;
    const Shape& shape = context.scene.shapes[light.shape];
    if (quadric_of(context.scene, shape) != nullptr) return light.scale;
    const float area = primitive_area(light, context, part);
    return area > 0 ? light.scale * (light.primitive_flux / (sides(light) * area * pi_f)) : 0;
}

// Radiance over radiance_scale at a point of the surface, seen along w.
SampledSpectrum color_at(const AreaLight& light, const LightContext& context, Point3f p, Vec3f w, Hit hit,
                         const SampledWavelengths& lambda) {
    if (light.picture == no_index) return context.scene.sample(light.spectrum, lambda);
    hit.t = 0;
    hit.shape = light.shape;
    hit.instance = context.tables().instance(context.light);
    const Point2f uv = surface_point(context.scene, ray_at(context, p, w), hit, true).uv;
    return context.tables().picture_color(light.picture, uv, light.picture_lookup, lambda) *
           LightTablesView::white_of_picture(light.equal_energy, lambda);
}

// As if the picture covered each part evenly.
double picture_brightness(const LightContext& context, const AreaLight& light) {
    const Image& image = context.tables().maps[light.picture];
    double sum = 0;
    for (std::size_t i = 0; i < image.sample_count(); ++i) sum += double(image.value_at(i));
    const Spectrum illuminant(RgbIlluminantSpectrum(LightTablesView::map_color_space(), {1, 1, 1}));
    const Spectrum white = light.equal_energy ? Spectrum(1.0f) : illuminant;
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
    s.p = Vec3f(p);
    s.n = flipped ? -n : n;
    return s;
}

// The light as a sphere in the world. `moved` holds it if the light moves.
const std::optional<WorldSphere>& sphere_of(const AreaLight& light, const LightContext& context,
                                            std::optional<WorldSphere>& moved) {
    const auto& sphere = context.tables().sphere(context.light);
    const Index instance = context.tables().instance(context.light);
    if (!sphere || instance == no_index) [[likely]]
        return sphere;
    const Quadric& quadric = *quadric_of(context.scene, context.scene.shapes[light.shape]);
    moved = whole_sphere(placed(quadric, EmitterPlace(context, instance).world_from_shape()));
    return moved;
}
std::optional<SphereCone> cone_of(const std::optional<WorldSphere>& sphere, Point3f from) {
    return sphere ? SphereCone::seen_from(from, *sphere) : std::nullopt;
}

bool is_invisible(const LightContext& context, const Shape& shape) {
    return is_cut_out(shape) && constant_alpha(context.scene, shape).value_or(1) <= 0;
}

// Share of the light that leaves `point`, in the space of the shape, or arrives there: holes do not emit. 1 for
// lights of alpha 0. The direction counts for nothing.
float share_there(const LightContext& context, const Shape& shape, const EmissivePoint& point) {
    if (!is_cut_out(shape) || is_invisible(context, shape)) return 1;
    return std::clamp(alpha_at(context.scene, ray_at(context, point.p, point.n), point.hit), 0.0f, 1.0f);
}

float world_density(const AreaLight& light, const LightContext& context, const LightHit& hit) {
    const Index instance = context.tables().instance(context.light);
    if (instance == no_index) [[likely]]
        return area_density(context, light.shape, hit);
    const EmitterPlace place(context, instance);
    LightHit local = hit;
    local.p = Vec3f(place.world_from_shape().inverse_point(Vec3d(hit.p)));
    return area_density(context, light.shape, local) / place.area_scale(hit.n);
}

// Light from a point of a surface, in the world, if it shines towards the reference; `radiance` maps the direction to
// it to its radiance.
template <typename F>
[[gnu::always_inline]] inline std::optional<LightSample>
from_point(const AreaLight& light, const ReferencePoint& from, Point3f p, Normal3f n, Vec2f b,
           float area_density, float error, const F& radiance) {
    std::optional<LightSample> result;
    const Vec3f d = p - from.p;
    const float d2 = length_squared(d);
    if (!(d2 > 0)) return result;
    const Vec3f wi = d / std::sqrt(d2);
    const float cosine = -dot(n, wi);
    if (!shines(light, cosine)) return result;
    LightSample& s = result.emplace();
    s.radiance = radiance(wi);
    s.wi = wi;
    s.pdf = area_density * d2 / std::abs(cosine);
    s.shadow = shadow_ray(from, wi, p, n, error);
    s.p = p;
    s.n = n;
    s.b = b;
    return result;
}

// As sample_surface, for most lights: LightTablesView::plain_triangles.
std::optional<LightSample> sample_plain_triangle(const AreaLight& light, const LightContext& context,
                                                 Index part, const ReferencePoint& from, Vec2f u,
                                                 const SampledWavelengths& lambda) {
    const LightTriangle& t = context.tables().triangle(context.light, part);
    if (!(t.area > 0)) return std::nullopt;
    const Vec3f b = sample_uniform_triangle(u);
    return from_point(light, from, t.p0 + b.y * t.e1 + b.z * t.e2, t.n, {b.y, b.z}, 1 / t.area, t.error,
                      [&](Vec3f) { return context.scene.sample(light.spectrum, lambda) * light.scale; });
}

std::optional<LightSample> sample_surface(const AreaLight& light, const LightContext& context, Index part,
                                          const ReferencePoint& from, Vec2f u,
                                          const SampledWavelengths& lambda) {
    std::optional<LightSample> result;
    auto point = sample_area(context, light.shape, part, u);
    if (!point) return result;
    const Shape& shape = context.scene.shapes[light.shape];
    const Index instance = context.tables().instance(context.light);
    float share = 1;
    if (instance != no_index) [[unlikely]] {
        share = share_there(context, shape, *point);
        EmitterPlace(context, instance).move(*point);
    }
    const Vec2f b{point->hit.b1, point->hit.b2};
    result = from_point(light, from, point->p, point->n, b, point->area_density, point->error, [&](Vec3f wi) {
        if (instance == no_index) share = share_there(context, shape, *point);
        if (!(share > 0)) return SampledSpectrum{};
        return color_at(light, context, point->p, wi, point->hit, lambda) *
               radiance_scale(light, context, part) * share;
    });
    if (!(share > 0)) result.reset();
    if (result) result->invisible = is_invisible(context, shape);
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
    if (!context.tables().may_emit(shape)) return 0;
    const Shape& s = context.scene.shapes[shape];
    return visit_geometry(
        context.scene, s,
        Overloaded{[](const TriangleMesh& mesh) { return static_cast<Index>(mesh.triangle_count()); },
                   [](const BilinearMesh& mesh) { return static_cast<Index>(mesh.patch_count()); },
                   [](const Quadric&) { return Index{1}; }, [](const Curves&) { return Index{0}; }});
}

bool AreaLight::moves(const LightContext& context) const {
    const TriangleMesh* mesh = mesh_of(context.scene, context.scene.shapes[shape]);
    return context.tables().instance(context.light) != no_index || (mesh != nullptr && mesh->deforms());
}

std::optional<LightSample> AreaLight::sample_li(const LightContext& context, Index part,
                                                const ReferencePoint& from, Vec2f u,
                                                const SampledWavelengths& lambda) const {
    if (context.tables().has_plain_triangles(context.light)) [[likely]]
        return sample_plain_triangle(*this, context, part, from, u, lambda);
    const Shape& s = context.scene.shapes[shape];
    std::optional<WorldSphere> moved;
    const auto& sphere = sphere_of(*this, context, moved);
    if (const auto cone = cone_of(sphere, from.p))
        return sample_sphere(*this, context, *sphere, *cone, s.flip_normal, from, u, lambda);
    return sample_surface(*this, context, part, from, u, lambda);
}

float AreaLight::pdf_li(const LightContext& context, const ReferencePoint& from, const LightHit& hit) const {
    std::optional<WorldSphere> moved;
    if (const auto cone = cone_of(sphere_of(*this, context, moved), from.p)) return cone->pdf();
    const float density = world_density(*this, context, hit);
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
    auto point = sample_area(context, shape, part, u_position);
    if (!point) return std::nullopt;
    const float share = share_there(context, context.scene.shapes[shape], *point);
    if (!(share > 0)) return std::nullopt;
    if (const Index instance = context.tables().instance(context.light); instance != no_index)
        EmitterPlace(context, instance).move(*point);
    bool back = false;
    if (two_sided) {
        back = u_direction.x >= 0.5f;
        u_direction.x = 2 * u_direction.x - (back ? 1.0f : 0.0f);
    }
    const Vec3f local = sample_cosine_hemisphere(u_direction);
    if (!(local.z > 0)) return std::nullopt;
    const Normal3f n = back ? -point->n : point->n;
    const Vec3f w = normalize(Frame::from_normal(n).to_world(local));
    EmissionSample s;
    s.radiance = color_at(*this, context, point->p, w, point->hit, lambda) *
                 (radiance_scale(*this, context, part) * share);
    s.ray = {offset_origin(point->p, n, point->error, w), w};
    s.n = n;
    s.cosine = local.z;
    s.pdf_position = point->area_density;
    s.pdf_direction = cosine_hemisphere_pdf(local.z) / sides(*this);
    s.invisible = is_invisible(context, context.scene.shapes[shape]);
    s.p = point->p;
    s.b = {point->hit.b1, point->hit.b2};
    return s;
}

EmissionPdf AreaLight::pdf_le(const LightContext& context, const LightHit& hit, Vec3f w) const {
    const float cosine = dot(hit.n, w);
    return {world_density(*this, context, hit),
            cosine_hemisphere_pdf(two_sided ? std::abs(cosine) : cosine) / sides(*this)};
}

void AreaLight::powers(const LightContext& context, std::span<double> parts) const {
    const Shape& s = context.scene.shapes[shape];
    const float alpha = constant_alpha(context.scene, s).value_or(1);
    const double brightness = picture == no_index ? visible_mean(context.scene.spectrum(spectrum))
                                                  : picture_brightness(context, *this);
    auto power = [&](double area, float factor) {
        if (alpha > 0 && alpha < 1) area *= double(alpha);
        return pi * area * (two_sided ? 2 : 1) * double(factor) * brightness;
    };
    const auto of_primitives = [&] {
        for (Index part = 0; part < parts.size(); ++part)
            parts[part] =
                power(double(primitive_area(*this, context, part)), radiance_scale(*this, context, part));
    };
    visit_geometry(context.scene, s,
                   Overloaded{[&](const Quadric& quadric) {
                                  const Index instance = context.tables().instance(context.light);
                                  parts[0] = power(
                                      instance == no_index
                                          ? world_area(quadric)
                                          : world_area(placed(
                                                quadric, EmitterPlace(context, instance).world_from_shape())),
                                      scale);
                              },
                              [&](const TriangleMesh&) { of_primitives(); },
                              [&](const BilinearMesh&) { of_primitives(); }, [](const Curves&) {}});
}

std::optional<LightBounds> AreaLight::bounds(const LightContext& context, Index part) const {
    const Shape& s = context.scene.shapes[shape];
    if (moves(context)) return moving_emitter_bounds(context, *this, part);
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
