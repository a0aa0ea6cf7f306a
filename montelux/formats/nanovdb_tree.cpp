#include "montelux/formats/nanovdb_tree.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <nanovdb/NanoVDB.h>
#include <string>
#include <unordered_map>
#include <zlib.h>

#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

using NanoLeaf = nanovdb::NanoLeaf<float>::DataType;
using NanoLower = nanovdb::NanoLower<float>::DataType;
using NanoUpper = nanovdb::NanoUpper<float>::DataType;
using NanoRoot = nanovdb::NanoRoot<float>::DataType;
using NodePlace = std::array<int, 3>; // of a node of 128^3 voxels, in units of its width

constexpr std::uint64_t nanovdb_newer_grid_magic = 0x314244566f6e614eu; // "NanoVDB1", from version 32.6 on
constexpr int upper_width = 32, root_tile_width = 32;                   // in nodes of 128^3 voxels
// Limits of a grid's extent: its tables stay small, and positions of voxels exact enough in single precision.
constexpr int most_nodes_along = 512, most_nodes = 1 << 22;

constexpr const char* damaged_tree = "the tree is damaged: a node lies outside its place";

class TreeCopy {
  public:
    explicit TreeCopy(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

    PlacedSparseGrid copy() {
        read_header();
        check_sum();
        grid_.constants = {finite(get<float>(root_at_ + offsetof(NanoRoot, mBackground)))};
        constant_of_[std::bit_cast<std::uint32_t>(grid_.background())] = 0;
        collect_nodes();
        const NodePlace origin = allocate_nodes();
        for (const Placed& p : placed_) copy_node(p, origin);
        for (const Level& level : levels_)
            if (std::find(level.visited.begin(), level.visited.end(), false) != level.visited.end())
                throw Error("the tree is damaged: a node has no parent");
        const Vec3d shift(128.0 * origin[0], 128.0 * origin[1], 128.0 * origin[2]);
        return {std::move(grid_), map() * Transform::translate(shift)};
    }

  private:
    // Nodes of 128^3 voxels from `first`, `width` along each axis: one lower node of the file, or a constant.
    struct Placed {
        NodePlace first{};
        int width = 1;
        bool is_constant = false;
        std::uint32_t constant = 0;
        std::size_t lower = 0; // its offset
    };
    // The nodes of a level, one after the other.
    struct Level {
        std::size_t first = 0, count = 0, size = 0;
        std::vector<bool> visited;
    };

    template <typename T>
    T get(std::size_t offset) const {
        T value;
        copy_bytes(offset, &value, sizeof value);
        return value;
    }
    void copy_bytes(std::size_t offset, void* to, std::size_t size) const {
        if (offset > bytes_.size() || size > bytes_.size() - offset) throw Error("the grid ends early");
        std::memcpy(to, bytes_.data() + offset, size);
    }
    static float finite(float value) {
        if (!std::isfinite(value)) throw Error("has a value that is not finite");
        return value;
    }

    void read_header() {
        header_ = get<nanovdb::GridData>(0);
        if (header_.mMagic != NANOVDB_MAGIC_NUMBER && header_.mMagic != nanovdb_newer_grid_magic)
            throw Error("is no NanoVDB grid");
        if (header_.mVersion.getMajor() != NANOVDB_MAJOR_VERSION_NUMBER)
            throw Error("has NanoVDB's version " + std::to_string(header_.mVersion.getMajor()) +
                        "; expected version " + std::to_string(NANOVDB_MAJOR_VERSION_NUMBER));
        // Values of an enumeration in a file may be none of it.
        const auto type = static_cast<std::uint32_t>(header_.mGridType);
        if (type != static_cast<std::uint32_t>(nanovdb::GridType::Float)) {
            const bool known = type < static_cast<std::uint32_t>(nanovdb::GridType::End);
            throw Error("has values of type " +
                        (known ? std::string(nanovdb::toStr(header_.mGridType)) : std::to_string(type)) +
                        "; expected float");
        }
        const auto grid_class = static_cast<std::uint32_t>(header_.mGridClass);
        if (grid_class != static_cast<std::uint32_t>(nanovdb::GridClass::FogVolume) &&
            grid_class != static_cast<std::uint32_t>(nanovdb::GridClass::Unknown)) {
            const bool known = grid_class < static_cast<std::uint32_t>(nanovdb::GridClass::End);
            throw Error(
                "has class " +
                (known ? std::string(nanovdb::toStr(header_.mGridClass)) : std::to_string(grid_class)) +
                "; expected a fog volume (FOG)");
        }
        constexpr std::size_t tree = sizeof(nanovdb::GridData);
        const auto tree_data = get<nanovdb::TreeData<3>>(tree);
        const std::array<std::size_t, 3> sizes = {sizeof(NanoLeaf), sizeof(NanoLower), sizeof(NanoUpper)};
        for (std::size_t i = 0; i < 3; ++i) {
            Level& level = levels_[i];
            level.count = tree_data.mNodeCount[i];
            level.size = sizes[i];
            if (level.count == 0) continue;
            const std::uint64_t from_tree = tree_data.mNodeOffset[i];
            if (from_tree > bytes_.size() - tree) throw Error(damaged_tree);
            level.first = tree + from_tree;
            if (level.count > (bytes_.size() - level.first) / level.size)
                throw Error("the tree is damaged: it has more nodes than the file holds");
            level.visited.resize(level.count);
        }
        if (tree_data.mNodeOffset[3] > bytes_.size() - tree) throw Error(damaged_tree);
        root_at_ = tree + tree_data.mNodeOffset[3];
        root_tiles_ = get<std::uint32_t>(root_at_ + offsetof(NanoRoot, mTableSize));
        if (sizeof(NanoRoot) > bytes_.size() - root_at_ ||
            root_tiles_ > (bytes_.size() - root_at_ - sizeof(NanoRoot)) / sizeof(NanoRoot::Tile))
            throw Error("the tree is damaged: it has more nodes than the file holds");
    }

    // Version 32.4 has CRC-32 of grid, tree and root, and one of those of all nodes. Others compute them otherwise.
    void check_sum() const {
        constexpr std::uint32_t none = ~std::uint32_t{0};
        const auto head = static_cast<std::uint32_t>(header_.mChecksum),
                   tail = static_cast<std::uint32_t>(header_.mChecksum >> 32);
        constexpr std::size_t begin = 16, root = sizeof(nanovdb::GridData) + sizeof(nanovdb::TreeData<3>);
        if (header_.mVersion.getMinor() != 4 || root_at_ != root || (head == none && tail == none)) return;
        const auto crc = [](std::span<const std::uint8_t> b) {
            return static_cast<std::uint32_t>(crc32_z(crc32_z(0, nullptr, 0), b.data(), b.size()));
        };
        const std::size_t end = root + sizeof(NanoRoot) + root_tiles_ * sizeof(NanoRoot::Tile);
        bool right = crc(bytes_.subspan(begin, end - begin)) == head;
        if (right && tail != none) {
            std::vector<std::uint64_t> sums;
            for (const std::size_t i : {2u, 1u, 0u})
                for (std::size_t n = 0; n < levels_[i].count; ++n)
                    sums.push_back(
                        crc(bytes_.subspan(levels_[i].first + n * levels_[i].size, levels_[i].size)));
            right = crc({reinterpret_cast<const std::uint8_t*>(sums.data()), sums.size() * 8}) == tail;
        }
        if (!right) throw Error("the checksum does not fit: the file is damaged");
    }

    // The offset of a child of the node at `parent`. Each node has one parent, so copies are not larger than files.
    std::size_t child_at(std::size_t level, std::size_t parent, std::int64_t difference) {
        Level& nodes = levels_[level];
        const std::uint64_t at = parent + static_cast<std::uint64_t>(difference) - nodes.first; // modulo 2^64
        if (at % nodes.size != 0 || at / nodes.size >= nodes.count) throw Error(damaged_tree);
        const std::size_t index = at / nodes.size;
        if (nodes.visited[index]) throw Error("the tree is damaged: two nodes share a child");
        nodes.visited[index] = true;
        return nodes.first + at;
    }

    // visit(n, is a child, offset of the entry) for each entry of the table of an internal node.
    template <typename Node, typename Visit>
    void for_each_entry(std::size_t node, const Visit& visit) const {
        constexpr std::size_t size = sizeof(Node::mTable) / 8;
        std::vector<std::uint64_t> mask(size / 64);
        copy_bytes(node + offsetof(Node, mChildMask), mask.data(), size / 8);
        for (std::size_t n = 0; n < size; ++n)
            visit(n, (mask[n / 64] >> (n % 64) & 1) != 0, node + offsetof(Node, mTable) + 8 * n);
    }

    std::uint32_t constant(float value) {
        const auto [place, is_new] = constant_of_.try_emplace(
            std::bit_cast<std::uint32_t>(finite(value)), static_cast<std::uint32_t>(grid_.constants.size()));
        if (is_new) grid_.constants.push_back(value);
        return SparseGrid::constant_entry | place->second;
    }

    void collect_nodes() {
        std::vector<std::uint64_t> keys;
        for (std::size_t i = 0; i < root_tiles_; ++i) {
            const auto tile = get<NanoRoot::Tile>(root_at_ + sizeof(NanoRoot) + i * sizeof(NanoRoot::Tile));
            keys.push_back(tile.key);
            const nanovdb::Coord origin = NanoRoot::KeyToCoord(tile.key);
            const NodePlace first{origin[0] >> 7, origin[1] >> 7, origin[2] >> 7};
            if (tile.child == 0) {
                if (const std::uint32_t c = constant(tile.value); c != SparseGrid::constant_entry)
                    placed_.push_back({first, root_tile_width, true, c, 0});
                continue;
            }
            const std::size_t upper = child_at(2, root_at_, tile.child);
            for_each_entry<NanoUpper>(upper, [&](std::size_t n, bool is_child, std::size_t entry) {
                const auto along = [&](int shift) {
                    return static_cast<int>(n >> shift & (upper_width - 1));
                };
                Placed p{{first[0] + along(10), first[1] + along(5), first[2] + along(0)}, 1, false, 0, 0};
                if (is_child) {
                    p.lower = child_at(1, upper, get<std::int64_t>(entry));
                } else {
                    p.is_constant = true;
                    p.constant = constant(get<float>(entry));
                    if (p.constant == SparseGrid::constant_entry) return;
                }
                placed_.push_back(p);
            });
        }
        std::sort(keys.begin(), keys.end());
        if (std::adjacent_find(keys.begin(), keys.end()) != keys.end())
            throw Error("the tree is damaged: two nodes at one place");
    }

    // Makes the table of nodes, all of them background. Its first node.
    NodePlace allocate_nodes() {
        if (placed_.empty()) return {};
        NodePlace lower = placed_[0].first, upper = lower;
        for (const Placed& p : placed_)
            for (std::size_t a = 0; a < 3; ++a) {
                lower[a] = std::min(lower[a], p.first[a]);
                upper[a] = std::max(upper[a], p.first[a] + p.width);
            }
        std::int64_t count = 1;
        for (std::size_t a = 0; a < 3; ++a) {
            const int along = upper[a] - lower[a];
            grid_.node_count[a] = along;
            count *= std::min(along, most_nodes_along + 1);
            if (along > most_nodes_along || count > most_nodes)
                throw Error("is too large: its voxels spread over " +
                            std::to_string(128 * std::int64_t{along}) + " along axis " + std::to_string(a) +
                            "; expected at most " + std::to_string(128 * most_nodes_along) +
                            " along each, and " + std::to_string(most_nodes) + " blocks of 128^3");
        }
        grid_.nodes.assign(static_cast<std::size_t>(count), SparseGrid::constant_entry);
        return lower;
    }

    void copy_node(const Placed& p, const NodePlace& origin) {
        std::uint32_t entry = p.constant;
        if (!p.is_constant) {
            entry = static_cast<std::uint32_t>(grid_.blocks.size() / SparseGrid::node_size);
            for_each_entry<NanoLower>(p.lower, [&](std::size_t, bool is_child, std::size_t at) {
                grid_.blocks.push_back(is_child ? copy_leaf(child_at(0, p.lower, get<std::int64_t>(at)))
                                                : constant(get<float>(at)));
            });
        }
        for (int x = 0; x < p.width; ++x)
            for (int y = 0; y < p.width; ++y)
                for (int z = 0; z < p.width; ++z) {
                    const auto along = [&](std::size_t a, int i) {
                        const int place = p.first[a] - origin[a] + i;
                        return static_cast<std::size_t>(place);
                    };
                    grid_.nodes[(along(0, x) * static_cast<std::size_t>(grid_.node_count[1]) + along(1, y)) *
                                    static_cast<std::size_t>(grid_.node_count[2]) +
                                along(2, z)] = entry;
                }
    }

    std::uint32_t copy_leaf(std::size_t leaf) {
        std::array<float, SparseGrid::block_size> values{};
        static_assert(sizeof values == sizeof(NanoLeaf::mValues));
        copy_bytes(leaf + offsetof(NanoLeaf, mValues), values.data(), sizeof values);
        for (const float v : values) finite(v);
        if (std::all_of(values.begin(), values.end(), [&](float v) { return v == values[0]; }))
            return constant(values[0]);
        grid_.values.insert(grid_.values.end(), values.begin(), values.end());
        return static_cast<std::uint32_t>(grid_.block_count() - 1);
    }

    Transform map() const {
        Matrix4 matrix;
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t k = 0; k < 3; ++k) matrix.m[i][k] = header_.mMap.mMatD[3 * i + k];
            matrix.m[i][3] = header_.mMap.mVecD[i];
        }
        for (const auto& row : matrix.m)
            for (const double x : row)
                if (!(std::abs(x) <= 1e30)) throw Error("has a transformation that is not finite");
        const std::optional<Transform> transform = Transform::from_matrix(matrix);
        if (!transform) throw Error("has a transformation that cannot be inverted");
        return *transform;
    }

    std::span<const std::uint8_t> bytes_;
    nanovdb::GridData header_{};
    std::size_t root_at_ = 0, root_tiles_ = 0;
    std::array<Level, 3> levels_; // leaf, lower, upper
    std::vector<Placed> placed_;
    SparseGrid grid_;
    std::unordered_map<std::uint32_t, std::uint32_t> constant_of_; // by the bits of the value
};

} // namespace

PlacedSparseGrid copy_nanovdb_grid(std::span<const std::uint8_t> bytes) { return TreeCopy(bytes).copy(); }

} // namespace montelux
