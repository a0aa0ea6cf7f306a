// Fixtures for rays: a scene with its accelerator, random rays, and brute-force intersection.
#pragma once

#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "montelux/accel/accelerator.h"
#include "montelux/mc/math/overloaded.h"
#include "montelux/mc/stats/chi_squared.h"
#include "montelux/scene/build/scene_builder.h"
#include "montelux/scene/scene_tables.h"
#include "montelux/scene/shape/surface_point.h"

namespace montelux::testing {

struct World {
    explicit World(Scene s) : scene(std::move(s)), tables(scene), accelerator(tables.view()) {}
    World(const World&) = delete;
    World& operator=(const World&) = delete;

    Scene scene;
    SceneTables tables;
    Accelerator accelerator;
};

inline Index add_material(Scene& scene) {
    scene.materials.push_back(DiffuseMaterial{{0.5f}});
    return static_cast<Index>(scene.materials.size() - 1);
}
inline Index add_shape(Scene& scene, Geometry geometry, bool in_world = true) {
    CallMessages messages("scene of a test");
    const Index index = SceneBuilder(scene, messages)
                            .add_shape(std::move(geometry), {.material = add_material(scene), .alpha = {1}});
    if (!in_world) scene.world_shapes.pop_back();
    return index;
}

// Random geometry, drawn in a fixed order.
class Draws {
  public:
    explicit Draws(std::uint64_t seed) : uniforms_(seed) {}

    float uniform() { return uniforms_.next_float(); }
    float uniform(float low, float high) { return low + (high - low) * uniforms_.next_float(); }
    Vec2f uniform_2d() { return uniforms_.next_2f(); }
    Vec3f in_cube(float half) {
        float x = uniform(-half, half), y = uniform(-half, half), z = uniform(-half, half);
        return {x, y, z};
    }
    Vec3f direction() {
        for (;;) {
            Vec3f v = in_cube(1);
            float l2 = length_squared(v);
            if (l2 > 1e-4f && l2 <= 1) return v / std::sqrt(l2);
        }
    }
    Transform transform(double translation, bool similarity) {
        Vec3d t = translation * Vec3d(in_cube(1));
        double angle = uniform(0, 360);
        Vec3d axis(direction());
        double s = uniform(0.5f, 2);
        double sx = uniform(0.3f, 1.5f), sy = uniform(0.3f, 1.5f), sz = uniform(0.3f, 1.5f);
        return Transform::translate(t) * Transform::rotate(angle, axis) *
               Transform::scale(similarity ? Vec3d{s, s, s} : Vec3d{sx, -sy, sz});
    }

  private:
    TestUniforms uniforms_;
};

inline TriangleMesh soup(Draws& draws, int triangles, float size) {
    TriangleMesh mesh;
    for (int i = 0; i < triangles; ++i) {
        Vec3f p = draws.in_cube(1);
        mesh.positions.push_back(p);
        for (int k = 0; k < 2; ++k) mesh.positions.push_back(p + draws.in_cube(size));
        for (int k = 0; k < 3; ++k) mesh.indices.push_back(static_cast<Index>(3 * i + k));
    }
    return mesh;
}

// An octahedron whose faces are split in four `levels` times and projected onto the sphere; vertices are
// shared.
inline TriangleMesh geodesic_sphere(int levels, Vec3f center, float radius) {
    std::vector<Vec3d> p{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    std::vector<Index> f{0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
    for (int level = 0; level < levels; ++level) {
        std::map<std::pair<Index, Index>, Index> middles;
        auto middle = [&](Index a, Index b) {
            auto [at, fresh] =
                middles.try_emplace({std::min(a, b), std::max(a, b)}, static_cast<Index>(p.size()));
            if (fresh) p.push_back(normalize(p[a] + p[b]));
            return at->second;
        };
        std::vector<Index> finer;
        for (std::size_t i = 0; i < f.size(); i += 3) {
            Index a = f[i], b = f[i + 1], c = f[i + 2];
            Index ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
            for (Index v : {a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca}) finer.push_back(v);
        }
        f = std::move(finer);
    }
    TriangleMesh mesh;
    for (Vec3d v : p) mesh.positions.push_back(center + radius * Vec3f(v));
    mesh.indices = std::move(f);
    return mesh;
}

// The closest hit by brute force in double precision. `margin`: distance of the hit from an edge that
// rounding may put on either side, in units of the shape.
struct ReferenceHit {
    double t = 1e300;
    Index shape = no_index, primitive = 0, instance = no_index;
    double margin = 1;
};

class BruteForce {
  public:
    explicit BruteForce(const Scene& scene) : scene_(scene) {}

    std::optional<ReferenceHit> closest(const Ray& ray) const {
        best_ = {};
        closest_miss_ = 1;
        for (Index s : scene_.world_shapes) try_shape(s, no_index, Vec3d(ray.o), Vec3d(ray.d), ray.t_max);
        for (std::size_t i = 0; i < scene_.instances.size(); ++i) {
            const Instance& instance = scene_.instances[i];
            Transform inverse = instance.world_from_object.inverse();
            for (Index s : scene_.objects[instance.object].shapes)
                try_shape(s, static_cast<Index>(i), inverse.point(Vec3d(ray.o)), inverse.vector(Vec3d(ray.d)),
                          ray.t_max);
        }
        if (best_.shape == no_index) return std::nullopt;
        return best_;
    }
    // Of the last ray: the margin by which it hit or missed.
    double closest_call() const { return closest_miss_; }

  private:
    void accept(double t, double margin, Index shape, Index primitive, Index instance, double t_max) const {
        closest_miss_ = std::min(closest_miss_, std::abs(margin));
        closest_miss_ = std::min(closest_miss_, std::abs(t));
        if (margin < 0 || !(t > 0 && t < t_max) || t >= best_.t) return;
        best_ = {t, shape, primitive, instance, margin};
    }

    void try_shape(Index index, Index instance, Vec3d o, Vec3d d, double t_max) const {
        visit_geometry(scene_, scene_.shapes[index],
                       Overloaded{[&](const TriangleMesh& m) { try_mesh(m, index, instance, o, d, t_max); },
                                  [&](const Quadric& quadric) {
                                      std::visit(
                                          [&](const auto& q) {
                                              Transform inverse = q.world_from_object.inverse();
                                              try_quadric(q, index, instance, inverse.point(o),
                                                          inverse.vector(d), t_max);
                                          },
                                          quadric);
                                  },
                                  [](const Curves&) {},         // curves_test.cpp
                                  [](const BilinearMesh&) {}}); // bilinear_mesh_test.cpp
    }
    void try_mesh(const TriangleMesh& m, Index shape, Index instance, Vec3d o, Vec3d d, double t_max) const {
        for (std::size_t i = 0; i < m.triangle_count(); ++i) {
            Vec3d p0(m.positions[m.indices[3 * i]]), e1 = Vec3d(m.positions[m.indices[3 * i + 1]]) - p0,
                                                     e2 = Vec3d(m.positions[m.indices[3 * i + 2]]) - p0;
            Vec3d n = cross(e1, e2);
            double det = dot(n, d);
            if (det == 0) continue;
            double t = dot(n, p0 - o) / det;
            Vec3d q = o + t * d - p0;
            double n2 = dot(n, n), b1 = dot(cross(q, e2), n) / n2, b2 = dot(cross(e1, q), n) / n2;
            accept(t, std::min({b1, b2, 1 - b1 - b2}), shape, static_cast<Index>(i), instance, t_max);
        }
    }
    static double azimuth_margin(Vec3d p, double phi_max) {
        if (phi_max > 6.28318) return 1;
        double phi = std::atan2(p.y, p.x);
        if (phi < 0) phi += 2 * pi;
        return phi <= phi_max ? std::min(phi, phi_max - phi) : -std::min(phi - phi_max, 2 * pi - phi);
    }
    void try_quadric(const Sphere& s, Index shape, Index instance, Vec3d o, Vec3d d, double t_max) const {
        double r = s.radius, a = dot(d, d), b = dot(o, d), c = dot(o, o) - r * r;
        double discriminant = b * b - a * c;
        if (discriminant < 0) {
            closest_miss_ = std::min(closest_miss_, -discriminant / (a * r * r));
            return;
        }
        for (double sign : {-1.0, 1.0}) {
            double t = (-b + sign * std::sqrt(discriminant)) / a;
            Vec3d p = o + t * d;
            double margin = azimuth_margin(p, s.phi_max);
            if (s.z_min > -s.radius) margin = std::min(margin, (p.z - s.z_min) / r);
            if (s.z_max < s.radius) margin = std::min(margin, (s.z_max - p.z) / r);
            margin = std::min(margin, discriminant / (a * r * r));
            accept(t, margin, shape, 0, instance, t_max);
        }
    }
    void try_quadric(const Cylinder& s, Index shape, Index instance, Vec3d o, Vec3d d, double t_max) const {
        const double r = s.radius, a = d.x * d.x + d.y * d.y, b = o.x * d.x + o.y * d.y,
                     c = o.x * o.x + o.y * o.y - r * r;
        const double discriminant = b * b - a * c;
        if (discriminant < 0) {
            closest_miss_ = std::min(closest_miss_, -discriminant / (a * r * r));
            return;
        }
        for (const double sign : {-1.0, 1.0}) {
            const double t = (-b + sign * std::sqrt(discriminant)) / a;
            const Vec3d p = o + t * d;
            const double margin = std::min({azimuth_margin(p, s.phi_max), (p.z - s.z_min) / r,
                                            (s.z_max - p.z) / r, discriminant / (a * r * r)});
            accept(t, margin, shape, 0, instance, t_max);
        }
    }
    void try_quadric(const Disk& s, Index shape, Index instance, Vec3d o, Vec3d d, double t_max) const {
        if (d.z == 0) return;
        double t = (s.height - o.z) / d.z;
        Vec3d p = o + t * d;
        double r = std::hypot(p.x, p.y),
               margin = std::min(azimuth_margin(p, s.phi_max), (s.radius - r) / s.radius);
        if (s.inner_radius > 0) margin = std::min(margin, (r - s.inner_radius) / s.radius);
        accept(t, margin, shape, 0, instance, t_max);
    }

    const Scene& scene_;
    mutable ReferenceHit best_;
    mutable double closest_miss_ = 1;
};

} // namespace montelux::testing
