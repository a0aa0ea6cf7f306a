#include "montelux/formats/mitsuba/serialized.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>
#include <zlib.h>

#include "montelux/mc/math/error.h"

namespace montelux::mitsuba {
namespace {

static_assert(std::endian::native == std::endian::little, "the file's numbers are little-endian");

constexpr std::uint16_t magic = 0x041c;
constexpr std::size_t header_bytes = 4; // magic and version, before each stream

// Bits of the first number of a stream.
constexpr std::uint32_t has_normals = 0x1, has_uvs = 0x2, has_colors = 0x8, has_face_normals = 0x10,
                        is_single = 0x1000, is_double = 0x2000;                     // versions 3 and 4
constexpr std::uint32_t packs_normals = 0x1, packs_tangents = 0x2, packs_uvs = 0x4; // version 5

template <typename T>
T number_at(std::span<const std::uint8_t> bytes, std::size_t offset, std::string_view name) {
    if (offset > bytes.size() || bytes.size() - offset < sizeof(T)) throw Error(name, "the file ends early");
    T value;
    std::memcpy(&value, bytes.data() + offset, sizeof(T));
    return value;
}

// The numbers in a zlib stream, one after the other.
class InflatedNumbers {
  public:
    InflatedNumbers(std::span<const std::uint8_t> bytes, std::string_view name)
        : input_(bytes), name_(name), left_(std::max(unsuspicious_bytes, largest_ratio * bytes.size())) {
        if (inflateInit(&stream_) != Z_OK) throw Error(name, "zlib cannot be started");
    }
    ~InflatedNumbers() { inflateEnd(&stream_); }
    InflatedNumbers(const InflatedNumbers&) = delete;
    InflatedNumbers& operator=(const InflatedNumbers&) = delete;

    template <typename T>
    T number() {
        T value;
        read({reinterpret_cast<std::uint8_t*>(&value), sizeof(T)});
        return value;
    }
    // In pieces: the count, which is the file's, is no reason to allocate before the data is there.
    template <typename T>
    std::vector<T> numbers(std::uint64_t count) {
        constexpr std::uint64_t piece = (std::size_t{1} << 20) / sizeof(T);
        std::vector<T> all;
        while (all.size() < count) {
            const std::size_t more = static_cast<std::size_t>(std::min(piece, count - all.size()));
            const std::size_t before = all.size();
            all.resize(before + more);
            read({reinterpret_cast<std::uint8_t*>(all.data() + before), more * sizeof(T)});
        }
        return all;
    }
    // Floats, from floats or doubles.
    std::vector<float> floats(std::uint64_t count, bool from_doubles) {
        if (!from_doubles) return numbers<float>(count);
        const std::vector<double> wide = numbers<double>(count);
        std::vector<float> all(wide.size());
        std::ranges::transform(wide, all.begin(), [](double v) { return static_cast<float>(v); });
        return all;
    }

  private:
    // As in gunzip.h.
    static constexpr std::size_t unsuspicious_bytes = std::size_t{16} << 20, largest_ratio = 128;

    void read(std::span<std::uint8_t> to) {
        if (to.size() > left_) throw Error(name_, "unpacks to data that is out of proportion to its size");
        left_ -= to.size();
        stream_.next_out = to.data();
        stream_.avail_out = static_cast<uInt>(to.size());
        while (stream_.avail_out > 0) {
            const std::size_t room = std::min<std::size_t>(input_.size(), std::numeric_limits<uInt>::max());
            stream_.next_in = const_cast<Bytef*>(input_.data()); // zlib does not write through it
            stream_.avail_in = static_cast<uInt>(room);
            const int status = inflate(&stream_, Z_NO_FLUSH);
            input_ = input_.subspan(room - stream_.avail_in);
            if (stream_.avail_out == 0) return;
            if (status == Z_STREAM_END || status == Z_BUF_ERROR || (status == Z_OK && input_.empty()))
                throw Error(name_, "the mesh ends early");
            if (status != Z_OK)
                throw Error(name_, std::string("the compressed data is damaged (") +
                                       (stream_.msg != nullptr ? stream_.msg : "zlib error") + ")");
        }
    }

    z_stream stream_{};
    std::span<const std::uint8_t> input_;
    std::string_view name_;
    std::size_t left_; // bytes that may still be unpacked
};

// Where the stream of a mesh begins. The last bytes of the file are the offsets of all meshes and their number.
std::size_t offset_of(std::span<const std::uint8_t> bytes, std::string_view name, std::uint16_t version,
                      std::uint32_t number) {
    if (number == 0) return 0;
    if (bytes.size() < header_bytes + sizeof(std::uint32_t)) throw Error(name, "the file ends early");
    const std::size_t end = bytes.size() - sizeof(std::uint32_t);
    const auto count = number_at<std::uint32_t>(bytes, end, name);
    if (number >= count)
        throw Error(name,
                    "there is no mesh " + std::to_string(number) + "; the file has " + std::to_string(count));
    const std::size_t entry = version == 3 ? sizeof(std::uint32_t) : sizeof(std::uint64_t);
    const std::uint64_t from_end = std::uint64_t{entry} * (count - number);
    if (from_end > end) throw Error(name, "the file ends early");
    const std::size_t at = end - static_cast<std::size_t>(from_end);
    const std::uint64_t offset =
        version == 3 ? number_at<std::uint32_t>(bytes, at, name) : number_at<std::uint64_t>(bytes, at, name);
    if (offset >= end)
        throw Error(name, "mesh " + std::to_string(number) + " begins beyond the end of the file");
    return static_cast<std::size_t>(offset);
}

void check_counts(std::uint64_t vertices, std::uint64_t triangles, std::string_view name) {
    if (vertices == 0 || triangles == 0) throw Error(name, "the mesh is empty");
    if (vertices >= no_index || triangles >= no_index)
        throw Error(name, "the mesh has more than 2^32 vertices or triangles");
}

// One array after the other.
SerializedMesh read_arrays(InflatedNumbers& data, std::uint16_t version, std::string_view name) {
    const auto flags = data.number<std::uint32_t>();
    if (version == 4)
        while (data.number<char>() != 0) // the mesh's name
            ;
    const auto vertices = data.number<std::uint64_t>(), triangles = data.number<std::uint64_t>();
    check_counts(vertices, triangles, name);
    const bool doubles = (flags & is_double) != 0;
    if (doubles == ((flags & is_single) != 0))
        throw Error(name, "the mesh has either single or double precision, not none or both");
    SerializedMesh result;
    result.face_normals = (flags & has_face_normals) != 0;
    TriangleMesh& mesh = result.mesh;
    const auto triples = [](const std::vector<float>& from) {
        std::vector<Vec3f> to(from.size() / 3);
        for (std::size_t i = 0; i < to.size(); ++i) to[i] = {from[3 * i], from[3 * i + 1], from[3 * i + 2]};
        return to;
    };
    mesh.positions = triples(data.floats(3 * vertices, doubles));
    if ((flags & has_normals) != 0) mesh.normals = triples(data.floats(3 * vertices, doubles));
    if ((flags & has_uvs) != 0) {
        const std::vector<float> uvs = data.floats(2 * vertices, doubles);
        for (std::size_t i = 0; i < uvs.size(); i += 2) mesh.uvs.emplace_back(uvs[i], uvs[i + 1]);
    }
    if ((flags & has_colors) != 0) static_cast<void>(data.floats(3 * vertices, doubles));
    mesh.indices = data.numbers<Index>(3 * triangles);
    return result;
}

// Rows of eight numbers for vertices and of four for triangles.
SerializedMesh read_rows(InflatedNumbers& data, std::string_view name) {
    const auto flags = data.number<std::uint32_t>();
    if ((flags & is_single) == 0) throw Error(name, "a mesh of version 5 has single precision");
    static_cast<void>(data.numbers<char>(data.number<std::uint32_t>())); // the mesh's name
    const auto vertices = data.number<std::uint64_t>(), triangles = data.number<std::uint64_t>();
    check_counts(vertices, triangles, name);
    static_cast<void>(data.numbers<std::uint64_t>(2)); // of points and normals that vertices share
    // With tangents, the lanes of the normals hold turns of a frame.
    if ((flags & packs_tangents) != 0) throw Error(name, "meshes with stored tangents are not supported");
    SerializedMesh result;
    result.face_normals = (flags & has_face_normals) != 0;
    TriangleMesh& mesh = result.mesh;
    const std::vector<float> rows = data.numbers<float>(8 * vertices);
    for (const float* v = rows.data(); v != rows.data() + rows.size(); v += 8) {
        mesh.positions.emplace_back(v[0], v[1], v[2]);
        if ((flags & packs_normals) != 0) mesh.normals.emplace_back(v[3], v[4], v[5]);
        if ((flags & packs_uvs) != 0) mesh.uvs.emplace_back(v[6], v[7]);
    }
    const std::vector<Index> faces = data.numbers<Index>(4 * triangles);
    for (std::size_t i = 0; i < faces.size(); i += 4)
        mesh.indices.insert(mesh.indices.end(), {faces[i], faces[i + 1], faces[i + 2]});
    return result;
}

void check_mesh(const TriangleMesh& mesh, std::string_view name) {
    const auto finite = [&](const auto& values, const char* what) {
        for (std::size_t i = 0; i < values.size(); ++i)
            if (!is_finite(values[i]))
                throw Error(name, std::string(what) + " of vertex " + std::to_string(i) + " is not finite");
    };
    finite(mesh.positions, "the position");
    finite(mesh.normals, "the normal");
    for (const Index i : mesh.indices)
        if (i >= mesh.positions.size())
            throw Error(name, "a triangle refers to vertex " + std::to_string(i) + "; there are " +
                                  std::to_string(mesh.positions.size()));
}

} // namespace

SerializedMesh parse_serialized(std::span<const std::uint8_t> bytes, std::string_view name,
                                std::uint32_t number) {
    const auto version_at = [&](std::size_t offset) {
        if (number_at<std::uint16_t>(bytes, offset, name) != magic)
            throw Error(name, offset == 0 ? "this is no serialized mesh of Mitsuba"
                                          : "no mesh begins where the file says so");
        const auto version = number_at<std::uint16_t>(bytes, offset + 2, name);
        if (version < 3 || version > 5)
            throw Error(name, "version " + std::to_string(version) +
                                  " of serialized meshes; versions 3 to 5 are read");
        return version;
    };
    const std::size_t offset = offset_of(bytes, name, version_at(0), number);
    const std::uint16_t version = version_at(offset);
    InflatedNumbers data(bytes.subspan(offset + header_bytes), name);
    SerializedMesh result = version == 5 ? read_rows(data, name) : read_arrays(data, version, name);
    check_mesh(result.mesh, name);
    return result;
}

} // namespace montelux::mitsuba
