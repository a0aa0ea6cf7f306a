#include "montelux/formats/nanovdb_file.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <nanovdb/NanoVDB.h>
#include <zlib.h>
#ifdef MONTELUX_BLOSC
#include <blosc.h>
#endif

#include "montelux/formats/nanovdb_tree.h"
#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

// "NanoVDB0", and "NanoVDB2" of files from version 32.6 on.
constexpr std::array<std::uint64_t, 2> nanovdb_file_magic = {NANOVDB_MAGIC_NUMBER, 0x324244566f6e614eu};

// As the file begins, and as each of its further segments does.
struct SegmentHeader {
    std::uint64_t magic;
    std::uint32_t version;
    std::uint16_t grid_count, codec;
};
static_assert(sizeof(SegmentHeader) == 16);

// Before the name of a grid.
struct GridRecord {
    std::uint64_t unpacked_size, stored_size, name_key, voxel_count;
    std::uint32_t type, grid_class;
    std::array<double, 6> world_bounds;
    std::array<std::int32_t, 6> index_bounds;
    std::array<double, 3> voxel_size;
    std::uint32_t name_size;
    std::array<std::uint32_t, 7> node_and_tile_counts;
    std::uint16_t codec, padding;
    std::uint32_t version;
};
static_assert(sizeof(GridRecord) == 176);

template <typename T>
T from_bytes(std::span<const std::uint8_t> bytes) {
    T value;
    std::memcpy(&value, bytes.data(), sizeof value);
    return value;
}

enum : std::uint16_t { codec_none = 0, codec_zip = 1, codec_blosc = 2 };

// Bytes that follow their number.
std::span<const std::uint8_t> take_chunk(std::span<const std::uint8_t>& stored) {
    if (stored.size() < sizeof(std::uint64_t)) throw Error("the compressed data ends early");
    const auto count = from_bytes<std::uint64_t>(stored);
    stored = stored.subspan(sizeof count);
    if (count > stored.size()) throw Error("the compressed data ends early");
    const std::span<const std::uint8_t> chunk = stored.first(count);
    stored = stored.subspan(count);
    return chunk;
}

void check_proportion(std::uint64_t size, std::uint64_t count) {
    constexpr std::uint64_t unsuspicious_bytes = std::uint64_t{16} << 20, largest_ratio = 128;
    if (size > std::max(unsuspicious_bytes, largest_ratio * count))
        throw Error("unpacks to " + std::to_string(size >> 20) + " MiB, which is out of proportion to its " +
                    std::to_string(count) + " bytes; save it without compression");
}

#ifdef MONTELUX_BLOSC
// Chunks of at most 1 GiB of the grid.
std::vector<std::uint8_t> unpack_blosc(std::span<const std::uint8_t> stored, std::uint64_t size) {
    check_proportion(size, stored.size());
    std::vector<std::uint8_t> result(size);
    for (std::size_t done = 0; done < result.size();) {
        const std::span<const std::uint8_t> chunk = take_chunk(stored);
        std::size_t unpacked = 0;
        if (blosc_cbuffer_validate(chunk.data(), chunk.size(), &unpacked) != 0 || unpacked == 0 ||
            unpacked > result.size() - done ||
            blosc_decompress_ctx(chunk.data(), result.data() + done, unpacked, 1) !=
                static_cast<int>(unpacked))
            throw Error("the compressed data is damaged");
        done += unpacked;
    }
    return result;
}
#else
std::vector<std::uint8_t> unpack_blosc(std::span<const std::uint8_t>, std::uint64_t) { return {}; }
#endif

std::vector<std::uint8_t> unzip(std::span<const std::uint8_t> stored, std::uint64_t size) {
    stored = take_chunk(stored);
    const std::size_t count = stored.size();
    check_proportion(size, count);
    std::vector<std::uint8_t> result(size);
    uLongf written = size;
    if (uncompress(result.data(), &written, stored.data(), count) != Z_OK || written != size)
        throw Error("the compressed data is damaged");
    return result;
}

} // namespace

#ifdef MONTELUX_BLOSC
const bool NanovdbFile::reads_blosc = true;
#else
const bool NanovdbFile::reads_blosc = false;
#endif

NanovdbFile::NanovdbFile(std::span<const std::uint8_t> bytes, std::string name) : name_(std::move(name)) {
    const auto take = [&](std::uint64_t count, const std::string& what) {
        if (count > bytes.size()) throw Error(name_, what);
        const std::span<const std::uint8_t> taken = bytes.first(count);
        bytes = bytes.subspan(count);
        return taken;
    };
    while (entries_.empty() || !bytes.empty()) {
        const auto header = from_bytes<SegmentHeader>(
            take(sizeof(SegmentHeader), entries_.empty() ? "is no NanoVDB file (.nvdb)" : "ends early"));
        if (std::find(nanovdb_file_magic.begin(), nanovdb_file_magic.end(), header.magic) ==
            nanovdb_file_magic.end())
            throw Error(name_, entries_.empty() ? "is no NanoVDB file (.nvdb)"
                                                : "has something that is no NanoVDB grid after its grids");
        const std::uint32_t major = header.version >> 21;
        if (major != NANOVDB_MAJOR_VERSION_NUMBER)
            throw Error(name_, "has NanoVDB's version " + std::to_string(major) + "; expected version " +
                                   std::to_string(NANOVDB_MAJOR_VERSION_NUMBER));
        if (header.codec == codec_blosc && !reads_blosc)
            throw Error(name_,
                        "is compressed by Blosc, without which this program was built; convert it with "
                        "nanovdb_convert to zip or to no compression");
        if (header.codec > codec_blosc)
            throw Error(name_, "has an unknown compression, " + std::to_string(header.codec));
        if (header.grid_count == 0) throw Error(name_, "has no grid");
        const std::size_t first = entries_.size();
        std::vector<std::uint64_t> stored_sizes;
        for (int i = 0; i < header.grid_count; ++i) {
            const auto record = from_bytes<GridRecord>(take(sizeof(GridRecord), "ends early"));
            const std::span<const std::uint8_t> text = take(record.name_size, "ends early");
            Entry entry;
            entry.name.assign(text.begin(), std::find(text.begin(), text.end(), std::uint8_t{0}));
            entry.unpacked_size = record.unpacked_size;
            entry.codec = header.codec;
            entries_.push_back(std::move(entry));
            stored_sizes.push_back(record.stored_size);
        }
        for (std::size_t i = 0; i < stored_sizes.size(); ++i) {
            Entry& entry = entries_[first + i];
            const std::string early = "grid '" + entry.name + "' ends early";
            entry.stored = take(stored_sizes[i], early);
            if (entry.codec == codec_none && entry.unpacked_size > stored_sizes[i]) throw Error(name_, early);
        }
    }
}

const NanovdbFile::Entry* NanovdbFile::find(std::string_view grid) const {
    const auto found =
        std::find_if(entries_.begin(), entries_.end(), [&](const Entry& e) { return e.name == grid; });
    return found == entries_.end() ? nullptr : &*found;
}

std::string NanovdbFile::grid_names() const {
    std::string names;
    for (const Entry& entry : entries_) names += (names.empty() ? "'" : ", '") + entry.name + '\'';
    return names;
}

PlacedSparseGrid NanovdbFile::read(std::string_view grid) const {
    const Entry* entry = find(grid);
    if (entry == nullptr)
        throw Error(name_, "has no grid '" + std::string(grid) + "'; it has " + grid_names());
    try {
        if (entry->codec == codec_none) return copy_nanovdb_grid(entry->stored.first(entry->unpacked_size));
        if (entry->codec == codec_blosc)
            return copy_nanovdb_grid(unpack_blosc(entry->stored, entry->unpacked_size));
        return copy_nanovdb_grid(unzip(entry->stored, entry->unpacked_size));
    } catch (const Error& e) {
        throw Error(name_ + ", grid '" + entry->name + "'", e.what());
    }
}

} // namespace montelux
