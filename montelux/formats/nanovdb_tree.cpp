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

using NodePlace = std::array<int, 3>; // of a node of 128^3 voxels, in units of its width

constexpr std::uint64_t nanovdb_newer_grid_magic = 0x314244566f6e614eu; // "NanoVDB1", from version 32.6 on
constexpr int upper_width = 32, root_tile_width = 32;                   // in nodes of 128^3 voxels
// Limits of a grid's extent: its tables stay small, and positions of voxels exact enough in single precision.
constexpr int most_nodes_along = 512, most_nodes = 1 << 22;

constexpr const char* damaged_tree = "the tree is damaged: a node lies outside its place";

// A leaf of quantised values begins with 80 bytes of place and mask, then minimum and step (float) and four numbers
// of 16 bits; the codes follow. Value = minimum + code * step.
constexpr std::size_t quantised_minimum_at = 80, quantised_header = 96, leaf_flags_at = 15;

// Bits of a code; 0: the values themselves. -1: as the leaf says.
template <typename Build>
constexpr int code_bits = 0;
template <>
constexpr int code_bits<nanovdb::Fp4> = 4;
template <>
constexpr int code_bits<nanovdb::Fp8> = 8;
template <>
constexpr int code_bits<nanovdb::Fp16> = 16;
template <>
constexpr int code_bits<nanovdb::FpN> = -1;

// Build: float, double, or one of NanoVDB's quantised floats.
template <typename Build>
class TreeCopy {
    using NanoLeaf = typename nanovdb::NanoLeaf<Build>::DataType;
    using NanoLower = typename nanovdb::NanoLower<Build>::DataType;
    using NanoUpper = typename nanovdb::NanoUpper<Build>::DataType;
    using NanoRoot = typename nanovdb::NanoRoot<Build>::DataType;
    using Tile = typename NanoRoot::Tile;
    using Value = typename NanoRoot::ValueT;
    static_assert(std::is_same_v<Value, float> || std::is_same_v<Value, double>);

  public:
    explicit TreeCopy(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

    PlacedSparseGrid copy() {
        read_header();
        check_sum();
        grid_.constants = {finite(get<Value>(root_at_ + offsetof(NanoRoot, mBackground)))};
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
        // Of nodes of different sizes: where each begins, and the end of the last one.
        std::vector<std::size_t> starts;
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
    static float finite(Value value) {
        const auto single = static_cast<float>(value);
        if (!std::isfinite(single)) throw Error("has a value that is not finite");
        return single;
    }

    void read_header() {
        header_ = get<nanovdb::GridData>(0);
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
            if (i == 0 && code_bits<Build> < 0) find_leaves(level);
            level.visited.resize(level.count);
        }
        if (tree_data.mNodeOffset[3] > bytes_.size() - tree) throw Error(damaged_tree);
        root_at_ = tree + tree_data.mNodeOffset[3];
        root_tiles_ = get<std::uint32_t>(root_at_ + offsetof(NanoRoot, mTableSize));
        if (sizeof(NanoRoot) > bytes_.size() - root_at_ ||
            root_tiles_ > (bytes_.size() - root_at_ - sizeof(NanoRoot)) / sizeof(Tile))
            throw Error("the tree is damaged: it has more nodes than the file holds");
    }

    // Leaves of their own number of bits.
    void find_leaves(Level& level) const {
        std::size_t at = level.first;
        for (std::size_t n = 0; n < level.count; ++n) {
            level.starts.push_back(at);
            at += quantised_header + 64 * static_cast<std::size_t>(bits_of_leaf(at));
        }
        level.starts.push_back(at);
        if (at > bytes_.size()) throw Error("the tree is damaged: it has more nodes than the file holds");
    }
    int bits_of_leaf(std::size_t leaf) const {
        const int log = get<std::uint8_t>(leaf + leaf_flags_at) >> 5;
        if (log > 4) throw Error("the tree is damaged: a leaf has codes of more than 16 bits");
        return 1 << log;
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
        const std::size_t end = root + sizeof(NanoRoot) + root_tiles_ * sizeof(Tile);
        bool right = crc(bytes_.subspan(begin, end - begin)) == head;
        if (right && tail != none) {
            std::vector<std::uint64_t> sums;
            for (const std::size_t i : {2u, 1u, 0u})
                for (std::size_t n = 0; n < levels_[i].count; ++n) {
                    // Of leaves with their own number of bits, NanoVDB counts what comes before the codes.
                    const Level& l = levels_[i];
                    const std::size_t at = l.starts.empty() ? l.first + n * l.size : l.starts[n];
                    sums.push_back(crc(bytes_.subspan(at, l.size)));
                }
            right = crc({reinterpret_cast<const std::uint8_t*>(sums.data()), sums.size() * 8}) == tail;
        }
        if (!right) throw Error("the checksum does not fit: the file is damaged");
    }

    // The offset of a child of the node at `parent`. Each node has one parent, so copies are not larger than files.
    std::size_t child_at(std::size_t level, std::size_t parent, std::int64_t difference) {
        Level& nodes = levels_[level];
        const std::uint64_t at = parent + static_cast<std::uint64_t>(difference) - nodes.first; // modulo 2^64
        std::size_t index = at / nodes.size;
        if (nodes.starts.empty()) {
            if (at % nodes.size != 0 || index >= nodes.count) throw Error(damaged_tree);
        } else {
            const auto found =
                std::lower_bound(nodes.starts.begin(), nodes.starts.end() - 1, nodes.first + at);
            if (found == nodes.starts.end() - 1 || *found != nodes.first + at) throw Error(damaged_tree);
            index = static_cast<std::size_t>(found - nodes.starts.begin());
        }
        if (nodes.visited[index]) throw Error("the tree is damaged: two nodes share a child");
        nodes.visited[index] = true;
        return nodes.first + at;
    }

    // visit(n, is a child, offset of the entry) for each entry of the table of an internal node.
    template <typename Node, typename Visit>
    void for_each_entry(std::size_t node, const Visit& visit) const {
        constexpr std::size_t entry = sizeof(typename Node::Tile), size = sizeof(Node::mTable) / entry;
        static_assert(entry == 8);
        std::vector<std::uint64_t> mask(size / 64);
        copy_bytes(node + offsetof(Node, mChildMask), mask.data(), size / 8);
        for (std::size_t n = 0; n < size; ++n)
            visit(n, (mask[n / 64] >> (n % 64) & 1) != 0, node + offsetof(Node, mTable) + entry * n);
    }

    std::uint32_t constant(Value given) {
        const float value = finite(given);
        const auto [place, is_new] = constant_of_.try_emplace(
            std::bit_cast<std::uint32_t>(value), static_cast<std::uint32_t>(grid_.constants.size()));
        if (is_new) grid_.constants.push_back(value);
        return SparseGrid::constant_entry | place->second;
    }

    void collect_nodes() {
        std::vector<std::uint64_t> keys;
        for (std::size_t i = 0; i < root_tiles_; ++i) {
            const auto tile = get<Tile>(root_at_ + sizeof(NanoRoot) + i * sizeof(Tile));
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
                    p.constant = constant(get<Value>(entry));
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
                                                : constant(get<Value>(at)));
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
        if constexpr (code_bits<Build> == 0) {
            std::array<Value, SparseGrid::block_size> given{};
            static_assert(sizeof given == sizeof(NanoLeaf::mValues));
            copy_bytes(leaf + offsetof(NanoLeaf, mValues), given.data(), sizeof given);
            std::transform(given.begin(), given.end(), values.begin(), finite);
        } else {
            static_assert(sizeof(NanoLeaf) ==
                          quantised_header + (code_bits<Build> > 0 ? 64 * code_bits<Build> : 0));
            const int bits = code_bits<Build> > 0 ? code_bits<Build> : bits_of_leaf(leaf);
            const auto minimum = get<float>(leaf + quantised_minimum_at),
                       step = get<float>(leaf + quantised_minimum_at + sizeof(float));
            std::array<std::uint8_t, 2 * SparseGrid::block_size> codes{};
            copy_bytes(leaf + quantised_header, codes.data(), 64 * static_cast<std::size_t>(bits));
            for (std::size_t i = 0; i < values.size(); ++i)
                values[i] = finite(static_cast<float>(code_of(codes, i, bits)) * step + minimum);
        }
        if (std::all_of(values.begin(), values.end(), [&](float v) { return v == values[0]; }))
            return constant(values[0]);
        grid_.values.insert(grid_.values.end(), values.begin(), values.end());
        return static_cast<std::uint32_t>(grid_.block_count() - 1);
    }

    // Codes lie one after the other, from the lowest bit of each byte on.
    static unsigned code_of(std::span<const std::uint8_t> codes, std::size_t i, int bits) {
        if (bits == 16) return codes[2 * i] | static_cast<unsigned>(codes[2 * i + 1]) << 8;
        const std::size_t bit = i * static_cast<std::size_t>(bits);
        return static_cast<unsigned>(codes[bit / 8]) >> (bit % 8) & ((1u << bits) - 1);
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

PlacedSparseGrid copy_nanovdb_grid(std::span<const std::uint8_t> bytes) {
    nanovdb::GridData header{};
    if (bytes.size() < sizeof header) throw Error("the grid ends early");
    std::memcpy(&header, bytes.data(), sizeof header);
    if (header.mMagic != NANOVDB_MAGIC_NUMBER && header.mMagic != nanovdb_newer_grid_magic)
        throw Error("is no NanoVDB grid");
    if (header.mVersion.getMajor() != NANOVDB_MAJOR_VERSION_NUMBER)
        throw Error("has NanoVDB's version " + std::to_string(header.mVersion.getMajor()) +
                    "; expected version " + std::to_string(NANOVDB_MAJOR_VERSION_NUMBER));
    using nanovdb::GridType;
    switch (header.mGridType) {
    case GridType::Float:
        return TreeCopy<float>(bytes).copy();
    case GridType::Double:
        return TreeCopy<double>(bytes).copy();
    case GridType::Fp4:
        return TreeCopy<nanovdb::Fp4>(bytes).copy();
    case GridType::Fp8:
        return TreeCopy<nanovdb::Fp8>(bytes).copy();
    case GridType::Fp16:
        return TreeCopy<nanovdb::Fp16>(bytes).copy();
    case GridType::FpN:
        return TreeCopy<nanovdb::FpN>(bytes).copy();
    default:
        break;
    }
    // Values of an enumeration in a file may be none of it.
    const auto type = static_cast<std::uint32_t>(header.mGridType);
    const bool known = type < static_cast<std::uint32_t>(GridType::End);
    throw Error("has values of type " +
                (known ? std::string(nanovdb::toStr(header.mGridType)) : std::to_string(type)) +
                "; expected float, double, or a quantised float (Fp4, Fp8, Fp16, FpN)");
}

} // namespace montelux
