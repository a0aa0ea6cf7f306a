#include "montelux/transport/manifold/casters.h"

#include <algorithm>
#include <cmath>

#include "montelux/mc/math/constants.h"
#include "montelux/mc/math/frame.h"
#include "montelux/mc/math/overloaded.h"
#include "montelux/mc/warp/disk.h"
#include "montelux/mc/warp/sphere.h"
#include "montelux/mc/warp/triangle.h"
#include "montelux/scene/light/light_sampling.h"
#include "montelux/scene/shape/alpha.h"

namespace montelux {

namespace {

bool is_zero(const RoughnessParameter& r) {
    return r.u.is_constant() && r.v.is_constant() && r.u.value == 0 && r.v.value == 0;
}

// Caster::eta of a material; empty unless it is one of a caster.
std::optional<double> eta_of(const SceneView& scene, const Material& material) {
    return std::visit(Overloaded{[&](const DielectricMaterial& m) -> std::optional<double> {
                                     if (!is_zero(m.roughness) || !m.detail.is_flat() ||
                                         !scene.is_constant(m.eta))
                                         return std::nullopt;
                                     const auto eta = double(scene.spectrum(m.eta)(550));
                                     // Light that goes straight on is found by scattering as well.
                                     return eta > 0 && eta != 1 ? std::optional(eta) : std::nullopt;
                                 },
                                 [](const ConductorMaterial& m) -> std::optional<double> {
                                     if (!is_zero(m.roughness) || !m.detail.is_flat()) return std::nullopt;
                                     return 0;
                                 },
                                 [](const auto&) -> std::optional<double> { return std::nullopt; }},
                      material);
}

std::optional<Caster> caster_on(const TriangleMesh& mesh, Index index) {
    if (mesh.deforms() || mesh.indices.empty()) return std::nullopt;
    std::vector<double> areas;
    double sum = 0;
    for (std::size_t i = 0; i < mesh.triangle_count(); ++i) {
        const Index* v = &mesh.indices[3 * i];
        const Vec3d p(mesh.positions[v[0]]);
        areas.push_back(0.5 *
                        length(cross(Vec3d(mesh.positions[v[1]]) - p, Vec3d(mesh.positions[v[2]]) - p)));
        sum += areas.back();
    }
    if (!(sum > 0 && std::isfinite(sum))) return std::nullopt;
    return Caster{.geometry = CasterMesh{index, AliasTable(areas)}, .area = sum};
}
std::optional<Caster> caster_on(const Quadric& quadric) {
    if (const auto sphere = whole_sphere(quadric))
        return Caster{.geometry = *sphere, .area = 4 * pi * sphere->radius * sphere->radius};
    if (const auto disk = whole_disk(quadric)) return Caster{.geometry = *disk, .area = double(disk->area)};
    return std::nullopt;
}

std::optional<Caster> make_caster(const SceneView& scene, Index index) {
    const Shape& shape = scene.shapes[index];
    const std::optional<double> eta = eta_of(scene, scene.materials[shape.material]);
    if (!eta || is_cut_out(shape)) return std::nullopt;
    std::optional<Caster> caster;
    if (const TriangleMesh* mesh = mesh_of(scene, shape))
        caster = caster_on(*mesh, std::get_if<MeshIndex>(&shape.geometry)->index);
    else if (const Quadric* quadric = quadric_of(scene, shape))
        caster = caster_on(*quadric);
    if (!caster || !(caster->area > 0)) return std::nullopt;
    caster->shape = index;
    caster->flipped = shape.flip_normal;
    caster->eta = *eta;
    return caster;
}

bool is_covered(const SceneView& scene, Index light) {
    return std::visit(Overloaded{[&](const AreaLight& l) {
                                     return !l.moves({scene, light}) && !is_cut_out(scene.shapes[l.shape]);
                                 },
                                 [](const SunLight&) { return true; },
                                 [](const auto& l) {
                                     return l.kind == LightKind::position || l.kind == LightKind::direction;
                                 }},
                      scene.lights[light]);
}

// Half of the probability in proportion to the sizes, half for all alike.
void even_out(std::vector<double>& sizes) {
    const double largest = *std::max_element(sizes.begin(), sizes.end());
    double sum = 0;
    for (double& x : sizes) sum += x = largest > 0 ? x / largest : 1;
    for (double& x : sizes) x += sum / static_cast<double>(sizes.size());
}

void set_axes(CasterPoint& point, double scale) {
    const auto frame = FrameOf<double>::from_normal(point.n);
    point.dpdu = frame.s * scale;
    point.dpdv = frame.t * scale;
}

} // namespace

CasterPoint mesh_point(const SceneView& scene, const Caster& caster, Index primitive, double b1, double b2) {
    const TriangleMesh& mesh = scene.meshes[std::get_if<CasterMesh>(&caster.geometry)->mesh];
    const Index* v = &mesh.indices[3 * std::size_t{primitive}];
    CasterPoint point{.primitive = primitive, .b1 = b1, .b2 = b2};
    const Vec3d p0(mesh.positions[v[0]]);
    point.dpdu = Vec3d(mesh.positions[v[1]]) - p0;
    point.dpdv = Vec3d(mesh.positions[v[2]]) - p0;
    point.p = p0 + point.dpdu * b1 + point.dpdv * b2;
    if (!mesh.normals.empty()) {
        const Vec3d n0(mesh.normals[v[0]]);
        const Vec3d du = Vec3d(mesh.normals[v[1]]) - n0, dv = Vec3d(mesh.normals[v[2]]) - n0;
        const Vec3d n = n0 + du * b1 + dv * b2;
        if (const double size = length(n); size > 0) {
            point.n = n / size;
            point.dndu = (du - point.n * dot(point.n, du)) / size;
            point.dndv = (dv - point.n * dot(point.n, dv)) / size;
            return point;
        }
    }
    point.n = normalize(cross(point.dpdu, point.dpdv));
    if (caster.flipped) point.n = -point.n;
    return point;
}

CasterPoint quadric_point(const Caster& caster, Vec3d p) {
    CasterPoint point;
    if (const auto* sphere = std::get_if<WorldSphere>(&caster.geometry)) {
        const Vec3d outward = p - sphere->center;
        const double distance = length(outward);
        point.n = distance > 0 ? outward / distance : Vec3d{0, 0, 1};
        point.p = sphere->center + point.n * sphere->radius;
        set_axes(point, sphere->radius);
        const double turn = caster.flipped ? -1 : 1;
        point.n = point.n * turn;
        point.dndu = point.dpdu * (turn / sphere->radius);
        point.dndv = point.dpdv * (turn / sphere->radius);
        return point;
    }
    const WorldDisk& disk = *std::get_if<WorldDisk>(&caster.geometry);
    const Vec3d normal = normalize(Vec3d(disk.n)), center(disk.center);
    point.p = p - normal * dot(p - center, normal);
    point.n = caster.flipped ? -normal : normal;
    set_axes(point, 1);
    return point;
}

CasterPoint sample_point(const SceneView& scene, const Caster& caster, PhiloxStream& stream) {
    return std::visit(Overloaded{[&](const CasterMesh& mesh) {
                                     const auto primitive = mesh.triangles.sample(stream.next_double()).index;
                                     const Vec3f b = sample_uniform_triangle(stream.next_2d());
                                     return mesh_point(scene, caster, primitive, double(b.y), double(b.z));
                                 },
                                 [&](const WorldSphere& sphere) {
                                     const Vec3d w(sample_uniform_sphere(stream.next_2d()));
                                     return quadric_point(caster, sphere.center + w * sphere.radius);
                                 },
                                 [&](const WorldDisk& disk) {
                                     const Vec2f at = sample_uniform_disk_concentric(stream.next_2d());
                                     return quadric_point(caster,
                                                          Vec3d(disk.center + disk.s * at.x + disk.t * at.y));
                                 }},
                      caster.geometry);
}

bool contains(const Caster& caster, const CasterPoint& point) {
    const auto* disk = std::get_if<WorldDisk>(&caster.geometry);
    if (disk == nullptr) return true;
    // Coordinates along the two conjugate radii.
    const Vec3d s(disk->s), t(disk->t), d = point.p - Vec3d(disk->center);
    const double ss = dot(s, s), st = dot(s, t), tt = dot(t, t), ds = dot(d, s), dt = dot(d, t);
    const double determinant = ss * tt - st * st;
    const double x = (tt * ds - st * dt) / determinant, y = (ss * dt - st * ds) / determinant;
    return x * x + y * y <= 1;
}

Casters::Casters(const SceneView& scene)
    : is_caster_(scene.shapes.size(), 0), covered_(scene.lights.size(), 0) {
    std::vector<double> areas;
    for (const Index shape : scene.world_shapes)
        if (auto caster = make_caster(scene, shape)) {
            areas.push_back(caster->area);
            casters_.push_back(*std::move(caster));
            is_caster_[shape] = 1;
        }
    if (!areas.empty()) {
        even_out(areas);
        choice_.emplace(areas);
    }

    std::vector<Index> counts(scene.lights.size(), 0);
    for (Index i = 0; i < static_cast<Index>(counts.size()); ++i)
        if (is_covered(scene, i)) {
            covered_[i] = 1;
            counts[i] = part_count({scene, i});
        }
    LightParts parts(counts);
    if (parts.size() == 0) return;
    std::vector<double> powers(parts.size());
    for (Index i = 0; i < static_cast<Index>(counts.size()); ++i)
        if (counts[i] > 0) light_powers({scene, i}, std::span(powers).subspan(parts.row(i, 0), counts[i]));
    // As for all lights (scene_tables.cpp).
    for (double& power : powers) power = power > 0 ? std::min(power, 1e290) : 0;
    even_out(powers);
    lights_.emplace(std::move(parts), powers);
}

} // namespace montelux
