#include "montelux/scene/build/scene_builder.h"

#include <utility>
#include <vector>

#include "montelux/mc/math/error.h"
#include "montelux/mc/math/overloaded.h"
#include "montelux/scene/build/check_references.h"
#include "montelux/scene/build/float_range.h"
#include "montelux/scene/scene_digest.h"

namespace montelux {
namespace {

Bounds3 bounds_of(const ObjectDefinition& object, const Scene& scene) {
    Bounds3 bounds;
    for (const Index i : object.shapes) {
        visit_geometry(scene, scene.shapes[i],
                       Overloaded{[&](const TriangleMesh& mesh) {
                                      for (const Point3f p : mesh.positions) bounds.add(Vec3d(p));
                                  },
                                  [&](const Quadric& quadric) {
                                      const Bounds3 b = world_bounds(quadric);
                                      bounds.add(b.lower);
                                      bounds.add(b.upper);
                                  },
                                  [&](const Curves& curves) {
                                      for (std::size_t k = 0; k < curves.segment_count(); ++k) {
                                          const Bounds3 b = bounds_of(curves.segment(k));
                                          bounds.add(b.lower);
                                          bounds.add(b.upper);
                                      }
                                  },
                                  [&](const BilinearMesh& mesh) {
                                      for (const Point3f p : mesh.positions) bounds.add(Vec3d(p));
                                  }});
    }
    return bounds;
}

// Gives back room that growing left over, if it is much. (An eighth: the copy that this needs is not worth less.)
template <typename T>
void trim(std::vector<T>& v) {
    if (v.capacity() - v.size() > v.size() / 8 + 1) v.shrink_to_fit();
}

} // namespace

Index SceneBuilder::add_shape(Geometry geometry, const ShapeSettings& settings, SourceLocation at) {
    try {
        check_geometry(geometry);
    } catch (const Error& e) {
        messages_.error(at, e.what());
    }
    if (scene_.shapes.size() >= no_index) messages_.error(at, "more than 2^32 shapes");
    const auto index = static_cast<Index>(scene_.shapes.size());
    Shape shape;
    shape.material = settings.material;
    shape.alpha = settings.alpha;
    shape.flip_normal = settings.flip_normal;
    shape.media = settings.media;
    scene_.shapes.push_back(shape);
    if (!settings.name.empty()) {
        scene_.shape_names.resize(index + std::size_t{1});
        scene_.shape_names[index] = settings.name;
    }
    (in_object() ? scene_.objects[open_object_].shapes : scene_.world_shapes).push_back(index);
    if (settings.emission != nullptr) add_area_light(index, *settings.emission, geometry, at);
    scene_.shapes[index].geometry = std::visit(
        Overloaded{[&](TriangleMesh& mesh) -> ShapeGeometry {
                       trim(mesh.positions);
                       trim(mesh.normals);
                       trim(mesh.uvs);
                       trim(mesh.indices);
                       trim(mesh.tangents);
                       // Room for the ray tracer to read the positions in place.
                       if (!mesh.positions.empty()) mesh.positions.reserve(mesh.positions.size() + 1);
                       scene_.meshes.push_back(std::move(mesh));
                       return MeshIndex{static_cast<Index>(scene_.meshes.size() - 1)};
                   },
                   [&](Quadric& quadric) -> ShapeGeometry {
                       scene_.quadrics.push_back(quadric);
                       return QuadricIndex{static_cast<Index>(scene_.quadrics.size() - 1)};
                   },
                   [&](Curves& curves) -> ShapeGeometry {
                       scene_.curves.push_back(std::move(curves));
                       return CurvesIndex{static_cast<Index>(scene_.curves.size() - 1)};
                   },
                   [&](BilinearMesh& mesh) -> ShapeGeometry {
                       scene_.bilinear_meshes.push_back(std::move(mesh));
                       return BilinearMeshIndex{static_cast<Index>(scene_.bilinear_meshes.size() - 1)};
                   }},
        geometry);
    return index;
}

void SceneBuilder::add_area_light(Index shape, const Emission& emission, const Geometry& geometry,
                                  SourceLocation at) {
    if (in_object()) {
        messages_.warn_once("area light in object", at, "area lights inside object definitions do not shine");
        return;
    }
    if (std::holds_alternative<Curves>(geometry)) {
        messages_.warn_once("area light on curves", at, "curves do not emit light");
        return;
    }
    const std::size_t count = primitive_count(geometry);
    if (count == 0) return;
    emissive_primitives_ += count;
    if (emissive_primitives_ >= no_index) messages_.error(at, "more than 2^32 emissive triangles");
    scene_.shapes[shape].light = add_light(emission.light(shape, geometry), at, emission.group);
}

void SceneBuilder::begin_object(const std::string& name, SourceLocation at) {
    objects_.declare(name, static_cast<Index>(scene_.objects.size()), at, messages_);
    open_object_ = static_cast<Index>(scene_.objects.size());
    scene_.objects.emplace_back();
    // Readers name objects that have no name in the file by a line break and a number.
    if (!name.starts_with('\n')) scene_.objects.back().name = name;
}

void SceneBuilder::add_instance(const std::string& object, const Transform& world_from_object,
                                SourceLocation at) {
    if (!fits_float(world_from_object))
        messages_.error(at, "the instance's transformation is beyond what single-precision numbers hold");
    instances_.push_back({objects_.refer(object), world_from_object, no_index, at});
}

void SceneBuilder::add_instance(const std::string& object, const Transform& start, const Transform& end,
                                SourceLocation at) {
    add_instance(object, start, at);
    if (start == end) return;
    if (!fits_float(end))
        messages_.error(at,
                        "the instance's last transformation is beyond what single-precision numbers hold");
    try {
        scene_.motions.emplace_back(start, end);
    } catch (const Error& e) {
        messages_.error(at, e.what());
    }
    instances_.back().motion = static_cast<Index>(scene_.motions.size() - 1);
}

Index SceneBuilder::add_light(const Light& light, SourceLocation at, const std::string& group) {
    if (scene_.lights.size() >= no_index) messages_.error(at, "more than 2^32 lights");
    try {
        check_light(scene_, light);
    } catch (const Error& e) {
        messages_.error(at, e.what());
    }
    scene_.lights.push_back(light);
    if (!group.empty()) {
        scene_.light_groups.resize(scene_.lights.size());
        scene_.light_groups.back() = group;
    }
    return static_cast<Index>(scene_.lights.size() - 1);
}

SceneSpectrum SceneBuilder::add_spectrum(const Spectrum& spectrum) {
    if (spectrum.is_constant()) return montelux::add_spectrum(scene_, spectrum);
    const auto [known, is_new] = spectra_.try_emplace(digest_of(spectrum));
    if (is_new) known->second = montelux::add_spectrum(scene_, spectrum);
    return known->second;
}

void SceneBuilder::place_instances() {
    std::vector<Bounds3> bounds;
    for (const ObjectDefinition& object : scene_.objects) bounds.push_back(bounds_of(object, scene_));
    for (const InstanceUse& use : instances_) {
        const Index object = objects_.resolve(use.object, use.at, messages_);
        const Bounds3& b = bounds[object];
        const auto reaches_too_far = [&](const Transform& t) {
            bool far = false;
            for (int i = 0; i < 8 && !b.empty(); ++i) far = far || !fits_float(t.point(b.corner(i)));
            return far;
        };
        if (reaches_too_far(use.world_from_object) ||
            (use.motion != no_index && reaches_too_far(scene_.motions[use.motion].end())))
            messages_.error(use.at, "the instance reaches to infinity in world space");
        scene_.instances.push_back({object, use.world_from_object, use.motion});
    }
    instances_.clear();
}

void SceneBuilder::finish(SourceLocation end, bool lights_matter) {
    place_instances();
    for (std::size_t i = 0; i < scene_.shapes.size(); ++i) {
        const Shape& shape = scene_.shapes[i];
        if (shape.material >= scene_.materials.size())
            messages_.error(end, "shape " + std::to_string(i) + " has no material");
        if (!shape.alpha.is_constant() && shape.alpha.texture >= scene_.float_textures.size())
            messages_.error(end, "the alpha of shape " + std::to_string(i) + " has no texture");
    }
    try {
        check_textures(scene_);
        check_materials(scene_);
        check_media(scene_);
    } catch (const Error& e) {
        messages_.error(end, e.what());
    }
    if (lights_matter && scene_.lights.empty())
        messages_.warn(end, "the scene has no light; its picture is black");
}

} // namespace montelux
