#include "montelux/scene/light/motion_bounds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "montelux/mc/math/constants.h"
#include "montelux/mc/math/overloaded.h"
#include "montelux/scene/light/emissive_shape.h"
#include "montelux/scene/light/light_sampling.h"
#include "montelux/scene/shape/surface_point.h"

namespace montelux {

namespace {

// Directions within an angle of an axis.
struct Cap {
    Vec3d axis; // any length; zero: none
    double angle = 0;
};

// Sets a cone that contains all caps and, as it is convex on the sphere, what lies between them. All directions
// where that would not be less than a hemisphere.
void set_cone(std::span<const Cap> caps, LightBounds& bounds) {
    Vec3d sum;
    for (const Cap& cap : caps)
        if (length_squared(cap.axis) > 0) sum += normalize(cap.axis);
    bounds.cos_theta_o = -1;
    if (!(length(sum) > 0)) return;
    const Vec3f axis(normalize(sum));
    double widest = 0;
    for (const Cap& cap : caps)
        if (length_squared(cap.axis) > 0)
            widest = std::max(widest,
                              std::atan2(length(cross(Vec3d(axis), cap.axis)), dot(Vec3d(axis), cap.axis)) +
                                  cap.angle);
    constexpr double rounding = 1e-6; // of the axis
    if (!(widest < 0.5 * pi - 2 * rounding)) return;
    bounds.axis = axis;
    // Close to 1 the next cosine below is that of a much larger angle.
    bounds.cos_theta_o =
        widest > rounding ? std::nextafter(static_cast<float>(std::cos(widest + rounding)), -1.0f) : 1.0f;
}

// A part of a shape at a key of its motion: points whose box contains it, and pairs of edges; its normals are
// combinations of their cross products with positive weights.
struct Pose {
    std::array<Vec3d, 8> points;
    std::size_t point_count = 0;
    std::array<std::array<Vec3d, 2>, 4> edges;
    std::size_t edge_count = 0;

    void add_point(Vec3d p) { points[point_count++] = p; }
    void add_edges(Vec3d a, Vec3d b) { edges[edge_count++] = {a, b}; }
};

Pose pose_of(const TriangleMesh& mesh, Index part, float time) {
    const Index* v = &mesh.indices[3 * std::size_t{part}];
    Pose pose;
    for (int k = 0; k < 3; ++k) pose.add_point(Vec3d(mesh.position(v[k], time)));
    pose.add_edges(pose.points[1] - pose.points[0], pose.points[2] - pose.points[0]);
    return pose;
}

Pose pose_of(const BilinearMesh& mesh, Index part) {
    const auto [p00, p10, p01, p11] = mesh.patch(part);
    Pose pose;
    for (const Vec3d p : {p00, p10, p01, p11}) pose.add_point(p);
    if (!mesh.normals.empty()) return pose; // either side
    for (const Vec3d along : {p10 - p00, p11 - p01})
        for (const Vec3d across : {p01 - p00, p11 - p10}) pose.add_edges(along, across);
    return pose;
}

Pose pose_of(const Quadric& quadric) {
    const Bounds3 box = world_bounds(quadric);
    Pose pose;
    for (int i = 0; i < 8; ++i) pose.add_point(box.corner(i));
    if (const auto normal = constant_normal(quadric)) {
        const Transform& t =
            std::visit([](const auto& q) -> const Transform& { return q.world_from_object; }, quadric);
        Vec3d x = t.vector(Vec3d{1, 0, 0}), y = t.vector(Vec3d{0, 1, 0});
        if (dot(cross(x, y), *normal) < 0) std::swap(x, y);
        pose.add_edges(x, y);
    }
    return pose;
}

Pose placed_pose(Pose pose, const Transform& t) {
    for (Vec3d& p : pose.points) p = t.point(p);
    for (auto& [a, b] : pose.edges) {
        a = t.vector(a);
        b = t.vector(b);
        // Normals keep their side of the surface, cross products do not.
        if (t.swaps_handedness()) std::swap(a, b);
    }
    return pose;
}

// Which sides of the normals of `pose_of` emit.
struct Sides {
    bool front = true, back = false;
};

Sides sides_of(const SceneView& scene, const Shape& shape, Index part) {
    const bool flip = shape.flip_normal;
    const TriangleMesh* mesh = mesh_of(scene, shape);
    if (mesh == nullptr || mesh->normals.empty()) return {!flip, flip};
    if (mesh->deforms()) return {true, true};
    // Vertex normals decide; where they disagree the side changes within the triangle.
    const LightTriangle t = light_triangle(*mesh, shape, part);
    int turned = 0;
    for (std::size_t k = 0; k < 3; ++k)
        turned += turns_normal(mesh->normals[mesh->indices[3 * std::size_t{part} + k]], t.n);
    return {flip ? turned > 0 : turned < 3, flip ? turned < 3 : turned > 0};
}

// Between two keys edges change linearly, so their cross products are quadratic: combinations of these three.
void add_normals(const Pose& from, const Pose& to, std::vector<Cap>& normals) {
    for (std::size_t i = 0; i < from.edge_count; ++i) {
        const auto& [a, b] = from.edges[i];
        const auto& [c, d] = to.edges[i];
        normals.push_back({cross(a, b)});
        normals.push_back({cross(a, d) + cross(c, b)});
        normals.push_back({cross(c, d)});
    }
}

// In the space of the shape.
Pose own_pose(const SceneView& scene, const Shape& shape, Index part, float time) {
    return visit_geometry(scene, shape,
                          Overloaded{[&](const TriangleMesh& mesh) { return pose_of(mesh, part, time); },
                                     [&](const BilinearMesh& mesh) { return pose_of(mesh, part); },
                                     [](const Quadric& quadric) { return pose_of(quadric); },
                                     [](const Curves&) { return Pose(); }});
}

// In the world at the context's time.
Pose world_pose(const LightContext& context, const Shape& shape, Index part) {
    const Pose pose = own_pose(context.scene, shape, part, context.time);
    const Index instance = context.tables().instance(context.light);
    return instance == no_index ? pose
                                : placed_pose(pose, EmitterPlace(context, instance).world_from_shape());
}

// In the world at the keys of the motion.
std::vector<Pose> key_poses(const LightContext& context, const Shape& shape, Index part) {
    const SceneView& scene = context.scene;
    const auto world = [&](float time) { return world_pose({scene, context.light, time}, shape, part); };
    const TriangleMesh* mesh = mesh_of(scene, shape);
    const bool deforms = mesh != nullptr && mesh->deforms();
    const Index instance = context.tables().instance(context.light);
    if (instance == no_index || scene.instances[instance].motion == no_index)
        return deforms ? std::vector{world(0), world(1)} : std::vector{world(0)};
    const Pose own = own_pose(scene, shape, part, 0), own_end = own_pose(scene, shape, part, 1);
    std::vector<Pose> poses;
    for (const Matrix4& key : scene.motions[scene.instances[instance].motion].keys()) {
        const Transform t(key, Matrix4{}); // the inverse is not used
        poses.push_back(placed_pose(own, t));
        if (deforms) poses.push_back(placed_pose(own_end, t));
    }
    // Of a mesh that also deforms on its way the normals are of a higher degree.
    if (deforms)
        for (Pose& pose : poses) pose.edge_count = 0;
    return poses;
}

LightBounds emitter_bounds(const LightContext& context, const AreaLight& light, Index part,
                           std::span<const Pose> poses, std::span<const Cap> normals) {
    LightBounds b;
    for (const Pose& pose : poses)
        for (const Vec3d p : std::span(pose.points).first(pose.point_count)) b.box.add(p);
    set_cone(normals, b);
    const Sides sides = sides_of(context.scene, context.scene.shapes[light.shape], part);
    if (!sides.front) b.axis = -b.axis;
    b.two_sided = light.two_sided || (sides.front && sides.back);
    b.cos_theta_e = 0;
    return b;
}

LightBounds bounds_over_motion(const LightContext& context, const AreaLight& light, Index part) {
    const std::vector<Pose> poses = key_poses(context, context.scene.shapes[light.shape], part);
    std::vector<Cap> normals;
    for (std::size_t i = 0; i + 1 < poses.size(); ++i) add_normals(poses[i], poses[i + 1], normals);
    if (poses.size() == 1) add_normals(poses[0], poses[0], normals);
    return emitter_bounds(context, light, part, poses, normals);
}

template <MovableLight L>
std::optional<LightBounds> bounds_over_motion(const LightContext& context, const L& light, Index part) {
    LightBounds all;
    std::vector<Cap> caps;
    for (const Matrix4& key : context.scene.motions[light.motion].keys()) {
        const auto b =
            light.moved(Transform(key, Matrix4{})).bounds(context, part); // the inverse is not used
        if (!b) return std::nullopt;
        all.box.add(b->box.lower);
        all.box.add(b->box.upper);
        // Light within both angles. Beyond a right angle the cone will be that of all directions.
        const auto angle = [](float cosine) { return std::acos(std::clamp(double(cosine), -1.0, 1.0)); };
        caps.push_back({Vec3d(b->axis), angle(b->cos_theta_o) + angle(b->cos_theta_e)});
    }
    set_cone(caps, all);
    if (all.cos_theta_o > -1) all.cos_theta_e = 1;
    return all;
}

} // namespace

LightBounds moving_emitter_bounds(const LightContext& context, const AreaLight& light, Index part) {
    const Pose pose = world_pose(context, context.scene.shapes[light.shape], part);
    std::array<Cap, 4> normals; // this is called in the sampling loop, which does not allocate
    for (std::size_t i = 0; i < pose.edge_count; ++i)
        normals[i].axis = cross(pose.edges[i][0], pose.edges[i][1]);
    return emitter_bounds(context, light, part, std::span(&pose, 1),
                          std::span(normals).first(pose.edge_count));
}

std::optional<LightBounds> motion_bounds(const LightContext& context, Index part) {
    return std::visit(Overloaded{[&](const AreaLight& light) -> std::optional<LightBounds> {
                                     if (!light.moves(context)) return light.bounds(context, part);
                                     return bounds_over_motion(context, light, part);
                                 },
                                 [&](const auto& light) -> std::optional<LightBounds> {
                                     if constexpr (MovableLight<std::decay_t<decltype(light)>>)
                                         if (light.motion != no_index)
                                             return bounds_over_motion(context, light, part);
                                     return light.bounds(context, part);
                                 }},
                      context.scene.lights[context.light]);
}

} // namespace montelux
