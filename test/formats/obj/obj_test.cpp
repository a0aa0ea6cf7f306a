// The reader of OBJ files: faces, indices, parts, normals, and a sentence for each mistake.
#include <algorithm>
#include <gtest/gtest.h>
#include <string>

#include "montelux/formats/obj/obj.h"
#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

class ObjFile : public ::testing::Test {
  protected:
    ObjModel parse(const std::string& text, const ObjSettings& settings = {}) {
        return parse_obj({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, "a.obj",
                         warnings_, settings);
    }
    std::string obj_error(const std::string& text) {
        try {
            parse(text);
        } catch (const Error& e) {
            return e.what();
        }
        return {};
    }
    // Of a model with one part.
    TriangleMesh mesh(const std::string& text, const ObjSettings& settings = {}) {
        ObjModel model = parse(text, settings);
        EXPECT_EQ(model.parts.size(), 1u);
        return model.parts.empty() ? TriangleMesh() : model.parts[0].mesh;
    }

    Warnings warnings_;
};

TEST_F(ObjFile, IndicesCountFromBothEnds) {
    const TriangleMesh a = mesh(square + "f 1 2 3\n"), b = mesh(square + "f -4 -3 -2\n");
    EXPECT_EQ(a.indices, (std::vector<Index>{0, 1, 2}));
    ASSERT_EQ(a.positions.size(), 3u); // the fourth vertex is not used
    EXPECT_EQ(a.positions[2], (Point3f{1, 1, 0}));
    EXPECT_EQ(a.positions, b.positions);
    EXPECT_EQ(a.indices, b.indices);
    EXPECT_TRUE(warnings_.messages().empty());
}

TEST_F(ObjFile, QuadsAndPolygonsAreSplit) {
    EXPECT_EQ(mesh(square + "f 1 2 3 4\n").indices, (std::vector<Index>{0, 1, 2, 0, 2, 3}));
    // An L of area 3: no triangle may cover the notch.
    const TriangleMesh l = mesh("v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nf 1 2 3 4 5 6\n");
    ASSERT_EQ(l.triangle_count(), 4u);
    double area = 0;
    for (std::size_t t = 0; t < 4; ++t) {
        const Point3f p = l.positions[l.indices[3 * t]], q = l.positions[l.indices[3 * t + 1]],
                      r = l.positions[l.indices[3 * t + 2]];
        const double part = 0.5 * double(cross(q - p, r - p).z);
        EXPECT_GE(part, 0) << t;
        area += part;
    }
    EXPECT_DOUBLE_EQ(area, 3);
}

TEST_F(ObjFile, EqualCornersShareAVertex) {
    const std::string uvs = "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\n";
    EXPECT_EQ(mesh(square + uvs + "f 1/1/1 2/2/1 3/3/1 4/4/1\n").positions.size(), 4u);
    // A seam: vertex 3 has two places on the texture.
    const TriangleMesh seam = mesh(square + uvs + "f 1/1/1 2/2/1 3/3/1\nf 1/1/1 3/4/1 4/4/1\n");
    EXPECT_EQ(seam.positions.size(), 5u);
    EXPECT_EQ(seam.uvs[seam.indices[4]], (Point2f{0, 1}));
    // v//n and v/t
    EXPECT_TRUE(mesh(square + uvs + "f 1//1 2//1 3//1\n").uvs.empty());
    EXPECT_EQ(mesh(square + uvs + "f 1//1 2//1 3//1\n").normals[0], (Normal3f{0, 0, 1}));
    EXPECT_EQ(mesh(square + uvs + "f 1/2 2/2 3/2\n").uvs[0], (Point2f{1, 0}));
    // Corners without coordinates beside others.
    EXPECT_EQ(mesh(square + uvs + "f 1/2 2/2 3/2\nf 1 3 4\n").uvs.size(), 6u);
}

TEST_F(ObjFile, PartsHaveNamesAndMaterials) {
    const std::string text = "mtllib the materials.mtl\n" + square +
                             "o table\nusemtl oak\nf 1 2 3\nusemtl steel\nf 1 2 4\nusemtl oak\nf 1 3 4\n"
                             "o chair\nf 2 3 4\n";
    const ObjModel model = parse(text);
    ASSERT_EQ(model.parts.size(), 3u);
    EXPECT_EQ(model.parts[0].name + model.parts[0].material, "tableoak");
    EXPECT_EQ(model.parts[0].mesh.triangle_count(), 2u);
    EXPECT_EQ(model.parts[0].line, 8u);
    EXPECT_EQ(model.parts[1].name + model.parts[1].material, "tablesteel");
    EXPECT_EQ(model.parts[2].name + model.parts[2].material, "chairoak");
    ASSERT_EQ(model.libraries.size(), 1u);
    EXPECT_EQ(model.libraries[0].file, "the materials.mtl");
    const ObjModel whole = parse(text, {.split = false});
    ASSERT_EQ(whole.parts.size(), 1u);
    EXPECT_EQ(whole.parts[0].mesh.triangle_count(), 4u);
    EXPECT_EQ(whole.parts[0].mesh.positions.size(), 4u);
}

// Two squares with a common edge, folded by 90 and by 20 degrees.
TEST_F(ObjFile, NormalsAreSmoothUpToACrease) {
    const std::string sharp = square + "v 2 0 0\nv 1 0 1\nv 1 1 1\n", faces = "f 1 2 3 4\nf 2 6 7 3\n";
    EXPECT_EQ(mesh(sharp + faces).positions.size(), 8u);
    EXPECT_EQ(mesh(sharp + faces).normals[0], (Normal3f{0, 0, 1}));
    const std::string flat = square + "v 2 0 0\nv 1.94 0 0.342\nv 1.94 1 0.342\n";
    EXPECT_EQ(mesh(flat + faces).positions.size(), 6u);
    // Smoothing groups rule where there are any.
    EXPECT_EQ(mesh(sharp + "s 1\n" + faces).positions.size(), 6u);
    EXPECT_EQ(mesh(flat + "s off\n" + faces).positions.size(), 12u);
    EXPECT_EQ(mesh(flat + "s 1\nf 1 2 3 4\ns 2\nf 2 6 7 3\n").positions.size(), 8u);
    EXPECT_TRUE(mesh(sharp + faces, {.make_normals = false}).normals.empty());
    // Given normals stay beside made ones.
    const TriangleMesh mixed = mesh(square + "vn 0 1 0\nf 1//1 2//1 3//1\nf 1 3 4\n");
    EXPECT_EQ(mixed.normals[mixed.indices[0]], (Normal3f{0, 1, 0}));
    EXPECT_EQ(mixed.normals[mixed.indices[3]], (Normal3f{0, 0, 1}));
}

TEST_F(ObjFile, LinesMayBeContinuedAndEndInAnyWay) {
    EXPECT_EQ(mesh("\xef\xbb\xbf# made by hand\r\nv 0 0 0\r\nv 1 \\\r\n0 0\r\n\tv 1 1 0 \r\nf 1 2\\\n3")
                  .indices.size(),
              3u);
    EXPECT_TRUE(warnings_.messages().empty());
}

TEST_F(ObjFile, VerticesMayHaveColors) {
    const std::string text = "v 0 0 0\nv 1 0 0 0.5 0.25 1\nv 1 1 0 1 0.1 0.2 0.3\nv 0 1 0\nf 1 2 3 4\n";
    const TriangleMesh m = mesh(text, {.make_normals = false, .colors = true});
    ASSERT_EQ(m.colors.size(), 4u);
    const Vec3f expected[] = {{1, 1, 1}, {0.5f, 0.25f, 1}, {0.1f, 0.2f, 0.3f}, {1, 1, 1}};
    for (std::size_t i = 0; i < 4; ++i) {
        const auto at =
            std::ranges::find(m.positions, Point3f(i == 1 || i == 2 ? 1.0f : 0.0f, i > 1 ? 1.0f : 0.0f, 0));
        EXPECT_EQ(m.colors[static_cast<std::size_t>(at - m.positions.begin())], expected[i]) << i;
    }
    EXPECT_TRUE(mesh(text).colors.empty());
    EXPECT_TRUE(mesh("v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n", {.colors = true}).colors.empty());
}

TEST_F(ObjFile, WhatIsIgnoredIsToldOnce) {
    mesh("v 0 0 0 1\nv 1 0 0 0.5\nv 1 1 0 1 0 0\nv 0 1 0 0 1 0\nf 1 2 3\nl 1 2\nl 2 3\nfoo 1\nfoo 2\nsurf 0 "
         "1\nf 1 2\n");
    const std::vector<std::string> expected{
        "a.obj:2: weights of vertices are ignored",
        "a.obj:3: colours of vertices are ignored",
        "a.obj:6: 'l' is ignored: lines and points are not rendered",
        "a.obj:8: 'foo' is unknown and ignored",
        "a.obj:10: 'surf' is ignored: curves and free-form surfaces are not read",
        "a.obj: 1 faces of fewer than 3 corners are left out"};
    EXPECT_EQ(warnings_.messages(), expected);
}

TEST_F(ObjFile, MistakesAreSentences) {
    const struct {
        std::string text, sentence;
    } cases[] = {
        {"v 1 2\n", "a.obj:1: the line ends early; expected 3 coordinates, read 2"},
        {"v\n", "a.obj:1: the line ends early; expected the 3 coordinates of a vertex"},
        {"v 1 2 x\n", "a.obj:1: read 'x'; expected 3 coordinates, read 2"},
        {"v 1 nan 3\n", "a.obj:1: read 'nan'; expected 3 coordinates, read 1"},
        {"v 1 2 1e99\n",
         "a.obj:1: '1e99' is beyond what single-precision numbers hold; expected 3 coordinates, read 2"},
        {"v 1,5 2 3\n", "a.obj:1: read '1,5'; expected the 3 coordinates of a vertex"},
        {"v 1 2 3 red\n", "a.obj:1: read 'red'; expected a weight or a colour behind the coordinates"},
        {"\nvt\n", "a.obj:2: the line ends early; expected 1 to 3 texture coordinates"},
        {"vt 0 one\n", "a.obj:1: read 'one'; expected a texture coordinate"},
        {"vn 0 1\n", "a.obj:1: the line ends early; expected 3 components, read 2"},
        {square + "f 1 2 5\n", "a.obj:5: the face refers to vertex 5; there are 4 so far"},
        {square + "f 1 2 -5\n", "a.obj:5: the face refers to vertex -5; there are 4 so far"},
        {square + "f 0 1 2\n", "a.obj:5: the face refers to vertex 0; indices count from 1"},
        {square + "f 1 2 99999999999\n",
         "a.obj:5: the face refers to vertex 99999999999; there are 4 so far"},
        {square + "f 1 2 2147483648\n", "a.obj:5: the face refers to vertex 2147483648; there are 4 so far"},
        {square + "f 1/1 2 3\n", "a.obj:5: the face refers to texture coordinates 1; there are 0 so far"},
        {square + "f 1//7 2 3\n", "a.obj:5: the face refers to normal 7; there are 0 so far"},
        {square + "f a b c\n", "a.obj:5: read 'a'; expected a corner of a face, such as 3, 3/1 or 3/1/2"},
        {square + "f 1 2 3.5\n", "a.obj:5: read '3.5'; expected a corner of a face, such as 3, 3/1 or 3/1/2"},
        {square + "vt 0 0\nvn 0 0 1\nf 1/1/1/1 2 3\n",
         "a.obj:7: read '1/1/1/1'; expected a corner of a face, such as 3, 3/1 or 3/1/2"},
        {square + "f 1 2 3\\\n x\n",
         "a.obj:5: read 'x'; expected a corner of a face, such as 3, 3/1 or 3/1/2"},
        {square + "s two\nf 1 2 3\n", "a.obj:5: read smoothing group 'two'; expected a number or 'off'"},
        {square + "s -1\nf 1 2 3\n", "a.obj:5: read smoothing group '-1'; expected a number or 'off'"},
    };
    for (const auto& c : cases) EXPECT_EQ(obj_error(c.text), c.sentence) << c.text;
}

// Files that would take hours or all memory of a careless reader.
TEST_F(ObjFile, HostileFilesTakeNoTime) {
    std::string polygon = square, fan = square;
    for (int i = 0; i < 20000; ++i) {
        polygon += "v " + std::to_string(i % 7) + " " + std::to_string(i * i % 11) + " 0\n";
        fan += "v " + std::to_string(i) + " " + std::to_string(i % 2) + " " + std::to_string(i % 3) + "\n";
    }
    polygon += "f";
    for (int i = 1; i <= 20000; ++i) {
        polygon += " " + std::to_string(i);
        fan += "f 1 " + std::to_string(i + 4) + " " + std::to_string(i + 3) + "\n";
    }
    EXPECT_EQ(mesh(polygon + "\n").triangle_count(), 19998u);
    EXPECT_EQ(warnings_.messages().size(), 1u);
    EXPECT_EQ(mesh(fan).triangle_count(), 20000u);
    EXPECT_EQ(obj_error(std::string(100000, '\\')), "");
    EXPECT_TRUE(parse("").parts.empty());
}

} // namespace
} // namespace montelux
