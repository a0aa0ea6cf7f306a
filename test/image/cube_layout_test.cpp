#include "test/image/image_testing.h"
#include <cmath>
#include <gtest/gtest.h>

#include "montelux/image/cube_layout.h"

namespace montelux {
namespace {

// Each texel holds the direction that it sees.
CubeMap directions(int size) {
    CubeMap map = make_cube_map(size);
    for (int f = 0; f < cube_faces; ++f)
        for (int y = 0; y < size; ++y)
            for (int x = 0; x < size; ++x) {
                const Vec3d d = cube_texel_direction({f, x, y}, size);
                for (int c = 0; c < 3; ++c) map.faces[f].set(x, y, c, static_cast<float>(d[c]));
            }
    return map;
}

Vec3d pixel(const Image& image, int x, int y) {
    return {image.value(x, y, 0), image.value(x, y, 1), image.value(x, y, 2)};
}

TEST(CubeLayout, TheCrossIsConnected) {
    constexpr int n = 16;
    const Image cross = lay_out(directions(n), CubeLayout::horizontal_cross);
    ASSERT_EQ(cross.width(), 4 * n);
    ASSERT_EQ(cross.height(), 3 * n);
    const double near = 3.0 / n;
    for (int y = 0; y < 3 * n; ++y)
        for (int x = 0; x < 4 * n; ++x) {
            const bool used = y / n == 1 || x / n == 1;
            const Vec3d here = pixel(cross, x, y);
            ASSERT_NEAR(length(here), used ? 1 : 0, 1e-6);
            if (!used) continue;
            // Pixels side by side see nearly the same, across edges too.
            if (x + 1 < 4 * n && (y / n == 1 || (x + 1) / n == 1)) {
                ASSERT_LT(length(pixel(cross, x + 1, y) - here), near) << x << " " << y;
            }
            if (y + 1 < 3 * n && (x / n == 1 || (y + 1) / n == 1)) {
                ASSERT_LT(length(pixel(cross, x, y + 1) - here), near) << x << " " << y;
            }
        }
    for (int y = n; y < 2 * n; ++y) EXPECT_LT(length(pixel(cross, 0, y) - pixel(cross, 4 * n - 1, y)), near);
    // +Z is the middle of the second cell of the second row, +Y above it.
    EXPECT_GT(pixel(cross, n + n / 2, n + n / 2).z, 0.99);
    EXPECT_GT(pixel(cross, n + n / 2, n / 2).y, 0.99);
    EXPECT_GT(pixel(cross, 2 * n + n / 2, n + n / 2).x, 0.99);
}

TEST(CubeLayout, StripsHoldTheFacesInOrder) {
    constexpr int n = 4;
    const CubeMap map = directions(n);
    const Image vertical = lay_out(map, CubeLayout::vertical_strip);
    const Image horizontal = lay_out(map, CubeLayout::horizontal_strip);
    ASSERT_EQ(vertical.width(), n);
    ASSERT_EQ(vertical.height(), 6 * n);
    ASSERT_EQ(horizontal.width(), 6 * n);
    ASSERT_EQ(horizontal.height(), n);
    for (int f = 0; f < cube_faces; ++f)
        for (int y = 0; y < n; ++y)
            for (int x = 0; x < n; ++x) {
                EXPECT_EQ(pixel(vertical, x, f * n + y), pixel(map.faces[f], x, y));
                EXPECT_EQ(pixel(horizontal, f * n + x, y), pixel(map.faces[f], x, y));
            }
}

TEST(CubeLayout, FacesHaveNames) {
    EXPECT_EQ(cube_face_path("a/sky.exr", CubeFace::positive_x), "a/sky_px.exr");
    EXPECT_EQ(cube_face_path("sky.v2.png", CubeFace::negative_z, 3), "sky.v2_m3_nz.png");
    for (CubeLayout layout :
         {CubeLayout::horizontal_cross, CubeLayout::vertical_strip, CubeLayout::horizontal_strip})
        EXPECT_EQ(cube_layout_named(name_of(layout)), layout);
    EXPECT_FALSE(cube_layout_named("star"));
}

TEST(CubeLayout, TheContactSheetShowsEveryFaceOfEveryLevel) {
    CubeMapChain chain;
    for (int level = 0; level < 4; ++level) {
        chain.levels.push_back(make_cube_map(level_size(12, level)));
        for (int f = 0; f < cube_faces; ++f) {
            auto samples = chain.levels[level].faces[f].f32();
            std::fill(samples.begin(), samples.end(), 0.5f + static_cast<float>(level * 6 + f));
        }
    }
    // Cells smaller than, as large as, and larger than faces, by no whole factor.
    for (int cell : {1, 5, 12, 17}) {
        const ContactSheet sheet = contact_sheet(chain, cell);
        ASSERT_EQ(sheet.picture.width(), 6 * (cell + 2) + 2);
        ASSERT_EQ(sheet.picture.height(), 4 * (cell + 2) + 2);
        for (int y = 0; y < sheet.picture.height(); ++y)
            for (int x = 0; x < sheet.picture.width(); ++x) {
                const int f = x / (cell + 2), level = y / (cell + 2);
                const bool bar = x % (cell + 2) < 2 || y % (cell + 2) < 2;
                ASSERT_EQ(sheet.picture.value(x, y, 1), bar ? 0 : 0.5f + static_cast<float>(level * 6 + f));
            }
        EXPECT_NEAR(0.18 / std::exp2(sheet.exposure), 8.957, 0.001); // log-average of 0.5, 1.5 ... 23.5
    }
}

TEST(CubeLayout, CellsKeepTheMeanAndTheOrientation) {
    CubeMapChain chain{{directions(8)}};
    const ContactSheet sheet = contact_sheet(chain, 4);
    for (int f = 0; f < cube_faces; ++f)
        for (int y = 0; y < 4; ++y)
            for (int x = 0; x < 4; ++x) {
                const Vec3d d = pixel(sheet.picture, 2 + f * 6 + x, 2 + y);
                EXPECT_LT(length(d - cube_texel_direction({f, x, y}, 4)), 0.03);
            }
}

TEST(CubeLayout, BadInputGivesASentence) {
    expect_error([] { contact_sheet({}, 8); }, {"contact sheet", "no level"});
    expect_error([] { contact_sheet({{make_cube_map(1)}}, 0); }, {"contact sheet", "size of 0"});
    expect_error([] { contact_sheet({{make_cube_map(1)}}, 20000); }, {"contact sheet", "65536"});
}

} // namespace
} // namespace montelux
