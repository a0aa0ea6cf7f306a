#include "montelux/scene/shape/quadric.h"

#include <algorithm>
#include <cmath>

#include "montelux/mc/math/constants.h"

namespace montelux {

namespace {

double azimuth(Vec3d p) {
    double phi = std::atan2(p.y, p.x);
    return phi < 0 ? phi + 2 * pi : phi;
}

bool within(const Sphere& s, Vec3d p) {
    bool whole_z = s.z_min <= -s.radius && s.z_max >= s.radius;
    if (!whole_z && (p.z < double(s.z_min) || p.z > double(s.z_max))) return false;
    return double(s.phi_max) >= 2 * pi - 1e-6 || azimuth(p) <= double(s.phi_max);
}

bool within(const Cylinder& c, Vec3d p) {
    if (p.z < double(c.z_min) || p.z > double(c.z_max)) return false;
    return double(c.phi_max) >= 2 * pi - 1e-6 || azimuth(p) <= double(c.phi_max);
}

bool within(const Disk& d, Vec3d p) {
    double r2 = p.x * p.x + p.y * p.y;
    if (r2 > double(d.radius) * double(d.radius) || r2 < double(d.inner_radius) * double(d.inner_radius))
        return false;
    return double(d.phi_max) >= 2 * pi - 1e-6 || azimuth(p) <= double(d.phi_max);
}

struct ObjectRay {
    Vec3d o, d;
};
ObjectRay to_object(const Transform& world_from_object, const Ray& ray) {
    return {world_from_object.inverse_point(Vec3d(ray.o)), world_from_object.inverse_vector(Vec3d(ray.d))};
}

std::optional<double> intersect_object(const Sphere& s, const ObjectRay& r, double t_min, double t_max) {
    double a = dot(r.d, r.d);
    if (!(a > 0)) return std::nullopt;
    // Uses the distance of the centre from the line instead of b^2 - ac: no cancellation far from the sphere.
    double t_mid = -dot(r.o, r.d) / a;
    Vec3d closest = r.o + t_mid * r.d;
    double h2 = double(s.radius) * double(s.radius) - dot(closest, closest);
    if (h2 < 0) return std::nullopt;
    double half = std::sqrt(h2 / a);
    for (double t : {t_mid - half, t_mid + half})
        if (t > t_min && t < t_max && within(s, r.o + t * r.d)) return t;
    return std::nullopt;
}

std::optional<double> intersect_object(const Cylinder& c, const ObjectRay& r, double t_min, double t_max) {
    const double a = r.d.x * r.d.x + r.d.y * r.d.y;
    if (!(a > 0)) return std::nullopt;
    // As for spheres, in the xy plane.
    const double t_mid = -(r.o.x * r.d.x + r.o.y * r.d.y) / a;
    const double x = r.o.x + t_mid * r.d.x, y = r.o.y + t_mid * r.d.y;
    const double h2 = double(c.radius) * double(c.radius) - (x * x + y * y);
    if (h2 < 0) return std::nullopt;
    const double half = std::sqrt(h2 / a);
    for (double t : {t_mid - half, t_mid + half})
        if (t > t_min && t < t_max && within(c, r.o + t * r.d)) return t;
    return std::nullopt;
}

std::optional<double> intersect_object(const Disk& d, const ObjectRay& r, double t_min, double t_max) {
    if (r.d.z == 0) return std::nullopt;
    double t = (double(d.height) - r.o.z) / r.d.z;
    if (!(t > t_min && t < t_max) || !within(d, r.o + t * r.d)) return std::nullopt;
    return t;
}

Vec3d project(const Sphere& s, Vec3d p) {
    double len = length(p);
    return len > 0 ? p * (double(s.radius) / len) : Vec3d{0, 0, double(s.radius)};
}
Vec3d project(const Disk& d, Vec3d p) { return {p.x, p.y, double(d.height)}; }

Vec3d project(const Cylinder& c, Vec3d p) {
    const double len = std::sqrt(p.x * p.x + p.y * p.y), r = c.radius;
    return len > 0 ? Vec3d{p.x * (r / len), p.y * (r / len), p.z} : Vec3d{r, 0, p.z};
}

Vec3d object_normal(const Sphere& s, Vec3d p) { return p / double(s.radius); }
Vec3d object_normal(const Disk&, Vec3d) { return {0, 0, 1}; }
Vec3d object_normal(const Cylinder& c, Vec3d p) {
    return {p.x / double(c.radius), p.y / double(c.radius), 0};
}

// The unit vector from the axis to p.
Vec3d radial(Vec3d p) {
    const double r = std::sqrt(p.x * p.x + p.y * p.y);
    return r > 0 ? Vec3d{p.x / r, p.y / r, 0} : Vec3d{1, 0, 0};
}

// Of a point in object space, and its derivatives.
struct Coordinates {
    double u = 0, v = 0;
    Vec3d dpdu, dpdv;
};
// The derivative by the share of the azimuth.
template <typename S>
Vec3d around(const S& s, Vec3d p) {
    const Vec3d d = double(s.phi_max) * Vec3d{-p.y, p.x, 0};
    return dot(d, d) > 0 ? d : Vec3d{0, 1, 0};
}
Coordinates coordinates(const Sphere& s, Vec3d p) {
    const double r = s.radius;
    const double theta_min = std::acos(std::clamp(std::min(double(s.z_min), double(s.z_max)) / r, -1.0, 1.0));
    const double theta_max = std::acos(std::clamp(std::max(double(s.z_min), double(s.z_max)) / r, -1.0, 1.0));
    const double theta = std::acos(std::clamp(p.z / r, -1.0, 1.0));
    return {azimuth(p) / double(s.phi_max), (theta - theta_min) / (theta_max - theta_min), around(s, p),
            (theta_max - theta_min) * (p.z * radial(p) - Vec3d{0, 0, r * std::sin(theta)})};
}
Coordinates coordinates(const Disk& d, Vec3d p) {
    const double width = double(d.radius) - double(d.inner_radius);
    const double inwards = (double(d.radius) - std::sqrt(p.x * p.x + p.y * p.y)) / width;
    const double turn = azimuth(p) / double(d.phi_max);
    if (d.polar) return {1 - inwards, turn, width * radial(p), around(d, p)};
    return {turn, inwards, around(d, p), -width * radial(p)};
}
Coordinates coordinates(const Cylinder& c, Vec3d p) {
    const double length = double(c.z_max) - double(c.z_min);
    return {azimuth(p) / double(c.phi_max), (p.z - double(c.z_min)) / length, around(c, p), {0, 0, length}};
}

template <typename S>
QuadricPoint to_world(const S& s, Vec3d p, bool with_coordinates) {
    QuadricPoint q;
    q.p = s.world_from_object.point(p);
    q.n = normalize(s.world_from_object.normal(object_normal(s, p)));
    if (!with_coordinates) return q;
    const Coordinates at = coordinates(s, p);
    q.uv = {static_cast<float>(at.u), static_cast<float>(at.v)};
    q.dpdu = s.world_from_object.vector(at.dpdu);
    q.dpdv = s.world_from_object.vector(at.dpdv);
    return q;
}

// World area over object area around an object-space point with unit normal n: |det M| |M^-T n|.
double area_scale(const Transform& t, Vec3d n) {
    return std::abs(t.matrix().linear_determinant()) * length(t.normal(n));
}

double z_low(const Sphere& s) {
    return std::max(-double(s.radius), std::min(double(s.z_min), double(s.z_max)));
}
double z_high(const Sphere& s) {
    return std::min(double(s.radius), std::max(double(s.z_min), double(s.z_max)));
}

double object_area(const Sphere& s) { return double(s.phi_max) * double(s.radius) * (z_high(s) - z_low(s)); }
double object_area(const Disk& d) {
    double r = d.radius, ri = d.inner_radius;
    return 0.5 * double(d.phi_max) * (r * r - ri * ri);
}
double object_area(const Cylinder& c) {
    return double(c.phi_max) * double(c.radius) * (double(c.z_max) - double(c.z_min));
}

Vec3d sample_object(const Sphere& s, Vec2d u) {
    double z = z_low(s) + u.x * (z_high(s) - z_low(s)), phi = u.y * double(s.phi_max);
    double r = std::sqrt(std::max(0.0, double(s.radius) * double(s.radius) - z * z));
    return {r * std::cos(phi), r * std::sin(phi), z};
}
Vec3d sample_object(const Disk& d, Vec2d u) {
    double ri = double(d.inner_radius) * double(d.inner_radius), ro = double(d.radius) * double(d.radius);
    double r = std::sqrt(ri + u.x * (ro - ri)), phi = u.y * double(d.phi_max);
    return {r * std::cos(phi), r * std::sin(phi), double(d.height)};
}
Vec3d sample_object(const Cylinder& c, Vec2d u) {
    const double z = double(c.z_min) + u.x * (double(c.z_max) - double(c.z_min));
    const double phi = u.y * double(c.phi_max);
    return {double(c.radius) * std::cos(phi), double(c.radius) * std::sin(phi), z};
}

std::optional<double> uniform_scale(const Transform& t) {
    Vec3d x = t.vector(Vec3d{1, 0, 0}), y = t.vector(Vec3d{0, 1, 0}), z = t.vector(Vec3d{0, 0, 1});
    double s2 = dot(x, x), tolerance = 1e-5 * s2;
    bool similar = std::abs(dot(y, y) - s2) < tolerance && std::abs(dot(z, z) - s2) < tolerance &&
                   std::abs(dot(x, y)) < tolerance && std::abs(dot(y, z)) < tolerance &&
                   std::abs(dot(z, x)) < tolerance;
    if (!similar) return std::nullopt;
    return std::sqrt(s2);
}

} // namespace

Bounds3 world_bounds(const Quadric& quadric) {
    return std::visit(
        [](const auto& s) {
            Vec3d lower{-double(s.radius), -double(s.radius), 0},
                upper{double(s.radius), double(s.radius), 0};
            if constexpr (std::is_same_v<std::decay_t<decltype(s)>, Sphere>) {
                lower.z = z_low(s);
                upper.z = z_high(s);
            } else if constexpr (std::is_same_v<std::decay_t<decltype(s)>, Cylinder>) {
                lower.z = double(s.z_min);
                upper.z = double(s.z_max);
            } else {
                lower.z = upper.z = double(s.height);
            }
            Bounds3 bounds;
            for (int i = 0; i < 8; ++i)
                bounds.add(s.world_from_object.point(Bounds3{lower, upper}.corner(i)));
            return bounds;
        },
        quadric);
}

std::optional<Vec3d> constant_normal(const Quadric& quadric) {
    struct Normal {
        std::optional<Vec3d> operator()(const Sphere&) const { return std::nullopt; }
        std::optional<Vec3d> operator()(const Cylinder&) const { return std::nullopt; }
        std::optional<Vec3d> operator()(const Disk& d) const {
            return normalize(d.world_from_object.normal(Vec3d{0, 0, 1}));
        }
    };
    return std::visit(Normal{}, quadric);
}

double world_area(const Quadric& quadric) {
    return std::visit(
        [](const auto& s) {
            if (auto k = uniform_scale(s.world_from_object)) return object_area(s) * *k * *k;
            constexpr int n = 128;
            double sum = 0;
            for (int i = 0; i < n; ++i)
                for (int j = 0; j < n; ++j)
                    sum += area_scale(s.world_from_object,
                                      object_normal(s, sample_object(s, {(i + 0.5) / n, (j + 0.5) / n})));
            return object_area(s) * sum / (n * n);
        },
        quadric);
}

std::optional<double> intersect(const Quadric& quadric, const Ray& ray, double t_min) {
    return std::visit(
        [&](const auto& s) {
            return intersect_object(s, to_object(s.world_from_object, ray), t_min, double(ray.t_max));
        },
        quadric);
}

QuadricPoint point_at(const Quadric& quadric, const Ray& ray, double t, bool with_coordinates) {
    return std::visit(
        [&](const auto& s) {
            ObjectRay r = to_object(s.world_from_object, ray);
            return to_world(s, project(s, r.o + t * r.d), with_coordinates);
        },
        quadric);
}

QuadricAreaSample sample_area(const Quadric& quadric, Vec2f u) {
    return std::visit(
        [&](const auto& s) {
            Vec3d p = sample_object(s, Vec2d(u));
            double scale = area_scale(s.world_from_object, object_normal(s, p));
            return QuadricAreaSample{to_world(s, p, false), 1 / (object_area(s) * scale)};
        },
        quadric);
}

double area_pdf(const Quadric& quadric, Vec3d world_point) {
    return std::visit(
        [&](const auto& s) {
            Vec3d p = project(s, s.world_from_object.inverse_point(world_point));
            return 1 / (object_area(s) * area_scale(s.world_from_object, object_normal(s, p)));
        },
        quadric);
}

std::optional<WorldSphere> whole_sphere(const Quadric& quadric) {
    const auto* s = std::get_if<Sphere>(&quadric);
    if (s == nullptr || z_low(*s) > -double(s->radius) || z_high(*s) < double(s->radius) ||
        double(s->phi_max) < 2 * pi - 1e-6)
        return std::nullopt;
    auto scale = uniform_scale(s->world_from_object);
    if (!scale) return std::nullopt;
    return WorldSphere{s->world_from_object.point(Vec3d{0, 0, 0}), *scale * double(s->radius)};
}

std::optional<double> intersect(const WorldSphere& sphere, const Ray& ray, double t_min) {
    Vec3d d(ray.d), o = Vec3d(ray.o) - sphere.center;
    double inverse_a = 1 / dot(d, d);
    double t_mid = -dot(o, d) * inverse_a;
    Vec3d closest = o + t_mid * d;
    double h2 = sphere.radius * sphere.radius - dot(closest, closest);
    if (!(h2 >= 0)) return std::nullopt;
    double half = std::sqrt(h2 * inverse_a);
    for (double t : {t_mid - half, t_mid + half})
        if (t > t_min && t < double(ray.t_max)) return t;
    return std::nullopt;
}

std::optional<WorldDisk> whole_disk(const Quadric& quadric) {
    const auto* d = std::get_if<Disk>(&quadric);
    if (d == nullptr || d->inner_radius > 0 || double(d->phi_max) < 2 * pi - 1e-6) return std::nullopt;
    const Transform& t = d->world_from_object;
    double r = d->radius;
    Vec3d s = t.vector(Vec3d{r, 0, 0}), u = t.vector(Vec3d{0, r, 0});
    return WorldDisk{Vec3f(t.point(Vec3d{0, 0, double(d->height)})), Vec3f(s), Vec3f(u),
                     Vec3f(normalize(t.normal(Vec3d{0, 0, 1}))),
                     static_cast<float>(pi * length(cross(s, u)))};
}

} // namespace montelux
