// STL files, binary and ASCII.
#include <cstring>
#include <gtest/gtest.h>
#include <limits>
#include <string>
#include <vector>

#include "montelux/formats/stl.h"
#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

std::span<const std::uint8_t> bytes_of(const std::string& text) {
    return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}
std::string stl_error(const std::string& text) {
    try {
        parse_stl(bytes_of(text), "a.stl");
    } catch (const Error& e) {
        return e.what();
    }
    return {};
}

// Two triangles of a square; header of any text.
std::string binary_square(const std::string& header, std::uint32_t count = 2, float last = 0) {
    std::string s = header;
    s.resize(80, ' ');
    s.append(reinterpret_cast<const char*>(&count), 4);
    const float corners[2][12] = {{0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 1, 0},
                                  {0, 0, 1, 0, 0, 0, 1, 1, 0, 0, 1, last}};
    for (const auto& triangle : corners) {
        s.append(reinterpret_cast<const char*>(triangle), sizeof triangle);
        s.append(2, '\0');
    }
    return s;
}

const std::string ascii_square =
    "solid a square\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n"
    "   vertex 1 1 0\n  endloop\n endfacet\n facet normal nan nan nan\n  outer loop\n"
    "   vertex 0 0 0\n   vertex 1 1 0\n   vertex 0 1 0\n  endloop\n endfacet\n"
    "endsolid a square\n";

TEST(Stl, BothKindsAreWelded) {
    for (const std::string& file :
         {binary_square("made by hand"), binary_square("solid ground"), ascii_square}) {
        const TriangleMesh mesh = parse_stl(bytes_of(file), "a.stl");
        EXPECT_EQ(mesh.positions.size(), 4u);
        EXPECT_EQ(mesh.indices, (std::vector<Index>{0, 1, 2, 0, 2, 3}));
        EXPECT_EQ(mesh.normals[0], (Normal3f{0, 0, 1}));
    }
    EXPECT_TRUE(is_binary_stl(bytes_of(binary_square("solid"))));
    EXPECT_FALSE(is_binary_stl(bytes_of(ascii_square)));
    EXPECT_EQ(parse_stl(bytes_of(ascii_square + ascii_square), "two").triangle_count(), 4u);
}

// The cube's edges stay sharp: three vertices at each corner.
TEST(Stl, EdgesStaySharp) {
    std::string cube = "solid\n";
    const int corner[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                              {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    for (const auto& face : corner)
        for (const int k : {1, 2}) {
            cube += "facet normal 0 0 0 outer loop\n";
            for (const int i : {face[0], face[k], face[k + 1]})
                cube += "vertex " + std::to_string(i & 1) + " " + std::to_string(i >> 1 & 1) + " " +
                        std::to_string(i >> 2) + "\n";
            cube += "endloop endfacet\n";
        }
    const TriangleMesh mesh = parse_stl(bytes_of(cube + "endsolid\n"), "cube");
    EXPECT_EQ(mesh.triangle_count(), 12u);
    EXPECT_EQ(mesh.positions.size(), 24u);
    for (const Normal3f n : mesh.normals) EXPECT_FLOAT_EQ(length(n), 1);
}

TEST(Stl, MistakesAreSentences) {
    std::string short_file = binary_square("x");
    short_file.pop_back();
    const std::string begin = "solid\nfacet normal 0 0 1\nouter loop\n";
    const struct {
        std::string text, sentence;
    } cases[] = {
        {"", "a.stl: an STL file has at least 84 bytes; this one ends after 0"},
        {short_file, "a.stl: an STL file of 2 triangles has 184 bytes; this one ends after 183"},
        {binary_square("x", 4000000000u),
         "a.stl: an STL file of 4000000000 triangles has 200000000084 bytes; this one ends after 184"},
        {binary_square("x", 2, std::numeric_limits<float>::quiet_NaN()),
         "a.stl: triangle 1 has a coordinate that is not finite"},
        {binary_square("x", 2, std::numeric_limits<float>::infinity()),
         "a.stl: triangle 1 has a coordinate that is not finite"},
        {"solid\nfacets\n", "a.stl:2: read 'facets'; expected 'facet' or 'endsolid'"},
        {"solid\nfacet\n", "a.stl:3: the file ends early; expected 'normal'"},
        {begin + "vertex 0 0\nvertex", "a.stl:5: read 'vertex'; expected a coordinate"},
        {begin + "vertex 0 0 1e99\n", "a.stl:4: '1e99' is beyond what single-precision numbers hold"},
        {begin + "vertex 0 0 0\nendloop\n", "a.stl:5: read 'endloop'; expected 'vertex'"},
        {begin + "vertex 0 0 0\nvertex 0 0 0\nvertex 0 0 0\nvertex 0 0 0\n",
         "a.stl:7: read 'vertex'; expected 'endloop'"},
    };
    for (const auto& c : cases) EXPECT_EQ(stl_error(c.text), c.sentence);
}

} // namespace
} // namespace montelux
