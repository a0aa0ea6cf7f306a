#include "montelux/formats/ply.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>

#include "montelux/formats/gunzip.h"
#include "montelux/formats/number.h"
#include "montelux/formats/ply_header.h"
#include "montelux/image/color_encoding.h"
#include "montelux/mc/io/file.h"
#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

using ply::Element;
using ply::Format;
using ply::Header;
using ply::Property;
using ply::Type;

template <typename T>
T byte_swapped(T value) {
    std::array<std::uint8_t, sizeof(T)> bytes;
    std::memcpy(bytes.data(), &value, sizeof(T));
    for (std::size_t i = 0; i < sizeof(T) / 2; ++i) std::swap(bytes[i], bytes[sizeof(T) - 1 - i]);
    std::memcpy(&value, bytes.data(), sizeof(T));
    return value;
}

// Both cursors read numbers in sequence and know their position for messages.
class BinaryCursor {
  public:
    BinaryCursor(std::span<const std::uint8_t> bytes, const Header& header, std::string_view name)
        : begin_(bytes.data()), p_(begin_ + header.size), end_(begin_ + bytes.size()),
          swap_((header.format == Format::big_endian) == (std::endian::native == std::endian::little)),
          name_(name) {}

    double number(Type type) {
        switch (type) {
        case Type::int8:
            return read<std::int8_t>();
        case Type::uint8:
            return read<std::uint8_t>();
        case Type::int16:
            return read<std::int16_t>();
        case Type::uint16:
            return read<std::uint16_t>();
        case Type::int32:
            return read<std::int32_t>();
        case Type::uint32:
            return read<std::uint32_t>();
        case Type::float32:
            return static_cast<double>(read<float>());
        case Type::float64:
            break;
        }
        return read<double>();
    }
    // Lower bound of a row's size.
    static std::size_t smallest_row(const Element& e) {
        std::size_t size = 0;
        for (const Property& p : e.properties) size += ply::size_of(p.is_list ? p.count_type : p.type);
        return size;
    }
    void skip(std::uint64_t count, Type type) {
        if (count > remaining() / ply::size_of(type)) fail_short();
        p_ += count * ply::size_of(type);
    }
    std::size_t remaining() const { return static_cast<std::size_t>(end_ - p_); }
    std::string where() const {
        return std::string(name_) + ": byte " + std::to_string(static_cast<std::size_t>(p_ - begin_));
    }
    [[noreturn]] void fail_short() const { throw Error(where(), "the data end early"); }

  private:
    template <typename T>
    T read() {
        if (remaining() < sizeof(T)) fail_short();
        T value;
        std::memcpy(&value, p_, sizeof(T));
        p_ += sizeof(T);
        return swap_ ? byte_swapped(value) : value;
    }
    const std::uint8_t *begin_, *p_, *end_;
    bool swap_;
    std::string_view name_;
};

class AsciiCursor {
  public:
    AsciiCursor(std::span<const std::uint8_t> bytes, const Header& header, std::string_view name)
        : p_(reinterpret_cast<const char*>(bytes.data()) + header.size),
          end_(reinterpret_cast<const char*>(bytes.data()) + bytes.size()), line_(header.lines + 1),
          name_(name) {}

    double number(Type type) {
        while (p_ != end_ && (*p_ == ' ' || *p_ == '\n' || *p_ == '\t' || *p_ == '\r'))
            if (*p_++ == '\n') ++line_;
        if (p_ == end_) fail_short();
        double value;
        NumberResult result = parse_number(p_, end_, value);
        bool whole = result.end == end_ || static_cast<unsigned char>(*result.end) <= ' ';
        if (result.status != NumberStatus::ok || !whole) throw Error(where(), "expected a number");
        if (ply::is_integer(type) && value != std::floor(value))
            throw Error(where(), "expected an integer, read a number with a fraction");
        p_ = result.end;
        return value;
    }
    // At least one digit for each number or list.
    static std::size_t smallest_row(const Element& e) { return e.properties.size(); }
    void skip(std::uint64_t count, Type type) {
        if (count > remaining()) fail_short();
        for (std::uint64_t i = 0; i < count; ++i) number(type);
    }
    std::size_t remaining() const { return static_cast<std::size_t>(end_ - p_); }
    std::string where() const { return std::string(name_) + ":" + std::to_string(line_); }
    [[noreturn]] void fail_short() const { throw Error(where(), "the data end early"); }

  private:
    const char *p_, *end_;
    std::size_t line_;
    std::string_view name_;
};

// Where a vertex's properties go: position, normal, both texture coordinates, colour, opacity.
constexpr int slots = 14, first_color = 10, opacity = 13;
int slot_of(std::string_view property) {
    struct Name {
        std::string_view name;
        int slot;
    };
    constexpr std::array<Name, 29> names = {{{"x", 0},
                                             {"y", 1},
                                             {"z", 2},
                                             {"nx", 3},
                                             {"ny", 4},
                                             {"nz", 5},
                                             {"u", 6},
                                             {"v", 7},
                                             {"s", 6},
                                             {"t", 7},
                                             {"texture_u", 6},
                                             {"texture_v", 7},
                                             {"texture_s", 6},
                                             {"texture_t", 7},
                                             {"u2", 8},
                                             {"v2", 9},
                                             {"red", 10},
                                             {"green", 11},
                                             {"blue", 12},
                                             {"diffuse_red", 10},
                                             {"diffuse_green", 11},
                                             {"diffuse_blue", 12},
                                             {"r", 10},
                                             {"g", 11},
                                             {"b", 12},
                                             {"color_0", 10},
                                             {"color_1", 11},
                                             {"color_2", 12},
                                             {"alpha", 13}}};
    for (const Name& n : names)
        if (n.name == property) return n.slot;
    return -1;
}

// A colour or an opacity, linear.
float shade(double value, Type type, bool is_color) {
    if (!ply::is_integer(type)) return static_cast<float>(value);
    const double largest = std::pow(2.0, 8.0 * static_cast<double>(ply::size_of(type))) - 1;
    const float share = static_cast<float>(std::clamp(value / largest, 0.0, 1.0));
    return is_color ? srgb_to_linear(share) : share;
}

template <typename Cursor>
class BodyParser {
  public:
    BodyParser(Cursor cursor, const Header& header, std::string_view name, bool colors)
        : cursor_(cursor), header_(header), name_(name), colors_(colors) {}

    PlyMesh parse() {
        bool vertices = false, faces = false;
        for (const Element& e : header_.elements) {
            std::size_t smallest = Cursor::smallest_row(e);
            if (e.count > 0 && smallest > 0 && e.count > cursor_.remaining() / smallest)
                throw Error(std::string(name_) + ":" + std::to_string(e.line),
                            "the header declares " + std::to_string(e.count) + " rows of '" + e.name +
                                "', more than the file can hold");
            if (e.name == "vertex") {
                parse_vertices(e);
                vertices = true;
            } else if (e.name == "face" || e.name == "tristrips") {
                parse_faces(e, e.name == "tristrips");
                faces = true;
            } else if (!e.properties.empty()) {
                for (std::uint64_t i = 0; i < e.count; ++i)
                    for (const Property& p : e.properties) skip(p);
            }
        }
        if (!vertices) throw Error(name_, "the file has no element 'vertex'");
        if (!faces)
            throw Error(name_,
                        "the file has no element 'face': it is a cloud of points, which has no surface");
        check_indices();
        return std::move(result_);
    }

  private:
    void skip(const Property& p) {
        if (p.is_list)
            skip_list(p, list_count(p));
        else
            cursor_.skip(1, p.type);
    }
    void skip_list(const Property& p, std::uint64_t count) { cursor_.skip(count, p.type); }
    std::uint64_t list_count(const Property& p) {
        double n = cursor_.number(p.count_type);
        if (!(n >= 0)) throw Error(cursor_.where(), "a list of negative length");
        if (n > static_cast<double>(cursor_.remaining())) cursor_.fail_short();
        return static_cast<std::uint64_t>(n);
    }

    void parse_vertices(const Element& e) {
        if (e.count >= std::numeric_limits<Index>::max()) throw Error(name_, "too many vertices");
        std::vector<int> slot;
        std::array<bool, slots> have{};
        for (const Property& p : e.properties) {
            int s = p.is_list ? -1 : slot_of(p.name);
            if (s == first_color) result_.has_colors = true;
            if (s >= first_color && !colors_) s = -1;
            slot.push_back(s);
            if (s >= 0) have[static_cast<std::size_t>(s)] = true;
        }
        if (!(have[0] && have[1] && have[2]))
            throw Error(std::string(name_) + ":" + std::to_string(e.line),
                        "element 'vertex' needs the properties x, y and z");
        bool normals = have[3] && have[4] && have[5], uvs = have[6] && have[7];
        TriangleMesh& mesh = result_.mesh;
        mesh.positions.reserve(e.count + 1); // so that Embree can read them in place
        mesh.positions.resize(e.count);
        if (normals) mesh.normals.resize(e.count);
        if (uvs) mesh.uvs.resize(e.count);
        const bool second_uvs = have[8] && have[9];
        if (second_uvs) mesh.second_uvs.resize(e.count);
        const bool colors = have[10] && have[11] && have[12];
        if (colors) mesh.colors.resize(e.count);
        if (have[opacity]) mesh.opacities.resize(e.count);
        std::array<float, slots> v{};
        for (std::size_t i = 0; i < e.count; ++i) {
            for (std::size_t k = 0; k < slot.size(); ++k) {
                const Type type = e.properties[k].type;
                if (slot[k] < 0)
                    skip(e.properties[k]);
                else if (slot[k] < first_color)
                    v[static_cast<std::size_t>(slot[k])] = static_cast<float>(cursor_.number(type));
                else
                    v[static_cast<std::size_t>(slot[k])] =
                        shade(cursor_.number(type), type, slot[k] != opacity);
            }
            mesh.positions[i] = {v[0], v[1], v[2]};
            if (normals) mesh.normals[i] = {v[3], v[4], v[5]};
            if (uvs) mesh.uvs[i] = {v[6], v[7]};
            if (colors) mesh.colors[i] = {v[10], v[11], v[12]};
            if (second_uvs) mesh.second_uvs[i] = {v[8], v[9]};
            if (have[opacity]) mesh.opacities[i] = v[opacity];
            float sum = v[0] + v[1] + v[2] + v[3] + v[4] + v[5] + v[6] + v[7] + v[8] + v[9] + v[10] + v[11] +
                        v[12] + v[13];
            if (!std::isfinite(sum)) check_vertex(i, v);
        }
    }
    void check_vertex(std::size_t i, const std::array<float, slots>& v) const {
        for (float x : v)
            if (!std::isfinite(x))
                throw Error(cursor_.where(),
                            "vertex " + std::to_string(i) + " has a value that is not finite");
    }

    void parse_faces(const Element& e, bool strips) {
        const Property* list = nullptr;
        for (const Property& p : e.properties)
            if (p.is_list && (p.name == "vertex_indices" || p.name == "vertex_index")) list = &p;
        if (!list)
            throw Error(std::string(name_) + ":" + std::to_string(e.line),
                        "element '" + e.name + "' needs a list 'vertex_indices'");
        if (!ply::is_integer(list->type))
            throw Error(std::string(name_) + ":" + std::to_string(e.line),
                        "list 'vertex_indices' must be of an integer type");
        result_.mesh.indices.reserve(3 * e.count);
        for (std::uint64_t i = 0; i < e.count; ++i)
            for (const Property& p : e.properties) {
                if (&p == list)
                    strips ? parse_strips(p) : parse_corners(p);
                else
                    skip(p);
            }
    }
    void parse_corners(const Property& p) {
        std::uint64_t corners = list_count(p);
        if (corners < 3) {
            skip_list(p, corners);
            ++result_.degenerate;
            return;
        }
        result_.quads += corners == 4;
        result_.polygons += corners > 4;
        Index first = corner(p.type), last = corner(p.type);
        for (std::uint64_t k = 2; k < corners; ++k) {
            Index c = corner(p.type);
            result_.mesh.indices.insert(result_.mesh.indices.end(), {first, last, c});
            last = c;
        }
    }
    void parse_strips(const Property& p) {
        std::vector<Index>& indices = result_.mesh.indices;
        std::size_t length = 0; // corners of the open strip so far
        Index a = 0, b = 0;     // the last two
        for (std::uint64_t count = list_count(p); count > 0; --count) {
            const double v = cursor_.number(p.type);
            if (v == -1) {
                length = 0;
                continue;
            }
            const Index c = corner(v);
            // Every other triangle is reversed. Strips turn by repeated corners, whose triangles have no area.
            if (length >= 2 && a != b && b != c && a != c) {
                if (length % 2 == 0)
                    indices.insert(indices.end(), {a, b, c});
                else
                    indices.insert(indices.end(), {b, a, c});
            }
            a = b;
            b = c;
            ++length;
        }
    }
    Index corner(Type type) { return corner(cursor_.number(type)); }
    Index corner(double v) const {
        if (!(v >= 0 && v < static_cast<double>(no_index)))
            throw Error(cursor_.where(), "a face has a negative vertex index or one beyond 2^32");
        return static_cast<Index>(v);
    }
    void check_indices() const {
        std::size_t count = result_.mesh.positions.size();
        for (std::size_t i = 0; i < result_.mesh.indices.size(); ++i)
            if (result_.mesh.indices[i] >= count)
                throw Error(name_, "triangle " + std::to_string(i / 3) + " refers to vertex " +
                                       std::to_string(result_.mesh.indices[i]) + "; the file has " +
                                       std::to_string(count) + " vertices");
    }

    Cursor cursor_;
    const Header& header_;
    std::string_view name_;
    bool colors_;
    PlyMesh result_;
};

} // namespace

PlyMesh parse_ply(std::span<const std::uint8_t> bytes, std::string_view name, bool colors) {
    Header header = ply::parse_header(bytes, name);
    if (header.format == Format::ascii)
        return BodyParser(AsciiCursor(bytes, header, name), header, name, colors).parse();
    return BodyParser(BinaryCursor(bytes, header, name), header, name, colors).parse();
}

PlyMesh read_ply(const std::filesystem::path& path) {
    constexpr std::size_t max_bytes = std::size_t{16} << 30;
    std::vector<std::uint8_t> bytes = read_file_bytes(path, max_bytes);
    if (path.extension() == ".gz") bytes = gunzip(bytes, path.string(), max_bytes);
    return parse_ply(bytes, path.string());
}

} // namespace montelux
