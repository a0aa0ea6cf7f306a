#include "montelux/scene/light/light_tables.h"

#include <algorithm>
#include <numeric>
#include <optional>

#include "montelux/mc/math/overloaded.h"
#include "montelux/mc/math/vector_bytes.h"
#include "montelux/mc/parallel/parallel_for.h"
#include "montelux/scene/light/emissive_shape.h"
#include "montelux/scene/medium/medium.h"
#include "montelux/scene/shape/alpha.h"

namespace montelux {

namespace {

// Above this size (64 MiB of spectra) texels are uplifted at each look-up.
constexpr std::size_t max_precomputed_texels = std::size_t{1} << 22;

std::vector<ScaledPolynomial> map_spectra(const Image& map) {
    if (map.pixel_count() > max_precomputed_texels) return {};
    std::vector<ScaledPolynomial> spectra(map.pixel_count());
    parallel_for(map.height(), [&](std::int64_t y) {
        for (std::size_t x = 0, i = static_cast<std::size_t>(y) * static_cast<std::size_t>(map.width());
             x < static_cast<std::size_t>(map.width()); ++x, ++i)
            spectra[i] = LightTablesView::texel_spectrum(map, i);
    });
    return spectra;
}

} // namespace

Bounds3 bounds_of(const Scene& scene) {
    Bounds3 bounds;
    auto add_shape = [&](Index index, const Transform* t) {
        const Shape& shape = scene.shapes[index];
        auto add = [&](Vec3d p) { bounds.add(t != nullptr ? t->point(p) : p); };
        visit_geometry(scene, shape,
                       Overloaded{[&](const TriangleMesh& mesh) {
                                      for (Point3f p : mesh.positions) add(Vec3d(p));
                                      for (Point3f p : mesh.end_positions) add(Vec3d(p));
                                  },
                                  [&](const Quadric& quadric) {
                                      const Bounds3 b = world_bounds(quadric);
                                      for (int i = 0; i < 8; ++i) add(b.corner(i));
                                  },
                                  [&](const Curves& curves) {
                                      for (std::size_t k = 0; k < curves.segment_count(); ++k) {
                                          const Bounds3 b = bounds_of(curves.segment(k));
                                          for (int i = 0; i < 8; ++i) add(b.corner(i));
                                      }
                                  },
                                  [&](const BilinearMesh& mesh) {
                                      for (Point3f p : mesh.positions) add(Vec3d(p));
                                  }});
    };
    for (Index shape : scene.world_shapes) add_shape(shape, nullptr);
    for (const Instance& instance : scene.instances)
        for (Index shape : scene.objects[instance.object].shapes) {
            if (instance.motion == no_index) {
                add_shape(shape, &instance.world_from_object);
                continue;
            }
            for (const Matrix4& key : scene.motions[instance.motion].keys()) {
                const Transform t(key, Matrix4{}); // the inverse is not used
                add_shape(shape, &t);
            }
        }
    return bounds;
}

namespace {

// What light from infinity may meet: the scene's shapes, and media that no shape encloses.
Bounds3 bounds_with_media(const Scene& scene) {
    Bounds3 bounds = bounds_of(scene);
    for (std::size_t i = 0; i < scene.media.size(); ++i) {
        const auto encloses = [&](const Shape& s) {
            return s.media.is_transition() && s.media.inside == static_cast<Index>(i);
        };
        if (std::any_of(scene.shapes.begin(), scene.shapes.end(), encloses)) continue;
        const std::optional<MediumBox> box = box_of(scene.media[i]);
        if (!box) continue;
        for (int corner = 0; corner < 8; ++corner)
            bounds.add(box->world_from_medium.point(
                Vec3d(box->at(Point3f(static_cast<float>(corner & 1), static_cast<float>(corner >> 1 & 1),
                                      static_cast<float>(corner >> 2))))));
    }
    return bounds;
}

} // namespace

LightTables::LightTables(const Scene& scene, const EnvironmentSettings& settings)
    : lookup_(settings.lookup), first_triangle_(scene.lights.size() + 1), spheres_(scene.lights.size()),
      disks_(scene.lights.size()), environment_of_light_(scene.lights.size(), no_index),
      map_spectra_(scene.environments.size()), instance_of_light_(scene.lights.size(), no_index),
      emits_(scene.shapes.size()), bounds_(bounds_with_media(scene)) {
    find_emitters(scene);
    for (Index i = 0; i < scene.lights.size(); ++i) {
        first_patch_.push_back(patch_areas_.size());
        if (kind_of(scene.lights[i]) == LightKind::infinite) infinite_lights_.push_back(i);
        std::visit(Overloaded{[&](const AreaLight& l) { add_shape(scene, i, l); },
                              [&](const ImageInfiniteLight& l) { add_map(scene, i, l, settings); },
                              [&](const SkyLight& l) {
                                  add_environment(scene, i, l.environment, EnvironmentLayout::equirectangular,
                                                  settings);
                              },
                              [&](const GoniometricLight& l) {
                                  add_environment(scene, i, l.environment, l.layout, settings);
                              },
                              [&](const SpotLight& l) {
                                  if (l.picture != no_index) add_spectra(scene, l.picture);
                              },
                              [&](const ProjectionLight& l) {
                                  const Image& picture = scene.environments[l.environment];
                                  add_spectra(scene, l.environment);
                                  environment_of_light_[i] = static_cast<Index>(projections_.size());
                                  projections_.emplace_back(picture, l.fov, l.profile, l.picture_lookup);
                              },
                              // Sampled in closed form.
                              [](const PointLight&) {}, [](const DistantLight&) {},
                              [](const UniformInfiniteLight&) {}, [](const SunLight&) {},
                              []<typename L>(const L&) {
                                  static_assert(sizeof(L) == 0,
                                                "say what LightTables computes for this light, or nothing");
                              }},
                   scene.lights[i]);
    }
    first_patch_.push_back(patch_areas_.size());
    add_triangles(scene);
}

void LightTables::find_emitters(const Scene& scene) {
    constexpr Index several = no_index - 1;
    std::vector<Index> instance_of_object(scene.objects.size(), no_index),
        instance_of_shape(scene.shapes.size(), no_index);
    for (Index i = 0; i < scene.instances.size(); ++i) {
        Index& only = instance_of_object[scene.instances[i].object];
        only = only == no_index ? i : several;
    }
    for (Index object = 0; object < scene.objects.size(); ++object) {
        const Index only = instance_of_object[object];
        if (only >= several || !scene.objects[object].shines) continue;
        for (const Index shape : scene.objects[object].shapes) {
            emits_[shape] = 1;
            instance_of_shape[shape] = only;
        }
    }
    for (const Index shape : scene.world_shapes) {
        emits_[shape] = 1;
        instance_of_shape[shape] = no_index;
    }
    for (std::size_t i = 0; i < scene.lights.size(); ++i)
        if (const auto* area = std::get_if<AreaLight>(&scene.lights[i]))
            instance_of_light_[i] = instance_of_shape[area->shape];
}

void LightTables::add_shape(const Scene& scene, Index light, const AreaLight& area) {
    if (area.picture != no_index) add_spectra(scene, area.picture);
    const Shape& shape = scene.shapes[area.shape];
    visit_geometry(scene, shape,
                   Overloaded{[&](const TriangleMesh& mesh) {
                                  // The number of its triangles; add_triangles sums them up.
                                  if (emits_[area.shape] != 0 && !mesh.deforms())
                                      first_triangle_[light + 1] = mesh.triangle_count();
                              },
                              [&](const Quadric& quadric) {
                                  // The far side is visible through its holes, but the cone does not sample
                                  // it.
                                  if (!is_cut_out(shape)) spheres_[light] = whole_sphere(quadric);
                                  disks_[light] = whole_disk(quadric);
                              },
                              [&](const BilinearMesh& mesh) {
                                  for (std::size_t i = 0; i < mesh.patch_count() && emits_[area.shape] != 0;
                                       ++i)
                                      patch_areas_.push_back(static_cast<float>(area_of(mesh.patch(i))));
                              },
                              [](const Curves&) {}});
}

namespace {

// Whether no interpolation of the vertex normals, if there are any, turns the normal of a triangle.
bool normals_agree(const TriangleMesh& mesh, std::span<const LightTriangle> triangles) {
    constexpr float least = 0.01f; // cosine; rounding turns none of those above it
    for (std::size_t k = 0; k < triangles.size() && !mesh.normals.empty(); ++k)
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const Normal3f n = mesh.normals[mesh.indices[3 * k + corner]];
            if (!(dot(n, triangles[k].n) > least * length(n))) return false;
        }
    return true;
}

} // namespace

void LightTables::add_triangles(const Scene& scene) {
    plain_triangles_.assign(scene.lights.size(), 0);
    std::partial_sum(first_triangle_.begin(), first_triangle_.end(), first_triangle_.begin());
    triangles_.resize(first_triangle_.back());
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        const std::size_t first = first_triangle_[i], count = first_triangle_[i + 1] - first;
        if (count == 0) continue;
        const Shape& shape = scene.shapes[std::get<AreaLight>(scene.lights[i]).shape];
        const TriangleMesh& mesh = scene.meshes[std::get<MeshIndex>(shape.geometry).index];
        const auto& light = std::get<AreaLight>(scene.lights[i]);
        parallel_for(static_cast<std::int64_t>(count), [&](std::int64_t k) {
            triangles_[first + static_cast<std::size_t>(k)] =
                light_triangle(mesh, shape, static_cast<std::size_t>(k));
        });
        plain_triangles_[i] = instance_of_light_[i] == no_index && light.picture == no_index &&
                              !(light.primitive_flux > 0) && !is_cut_out(shape) &&
                              normals_agree(mesh, std::span(triangles_).subspan(first, count));
    }
}

void LightTables::add_spectra(const Scene& scene, Index map) {
    if (map_spectra_[map].empty()) map_spectra_[map] = map_spectra(scene.environments[map]);
}

void LightTables::add_map(const Scene& scene, Index light, const ImageInfiniteLight& infinite,
                          const EnvironmentSettings& settings) {
    const Image& map = scene.environments[infinite.environment];
    add_spectra(scene, infinite.environment);
    if (infinite.portal) {
        environment_of_light_[light] = static_cast<Index>(portals_.size());
        portals_.emplace_back(map, infinite.layout, infinite.world_from_light, *infinite.portal,
                              settings.lookup);
    } else {
        add_environment(scene, light, infinite.environment, infinite.layout, settings);
    }
}

void LightTables::add_environment(const Scene& scene, Index light, Index map, EnvironmentLayout layout,
                                  const EnvironmentSettings& settings) {
    const auto [known, is_new] =
        known_environments_.try_emplace({map, layout}, static_cast<Index>(environments_.size()));
    if (is_new) environments_.emplace_back(scene.environments[map], layout, settings);
    environment_of_light_[light] = known->second;
}

std::size_t LightTables::bytes() const {
    std::size_t sum = vector_bytes(triangles_, first_triangle_, patch_areas_, first_patch_, spheres_, disks_,
                                   environments_, portals_, projections_, environment_of_light_, map_spectra_,
                                   infinite_lights_, instance_of_light_, emits_, plain_triangles_);
    for (const EnvironmentSampler& e : environments_) sum += e.bytes();
    for (const PortalSampler& p : portals_) sum += p.bytes();
    for (const ProjectionTable& p : projections_) sum += p.bytes();
    for (const auto& spectra : map_spectra_) sum += vector_bytes(spectra);
    return sum;
}

LightTablesView LightTables::view(const Scene& scene) const {
    LightTablesView view;
    view.lookup = lookup_;
    view.triangles = triangles_;
    view.plain_triangles = plain_triangles_;
    view.first_triangle = first_triangle_;
    view.patch_areas = patch_areas_;
    view.first_patch = first_patch_;
    view.spheres = spheres_;
    view.disks = disks_;
    view.maps = scene.environments;
    view.environments = environments_;
    view.portals = portals_;
    view.projections = projections_;
    view.environment_of_light = environment_of_light_;
    view.map_spectra = map_spectra_;
    view.infinite_lights = infinite_lights_;
    view.instance_of_light = instance_of_light_;
    view.emits = emits_;
    view.scene_bounds = bounds_;
    return view;
}

} // namespace montelux
