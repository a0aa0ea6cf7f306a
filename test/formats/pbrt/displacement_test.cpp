// 'displacement' of plymesh: textures, units, and what is refused.
#include "test/formats/pbrt/parse.h"
#include "test/temporary_folder.h"
#include <cmath>
#include <fstream>
#include <gtest/gtest.h>

#include "montelux/formats/mesh_displacement.h"
#include "montelux/image/image_write.h"

namespace montelux {
namespace {

class PbrtDisplacement : public ::testing::Test {
  protected:
    PbrtDisplacement() {
        const std::string header =
                              "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float "
                              "y\nproperty float z\n",
                          faces = "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
        std::ofstream(folder_ / "square.ply")
            << header << "property float u\nproperty float v\n"
            << faces << "0 0 0 0 0\n1 0 0 1 0\n1 1 0 1 1\n0 1 0 0 1\n4 0 1 2 3\n";
        std::ofstream(folder_ / "bare.ply") << header << faces << "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n";
        Image picture(2, 2, {"Y"}, PixelFormat::f32, ColorEncoding::linear());
        for (std::size_t i = 0; i < 4; ++i) picture.f32()[i] = 0.25f;
        write_image(folder_ / "quarter.pfm", picture);
    }
    TriangleMesh mesh(const std::string& world, const std::string& options = "") {
        Warnings ignored;
        return parse_pbrt(options + "\nWorldBegin\n" + world, "scene", folder_.path(), ignored)
            .scene.meshes.at(0);
    }
    std::string error(const std::string& world, const std::string& options = "") {
        try {
            mesh(world, options);
        } catch (const Error& e) {
            return e.what();
        }
        return "";
    }

    TemporaryFolder folder_;
    const std::string
        slope = "Texture \"h\" \"float\" \"bilerp\" \"float v00\" 0 \"float v10\" 0.5 \"float v01\" 0 "
                "\"float v11\" 0.5\n",
        shape = "Shape \"plymesh\" \"string filename\" \"square.ply\" \"texture displacement\" \"h\" ";
};

// Triangles with edges of at most l have at most the area sqrt(3) / 4 l^2.
TEST_F(PbrtDisplacement, TheLimitIsOneOfAllShapesTogether) {
    const auto of_at_least = [&](double triangles) {
        const double longest = std::sqrt(4 / std::sqrt(3.0) / triangles); // on a square of area 1
        return shape + "\"float edgelength\" " + std::to_string(1e3 * longest) + "\n";
    };
    const std::string options = "Option \"float displacementedgescale\" 1e-3";
    const std::string first = of_at_least(1 << 16), second = of_at_least(max_displaced_triangles);
    const std::size_t taken = mesh(slope + first, options).triangle_count();
    EXPECT_GE(taken, 1u << 16);
    EXPECT_NE(error(slope + first + second, options)
                  .find("more triangles than the " + std::to_string(max_displaced_triangles - taken) +
                        " that the displaced shapes before leave of 33554432"),
              std::string::npos);
}

TEST_F(PbrtDisplacement, HeightsAreInObjectSpaceAndEdgesInTheWorld) {
    const TriangleMesh plain = mesh(slope + shape);
    EXPECT_EQ(plain.triangle_count(), 8u); // the diagonal and the sides are not shorter than 1
    const TriangleMesh fine = mesh(slope + "Scale 2 2 2\n" + shape + "\"float edgelength\" 0.5");
    EXPECT_GT(fine.triangle_count(), 32u);
    for (const Point3f p : fine.positions) EXPECT_FLOAT_EQ(p.z, 0.5f * p.x);
    const TriangleMesh scaled = mesh(slope + "Scale 2 2 2\n" + shape + "\"float edgelength\" 0.25",
                                     "Option \"float displacementedgescale\" 2");
    EXPECT_EQ(scaled.positions, fine.positions);
    const TriangleMesh sheared = mesh(slope + "Scale 1 1 -3\n" + shape + "\"float edgelength\" 0.3");
    for (const Point3f p : sheared.positions) EXPECT_FLOAT_EQ(p.z, -1.5f * p.x);
}

TEST_F(PbrtDisplacement, ReadsPicturesAndNestedTextures) {
    const std::string nested = "Texture \"p\" \"float\" \"imagemap\" \"string filename\" \"quarter.pfm\"\n"
                               "Texture \"s\" \"float\" \"scale\" \"texture tex\" \"p\" \"float scale\" 2\n"
                               "Texture \"h\" \"float\" \"mix\" \"texture tex1\" \"s\" \"texture tex2\" "
                               "\"p\" \"float amount\" 0.5\n";
    for (const Point3f p : mesh(nested + shape).positions) EXPECT_FLOAT_EQ(p.z, 0.375f);
    // Of several pictures each texture reads its own; a picture that is transparent somewhere gives its alpha.
    Image half(2, 2, {"Y"}, PixelFormat::f32, ColorEncoding::linear()),
        clear(2, 2, {"R", "G", "B", "A"}, PixelFormat::f32, ColorEncoding::linear());
    for (float& v : half.f32()) v = 0.5f;
    for (float& v : clear.f32()) v = 1;
    for (std::size_t i = 3; i < 16; i += 4) clear.f32()[i] = 0.75f;
    write_image(folder_ / "half.pfm", half);
    write_image(folder_ / "clear.exr", clear);
    const std::string pictures = "Texture \"p\" \"float\" \"imagemap\" \"string filename\" \"half.pfm\"\n"
                                 "Texture \"q\" \"float\" \"imagemap\" \"string filename\" \"quarter.pfm\"\n"
                                 "Texture \"a\" \"float\" \"imagemap\" \"string filename\" \"clear.exr\"\n"
                                 "Texture \"h\" \"float\" \"mix\" \"texture tex1\" \"p\" \"texture tex2\" "
                                 "\"a\" \"texture amount\" \"q\"\n";
    for (const Point3f p : mesh(pictures + shape).positions)
        EXPECT_FLOAT_EQ(p.z, 0.75f * 0.5f + 0.25f * 0.75f);
    // Spaces of textures are those of the world.
    const std::string planar = "Texture \"h\" \"float\" \"checkerboard\" \"integer dimension\" 3\n";
    for (const Point3f p : mesh(planar + "Translate 0 0 1\n" + shape).positions)
        EXPECT_FLOAT_EQ(p.z, p.x == 1 || p.y == 1 ? (p.x == p.y ? 1 : 2) : 1);
    // A number needs no texture coordinates.
    for (const Point3f p :
         mesh("Shape \"plymesh\" \"string filename\" \"bare.ply\" \"float displacement\" 3").positions)
        EXPECT_EQ(p.z, 3);
}

TEST_F(PbrtDisplacement, MistakesAreNamed) {
    EXPECT_NE(error(slope + shape + "\"float edgelength\" 0").find("must be positive"), std::string::npos);
    EXPECT_NE(error(slope + shape + "\"float edgelength\" 1e-6").find("leave of 33554432"),
              std::string::npos);
    EXPECT_NE(error(shape).find("no float texture 'h'"), std::string::npos);
    EXPECT_NE(
        error(slope + "Shape \"plymesh\" \"string filename\" \"bare.ply\" \"texture displacement\" \"h\"")
            .find("no texture coordinates"),
        std::string::npos);
    EXPECT_NE(error("", "Option \"float displacementedgescale\" 0").find("must be positive"),
              std::string::npos);
}

} // namespace
} // namespace montelux
