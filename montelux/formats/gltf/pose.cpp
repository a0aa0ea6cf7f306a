#include "montelux/formats/gltf/pose.h"

#include <cmath>
#include <optional>
#include <string>

#include "montelux/mc/math/error.h"
#include "montelux/scene/shape/motion.h"

namespace montelux::gltf {
namespace {

// What the file or an animation says of a node.
struct LocalPlace {
    std::array<double, 3> translation{0, 0, 0};
    std::array<double, 4> rotation{0, 0, 0, 1};
    std::array<double, 3> scale{1, 1, 1};
    std::optional<Matrix4> matrix{};
};

template <std::size_t N>
void read_numbers(const Value& node, std::string_view key, std::array<double, N>& to) {
    if (const std::optional<Value> found = node.find(key)) {
        const std::vector<double> numbers = found->numbers(N);
        std::copy(numbers.begin(), numbers.end(), to.begin());
    }
}

LocalPlace local_place(const Value& node) {
    LocalPlace place;
    read_numbers(node, "translation", place.translation);
    read_numbers(node, "rotation", place.rotation);
    read_numbers(node, "scale", place.scale);
    if (const std::optional<Value> matrix = node.find("matrix")) {
        place.matrix = matrix_of_columns(matrix->numbers(16));
        if (place.matrix->m[3] != std::array<double, 4>{0, 0, 0, 1})
            matrix->error("a projective matrix; expected 0 0 0 1 in its last row");
    }
    if (place.rotation == std::array<double, 4>{0, 0, 0, 0})
        node.required("rotation").error("a quaternion of length 0");
    return place;
}

std::size_t target_count(const Document& document, const Value& node) {
    const std::optional<Value> mesh = node.find("mesh");
    if (!mesh) return 0;
    const std::optional<Value> primitives = document.refer(*mesh, "meshes", "mesh").find("primitives");
    if (!primitives || primitives->size() == 0) return 0;
    const std::optional<Value> targets = (*primitives)[0].find("targets");
    return targets ? targets->size() : 0;
}

// Of the node, or else of its mesh, or else all 0.
std::vector<double> weights_at_rest(const Document& document, const Value& node) {
    const std::size_t count = target_count(document, node);
    std::optional<Value> weights = node.find("weights");
    if (!weights && count > 0) weights = document.refer(*node.find("mesh"), "meshes", "mesh").find("weights");
    if (!weights || count == 0) return std::vector<double>(count, 0.0);
    return weights->numbers(count);
}

template <std::size_t N>
void assign(const std::vector<double>& from, std::array<double, N>& to) {
    std::copy(from.begin(), from.end(), to.begin());
}

} // namespace

Matrix4 matrix_of(const std::array<double, 3>& t, const std::array<double, 4>& q,
                  const std::array<double, 3>& s) {
    const double norm = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3], k = norm > 0 ? 2 / norm : 0;
    const double x = q[0], y = q[1], z = q[2], w = q[3];
    Matrix4 m;
    m.m = {{{(1 - k * (y * y + z * z)) * s[0], k * (x * y - z * w) * s[1], k * (x * z + y * w) * s[2], t[0]},
            {k * (x * y + z * w) * s[0], (1 - k * (x * x + z * z)) * s[1], k * (y * z - x * w) * s[2], t[1]},
            {k * (x * z - y * w) * s[0], k * (y * z + x * w) * s[1], (1 - k * (x * x + y * y)) * s[2], t[2]},
            {0, 0, 0, 1}}};
    return m;
}

Matrix4 matrix_of_columns(const std::vector<double>& columns) {
    Matrix4 m;
    for (std::size_t i = 0; i < 16; ++i) m.m[i % 4][i / 4] = columns[i];
    return m;
}

bool can_move(const Transform& start, const Transform& end, const Value& node) {
    try {
        Motion(start, end);
        return true;
    } catch (const Error&) {
        node.warn("is flat at a moment while the shutter is open, or mirrored: it stands still meanwhile");
        return false;
    }
}

Pose::Pose(Document& document, const std::vector<Channel>& channels, double time) {
    const std::vector<Value>& nodes = document.all("nodes");
    std::vector<LocalPlace> places;
    places.reserve(nodes.size());
    std::vector<std::size_t> parent(nodes.size(), nodes.size());
    children_.resize(nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        places.push_back(local_place(nodes[i]));
        weights_.push_back(weights_at_rest(document, nodes[i]));
        for (const Value& child : nodes[i].elements("children")) {
            document.refer(child, "nodes", "node");
            const std::size_t c = child.whole();
            if (parent[c] != nodes.size())
                child.error("node " + std::to_string(c) + " is a child of node " + std::to_string(parent[c]) +
                            " already; nodes form trees");
            parent[c] = i;
            children_[i].push_back(c);
        }
    }
    for (const Channel& channel : channels) {
        const std::vector<double> value = value_at(document, channel, time, weights_[channel.node].size());
        LocalPlace& place = places[channel.node];
        if (channel.path == "translation")
            assign(value, place.translation);
        else if (channel.path == "rotation")
            assign(value, place.rotation);
        else if (channel.path == "scale")
            assign(value, place.scale);
        else
            weights_[channel.node] = value;
        if (channel.path != "weights" && place.matrix)
            nodes[channel.node].error(
                "is animated, and has a matrix; expected translation, rotation and scale");
    }
    // Parents before children.
    world_.resize(nodes.size());
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < nodes.size(); ++i)
        if (parent[i] == nodes.size()) roots_.push_back(i);
    order = roots_;
    for (std::size_t k = 0; k < order.size(); ++k) {
        const std::size_t i = order[k];
        const LocalPlace& place = places[i];
        world_[i] = place.matrix ? *place.matrix : matrix_of(place.translation, place.rotation, place.scale);
        if (parent[i] != nodes.size()) world_[i] = world_[parent[i]] * world_[i];
        order.insert(order.end(), children_[i].begin(), children_[i].end());
    }
    if (order.size() == nodes.size()) return;
    std::vector<char> reached(nodes.size(), 0);
    for (const std::size_t i : order) reached[i] = 1;
    for (std::size_t i = 0; i < nodes.size(); ++i)
        if (reached[i] == 0) nodes[i].error("the node is its own ancestor");
}

} // namespace montelux::gltf
