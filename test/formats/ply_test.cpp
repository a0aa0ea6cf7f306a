#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <gtest/gtest.h>
#include <limits>
#include <random>
#include <string>

#include "montelux/formats/ply.h"
#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

PlyMesh parse(const std::string& text) {
    return parse_ply({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, "mesh.ply");
}
std::string ply_error(const std::string& text) {
    try {
        parse(text);
    } catch (const Error& e) {
        return e.what();
    }
    return {};
}

const std::string ascii = "ply\nformat ascii 1.0\ncomment made by hand\nelement vertex 4\nproperty float x\n"
                          "property float y\nproperty float z\nelement face 2\n"
                          "property list uchar int vertex_indices\nend_header\n"
                          "0 0 0\n1 0 0\n1 1 0\n0 1 0.5\n3 0 1 2\n3 0 2 3\n";

// Bytes of a number in either byte order.
template <typename T>
void put(std::string& out, T value, bool big) {
    char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    if (big == (std::endian::native == std::endian::little)) std::reverse(bytes, bytes + sizeof(T));
    out.append(bytes, sizeof(T));
}

// A quad, a triangle and a pentagon with every kind of property around, in odd order and types.
std::string binary(bool big) {
    std::string s = std::string("ply\r\nformat ") + (big ? "binary_big_endian" : "binary_little_endian") +
                    " 1.0\r\nelement camera 1\r\nproperty list ushort double k\r\nproperty char c\r\n"
                    "element vertex 5\r\nproperty double z\r\nproperty uchar red\r\nproperty float x\r\n"
                    "property short y\r\nproperty list uchar short extra\r\nproperty float ny\r\n"
                    "property float nx\r\nproperty float nz\r\nproperty float t\r\nproperty float s\r\n"
                    "element face 4\r\nproperty int faceIndices\r\nproperty list uint ushort vertex_index\r\n"
                    "element tail 2\r\nproperty int8 a\r\nend_header\r\n";
    put<std::uint16_t>(s, 2, big);
    put(s, 1.0, big);
    put(s, 2.0, big);
    put<std::int8_t>(s, 1, big);
    for (int i = 0; i < 5; ++i) {
        put(s, 0.5 * i, big);
        put<std::uint8_t>(s, 200, big);
        put(s, 1.5f * static_cast<float>(i), big);
        put<std::int16_t>(s, static_cast<std::int16_t>(-i), big);
        put<std::uint8_t>(s, static_cast<std::uint8_t>(i), big);
        for (int k = 0; k < i; ++k) put<std::int16_t>(s, 77, big);
        for (float v : {0.25f, 0.5f, 0.75f, 0.125f, static_cast<float>(i)}) put(s, v, big);
    }
    for (const std::vector<std::uint16_t>& face :
         {std::vector<std::uint16_t>{0, 1, 2, 3}, {2, 3, 4}, {0, 1}, {4, 3, 2, 1, 0}}) {
        put<std::int32_t>(s, 9, big);
        put<std::uint32_t>(s, static_cast<std::uint32_t>(face.size()), big);
        for (std::uint16_t i : face) put(s, i, big);
    }
    s += "ab";
    return s;
}

TEST(Ply, Ascii) {
    PlyMesh ply = parse(ascii);
    EXPECT_EQ(ply.mesh.positions.size(), 4u);
    EXPECT_EQ(ply.mesh.positions[3], Vec3f(0, 1, 0.5f));
    EXPECT_EQ(ply.mesh.indices, (std::vector<Index>{0, 1, 2, 0, 2, 3}));
    EXPECT_TRUE(ply.mesh.normals.empty() && ply.mesh.uvs.empty());
    EXPECT_EQ(ply.quads + ply.polygons + ply.degenerate, 0u);
}

TEST(Ply, BinaryOfBothByteOrders) {
    for (bool big : {false, true}) {
        PlyMesh ply = parse(binary(big));
        ASSERT_EQ(ply.mesh.positions.size(), 5u);
        EXPECT_EQ(ply.mesh.positions[3], Vec3f(4.5f, -3, 1.5f));
        EXPECT_EQ(ply.mesh.normals[1], Vec3f(0.5f, 0.25f, 0.75f));
        EXPECT_EQ(ply.mesh.uvs[4], Vec2f(4, 0.125f));
        EXPECT_EQ(ply.mesh.indices,
                  (std::vector<Index>{0, 1, 2, 0, 2, 3, 2, 3, 4, 4, 3, 2, 4, 2, 1, 4, 1, 0}));
        EXPECT_EQ(ply.quads, 1u);
        EXPECT_EQ(ply.polygons, 1u);
        EXPECT_EQ(ply.degenerate, 1u);
    }
}

TEST(Ply, EveryTruncationIsAnErrorAndNoCrash) {
    for (const std::string& whole : {binary(false), binary(true)})
        for (std::size_t n = 0; n < whole.size(); ++n) EXPECT_NE(ply_error(whole.substr(0, n)), "") << n;
    for (std::size_t n = 0; n + 2 < ascii.size(); ++n) EXPECT_NE(ply_error(ascii.substr(0, n)), "") << n;
}

TEST(Ply, MutationsThrowOnlyErrors) {
    std::mt19937 random(11);
    for (const std::string& whole : {binary(false), ascii})
        for (int n = 0; n < 20000; ++n) {
            std::string s = whole;
            for (int k = 0; k < 3; ++k) s[random() % s.size()] = static_cast<char>(random());
            try {
                PlyMesh ply = parse(s);
                for (Index i : ply.mesh.indices) ASSERT_LT(i, ply.mesh.positions.size());
                for (Vec3f p : ply.mesh.positions) ASSERT_TRUE(is_finite(p));
            } catch (const Error&) {
            }
        }
}

std::string replaced(std::string s, const std::string& from, const std::string& to) {
    return s.replace(s.find(from), from.size(), to);
}

TEST(Ply, SentencesOfErrors) {
    EXPECT_EQ(ply_error(""), "mesh.ply:1: the header has no end; expected 'end_header'");
    EXPECT_EQ(ply_error("OFF\n"), "mesh.ply:1: expected 'ply' on the first line: this is not a PLY file");
    EXPECT_EQ(ply_error(replaced(ascii, "ascii", "text")),
              "mesh.ply:2: format 'text'; expected ascii, binary_little_endian or binary_big_endian");
    EXPECT_EQ(ply_error(replaced(ascii, "vertex 4", "vertex 4000000000")),
              "mesh.ply:4: the header declares 4000000000 rows of 'vertex', more than the file can hold");
    EXPECT_EQ(
        ply_error(replaced(ascii, "face 2", "face 18446744073709551615")),
        "mesh.ply:8: the header declares 18446744073709551615 rows of 'face', more than the file can hold");
    EXPECT_EQ(ply_error(replaced(ascii, "vertex 4", "vertex -4")),
              "mesh.ply:4: element 'vertex' has the count '-4'; expected a number of 0 or more");
    EXPECT_EQ(ply_error(replaced(ascii, "float y", "quad y")), "mesh.ply:6: unknown property type 'quad'");
    EXPECT_EQ(ply_error(replaced(ascii, "float y", "float w")),
              "mesh.ply:4: element 'vertex' needs the properties x, y and z");
    EXPECT_EQ(ply_error(replaced(ascii, "vertex_indices", "corners")),
              "mesh.ply:8: element 'face' needs a list 'vertex_indices'");
    EXPECT_EQ(ply_error(replaced(ascii, "3 0 2 3", "3 0 2 4")),
              "mesh.ply: triangle 1 refers to vertex 4; the file has 4 vertices");
    EXPECT_EQ(ply_error(replaced(ascii, "3 0 2 3", "3 0 2 -1")),
              "mesh.ply:16: a face has a negative vertex index or one beyond 2^32");
    EXPECT_EQ(ply_error(replaced(ascii, "1 1 0", "1 nan 0")), "mesh.ply:13: expected a number");
    EXPECT_EQ(ply_error(replaced(ascii, "1 1 0", "1 1e200 0")),
              "mesh.ply:13: vertex 2 has a value that is not finite");
    EXPECT_EQ(ply_error(replaced(ascii, "3 0 2 3", "3 0 2")), "mesh.ply:17: the data end early");
    EXPECT_EQ(ply_error(replaced(ascii, "element vertex 4", "element point 4")),
              "mesh.ply: the file has no element 'vertex'");
}

// Integers are sRGB, floats linear; opacities are linear. They are read where they are asked for.
TEST(Ply, ColorsOfVertices) {
    const auto text = [](const char* type, const char* colors) {
        return std::string("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                           "property float z\n") +
               "property " + type + " red\nproperty " + type + " green\nproperty " + type +
               " blue\nproperty " + type +
               " alpha\nelement face 1\nproperty list uchar int vertex_indices\n" + "end_header\n0 0 0 " +
               colors + "\n1 0 0 " + colors + "\n0 1 0 " + colors + "\n3 0 1 2\n";
    };
    const auto read = [](const std::string& ply) {
        return parse_ply({reinterpret_cast<const std::uint8_t*>(ply.data()), ply.size()}, "mesh.ply", true)
            .mesh;
    };
    const TriangleMesh bytes = read(text("uchar", "255 128 0 51")),
                       floats = read(text("float", "1 0.5 0 0.2"));
    ASSERT_EQ(bytes.colors.size(), 3u);
    EXPECT_EQ(bytes.colors[2].x, 1);
    EXPECT_NEAR(bytes.colors[2].y, 0.2158605f, 1e-6f); // ((128 / 255 + 0.055) / 1.055)^2.4
    EXPECT_EQ(bytes.colors[2].z, 0);
    ASSERT_EQ(floats.colors.size(), 3u);
    EXPECT_EQ(floats.colors[1], (Vec3f{1, 0.5f, 0}));
    EXPECT_EQ(bytes.opacities, std::vector(3, 0.2f));
    EXPECT_EQ(floats.opacities, std::vector(3, 0.2f));
    std::string numbered = text("float", "1 0.5 0 0.2");
    for (const auto& [from, to] :
         {std::pair(" red", " color_0"), std::pair(" green", " color_1"), std::pair(" blue", " color_2")})
        numbered.replace(numbered.find(from), std::string_view(from).size(), to);
    EXPECT_EQ(read(numbered).colors, floats.colors);
    EXPECT_TRUE(parse(text("uchar", "1 2 3 4")).mesh.colors.empty());
    EXPECT_TRUE(parse(text("uchar", "1 2 3 4")).mesh.opacities.empty());
}

TEST(Ply, TriangleStrips) {
    const std::string strips = "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\n"
                               "property float z\nproperty uchar red\nelement tristrips 1\n"
                               "property list int int vertex_indices\nend_header\n"
                               "0 0 0 9\n1 0 0 9\n0 1 0 9\n1 1 0 9\n0 2 0 9\n11 0 1 2 3 -1 2 3 3 4 -1 1\n";
    // Every other triangle of a strip is reversed; a repeated corner turns it.
    const PlyMesh mesh = parse(strips);
    EXPECT_EQ(mesh.mesh.indices, (std::vector<Index>{0, 1, 2, 2, 1, 3}));
    EXPECT_TRUE(mesh.has_colors);
    EXPECT_FALSE(parse(ascii).has_colors);
    EXPECT_EQ(ply_error(replaced(strips, "-1 2", "-2 2")),
              "mesh.ply:16: a face has a negative vertex index or one beyond 2^32");
    EXPECT_EQ(ply_error(replaced(strips, "0 1 2 3", "0 1 2 7")),
              "mesh.ply: triangle 1 refers to vertex 7; the file has 5 vertices");
    EXPECT_EQ(ply_error(replaced(ascii, "element face 2", "element edge 2")),
              "mesh.ply: the file has no element 'face': it is a cloud of points, which has no surface");
}

TEST(Ply, NotFiniteInBinary) {
    constexpr std::array names = {"x", "y",  "z",  "nx",  "ny",    "nz",   "u",
                                  "v", "u2", "v2", "red", "green", "blue", "alpha"};
    const auto read = [&](std::size_t changed, float value) {
        std::string s = "ply\nformat binary_little_endian 1.0\nelement vertex 1\n";
        for (const char* name : names) s += std::string("property float ") + name + "\n";
        s += "element face 0\nproperty list uchar int vertex_indices\nend_header\n";
        for (std::size_t i = 0; i < names.size(); ++i) put(s, i == changed ? value : 0.5f, false);
        return parse_ply({reinterpret_cast<const std::uint8_t*>(s.data()), s.size()}, "mesh.ply", true);
    };
    using Limits = std::numeric_limits<float>;
    for (std::size_t changed = 0; changed < names.size(); ++changed) {
        EXPECT_EQ(read(changed, 0.25f).mesh.positions.size(), 1u);
        for (const float value : {Limits::quiet_NaN(), Limits::infinity(), -Limits::infinity()}) {
            std::string message;
            try {
                read(changed, value);
            } catch (const Error& e) {
                message = e.what();
            }
            EXPECT_NE(message.find("vertex 0 has a value that is not finite"), std::string::npos)
                << names.at(changed) << " is " << value << ": " << message;
        }
    }
}

TEST(Ply, DamagedFiles) {
    std::filesystem::path folder = std::filesystem::path(MONTELUX_SHARED_DIR) / "bad/models";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no shared files";
    int count = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        if (entry.path().extension() != ".ply") continue;
        EXPECT_THROW(read_ply(entry.path()), Error) << entry.path();
        ++count;
    }
    EXPECT_GE(count, 2);
    EXPECT_THROW(read_ply(folder), Error);
    EXPECT_THROW(read_ply(folder / "there is no such file.ply"), Error);
}

} // namespace
} // namespace montelux
