#include "montelux/formats/stl.h"

#include <bit>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "montelux/formats/number.h"
#include "montelux/formats/vertex_normals.h"
#include "montelux/mc/math/error.h"
#include "montelux/scene/build/quoted.h"

namespace montelux {
namespace {

constexpr std::size_t header_bytes = 80, facet_bytes = 50, first_facet = header_bytes + 4;
static_assert(std::endian::native == std::endian::little); // as the numbers in binary files

std::size_t facet_count(std::span<const std::uint8_t> bytes) {
    std::uint32_t count = 0;
    std::memcpy(&count, bytes.data() + header_bytes, sizeof count);
    return count;
}

std::vector<Point3f> read_binary(std::span<const std::uint8_t> bytes, std::string_view name) {
    if (bytes.size() < first_facet)
        throw Error(name,
                    "an STL file has at least 84 bytes; this one ends after " + std::to_string(bytes.size()));
    const std::size_t count = facet_count(bytes);
    if ((bytes.size() - first_facet) / facet_bytes < count)
        throw Error(name, "an STL file of " + std::to_string(count) + " triangles has " +
                              std::to_string(first_facet + facet_bytes * count) +
                              " bytes; this one ends after " + std::to_string(bytes.size()));
    std::vector<Point3f> corners;
    corners.reserve(3 * count);
    for (std::size_t t = 0; t < count; ++t)
        for (std::size_t k = 1; k <= 3; ++k) { // behind the normal
            float p[3];
            std::memcpy(p, bytes.data() + first_facet + facet_bytes * t + sizeof p * k, sizeof p);
            if (!std::isfinite(p[0] + p[1] + p[2]))
                throw Error(name, "triangle " + std::to_string(t) + " has a coordinate that is not finite");
            corners.push_back({p[0], p[1], p[2]});
        }
    return corners;
}

// solid [name], facets of "facet normal x y z outer loop vertex x y z (three times) endloop endfacet", endsolid [name].
class AsciiReader {
  public:
    AsciiReader(std::span<const std::uint8_t> bytes, std::string_view name)
        : p_(reinterpret_cast<const char*>(bytes.data())), end_(p_ + bytes.size()), name_(name) {}

    std::vector<Point3f> read() {
        std::vector<Point3f> corners;
        for (std::string_view word = next(); !word.empty(); word = next()) {
            if (word == "solid" || word == "endsolid")
                skip_line();
            else if (word == "facet")
                read_facet(corners);
            else
                fail(word, "'facet' or 'endsolid'");
        }
        return corners;
    }

  private:
    void read_facet(std::vector<Point3f>& corners) {
        expect("normal");
        // Of no use: some programs write 'nan' for those of degenerate triangles.
        for (int i = 0; i < 3; ++i) next();
        expect("outer");
        expect("loop");
        for (int k = 0; k < 3; ++k) {
            expect("vertex");
            const float x = number(), y = number(), z = number();
            corners.push_back({x, y, z});
        }
        expect("endloop");
        expect("endfacet");
    }
    static bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }
    std::string_view next() {
        for (; p_ != end_ && is_space(*p_); ++p_) line_ += *p_ == '\n';
        const char* begin = p_;
        while (p_ != end_ && !is_space(*p_)) ++p_;
        return {begin, static_cast<std::size_t>(p_ - begin)};
    }
    void skip_line() {
        while (p_ != end_ && *p_ != '\n') ++p_;
    }
    void expect(std::string_view expected) {
        const std::string_view word = next();
        if (word != expected) fail(word, quoted(expected));
    }
    float number() {
        const std::string_view word = next();
        float value = 0;
        const NumberResult r = parse_number(word.data(), word.data() + word.size(), value);
        if (r.status == NumberStatus::out_of_range)
            throw Error(where(), quoted(word) + " is beyond what single-precision numbers hold");
        if (word.empty() || r.status != NumberStatus::ok || r.end != word.data() + word.size())
            fail(word, "a coordinate");
        return value;
    }
    std::string where() const { return std::string(name_) + ":" + std::to_string(line_); }
    [[noreturn]] void fail(std::string_view word, const std::string& expected) const {
        throw Error(where(), (word.empty() ? "the file ends early" : "read " + quoted(word)) + "; expected " +
                                 expected);
    }

    const char *p_, *end_;
    std::string_view name_;
    std::size_t line_ = 1;
};

} // namespace

bool is_binary_stl(std::span<const std::uint8_t> bytes) {
    return bytes.size() >= first_facet && bytes.size() == first_facet + facet_bytes * facet_count(bytes);
}

TriangleMesh parse_stl(std::span<const std::uint8_t> bytes, std::string_view name) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const bool is_text = text.starts_with("solid") && !is_binary_stl(bytes);
    const std::vector<Point3f> corners = is_text ? AsciiReader(bytes, name).read() : read_binary(bytes, name);
    TriangleMesh mesh;
    std::vector<Index> number(corners.size()); // of the welded vertices
    const std::vector<Index> first = welded(corners);
    mesh.indices.reserve(corners.size());
    for (std::size_t c = 0; c < corners.size(); ++c) {
        if (first[c] == c) {
            number[c] = static_cast<Index>(mesh.positions.size());
            mesh.positions.push_back(corners[c]);
        }
        mesh.indices.push_back(number[first[c]]);
    }
    add_normals(mesh);
    return mesh;
}

} // namespace montelux
