#include "montelux/formats/gltf/scene_reader.h"

#include <algorithm>
#include <array>
#include <utility>

#include "montelux/formats/gltf/accessor.h"
#include "montelux/formats/gltf/primitive.h"
#include "montelux/mc/math/error.h"

namespace montelux::gltf {
namespace {

// Memory of an instance with its transformation.
constexpr double instance_bytes = 400;

} // namespace

SceneReader::SceneReader(Document& document, SceneDescription& description, const LoadOptions& options)
    : document_(document), description_(description), options_(options),
      builder_(description.scene, document.diagnostics()),
      materials_(document, builder_, options.variant, options.pictures),
      channels_(options.time ? channels_of(document) : std::vector<Channel>()),
      pose_(document, channels_, options.time.value_or(0)) {
    if (options.shutter > 0 && !channels_.empty())
        end_pose_.emplace(document, channels_, *options.time + options.shutter);
    description.animation_end = gltf::end_of(document, channels_);
    for (const Value& animation : document.all("animations"))
        description.animation_names.push_back(animation.text("name", ""));
    description.variant_names = variant_names(document.root());
    if (const std::optional<Value> all = document.root().extension("KHR_lights_punctual"))
        lights_ = all->elements("lights");
}

void SceneReader::read() {
    for (const SceneNode node : nodes_of_scene()) visit(node);
    place_meshes();
    choose_camera(cameras_, options_.camera, document_.root(), description_);
    if (description_.scene.shapes.empty()) document_.diagnostics().warn("", "the scene has no meshes");
    try {
        builder_.finish({}, false); // a studio lights what has no lights
    } catch (const LocatedError&) {
        throw;
    } catch (const Error& e) {
        document_.diagnostics().error("", e.what());
    }
}

std::vector<SceneReader::SceneNode> SceneReader::nodes_of_scene() {
    const std::vector<Value>& scenes = document_.all("scenes");
    std::vector<SceneNode> order;
    if (scenes.empty()) {
        for (const std::size_t root : pose_.roots()) order.push_back({root, true});
    } else {
        const std::optional<Value> chosen = document_.root().find("scene");
        const Value& scene = chosen ? document_.refer(*chosen, "scenes", "scene") : scenes.front();
        if (scenes.size() > 1)
            document_.diagnostics().warn(scene.pointer(), "is shown; the file has " +
                                                              std::to_string(scenes.size()) + " scenes");
        for (const Value& root : scene.elements("nodes")) {
            document_.refer(root, "nodes", "node");
            order.push_back({root.whole(), true});
        }
    }
    const std::vector<Value>& nodes = document_.all("nodes");
    std::vector<char> seen(nodes.size(), 0);
    std::vector<SceneNode> result;
    for (std::size_t k = 0; k < order.size(); ++k) {
        SceneNode node = order[k];
        if (std::exchange(seen[node.number], 1) != 0) continue;
        if (const std::optional<Value> own = nodes[node.number].extension("KHR_node_visibility"))
            node.is_visible = node.is_visible && own->boolean("visible", true);
        result.push_back(node);
        for (const std::size_t child : pose_.children(node.number)) order.push_back({child, node.is_visible});
    }
    return result;
}

void SceneReader::visit(SceneNode which) {
    const std::size_t i = which.number;
    const Value& node = document_.all("nodes")[i];
    if (const std::optional<Value> index = node.find("camera")) {
        const Value& camera = document_.refer(*index, "cameras", "camera");
        cameras_.push_back({camera, node.text("name", camera.text("name", "")), place_of(i), node});
    }
    if (!which.is_visible) return;
    if (const std::optional<Value> extension = node.extension("KHR_lights_punctual")) {
        const Value index = extension->required("light");
        if (index.whole() >= lights_.size())
            index.error("light " + std::to_string(index.whole()) + " does not exist (there are " +
                        std::to_string(lights_.size()) + ")");
        add_light(lights_[index.whole()], place_of(i), node, builder_);
    }
    const std::optional<Value> mesh = node.find("mesh");
    if (!mesh) return;
    document_.refer(*mesh, "meshes", "mesh");
    if (const std::optional<Value> instancing = node.extension("EXT_mesh_gpu_instancing"))
        add_gpu_instances(*instancing, i, mesh->whole());
    else
        uses_[mesh->whole()].push_back({i, place_of(i)});
}

void SceneReader::add_gpu_instances(const Value& instancing, std::size_t node, std::uint64_t mesh) {
    const Value attributes = instancing.required("attributes");
    std::vector<std::array<float, 3>> translations, scales;
    std::vector<std::array<float, 4>> rotations;
    std::size_t count = 0;
    const auto read = [&]<std::size_t N>(std::string_view name, std::string_view type,
                                         std::vector<std::array<float, N>>& to) {
        const std::optional<Value> index = attributes.find(name);
        if (!index) return;
        to = read_elements<N>(document_, open_accessor(document_, *index, {type}),
                              [](const std::array<float, N>& v) { return v; });
        if (count != 0 && to.size() != count)
            index->error("has " + std::to_string(to.size()) + " elements; the attributes before it have " +
                         std::to_string(count));
        count = to.size();
    };
    read("TRANSLATION", "VEC3", translations);
    read("ROTATION", "VEC4", rotations);
    read("SCALE", "VEC3", scales);
    document_.charge(static_cast<double>(count) * instance_bytes, instancing);
    const auto doubles = []<std::size_t N>(const std::array<float, N>& from) {
        std::array<double, N> to{};
        for (std::size_t k = 0; k < N; ++k) to[k] = double(from[k]);
        return to;
    };
    for (std::size_t k = 0; k < count; ++k) {
        const Matrix4 place =
            matrix_of(translations.empty() ? std::array<double, 3>{0, 0, 0} : doubles(translations[k]),
                      rotations.empty() ? std::array<double, 4>{0, 0, 0, 1} : doubles(rotations[k]),
                      scales.empty() ? std::array<double, 3>{1, 1, 1} : doubles(scales[k]));
        uses_[mesh].push_back({node, {pose_.world(node) * place, end_pose().world(node) * place}});
    }
}

void SceneReader::place_meshes() {
    const std::vector<Value>& meshes = document_.all("meshes");
    const std::vector<Value>& nodes = document_.all("nodes");
    for (const auto& [number, uses] : uses_) {
        const Value& mesh = meshes[number];
        std::vector<MeshUse> plain;
        for (const MeshUse& use : uses) {
            const auto morphs = [&](const Pose& pose) {
                return std::ranges::any_of(pose.weights(use.node), [](double w) { return w != 0; });
            };
            if (morphs(pose_) || morphs(end_pose()) || nodes[use.node].find("skin"))
                place_deformed(mesh, use);
            else
                plain.push_back(use);
        }
        if (plain.size() == 1)
            for (const Value& primitive : mesh.elements("primitives"))
                add_to_world(mesh, primitive, plain.front(), {}, {});
        else if (!plain.empty())
            place_object(mesh, mesh.text("name", "mesh") + ' ' + std::to_string(number), plain);
    }
}

SceneReader::Joints SceneReader::joints_of(const Value& node) {
    const std::optional<Value> index = node.find("skin");
    if (!index) return {};
    const Value& skin = document_.refer(*index, "skins", "skin");
    Joints joints;
    for (const Value& joint : skin.elements("joints")) {
        document_.refer(joint, "nodes", "node");
        const Placement place = place_of(joint.whole());
        joints.start.push_back(place.start);
        joints.end.push_back(place.end);
    }
    const std::size_t count = joints.start.size();
    if (count == 0) skin.error("has no joints");
    if (const std::optional<Value> inverse = skin.find("inverseBindMatrices")) {
        const auto matrices = read_elements<16>(document_, open_accessor(document_, *inverse, {"MAT4"}),
                                                [](const std::array<float, 16>& v) { return v; });
        if (matrices.size() < count)
            inverse->error("has " + std::to_string(matrices.size()) + " matrices for " +
                           std::to_string(count) + " joints");
        for (std::size_t i = 0; i < count; ++i) {
            const Matrix4 bind = matrix_of_columns({matrices[i].begin(), matrices[i].end()});
            joints.start[i] = joints.start[i] * bind;
            joints.end[i] = joints.end[i] * bind;
        }
    }
    return joints;
}

void SceneReader::place_deformed(const Value& mesh, const MeshUse& use) {
    const Joints joints = joints_of(document_.all("nodes")[use.node]);
    // The joints alone place a skinned mesh: section 3.7.3.2.
    const MeshUse placed{use.node, joints.start.empty() ? use.place : Placement()};
    for (const Value& primitive : mesh.elements("primitives"))
        add_to_world(mesh, primitive, placed, {pose_.weights(use.node), joints.start},
                     {end_pose().weights(use.node), joints.end});
}

std::optional<Transform> SceneReader::start_of(const MeshUse& use) {
    std::optional<Transform> t = Transform::from_matrix(use.place.start);
    if (!t) {
        const Value& node = document_.all("nodes")[use.node];
        node.warn("its transformation has no inverse: its mesh is not shown");
    }
    return t;
}

std::optional<Transform> SceneReader::end_of(const MeshUse& use, const Transform& start) {
    if (!use.place.moves()) return std::nullopt;
    // One without an inverse has no motion to it either.
    const Transform end = Transform::from_matrix(use.place.end).value_or(Transform(use.place.end, {}));
    if (!can_move(start, end, document_.all("nodes")[use.node])) return std::nullopt;
    return end;
}

std::optional<TriangleMesh> SceneReader::read_deformed(const Value& primitive, const SurfaceLook& look,
                                                       const Deformation& at_start,
                                                       const Deformation& at_end) {
    std::optional<TriangleMesh> mesh = read_primitive(document_, primitive, look.uv_sets, at_start);
    if (!mesh || mesh->indices.empty()) return std::nullopt;
    if (at_start == at_end) return mesh;
    std::optional<TriangleMesh> end = read_primitive(document_, primitive, look.uv_sets, at_end);
    mesh->end_positions = std::move(end->positions);
    mesh->end_normals = std::move(end->normals);
    mesh->tangents.clear(); // a mesh that deforms has none
    return mesh;
}

void SceneReader::add_to_world(const Value& mesh, const Value& primitive, const MeshUse& use,
                               const Deformation& at_start, const Deformation& at_end) {
    const std::optional<Transform> start = start_of(use);
    if (!start) return;
    const SurfaceLook& look = materials_.of(primitive);
    std::optional<TriangleMesh> triangles = read_deformed(primitive, look, at_start, at_end);
    if (!triangles) return;
    ShapeSettings settings = settings_of(mesh, look);
    if (const std::optional<Transform> end = end_of(use, *start)) {
        builder_.add_moving_shape(*std::move(triangles), settings, *start, *end, primitive.place());
        return;
    }
    transform_mesh(*triangles, *start);
    settings.flip_normal = start->swaps_handedness();
    builder_.add_shape(*std::move(triangles), settings, primitive.place());
}

ShapeSettings SceneReader::settings_of(const Value& mesh, const SurfaceLook& look) const {
    ShapeSettings settings;
    settings.material = look.material;
    settings.alpha = look.alpha;
    if (look.emission) settings.emission = &*look.emission;
    settings.media.inside = look.medium_inside;
    settings.name = mesh.text("name", "");
    return settings;
}

void SceneReader::place_object(const Value& mesh, const std::string& name, const std::vector<MeshUse>& uses) {
    bool is_open = false;
    std::vector<Value> emitters;
    for (const Value& primitive : mesh.elements("primitives")) {
        const SurfaceLook& look = materials_.of(primitive);
        if (look.emission) {
            emitters.push_back(primitive);
            continue;
        }
        std::optional<TriangleMesh> triangles = read_deformed(primitive, look, {}, {});
        if (!triangles) continue;
        if (!std::exchange(is_open, true)) builder_.begin_object(name, mesh.place());
        builder_.add_shape(*std::move(triangles), settings_of(mesh, look), primitive.place());
    }
    if (is_open) builder_.end_object();
    for (const MeshUse& use : uses) {
        if (is_open) {
            if (const std::optional<Transform> start = start_of(use))
                builder_.add_instance(name, *start, end_of(use, *start).value_or(*start),
                                      document_.all("nodes")[use.node].place());
        }
        for (const Value& primitive : emitters) add_to_world(mesh, primitive, use, {}, {});
    }
}

} // namespace montelux::gltf
