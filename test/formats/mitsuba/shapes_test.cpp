// Shapes of Mitsuba scenes: geometry, sides, texture coordinates, groups.
#include "test/formats/mitsuba/whole_scene.h"
#include <cmath>
#include <gtest/gtest.h>

#include "montelux/mc/math/constants.h"
#include "montelux/scene/shape/quadric.h"

namespace montelux::mitsuba_shapes {
namespace {

using test::bytes_of;
using test::load_scene_text;
using test::scene_text_error;
using test::WholeScene;

std::string shape(const std::string& type, const std::string& content = "") {
    return "<shape type=\"" + type + "\">" + content + "</shape>";
}
const std::string mirrored = R"(<transform name="to_world"><scale x="-1"/></transform>)",
                  flipped = R"(<boolean name="flip_normals" value="true"/>)";

// The first hit of the only quadric: normal on the front side, and texture coordinates.
struct Seen {
    Vec3d p, n;
    Point2f uv;
    Vec3d dpdu;
};
Seen seen(const WholeScene& s, Point3f o, Vec3f d) {
    const Ray ray{.o = o, .d = d};
    const Quadric& quadric = s.scene().quadrics.at(0);
    const auto t = intersect(quadric, ray, 0);
    if (!t) throw Error("test", "the ray misses");
    const QuadricPoint q = point_at(quadric, ray, *t, true);
    return {q.p, s.scene().shapes.at(0).flip_normal ? -q.n : q.n, q.uv, q.dpdu};
}
void expect_near(Vec3d a, Vec3d b, double tolerance = 1e-3) {
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], tolerance) << "component " << i;
}
void expect_uv(Point2f uv, double u, double v) {
    EXPECT_NEAR(uv.x, u, 1e-3);
    EXPECT_NEAR(uv.y, v, 1e-3);
}

// The numbers of this and the next tests are those of Mitsuba 3.9.1.
TEST(MitsubaShapes, Spheres) {
    const auto from_above = [](const std::string& content) {
        return seen(load_scene_text(shape("sphere", content)), {0.3f, 0.2f, 5}, {0, 0, -1});
    };
    const Vec3d out{0.3, 0.2, 0.9327};
    const Seen plain = from_above("");
    expect_near(plain.n, out);
    expect_uv(plain.uv, 0.0936, 0.1174);
    expect_near(plain.dpdu, {-1.257, 1.885, 0});
    expect_near(from_above(flipped).n, -out);
    const Seen mirror = from_above(mirrored);
    expect_near(mirror.n, -out);
    expect_uv(mirror.uv, 0.4064, 0.1174);
    expect_near(from_above(mirrored + flipped).n, out);
    const Seen negative = from_above(R"(<float name="radius" value="-1"/>)");
    expect_near(negative.n, -out);
    expect_uv(negative.uv, 0.5936, 0.8826);

    const WholeScene placed = load_scene_text(
        shape("sphere", R"(<point name="center" x="1" y="2" z="3"/><float name="radius" value="2"/>
                     <transform name="to_world"><scale value="3"/><translate x="10"/></transform>)"));
    const auto ball = whole_sphere(placed.scene().quadrics.at(0));
    ASSERT_TRUE(ball);
    expect_near(ball->center, {13, 6, 9});
    EXPECT_NEAR(ball->radius, 6, 1e-6);
    const WholeScene uneven =
        load_scene_text(shape("sphere", R"(<transform name="to_world"><scale x="2"/></transform>)"));
    EXPECT_TRUE(uneven.warns("scales unevenly"));
    EXPECT_NEAR(whole_sphere(uneven.scene().quadrics.at(0))->radius, 2, 1e-6);
    EXPECT_NE(scene_text_error(shape("sphere", R"(<float name="radius" value="0"/>)")).find("no extent"),
              std::string::npos);
}

TEST(MitsubaShapes, Disks) {
    const auto from_above = [](const std::string& content) {
        return seen(load_scene_text(shape("disk", content)), {0.3f, 0.2f, 5}, {0, 0, -1});
    };
    const Seen plain = from_above("");
    expect_near(plain.n, {0, 0, 1});
    expect_uv(plain.uv, 0.3606, 0.0936);
    expect_near(plain.dpdu, {0.832, 0.555, 0});
    expect_near(from_above(flipped).n, {0, 0, -1});
    const Seen mirror = from_above(mirrored);
    expect_near(mirror.n, {0, 0, 1});
    expect_uv(mirror.uv, 0.3606, 0.4064);
}

TEST(MitsubaShapes, Cylinders) {
    const auto from_the_side = [](const std::string& content) {
        return seen(load_scene_text(shape("cylinder", content)), {5, 0.2f, 0.3f}, {-1, 0, 0});
    };
    const Vec3d out{0.9798, 0.2, 0};
    const Seen plain = from_the_side("");
    expect_near(plain.n, out);
    expect_uv(plain.uv, 0.032, 0.3);
    expect_near(from_the_side(flipped).n, -out);
    const Seen mirror = from_the_side(mirrored);
    expect_near(mirror.n, out);
    expect_uv(mirror.uv, 0.468, 0.3);
    expect_near(from_the_side(R"(<float name="radius" value="-1"/>)").n, out);
    const Seen slanted = seen(load_scene_text(shape("cylinder", R"(<point name="p0" x="1" y="2" z="3"/>
                 <point name="p1" x="2" y="4" z="6"/><float name="radius" value="0.5"/>)")),
                              {6.5f, 3, 4.5f}, {-1, 0, 0});
    expect_near(slanted.p, {2.0189, 3, 4.5});
    expect_near(slanted.n, {0.9636, -0.1482, -0.2224});
    expect_uv(slanted.uv, 0.9869, 0.5371);
    EXPECT_NE(scene_text_error(shape("cylinder", R"(<point name="p1" value="0, 0, 0"/>)")).find("no extent"),
              std::string::npos);
}

TEST(MitsubaShapes, Rectangles) {
    const WholeScene s = load_scene_text(shape("rectangle"));
    const TriangleMesh& mesh = s.scene().meshes.at(0);
    ASSERT_EQ(mesh.triangle_count(), 2u);
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_FLOAT_EQ(mesh.uvs[i].x, (mesh.positions[i].x + 1) / 2);
        EXPECT_FLOAT_EQ(mesh.uvs[i].y, (mesh.positions[i].y + 1) / 2);
        EXPECT_EQ(mesh.normals[i], Normal3f(0, 0, 1));
    }
    const auto normal = [](const std::string& content) {
        return load_scene_text(shape("rectangle", content)).scene().meshes.at(0).normals.at(0).z;
    };
    EXPECT_EQ(normal(flipped), -1);
    EXPECT_EQ(normal(mirrored), 1);
    EXPECT_EQ(normal(R"(<transform name="to_world"><scale z="-1"/></transform>)"), -1);
}

// The direction of the triangles around the outside of each face, and its texture.
TEST(MitsubaShapes, Cubes) {
    const WholeScene s = load_scene_text(shape("cube"));
    const TriangleMesh& mesh = s.scene().meshes.at(0);
    ASSERT_EQ(mesh.triangle_count(), 12u);
    for (std::size_t t = 0; t < 12; ++t) {
        const auto vertex = [&](std::size_t k) { return Vec3d(mesh.positions[mesh.indices[3 * t + k]]); };
        const Vec3d n = normalize(cross(vertex(1) - vertex(0), vertex(2) - vertex(0)));
        for (std::size_t k = 0; k < 3; ++k) {
            expect_near(n, Vec3d(mesh.normals[mesh.indices[3 * t + k]]));
            EXPECT_DOUBLE_EQ(dot(n, vertex(k)), 1);
        }
    }
    // On top, u grows along y, and v along x.
    for (std::size_t i = 0; i < 24; ++i)
        if (mesh.normals[i].z > 0) {
            EXPECT_FLOAT_EQ(mesh.uvs[i].x, (mesh.positions[i].y + 1) / 2);
            EXPECT_FLOAT_EQ(mesh.uvs[i].y, (mesh.positions[i].x + 1) / 2);
        }
    EXPECT_TRUE(load_scene_text(shape("cube", mirrored)).scene().shapes.at(0).flip_normal);
}

// A square of two triangles that meet at a right angle, without normals.
constexpr std::string_view folded = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 0 1\nvt 0.25 0.125\n"
                                    "f 1/1 2/1 3/1\nf 1/1 4/1 2/1\n";

TEST(MitsubaShapes, ObjFiles) {
    const auto load = [](const std::string& content) {
        return load_scene_text(shape("obj", R"(<string name="filename" value="a.obj"/>)" + content),
                               {{"a.obj", bytes_of(folded)}});
    };
    const TriangleMesh smooth = load("").scene().meshes.at(0);
    ASSERT_EQ(smooth.normals.size(), smooth.positions.size());
    EXPECT_EQ(smooth.uvs.at(0), Point2f(0.25f, 0.875f));
    for (std::size_t i = 0; i < smooth.positions.size(); ++i) {
        // At the first vertex the angles are 45 and 90 degrees; the normals are +z and +y.
        if (smooth.positions[i] == Point3f(0, 0, 0))
            expect_near(Vec3d(smooth.normals[i]), normalize(Vec3d(0, 2, 1)), 1e-6);
        if (smooth.positions[i] == Point3f(1, 1, 0)) expect_near(Vec3d(smooth.normals[i]), {0, 0, 1});
    }
    EXPECT_TRUE(load(R"(<boolean name="face_normals" value="true"/>)").scene().meshes.at(0).normals.empty());
    EXPECT_EQ(load(R"(<boolean name="flip_tex_coords" value="false"/>)").scene().meshes.at(0).uvs.at(0).y,
              0.125f);
    EXPECT_NEAR(load(flipped).scene().meshes.at(0).normals.at(2).z, -1, 1e-6);
    const TriangleMesh moved =
        load(R"(<transform name="to_world"><translate x="5"/></transform>)").scene().meshes.at(0);
    EXPECT_EQ(moved.positions.at(0), Point3f(5, 0, 0));
    EXPECT_NE(scene_text_error(shape("obj", R"(<string name="filename" value="b.obj"/>)")).find("b.obj"),
              std::string::npos);
    EXPECT_NE(scene_text_error(shape("obj", R"(<string name="filename" value="a.obj"/>)"),
                               {{"a.obj", bytes_of("v 0 0 0\nf 1 2 3\n")}})
                  .find("a.obj"),
              std::string::npos);
    EXPECT_NE(scene_text_error(shape("obj")).find("needs the property 'filename'"), std::string::npos);
}

TEST(MitsubaShapes, PlyFiles) {
    const std::string text = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                             "property float z\nproperty float u\nproperty float v\nelement face 1\n"
                             "property list uchar int vertex_indices\nend_header\n"
                             "0 0 0 0.5 0.25\n1 0 0 0 0\n0 1 0 0 1\n3 0 1 2\n";
    const WholeScene s = load_scene_text(shape("ply", R"(<string name="filename" value="a.ply"/>)"),
                                         {{"a.ply", bytes_of(text)}});
    const TriangleMesh& mesh = s.scene().meshes.at(0);
    EXPECT_EQ(mesh.uvs.at(0), Point2f(0.5f, 0.25f));
    EXPECT_EQ(mesh.normals.at(0), Normal3f(0, 0, 1));
}

TEST(MitsubaShapes, Curves) {
    const auto load = [](const std::string& type, const std::string& text, const std::string& content = "") {
        return load_scene_text(shape(type, R"(<string name="filename" value="c.txt"/>)" + content),
                               {{"c.txt", bytes_of(text)}});
    };
    const std::string straight = "0 0 0 1\n1 0 0 1\n2 0 0 1\n3 0 0 4\n";
    const WholeScene spline = load("bsplinecurve", straight + "\n\n" + straight + "4 0 0 4\n");
    const Curves& curves = spline.scene().curves.at(0);
    ASSERT_EQ(curves.segment_count(), 3u); // one and two
    EXPECT_EQ(curves.control_points[0][0], Point3f(1, 0, 0));
    EXPECT_EQ(curves.control_points[0][3], Point3f(2, 0, 0));
    EXPECT_FLOAT_EQ(curves.widths[0][0], 2);
    EXPECT_FLOAT_EQ(curves.widths[0][1], 2 * (1 + 4 + 4) / 6.0f);
    const WholeScene polyline = load("linearcurve", "0 0 0 1\n3 0 0 2",
                                     R"(<transform name="to_world"><scale value="2"/></transform>)");
    const Curves& line = polyline.scene().curves.at(0);
    ASSERT_EQ(line.segment_count(), 1u);
    EXPECT_EQ(line.control_points[0][1], Point3f(2, 0, 0));
    EXPECT_FLOAT_EQ(line.widths[0][1], 4); // not scaled
    const auto error = [](const std::string& text) {
        return scene_text_error(shape("bsplinecurve", R"(<string name="filename" value="c.txt"/>)"),
                                {{"c.txt", bytes_of(text)}});
    };
    EXPECT_NE(error("0 0 0 1\n1 0 0 1\n").find("c.txt:2: a B-spline curve of 2 control points"),
              std::string::npos);
    EXPECT_NE(error("0 0 0 1\n1 0 0\n").find("c.txt:2: the control point is '1 0 0'"), std::string::npos);
    EXPECT_NE(error("0 0 0 -1\n").find("radius"), std::string::npos);
    EXPECT_NE(error("\n").find("no control points"), std::string::npos);
}

TEST(MitsubaShapes, GroupsAndInstances) {
    const WholeScene s = load_scene_text(R"(
        <shape type="shapegroup" id="g"><shape type="sphere"/><shape type="cube" id="box"/></shape>
        <shape type="instance"><ref id="g"/></shape>
        <shape type="instance"><ref id="g"/>
            <transform name="to_world"><translate x="3"/></transform></shape>
        <shape type="merge"><shape type="disk"/><shape type="cylinder"/></shape>)");
    EXPECT_EQ(s.scene().world_shapes.size(), 2u);
    ASSERT_EQ(s.scene().objects.size(), 1u);
    EXPECT_EQ(s.scene().objects[0].shapes.size(), 2u);
    ASSERT_EQ(s.scene().instances.size(), 2u);
    EXPECT_EQ(s.scene().instances[1].world_from_object.point(Point3f()), Point3f(3, 0, 0));
    EXPECT_EQ(s.scene().shape_names.at(1), "box");
    // A group without instances is not shown.
    EXPECT_TRUE(
        load_scene_text(R"(<shape type="shapegroup"><shape type="sphere"/></shape>)").scene().shapes.empty());
    const auto error = [](const std::string& group, const std::string& rest = "") {
        return scene_text_error("<shape type=\"shapegroup\" id=\"g\">" + group +
                                "</shape><shape type=\"instance\"><ref id=\"g\"/></shape>" + rest);
    };
    EXPECT_NE(error(R"(<shape type="sphere"><emitter type="area"/></shape>)").find("cannot emit light"),
              std::string::npos);
    EXPECT_NE(error(R"(<shape type="shapegroup"/>)").find("shapegroup within"), std::string::npos);
    EXPECT_NE(
        error("", R"(<shape type="instance"><shape type="sphere"/></shape>)").find("needs a shapegroup"),
        std::string::npos);
}

TEST(MitsubaShapes, MaterialsAndNames) {
    const WholeScene s = load_scene_text(R"(
        <bsdf type="diffuse" id="red"><rgb name="reflectance" value="1, 0, 0"/></bsdf>
        <shape type="sphere" id="ball"><ref id="red"/></shape>
        <shape type="disk"><ref id="red"/></shape>
        <shape type="cube"/><shape type="rectangle"><emitter type="area"/></shape>)");
    ASSERT_EQ(s.scene().shapes.size(), 4u);
    const auto material = [&](std::size_t i) { return s.scene().shapes[i].material; };
    EXPECT_EQ(material(0), material(1));
    EXPECT_NE(material(1), material(2));
    EXPECT_EQ(s.scene().shape_names.at(0), "ball");
    // Shapes that shine reflect nothing unless they say so.
    const auto& dark = std::get<DiffuseMaterial>(s.scene().materials.at(material(3)));
    EXPECT_EQ(dark.reflectance.value.constant, 0);
    EXPECT_EQ(s.scene().shapes[3].light, 0u);
    EXPECT_NE(scene_text_error("<shape type=\"spere\"/>").find("did you mean 'sphere'"), std::string::npos);
    EXPECT_NE(scene_text_error("<shape type=\"sdfgrid\"/>").find("is not supported"), std::string::npos);
    EXPECT_TRUE(load_scene_text(R"(<shape type="sphere"><float name="radios" value="1"/></shape>)")
                    .warns("did you mean 'radius'"));
}

TEST(MitsubaShapes, TheSameShapeTwiceIsShownOnce) {
    const WholeScene s =
        load_scene_text(R"(<shape type="sphere" id="a"/><shape type="merge"><ref id="a"/></shape>)");
    EXPECT_EQ(s.scene().shapes.size(), 1u);
    EXPECT_TRUE(s.warns("several times"));
}

} // namespace
} // namespace montelux::mitsuba_shapes
