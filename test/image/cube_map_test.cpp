#include "test/image/image_testing.h"
#include <cmath>

#include "montelux/image/cube_map.h"
#include "montelux/mc/math/constants.h"

namespace montelux {
namespace {

TEST(CubeMap, FacesStandAsInOpenGl) {
    // (s, t) by table 8.19 of the OpenGL 4.6 core specification: sc, tc and ma of each face.
    struct Row {
        CubeFace face;
        Vec3d sc, tc, ma;
    };
    const Row rows[] = {{CubeFace::positive_x, {0, 0, -1}, {0, -1, 0}, {1, 0, 0}},
                        {CubeFace::negative_x, {0, 0, 1}, {0, -1, 0}, {-1, 0, 0}},
                        {CubeFace::positive_y, {1, 0, 0}, {0, 0, 1}, {0, 1, 0}},
                        {CubeFace::negative_y, {1, 0, 0}, {0, 0, -1}, {0, -1, 0}},
                        {CubeFace::positive_z, {1, 0, 0}, {0, -1, 0}, {0, 0, 1}},
                        {CubeFace::negative_z, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}}};
    for (const Row& row : rows) {
        const int face = static_cast<int>(row.face);
        for (double s : {0.1, 0.5, 0.8})
            for (double t : {0.2, 0.5, 0.95}) {
                const Vec3d d = cube_direction({face, s, t});
                const double ma = dot(row.ma, d);
                EXPECT_NEAR(length(d), 1, 1e-15);
                EXPECT_GT(ma, 0.5);
                EXPECT_NEAR((dot(row.sc, d) / ma + 1) / 2, s, 1e-14) << face;
                EXPECT_NEAR((dot(row.tc, d) / ma + 1) / 2, t, 1e-14) << face;
            }
    }
}

TEST(CubeMap, DirectionsComeBackToTheirTexels) {
    for (int size : {1, 2, 5, 16})
        for (int face = 0; face < cube_faces; ++face)
            for (int y = 0; y < size; ++y)
                for (int x = 0; x < size; ++x) {
                    const CubeTexel texel{face, x, y};
                    EXPECT_EQ(cube_texel(cube_texel_direction(texel, size), size), texel);
                }
    // Edges and corners belong to some texel, and scale does not matter.
    for (double x : {-1.0, 0.0, 1.0})
        for (double y : {-1.0, 0.0, 1.0})
            for (double z : {-1.0, 0.0, 1.0}) {
                if (x == 0 && y == 0 && z == 0) continue;
                const CubeTexel texel = cube_texel({x, y, z}, 4);
                EXPECT_TRUE(texel.face >= 0 && texel.face < 6 && texel.x >= 0 && texel.x < 4 &&
                            texel.y >= 0 && texel.y < 4);
                EXPECT_EQ(cube_texel({1e9 * x, 1e9 * y, 1e9 * z}, 4), texel);
            }
}

TEST(CubeMap, SolidAnglesAreExact) {
    for (int size : {1, 3, 8, 256}) {
        double sum = 0;
        for (int y = 0; y < size; ++y)
            for (int x = 0; x < size; ++x) sum += cube_texel_solid_angle(x, y, size);
        EXPECT_NEAR(sum, 4 * pi / 6, 1e-12);
    }
    // By the midpoint rule with the density (1 + a^2 + b^2)^(-3/2) of the sphere's area over a face.
    const int size = 4, cells = 200;
    for (auto [x, y] : {std::pair{0, 0}, {1, 2}, {3, 1}}) {
        double sum = 0;
        for (int j = 0; j < cells; ++j)
            for (int i = 0; i < cells; ++i) {
                const double a = 2 * (x + (i + 0.5) / cells) / size - 1;
                const double b = 2 * (y + (j + 0.5) / cells) / size - 1;
                sum += std::pow(1 + a * a + b * b, -1.5);
            }
        const double cell = 2.0 / size / cells;
        EXPECT_NEAR(cube_texel_solid_angle(x, y, size), sum * cell * cell, 1e-6);
    }
}

TEST(CubeMap, ChainsAreChecked) {
    CubeMapChain chain;
    expect_error([&] { check_cube_map_chain("chain", chain); }, {"chain: ", "no level"});
    for (int size : {5, 2, 1}) chain.levels.push_back(make_cube_map(size));
    EXPECT_NO_THROW(check_cube_map_chain("chain", chain));
    EXPECT_EQ(level_count(5), 3);
    EXPECT_EQ(level_count(256), 9);
    EXPECT_EQ(level_size(256, 8), 1);
    EXPECT_EQ(level_size(256, 40), 1);
    chain.levels.push_back(make_cube_map(1));
    expect_error([&] { check_cube_map_chain("chain", chain); }, {"level 3", "size 1"});
    chain.levels.pop_back();
    chain.levels[1] = make_cube_map(3);
    expect_error([&] { check_cube_map_chain("chain", chain); }, {"level 1", "size 3", "expected 2"});
    chain.levels[1] = make_cube_map(2);
    chain.levels[2].faces[4] = Image(1, 1, {"Y"});
    expect_error([&] { check_cube_map_chain("chain", chain); }, {"level 2", "R, G, B"});
    expect_error([] { make_cube_map(0); }, {"0 x 0"});
}

} // namespace
} // namespace montelux
