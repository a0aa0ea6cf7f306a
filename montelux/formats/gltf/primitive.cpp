#include "montelux/formats/gltf/primitive.h"

#include <algorithm>
#include <array>
#include <list>
#include <string>
#include <utility>

#include "montelux/formats/gltf/accessor.h"
#include "montelux/formats/gltf/draco.h"

namespace montelux::gltf {
namespace {

enum Mode : std::uint64_t { triangles = 4, triangle_strip = 5, triangle_fan = 6 };

// Three vertices per triangle. The order of strips keeps the front, glTF 2.0 specification, section 3.7.2.1.
void make_triangles(std::vector<Index>& v, std::uint64_t mode, const Value& primitive) {
    const std::size_t n = v.size();
    if (mode == triangles) {
        if (n % 3 != 0)
            primitive.warn("has " + std::to_string(n) + " vertices in triangles; the last " +
                           std::to_string(n % 3) + " are ignored");
        v.resize(n - n % 3);
        return;
    }
    std::vector<Index> result;
    if (n >= 3) result.reserve(3 * (n - 2));
    for (std::size_t i = 0; i + 2 < n; ++i) {
        if (mode == triangle_fan)
            result.insert(result.end(), {v[i + 1], v[i + 2], v[0]});
        else
            result.insert(result.end(), {v[i], v[i + 1 + i % 2], v[i + 2 - i % 2]});
    }
    v = std::move(result);
}

class PrimitiveReader {
  public:
    PrimitiveReader(Document& document, const Value& primitive)
        : document_(document), primitive_(primitive), attributes_(primitive.required("attributes")) {}

    std::optional<TriangleMesh> read(const UvSets& uv_sets, const Deformation& deformation) {
        const std::uint64_t mode = primitive_.whole("mode", triangles);
        if (mode > triangle_fan)
            primitive_.required("mode").error("mode " + std::to_string(mode) + " is above 6");
        if (mode < triangles) {
            primitive_.warn("points and lines are not rendered");
            return std::nullopt;
        }
        const std::optional<Value> position = attributes_.find("POSITION");
        if (!position) {
            primitive_.warn("has no POSITION: it is not rendered");
            return std::nullopt;
        }
        count_ = open_accessor(document_, *position, {"VEC3"}).count;
        open_draco();
        const Accessor positions = *attribute("POSITION", {"VEC3"});
        read_indices_of(mode);
        if (mesh_.indices.empty()) return std::move(mesh_);
        mesh_.positions = read_vec3(document_, positions, chosen_);
        if (const auto a = attribute("NORMAL", {"VEC3"})) mesh_.normals = read_vec3(document_, *a, chosen_);
        // Without normals the surface is flat, and tangents are to be ignored: section 3.7.2.1.
        if (!mesh_.normals.empty())
            if (const auto a = attribute("TANGENT", {"VEC4"}))
                mesh_.tangents = read_vec3(document_, *a, chosen_);
        mesh_.uvs = read_uvs(uv_sets.first);
        if (uv_sets.second) mesh_.second_uvs = read_uvs(*uv_sets.second);
        if (const auto a = attribute("COLOR_0", {"VEC3", "VEC4"})) read_colors(*a);
        morph(deformation.weights);
        if (!deformation.joints.empty()) skin(deformation.joints);
        return std::move(mesh_);
    }

  private:
    // Of a compressed primitive, where its attributes lie.
    void open_draco() {
        const std::optional<Value> compressed = primitive_.extension("KHR_draco_mesh_compression");
        if (!compressed) return;
        const Value view = compressed->required("bufferView");
        const std::optional<Value> index = primitive_.find("indices");
        const std::size_t corners = index ? open_accessor(document_, *index, {"SCALAR"}).count : count_;
        document_.charge(static_cast<double>(corners) * sizeof(Index), *compressed);
        draco_.emplace(document_.view(view), count_, corners / 3, *compressed);
        draco_attributes_ = compressed->required("attributes");
    }

    std::optional<Accessor> attribute(const std::string& name,
                                      std::initializer_list<std::string_view> types) {
        std::optional<Accessor> a = attribute(attributes_, name, types);
        if (!a || !draco_) return a;
        const std::optional<Value> id = draco_attributes_->find(name);
        if (!id) return a;
        document_.charge(static_cast<double>(a->count * a->element_bytes), *id);
        unpacked_.push_back(draco_->attribute(id->whole(), *a, *id));
        a->bytes = unpacked_.back();
        a->stride = a->element_bytes;
        a->sparse.reset();
        return a;
    }
    std::optional<Accessor> attribute(const Value& set, const std::string& name,
                                      std::initializer_list<std::string_view> types) {
        const std::optional<Value> index = set.find(name);
        if (!index) return std::nullopt;
        Accessor a = open_accessor(document_, *index, types);
        if (a.count != count_)
            index->error("has " + std::to_string(a.count) + " elements for " + std::to_string(count_) +
                         " positions");
        return a;
    }

    void read_indices_of(std::uint64_t mode) {
        std::vector<Index>& v = mesh_.indices;
        if (draco_) {
            v = draco_->indices();
            if (v.size() < count_) choose_vertices();
            return;
        }
        if (const std::optional<Value> index = primitive_.find("indices")) {
            v = read_indices(document_, open_accessor(document_, *index, {"SCALAR"}));
            for (std::size_t i = 0; i < v.size(); ++i)
                if (v[i] >= count_)
                    index->error("index " + std::to_string(i) + " refers to vertex " + std::to_string(v[i]) +
                                 "; there are " + std::to_string(count_));
        } else {
            document_.charge(static_cast<double>(count_) * sizeof(Index), primitive_);
            v.resize(count_);
            for (std::size_t i = 0; i < count_; ++i) v[i] = static_cast<Index>(i);
        }
        make_triangles(v, mode, primitive_);
        if (v.size() < count_) choose_vertices();
    }

    // Primitives often share one large set of vertices; each takes its own alone.
    void choose_vertices() {
        chosen_ = mesh_.indices;
        std::sort(chosen_.begin(), chosen_.end());
        chosen_.erase(std::unique(chosen_.begin(), chosen_.end()), chosen_.end());
        for (Index& v : mesh_.indices)
            v = static_cast<Index>(std::lower_bound(chosen_.begin(), chosen_.end(), v) - chosen_.begin());
    }

    std::vector<Point2f> read_uvs(std::uint64_t set) {
        const auto a = attribute("TEXCOORD_" + std::to_string(set), {"VEC2"});
        if (!a) return {};
        return read_elements<2>(
            document_, *a, [](const std::array<float, 2>& v) { return Point2f(v[0], 1 - v[1]); }, chosen_);
    }

    void read_colors(const Accessor& a) {
        // Values beyond [0, 1] are clamped, section 3.7.2.1.
        const auto unit = [](float x) { return std::clamp(x, 0.0f, 1.0f); };
        mesh_.colors = read_elements<3>(
            document_, a,
            [&](const std::array<float, 3>& v) { return Vec3f(unit(v[0]), unit(v[1]), unit(v[2])); },
            chosen_);
        if (a.type == "VEC4")
            mesh_.opacities = read_elements<4>(
                document_, a, [&](const std::array<float, 4>& v) { return unit(v[3]); }, chosen_);
    }

    void morph(std::span<const double> weights) {
        const std::vector<Value> targets = primitive_.elements("targets");
        if (targets.size() != weights.size() && !weights.empty())
            primitive_.error("has " + std::to_string(targets.size()) +
                             " morph targets; the first primitive has " + std::to_string(weights.size()));
        for (std::size_t t = 0; t < weights.size(); ++t) {
            for (const std::string& name : targets[t].keys())
                if (name != "POSITION" && name != "NORMAL" && name != "TANGENT")
                    targets[t].diagnostics().warn_once("target " + name, targets[t].pointer(),
                                                       "changes of " + name + " are ignored");
            const auto w = static_cast<float>(weights[t]);
            if (w == 0) continue;
            const auto add = [&](const std::string& name, std::vector<Vec3f>& values) {
                if (values.empty()) return;
                if (const auto a = attribute(targets[t], name, {"VEC3"})) {
                    const std::vector<Vec3f> change = read_vec3(document_, *a, chosen_);
                    for (std::size_t i = 0; i < values.size(); ++i) values[i] += w * change[i];
                }
            };
            add("POSITION", mesh_.positions);
            add("NORMAL", mesh_.normals);
            add("TANGENT", mesh_.tangents);
        }
    }

    // The mean of the joints' matrices, for each vertex. Sections 3.7.3.1 and 3.7.3.3.
    void skin(std::span<const Matrix4> joints) {
        using Row = std::array<double, 4>;
        std::vector<std::array<Row, 3>> blended(mesh_.positions.size());
        std::vector<float> sums(mesh_.positions.size());
        bool found = false;
        for (int set = 0; set < 2; ++set) {
            const std::string number = std::to_string(set);
            const auto joint_set = attribute("JOINTS_" + number, {"VEC4"}),
                       weight_set = attribute("WEIGHTS_" + number, {"VEC4"});
            if (!joint_set || !weight_set) break;
            found = true;
            const auto four = [](const std::array<float, 4>& v) { return v; };
            const auto numbers = read_elements<4>(document_, *joint_set, four, chosen_),
                       weights = read_elements<4>(document_, *weight_set, four, chosen_);
            for (std::size_t i = 0; i < numbers.size(); ++i)
                for (std::size_t k = 0; k < 4; ++k) {
                    if (weights[i][k] == 0) continue;
                    if (!(numbers[i][k] >= 0 && numbers[i][k] < static_cast<float>(joints.size())))
                        joint_set->source.error("refers to joint " + shown_number(double(numbers[i][k])) +
                                                "; the skin has " + std::to_string(joints.size()));
                    const Matrix4& m = joints[static_cast<std::size_t>(numbers[i][k])];
                    sums[i] += weights[i][k];
                    for (std::size_t row = 0; row < 3; ++row)
                        for (std::size_t column = 0; column < 4; ++column)
                            blended[i][row][column] += double(weights[i][k]) * m.m[row][column];
                }
        }
        if (!found) primitive_.error("has no JOINTS_0 and WEIGHTS_0, which its skin needs");
        for (std::size_t i = 0; i < blended.size(); ++i) {
            Matrix4 m;
            if (sums[i] != 0)
                for (std::size_t row = 0; row < 3; ++row)
                    for (std::size_t column = 0; column < 4; ++column)
                        m.m[row][column] = blended[i][row][column] / double(sums[i]);
            const Transform to_world(m, m.inverse().value_or(Matrix4()));
            mesh_.positions[i] = to_world.point(mesh_.positions[i]);
            if (!mesh_.normals.empty()) mesh_.normals[i] = to_world.normal(mesh_.normals[i]);
            if (!mesh_.tangents.empty()) mesh_.tangents[i] = to_world.vector(mesh_.tangents[i]);
        }
    }

    Document& document_;
    const Value& primitive_;
    Value attributes_;
    std::optional<DracoMesh> draco_;
    std::optional<Value> draco_attributes_;
    std::list<std::vector<std::uint8_t>> unpacked_; // attributes, which accessors refer to
    std::size_t count_ = 0;
    std::vector<Index> chosen_; // in growing order; empty: all vertices
    TriangleMesh mesh_;
};

} // namespace

std::optional<TriangleMesh> read_primitive(Document& document, const Value& primitive, const UvSets& uv_sets,
                                           const Deformation& deformation) {
    return PrimitiveReader(document, primitive).read(uv_sets, deformation);
}

VertexColorKinds vertex_colors_of(Document& document, const Value& primitive) {
    const std::optional<Value> index = primitive.required("attributes").find("COLOR_0");
    if (!index) return {};
    return {true, open_accessor(document, *index, {"VEC3", "VEC4"}).type == "VEC4"};
}

} // namespace montelux::gltf
