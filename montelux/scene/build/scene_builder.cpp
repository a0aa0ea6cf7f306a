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
                                      for (const Point3f p : mesh.end_positions) bounds.add(Vec3d(p));
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

// Gives back unused capacity if it is more than an eighth of the values: less is not worth the copy.
template <typename T>
void trim(std::vector<T>& v) {
    if (v.capacity() - v.size() > v.size() / 8 + 1) v.shrink_to_fit();
}

// With room for the ray tracer to read them in place.
void trim_positions(std::vector<Point3f>& positions) {
    trim(positions);
    if (!positions.empty()) positions.reserve(positions.size() + 1);
}

// Whether the position of a light, if it has one, is finite.
template <typename L>
bool stays_in_floats(const L& light) {
    if constexpr (requires { light.position(); })
        return is_finite(light.position());
    else if constexpr (requires { light.position; })
        return is_finite(light.position);
    return true;
}

constexpr std::string_view dark_in_objects = "area lights inside object definitions do not shine";

// A use of an object needs memory for each of its moving parts, so a short file could ask for any amount: 4 GiB of keys
// in all.
constexpr std::size_t most_part_keys = std::size_t{1} << 25;
constexpr std::size_t keys_beside = 8; // what an instance and its motion need beside the keys, in keys

} // namespace

Index SceneBuilder::add_shape(Geometry geometry, const ShapeSettings& settings, SourceLocation at) {
    check_shape(geometry, at);
    const std::optional<AreaLight> light =
        area_light(settings, geometry, in_object() ? dark_in_objects : "", at);
    return add_shape_to(open_object_, std::move(geometry), settings, light, at);
}

Index SceneBuilder::add_moving_shape(Geometry geometry, const ShapeSettings& settings, const Transform& start,
                                     const Transform& end, SourceLocation at) {
    check_shape(geometry, at);
    if (in_object()) {
        const std::optional<AreaLight> none = area_light(settings, geometry, dark_in_objects, at);
        return add_shape_to(moving_part(start, end, at), std::move(geometry), settings, none, at);
    }
    // An object of its own, with one instance.
    std::optional<Motion> motion = motion_of_instance(start, end, at);
    const std::optional<AreaLight> light = area_light(settings, geometry, "", at);
    const auto object = static_cast<Index>(scene_.objects.size());
    const std::string name = std::string(1, '\0') + std::to_string(object); // no name in a file
    objects_.declare(name, object, at, messages_);
    scene_.objects.emplace_back().shines = true;
    const Index shape = add_shape_to(object, std::move(geometry), settings, light, at);
    use_object(name, start, std::move(motion), at);
    return shape;
}

void SceneBuilder::check_shape(const Geometry& geometry, SourceLocation at) const {
    if (scene_.shapes.size() >= no_index) messages_.error(at, "more than 2^32 shapes");
    try {
        check_geometry(geometry);
    } catch (const Error& e) {
        messages_.error(at, e.what());
    }
}

std::optional<AreaLight> SceneBuilder::area_light(const ShapeSettings& settings, const Geometry& geometry,
                                                  std::string_view dark, SourceLocation at) {
    if (settings.emission == nullptr) return std::nullopt;
    if (!dark.empty()) {
        messages_.warn_once(dark, at, dark);
        return std::nullopt;
    }
    if (std::holds_alternative<Curves>(geometry)) {
        messages_.warn_once("area light on curves", at, "curves do not emit light");
        return std::nullopt;
    }
    const std::size_t count = primitive_count(geometry);
    if (count == 0) return std::nullopt;
    if (emissive_primitives_ + count >= no_index) messages_.error(at, "more than 2^32 emissive triangles");
    const AreaLight light = settings.emission->light(static_cast<Index>(scene_.shapes.size()), geometry);
    check_new_light(light, 1, at);
    return light;
}

Index SceneBuilder::add_shape_to(Index object, Geometry geometry, const ShapeSettings& settings,
                                 const std::optional<AreaLight>& light, SourceLocation at) {
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
    (object != no_index ? scene_.objects[object].shapes : scene_.world_shapes).push_back(index);
    if (light) emissive_primitives_ += primitive_count(geometry);
    scene_.shapes[index].geometry = std::visit(
        Overloaded{[&](TriangleMesh& mesh) -> ShapeGeometry {
                       trim_positions(mesh.positions);
                       trim_positions(mesh.end_positions);
                       trim(mesh.normals);
                       trim(mesh.end_normals);
                       trim(mesh.uvs);
                       trim(mesh.indices);
                       trim(mesh.tangents);
                       trim(mesh.colors);
                       trim(mesh.opacities);
                       trim(mesh.second_uvs);
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
    if (light) scene_.shapes[index].light = add_light(*light, at, settings.emission->group);
    return index;
}

void SceneBuilder::begin_object(const std::string& name, SourceLocation at) {
    objects_.declare(name, static_cast<Index>(scene_.objects.size()), at, messages_);
    open_object_ = static_cast<Index>(scene_.objects.size());
    scene_.objects.emplace_back();
    scene_.objects.back().name = name;
}

void SceneBuilder::end_object() {
    open_object_ = no_index;
    open_parts_.clear();
}

bool SceneBuilder::MotionOrder::operator()(const MotionKey& a, const MotionKey& b) const {
    for (std::size_t end = 0; end < 2; ++end)
        if (a[end].m != b[end].m) return a[end].m < b[end].m;
    return false;
}

Motion SceneBuilder::motion(const Transform& start, const Transform& end, SourceLocation at) const {
    try {
        return {start, end};
    } catch (const Error& e) {
        messages_.error(at, e.what());
    }
}

Index SceneBuilder::moving_part(const Transform& start, const Transform& end, SourceLocation at) {
    if (!fits_float(start) || !fits_float(end))
        messages_.error(at, "the shape's transformation is beyond what single-precision numbers hold");
    const MotionKey ends{start.matrix(), end.matrix()};
    if (const auto known = open_parts_.find(ends); known != open_parts_.end()) return known->second;
    Motion in_object = motion(start, end, at);
    const auto object = static_cast<Index>(scene_.objects.size());
    parts_[open_object_].push_back({object, std::move(in_object)});
    scene_.objects.push_back({.shapes = {}, .name = {}, .part_of = open_object_});
    return open_parts_[ends] = object;
}

void SceneBuilder::add_instance(const std::string& object, const Transform& world_from_object,
                                SourceLocation at) {
    add_instance(object, world_from_object, world_from_object, at);
}

void SceneBuilder::add_instance(const std::string& object, const Transform& start, const Transform& end,
                                SourceLocation at) {
    use_object(object, start, motion_of_instance(start, end, at), at);
}

std::optional<Motion> SceneBuilder::motion_of_instance(const Transform& start, const Transform& end,
                                                       SourceLocation at) const {
    if (!fits_float(start))
        messages_.error(at, "the instance's transformation is beyond what single-precision numbers hold");
    if (start == end) return std::nullopt;
    if (!fits_float(end))
        messages_.error(at,
                        "the instance's last transformation is beyond what single-precision numbers hold");
    return motion(start, end, at);
}

void SceneBuilder::use_object(const std::string& object, const Transform& at_start,
                              std::optional<Motion> motion, SourceLocation at) {
    Index moving = no_index;
    if (motion) {
        moving = static_cast<Index>(motions_.size());
        motions_.push_back(std::move(*motion));
    }
    instances_.push_back({objects_.refer(object), at_start, moving, at});
}

void SceneBuilder::check_new_light(const Light& light, std::size_t new_shapes, SourceLocation at) const {
    if (scene_.lights.size() >= no_index) messages_.error(at, "more than 2^32 lights");
    try {
        check_light(scene_, light, new_shapes);
    } catch (const Error& e) {
        messages_.error(at, e.what());
    }
}

Index SceneBuilder::add_light(const Light& light, SourceLocation at, const std::string& group) {
    check_new_light(light, 0, at);
    scene_.lights.push_back(light);
    if (!group.empty()) {
        scene_.light_groups.resize(scene_.lights.size());
        scene_.light_groups.back() = group;
    }
    return static_cast<Index>(scene_.lights.size() - 1);
}

Index SceneBuilder::add_moving_light(const Light& light, const Transform& start, const Transform& end,
                                     SourceLocation at, const std::string& group) {
    const auto add = [&]<typename L>(L moving) {
        if constexpr (MovableLight<L>) {
            const auto check = [&](bool fits) {
                if (!fits)
                    messages_.error(
                        at, "the light's transformation is beyond what single-precision numbers hold");
            };
            for (const Transform* t : {&start, &end})
                check(fits_float(*t) && turns_in_floats(*t) && stays_in_floats(moving.moved(*t)));
            if constexpr (requires { moving.portal; })
                if (moving.portal) messages_.error(at, "an environment map with a portal does not move");
            if (start == end) return add_light(moving.moved(start), at, group);
            Motion path = motion(start, end, at);
            for (const Matrix4& key : path.keys())
                if (const std::optional<Transform> t = Transform::from_matrix(key))
                    check(stays_in_floats(moving.moved(*t)));
            check_new_light(moving, 0, at);
            moving.motion = static_cast<Index>(scene_.motions.size());
            scene_.motions.push_back(std::move(path));
        } else if constexpr (std::is_same_v<L, AreaLight>) {
            messages_.error(at, "the light of a shape moves with the shape");
        }
        return add_light(moving, at, group); // a uniform sky looks the same
    };
    return std::visit(add, light);
}

SceneSpectrum SceneBuilder::add_spectrum(const Spectrum& spectrum) {
    if (spectrum.is_constant()) return montelux::add_spectrum(scene_, spectrum);
    const auto [known, is_new] = spectra_.try_emplace(digest_of(spectrum));
    if (is_new) known->second = montelux::add_spectrum(scene_, spectrum);
    return known->second;
}

void SceneBuilder::place_instance(const InstanceUse& use, Index object, const Transform& at_start,
                                  std::optional<Motion> motion, const Bounds3& bounds) {
    const auto check = [&](const Transform& t) {
        bool far = false;
        for (int i = 0; i < 8 && !bounds.empty(); ++i) far = far || !fits_float(t.point(bounds.corner(i)));
        if (far) messages_.error(use.at, "the instance reaches to infinity in world space");
    };
    check(at_start);
    Index moving = no_index;
    if (motion) {
        check(motion->end());
        // Between two keys nothing is farther away. The inverse is not used.
        for (const Matrix4& key : motion->keys()) check(Transform(key, Matrix4()));
        moving = static_cast<Index>(scene_.motions.size());
        scene_.motions.push_back(std::move(*motion));
    }
    scene_.instances.push_back({object, at_start, moving});
}

void SceneBuilder::check_part_count() {
    std::map<Index, std::size_t> keys_of_object; // of its parts in a still instance
    for (const auto& [object, parts] : parts_)
        for (const MovingPart& part : parts)
            keys_of_object[object] += part.motion.keys().size() + keys_beside;
    std::size_t keys = 0;
    for (const InstanceUse& use : instances_) {
        const Index object = objects_.resolve(use.object, use.at, messages_);
        const auto parts = parts_.find(object);
        if (parts == parts_.end()) continue;
        keys += keys_of_object[object];
        if (use.motion != no_index) keys += parts->second.size() * motions_[use.motion].keys().size();
        if (keys > most_part_keys)
            messages_.error(use.at,
                            "the instances of objects whose shapes move need more than 4 GiB; expected "
                            "fewer instances, or fewer shapes that move");
    }
}

void SceneBuilder::place_instances() {
    check_part_count();
    std::vector<Bounds3> bounds;
    for (const ObjectDefinition& object : scene_.objects) bounds.push_back(bounds_of(object, scene_));
    for (const InstanceUse& use : instances_) {
        const Index object = objects_.resolve(use.object, use.at, messages_);
        const auto parts = parts_.find(object);
        const Motion* outer = use.motion != no_index ? &motions_[use.motion] : nullptr;
        if (parts == parts_.end() || !scene_.objects[object].shapes.empty())
            place_instance(use, object, use.world_from_object,
                           outer != nullptr ? std::optional(*outer) : std::nullopt, bounds[object]);
        if (parts == parts_.end()) continue;
        for (const MovingPart& part : parts->second) {
            const Transform start = use.world_from_object * part.motion.start(),
                            end =
                                (outer != nullptr ? outer->end() : use.world_from_object) * part.motion.end();
            if (!fits_float(start) || !fits_float(end))
                messages_.error(use.at,
                                "the instance's transformation is beyond what single-precision numbers hold");
            std::optional<Motion> motion;
            try {
                motion = outer != nullptr ? Motion::product(*outer, part.motion)
                                          : Motion::product(use.world_from_object, part.motion);
            } catch (const Error& e) {
                messages_.error(use.at, e.what());
            }
            place_instance(use, part.object, start, std::move(motion), bounds[part.object]);
        }
    }
    instances_.clear();
    motions_.clear();
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
