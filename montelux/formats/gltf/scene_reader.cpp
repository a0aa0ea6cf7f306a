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
    description.animation_end = end_of(document, channels_);
    if (const std::optional<Value> all = document.root().extension("KHR_lights_punctual"))
        lights_ = all->elements("lights");
}

void SceneReader::read() {
    for (const std::size_t node : nodes_shown()) visit(node);
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

std::vector<std::size_t> SceneReader::nodes_shown() {
    const std::vector<Value>& scenes = document_.all("scenes");
    std::vector<std::size_t> order;
    if (scenes.empty()) {
        order = pose_.roots();
    } else {
        const std::optional<Value> chosen = document_.root().find("scene");
        const Value& scene = chosen ? document_.refer(*chosen, "scenes", "scene") : scenes.front();
        if (scenes.size() > 1)
            document_.diagnostics().warn(scene.pointer(), "is shown; the file has " +
                                                              std::to_string(scenes.size()) + " scenes");
        for (const Value& root : scene.elements("nodes")) {
            document_.refer(root, "nodes", "node");
            order.push_back(root.whole());
        }
    }
    std::vector<char> seen(document_.all("nodes").size(), 0);
    std::vector<std::size_t> result;
    for (std::size_t k = 0; k < order.size(); ++k) {
        const std::size_t node = order[k];
        if (std::exchange(seen[node], 1) != 0) continue;
        result.push_back(node);
        order.insert(order.end(), pose_.children(node).begin(), pose_.children(node).end());
    }
    return result;
}

void SceneReader::visit(std::size_t i) {
    const Value& node = document_.all("nodes")[i];
    if (const std::optional<Value> index = node.find("camera")) {
        const Value& camera = document_.refer(*index, "cameras", "camera");
        cameras_.push_back({camera, node.text("name", camera.text("name", "")), pose_.world(i), node});
    }
    if (const std::optional<Value> extension = node.extension("KHR_lights_punctual")) {
        const Value index = extension->required("light");
        if (index.whole() >= lights_.size())
            index.error("light " + std::to_string(index.whole()) + " does not exist (there are " +
                        std::to_string(lights_.size()) + ")");
        add_light(lights_[index.whole()], pose_.world(i), node, builder_);
        description_.has_lights = true;
    }
    const std::optional<Value> mesh = node.find("mesh");
    if (!mesh) return;
    document_.refer(*mesh, "meshes", "mesh");
    if (const std::optional<Value> instancing = node.extension("EXT_mesh_gpu_instancing"))
        add_gpu_instances(*instancing, i, mesh->whole());
    else
        uses_[mesh->whole()].push_back({i, pose_.world(i)});
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
        uses_[mesh].push_back({node, pose_.world(node) * place});
    }
}

void SceneReader::place_meshes() {
    const std::vector<Value>& meshes = document_.all("meshes");
    const std::vector<Value>& nodes = document_.all("nodes");
    for (const auto& [number, uses] : uses_) {
        const Value& mesh = meshes[number];
        std::vector<MeshUse> plain;
        for (const MeshUse& use : uses) {
            const std::vector<double>& weights = pose_.weights(use.node);
            const bool morphed = std::ranges::any_of(weights, [](double w) { return w != 0; });
            if (morphed || nodes[use.node].find("skin"))
                place_deformed(mesh, use);
            else
                plain.push_back(use);
        }
        if (plain.size() == 1)
            for (const Value& primitive : mesh.elements("primitives"))
                add_to_world(mesh, primitive, plain.front(), {});
        else if (!plain.empty())
            place_object(mesh, mesh.text("name", "mesh") + ' ' + std::to_string(number), plain);
    }
}

std::vector<Matrix4> SceneReader::joints_of(const Value& node) {
    const std::optional<Value> index = node.find("skin");
    if (!index) return {};
    const Value& skin = document_.refer(*index, "skins", "skin");
    std::vector<Matrix4> joints;
    for (const Value& joint : skin.elements("joints")) {
        document_.refer(joint, "nodes", "node");
        joints.push_back(pose_.world(joint.whole()));
    }
    if (joints.empty()) skin.error("has no joints");
    if (const std::optional<Value> inverse = skin.find("inverseBindMatrices")) {
        const auto matrices = read_elements<16>(document_, open_accessor(document_, *inverse, {"MAT4"}),
                                                [](const std::array<float, 16>& v) { return v; });
        if (matrices.size() < joints.size())
            inverse->error("has " + std::to_string(matrices.size()) + " matrices for " +
                           std::to_string(joints.size()) + " joints");
        for (std::size_t i = 0; i < joints.size(); ++i)
            joints[i] = joints[i] * matrix_of_columns({matrices[i].begin(), matrices[i].end()});
    }
    return joints;
}

void SceneReader::place_deformed(const Value& mesh, const MeshUse& use) {
    const std::vector<Matrix4> joints = joints_of(document_.all("nodes")[use.node]);
    // The joints alone place a skinned mesh: section 3.7.3.2.
    const MeshUse placed{use.node, joints.empty() ? use.world_from_mesh : Matrix4()};
    for (const Value& primitive : mesh.elements("primitives"))
        add_to_world(mesh, primitive, placed, {pose_.weights(use.node), joints});
}

std::optional<Transform> SceneReader::invertible(const MeshUse& use) {
    std::optional<Transform> t = Transform::from_matrix(use.world_from_mesh);
    if (!t) {
        const Value& node = document_.all("nodes")[use.node];
        node.warn("its transformation has no inverse: its mesh is not shown");
    }
    return t;
}

void SceneReader::add_to_world(const Value& mesh, const Value& primitive, const MeshUse& use,
                               const Deformation& deformation) {
    const std::optional<Transform> world_from_mesh = invertible(use);
    if (!world_from_mesh) return;
    const SurfaceLook& look = materials_.of(primitive);
    std::optional<TriangleMesh> triangles = read_primitive(document_, primitive, look.uv_set, deformation);
    if (!triangles) return;
    transform_mesh(*triangles, *world_from_mesh);
    add_shape(*std::move(triangles), mesh, primitive, look, world_from_mesh->swaps_handedness());
}

void SceneReader::add_shape(TriangleMesh triangles, const Value& mesh, const Value& primitive,
                            const SurfaceLook& look, bool flipped) {
    if (triangles.indices.empty()) return;
    ShapeSettings settings;
    settings.material = look.material;
    settings.alpha = look.alpha;
    settings.flip_normal = flipped;
    if (look.emission) settings.emission = &*look.emission;
    settings.media.inside = look.medium_inside;
    settings.name = mesh.text("name", "");
    builder_.add_shape(std::move(triangles), settings, primitive.place());
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
        std::optional<TriangleMesh> triangles = read_primitive(document_, primitive, look.uv_set, {});
        if (!triangles || triangles->indices.empty()) continue;
        if (!std::exchange(is_open, true)) builder_.begin_object(name, mesh.place());
        add_shape(*std::move(triangles), mesh, primitive, look, false);
    }
    if (is_open) builder_.end_object();
    for (const MeshUse& use : uses) {
        if (is_open) {
            if (const std::optional<Transform> t = invertible(use))
                builder_.add_instance(name, *t, document_.all("nodes")[use.node].place());
        }
        for (const Value& primitive : emitters) add_to_world(mesh, primitive, use, {});
    }
}

} // namespace montelux::gltf
