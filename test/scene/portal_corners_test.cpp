// Which four corners make a portal.
#include "test/scene/portal_testing.h"
#include <cmath>
#include <gtest/gtest.h>
#include <string>

#include "montelux/mc/math/error.h"

namespace montelux::portals {
namespace {

TEST(Portals, BadCornersGetASentence) {
    auto message = [](const std::array<Point3f, 4>& corners) -> std::string {
        try {
            Portal portal(corners);
            return "no error";
        } catch (const Error& e) {
            return e.what();
        }
    };
    EXPECT_EQ(message(corners_of(0, 0, 2, 1)), "no error");
    EXPECT_EQ(message({Point3f{0, 0, 0}, {0, 1, 0}, {0, 1, 0}, {1, 0, 0}}),
              "two corners of the portal are the same point");
    EXPECT_EQ(message({Point3f{0, 0, 0}, {0, 1, 0}, {1, 1, INFINITY}, {1, 0, 0}}),
              "two corners of the portal are the same point");
    const char* parallel = "the portal is no rectangle: opposite edges are not parallel";
    EXPECT_EQ(message({Point3f{0, 0, 0}, {0, 1, 0}, {1, 1, 0.2f}, {1, 0, 0}}), parallel);
    EXPECT_EQ(message({Point3f{0, 0, 0}, {1, 1, 0}, {0, 1, 0}, {1, 0, 0}}), parallel);
    EXPECT_EQ(message({Point3f{0, 0, 0}, {0.1f, 1, 0}, {1.1f, 1, 0}, {1, 0, 0}}),
              "the portal is no rectangle: edges are not perpendicular");
}

} // namespace
} // namespace montelux::portals
