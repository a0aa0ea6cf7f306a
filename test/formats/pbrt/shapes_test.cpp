// Shapes of pbrt's files: their values, and where they are.
#include "test/formats/pbrt/parse.h"
#include "test/near.h"
#include <gtest/gtest.h>
#include <string>
#include <vector>

namespace montelux {
namespace {

using test::parse_world;
using test::sphere;

TEST(PbrtShapes, Quadrics) {
    SceneDescription d =
        parse_world("Shape \"sphere\" \"float radius\" 2 \"float zmin\" 1 \"float zmax\" -5 "
                    "\"float phimax\" 180 \"float alpha\" 0.5 Shape \"sphere\" Shape \"disk\" Scale -1 "
                    "1 1 Shape \"sphere\" ReverseOrientation Shape \"sphere\" Identity Shape \"disk\"");
    EXPECT_EQ(sphere(d, 0).z_min, -2);
    EXPECT_EQ(sphere(d, 0).z_max, 1);
    EXPECT_FLOAT_EQ(sphere(d, 0).phi_max, 3.14159265f);
    EXPECT_EQ(d.scene.shapes[0].alpha.value, 0.5f);
    EXPECT_EQ(sphere(d, 1).radius, 1);
    EXPECT_EQ(sphere(d, 1).z_min, -1);
    const Disk& disk = std::get<Disk>(d.scene.quadrics[2]);
    EXPECT_EQ(disk.radius, 1);
    EXPECT_EQ(disk.inner_radius + disk.height, 0);
    bool flips[] = {false, false, false, true, false, true};
    for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(d.scene.shapes[i].flip_normal, flips[i]) << i;
    EXPECT_EQ(d.scene.world_shapes, (std::vector<Index>{0, 1, 2, 3, 4, 5}));
}

TEST(PbrtShapes, BilinearMeshes) {
    const std::string flat = " \"point3 P\" [0 0 0  1 0 0  0 1 0  1 1 0]",
                      bent = " \"point3 P\" [0 0 0  1 0 0  0 1 0  1 1 1]";
    const SceneDescription d =
        parse_world("Scale 2 2 -2 Shape \"bilinearmesh\"" + flat + "Shape \"bilinearmesh\"" + bent +
                    " \"point2 uv\" [0 0 2 0 0 2 2 2] \"integer indices\" [0 1 2 3 1 0 3 2 7]" +
                    "ReverseOrientation Shape \"bilinearmesh\" \"normal N\" [0 0 1 0 0 1 0 0 1 0 0 1]" +
                    flat + "Shape \"bilinearmesh\" \"point2 uv\" [0 0 2 0 0 2 2 3]" + flat +
                    "AreaLightSource \"diffuse\" \"float power\" 3 Shape \"bilinearmesh\"" + flat);
    ASSERT_EQ(d.scene.shapes.size(), 5u);
    ASSERT_EQ(d.scene.meshes.size(), 1u); // the parallelogram
    const TriangleMesh& mesh = d.scene.meshes[0];
    EXPECT_EQ(mesh.indices, (std::vector<Index>{0, 1, 3, 0, 3, 2}));
    EXPECT_EQ(mesh.uvs[3], (Point2f{1, 1}));
    ASSERT_EQ(d.scene.bilinear_meshes.size(), 4u);
    const BilinearMesh& patches = d.scene.bilinear_meshes[0];
    ASSERT_EQ(patches.patch_count(), 2u); // the ninth index is ignored with a warning
    expect_near(patches.positions[3], {2, 2, -2});
    EXPECT_EQ(patches.uvs[3], (Point2f{2, 2}));
    expect_near(normalize(d.scene.bilinear_meshes[1].normals[0]), {0, 0, 1}); // mirrored and reversed
    EXPECT_TRUE(d.scene.shapes[1].flip_normal);
    EXPECT_FALSE(d.scene.shapes[2].flip_normal);
    EXPECT_EQ(std::get<AreaLight>(d.scene.lights.at(0)).primitive_flux, 3);
    EXPECT_EQ(std::get<BilinearMeshIndex>(d.scene.shapes[4].geometry).index, 3u);
}

TEST(PbrtShapes, Curves) {
    const std::string points = " \"point3 P\" [0 0 0 1 0 0 2 0 0 3 0 0 4 0 0]";
    const SceneDescription d = parse_world(
        "Scale 2 2 -2 Shape \"curve\" \"string basis\" \"bspline\" \"float width0\" 1 \"float width1\" 3" +
        points +
        "Shape \"curve\" \"integer degree\" 2 \"string type\" \"ribbon\" \"float width\" 0.5 "
        "\"normal N\" [0 0 2 0 3 0 0 0 2]" +
        points);
    ASSERT_EQ(d.scene.curves.size(), 2u);
    const Curves &spline = d.scene.curves[0], &ribbon = d.scene.curves[1];
    EXPECT_EQ(spline.kind, Curves::Kind::flat);
    ASSERT_EQ(spline.segment_count(), 2u);
    expect_near(spline.control_points[0][0], {2, 0, 0}); // (0 + 4 * 1 + 2) / 6, twice as large
    expect_near(spline.control_points[1][3], {6, 0, 0});
    EXPECT_FLOAT_EQ(spline.widths[0][0], 2);
    EXPECT_FLOAT_EQ(spline.widths[0][1], 4);
    EXPECT_FLOAT_EQ(spline.widths[1][1], 6);
    EXPECT_TRUE(spline.normals.empty());
    EXPECT_EQ(ribbon.kind, Curves::Kind::ribbon);
    ASSERT_EQ(ribbon.segment_count(), 2u);
    EXPECT_FLOAT_EQ(ribbon.widths[1][1], 1);
    expect_near(ribbon.normals[0][0], {0, 0, -1});
    expect_near(ribbon.normals[0][1], {0, 1, 0});
    EXPECT_TRUE(d.scene.shapes[0].flip_normal);
}

TEST(PbrtShapes, VertexTangents) {
    const std::string mesh = "Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] ";
    Warnings warnings;
    const SceneDescription d =
        test::parse_world("Scale 1 2 3 Translate 4 5 6 " + mesh + "\"vector3 S\" [ 1 1 1  0 1 0  1 0 0 ] " +
                              mesh + "\"vector3 S\" [ 1 1 1 ] LightSource \"point\"",
                          &warnings);
    EXPECT_EQ(d.scene.meshes.at(0).tangents, (std::vector<Vec3f>{{1, 2, 3}, {0, 2, 0}, {1, 0, 0}}));
    EXPECT_TRUE(d.scene.meshes.at(1).tangents.empty());
    ASSERT_EQ(warnings.messages().size(), 1u);
    EXPECT_NE(warnings.messages()[0].find("parameter 'S' has 1 entries for 3 vertices; it is ignored"),
              std::string::npos);
}

// A head of hair in a file is a shape for each hair.
TEST(PbrtShapes, CurvesInARowAreOneShape) {
    const std::string curve = "Shape \"curve\" \"point3 P\" [0 0 0 1 0 0 2 0 0 3 0 0] ";
    const auto shapes = [&](const std::string& between) {
        const SceneDescription d = parse_world(curve + between + curve);
        std::size_t segments = 0;
        for (const Curves& c : d.scene.curves) segments += c.segment_count();
        EXPECT_EQ(segments, 2u) << between;
        EXPECT_EQ(d.scene.curves.size(),
                  d.scene.shapes.size() - (between.find("sphere") != std::string::npos));
        return d.scene.curves.size();
    };
    EXPECT_EQ(shapes(""), 1u);
    EXPECT_EQ(shapes("Translate 1 0 0 "), 1u);
    EXPECT_EQ(shapes("AttributeBegin AttributeEnd "), 1u);
    EXPECT_EQ(shapes("Material \"diffuse\" "), 2u);
    EXPECT_EQ(shapes("ReverseOrientation "), 2u);
    EXPECT_EQ(shapes("Shape \"sphere\" "), 2u);
    EXPECT_EQ(shapes("Attribute \"shape\" \"float alpha\" 0.5 "), 2u);
    EXPECT_EQ(shapes("Attribute \"shape\" \"string type\" \"cylinder\" "), 2u);
    EXPECT_EQ(shapes("MakeNamedMedium \"m\" \"string type\" \"homogeneous\" MediumInterface \"m\" \"\" "),
              2u);
    const std::string object = "ObjectBegin \"o\" " + curve + "ObjectEnd ";
    EXPECT_EQ(parse_world(curve + object + curve).scene.curves.size(), 3u);
    EXPECT_EQ(shapes("ActiveTransform EndTime Translate 1 0 0 "), 2u);
}

TEST(PbrtShapes, Cylinders) {
    const SceneDescription d = parse_world(
        "Shape \"cylinder\" Scale 1 1 -2 Shape \"cylinder\" \"float radius\" 0.5 \"float zmin\" 3 "
        "\"float zmax\" 2 \"float phimax\" 90");
    const Cylinder& whole = std::get<Cylinder>(d.scene.quadrics[0]);
    EXPECT_EQ(whole.radius, 1);
    EXPECT_EQ(whole.z_min, -1);
    EXPECT_EQ(whole.z_max, 1);
    EXPECT_FLOAT_EQ(whole.phi_max, 6.2831853f);
    EXPECT_FALSE(d.scene.shapes[0].flip_normal);
    const Cylinder& part = std::get<Cylinder>(d.scene.quadrics[1]);
    EXPECT_EQ(part.radius, 0.5f);
    EXPECT_EQ(part.z_min, 2);
    EXPECT_EQ(part.z_max, 3);
    EXPECT_FLOAT_EQ(part.phi_max, 1.5707963f);
    expect_near(part.world_from_object.point(Vec3f(0, 0, 1)), {0, 0, -2});
    EXPECT_TRUE(d.scene.shapes[1].flip_normal);
}

TEST(PbrtShapes, MeshesGoToTheWorld) {
    SceneDescription d = parse_world(R"(
        ReverseOrientation
        Translate 0 0 1 Scale -2 1 1
        Shape "trianglemesh" "point3 P" [ 0 0 0  1 0 0  0 1 0  1 1 1 ] "integer indices" [ 0 1 2 2 1 3 ]
            "normal N" [ 1 0 0  0 0 1  0 0 1  0 0 1 ] "point2 uv" [ 0 0 1 0 0 1 1 1 ])");
    const TriangleMesh& mesh = d.scene.meshes.at(0);
    EXPECT_EQ(mesh.positions[1], Vec3f(-2, 0, 1));
    // Normals go by the inverse transpose, and are turned around by ReverseOrientation alone.
    expect_near(mesh.normals[0], {0.5f, 0, 0});
    expect_near(mesh.normals[1], {0, 0, -1});
    EXPECT_EQ(mesh.uvs[3], Vec2f(1, 1));
    EXPECT_EQ(mesh.indices, (std::vector<Index>{0, 1, 2, 2, 1, 3}));
    EXPECT_FALSE(d.scene.shapes[0].flip_normal); // both reversed and mirrored
    EXPECT_TRUE(std::holds_alternative<MeshIndex>(d.scene.shapes[0].geometry));
}

TEST(PbrtShapes, WhatDoesNotFitAMeshIsLeftOut) {
    Warnings warnings;
    SceneDescription d = parse_world(
        "LightSource \"point\" Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"point2 uv\" [0 0] "
        "\"normal N\" [0 0 1] \"integer indices\" [0 1 2 0]",
        &warnings);
    EXPECT_EQ(warnings.messages().size(), 3u);
    EXPECT_EQ(d.scene.meshes[0].indices.size(), 3u);
    EXPECT_TRUE(d.scene.meshes[0].normals.empty() && d.scene.meshes[0].uvs.empty());
}

} // namespace
} // namespace montelux
