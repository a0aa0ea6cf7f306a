// Infinite lights through portals: directions follow their density, light that is estimated is the light that
// a quadrature finds, and where no light comes none is sampled. 24 chi-squared tests at 1e-9 each and 24
// means at 6.5 standard errors (8e-11): below 1e-7 for the file.
#include "test/scene/portal_testing.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "montelux/mc/stats/chi_squared.h"
#include "montelux/mc/stats/moments.h"
#include "montelux/scene/light/light_sampling.h"
#include "montelux/scene/scene_tables.h"
#include "montelux/scene/shape/quadric.h"

namespace montelux::portals {
namespace {

ReferencePoint at(Point3f p) { return {p, {0, 0, 1}, 0}; }

// Where each of the directions of a room lies in the world.
const Transform room = Transform::translate({1, -2, 0.5}) * Transform::rotate(50, {2, -1, 0.4});

struct View {
    std::string name;
    Portal portal;
    Point3f from;
};

std::vector<View> views() {
    std::vector<View> v;
    auto add = [&](const char* name, float x0, float y0, float x1, float y1, Point3f from) {
        v.push_back({name, Portal(corners_of(x0, y0, x1, y1, 0, room)), room.point(from)});
    };
    add("wide", -40, -30, 50, 30, {0, 0, -1});
    add("in front", -1, -1, 1, 1, {0.2f, 0.1f, -1});
    add("aside", -1, -1, 1, 1, {2, -3, -1});
    add("narrow", 0, -1, 0.01f, 1, {0.5f, 0.5f, -2});
    add("far", -0.5f, -0.5f, 0.5f, 0.5f, {7, 3, -30});
    add("grazing", -1, -1, 1, 1, {5, 0.3f, -0.02f});
    return v;
}

Image test_map(int width, int height) {
    Image map(width, height, {"R", "G", "B"});
    for (int i = 0; i < width * height; ++i)
        for (int c = 0; c < 3; ++c)
            map.set(i % width, i / width, c,
                    i % 5 == 0 ? 0 : 0.1f + static_cast<float>((i * 7) % 11) + (i == 77 ? 300.0f : 0.0f));
    return map;
}

// 0: the same from everywhere; 1, 2: maps of both layouts; 3: as 2, between its texels.
constexpr int kinds = 4;
EnvironmentSettings settings_of(int kind) {
    return {.lookup = kind == 3 ? EnvironmentLookup::bilinear : EnvironmentLookup::nearest};
}
Scene scene_with(int kind, const std::optional<Portal>& portal) {
    Scene scene;
    if (kind == 0) {
        scene.lights.push_back(UniformInfiniteLight{1.0f, 3, portal});
        return scene;
    }
    scene.environments.push_back(kind == 1 ? test_map(16, 16) : test_map(32, 16));
    scene.lights.push_back(ImageInfiniteLight{.environment = 0,
                                              .layout = kind == 1 ? EnvironmentLayout::equal_area
                                                                  : EnvironmentLayout::equirectangular,
                                              .scale = 2,
                                              .world_from_light = Transform::rotate(77, {1, -2, 0.5}),
                                              .portal = portal});
    return scene;
}

void for_each_view(const auto& f) {
    for (const View& v : views())
        for (int kind = 0; kind < kinds; ++kind) {
            SCOPED_TRACE(v.name + ", light " + std::to_string(kind));
            const Scene scene = scene_with(kind, v.portal);
            const SceneTables tables(scene, settings_of(kind));
            f(v, scene, tables, settings_of(kind).lookup);
        }
}

// Whether the line from p along w meets the rectangle, by plane geometry; grown by `slack` of its sides.
bool meets(const std::array<Point3f, 4>& c, Point3f p, Vec3d w, double slack = 0) {
    const Vec3d x = Vec3d(c[3]) - Vec3d(c[0]), y = Vec3d(c[1]) - Vec3d(c[0]), n = cross(x, y);
    const double towards = dot(w, n), t = dot(Vec3d(c[0]) - Vec3d(p), n) / towards;
    if (!(towards > 0 && t > 0)) return false;
    const Vec3d q = Vec3d(p) + t * w - Vec3d(c[0]);
    const double a = dot(q, x) / dot(x, x), b = dot(q, y) / dot(y, y);
    return a >= -slack && a < 1 + slack && b >= -slack && b < 1 + slack;
}

// Between which the density over angles is smooth: n equal parts of angles and of tangents, and the cells of
// a portal's table for small maps.
std::vector<double> lines(double from, double to, int n) {
    std::vector<double> at;
    for (int i = 0; i <= n; ++i) at.push_back(from + (to - from) * i / n);
    for (int i = 1; i < n; ++i) {
        const double t = std::tan(from) + (std::tan(to) - std::tan(from)) * i / n;
        at.push_back(std::atan(t));
    }
    for (int i = 1; i < 64; ++i)
        if (const double line = pi * (i / 64.0 - 0.5); line > from && line < to) at.push_back(line);
    std::sort(at.begin(), at.end());
    return at;
}

TEST(Portals, AnglesAndSolidAnglesAgree) {
    for (const View& v : views()) {
        SCOPED_TRACE(v.name);
        const auto seen = v.portal.window(v.from);
        ASSERT_TRUE(seen);
        double solid_angle = 0;
        const std::vector<double> xs = lines(seen->lower.x, seen->upper.x, 150),
                                  ys = lines(seen->lower.y, seen->upper.y, 150);
        for (std::size_t i = 0; i < (xs.size() - 1) * (ys.size() - 1); ++i) {
            const std::size_t x = i % (xs.size() - 1), y = i / (xs.size() - 1);
            const Vec2d a{(xs[x] + xs[x + 1]) / 2, (ys[y] + ys[y + 1]) / 2};
            solid_angle += Portal::solid_angle_density(Portal::local_direction(a)) * (xs[x + 1] - xs[x]) *
                           (ys[y + 1] - ys[y]);
            if (i % 37 != 0) continue;
            const Vec3d w = v.portal.direction(a);
            ASSERT_TRUE(meets(v.portal.corners(), v.from, w, 0.01));
            ASSERT_NEAR(length(w), 1, 1e-12);
            const auto back = v.portal.angles(w);
            ASSERT_TRUE(back);
            ASSERT_LT(length(Vec3d{back->x - a.x, back->y - a.y, 0}), 1e-12);
            ASSERT_FALSE(v.portal.angles(-w));
        }
        const double truth = v.portal.seen_from(v.from)->solid_angle();
        EXPECT_NEAR(solid_angle / truth, 1, 1e-3);
        EXPECT_NEAR(v.portal.area() / length(cross(Vec3d(v.portal.corners()[3] - v.portal.corners()[0]),
                                                   Vec3d(v.portal.corners()[1] - v.portal.corners()[0]))),
                    1, 5e-3);
    }
}

TEST(Portals, DirectionsFollowTheirDensity) {
    for_each_view([](const View& v, const Scene&, const SceneTables& tables, EnvironmentLookup) {
        const Window2D seen = *v.portal.window(v.from);
        const Vec2d extent = seen.upper - seen.lower;
        constexpr int cells = 8, samples = 40000;
        auto cell_of = [&](Vec2d a) {
            const int x = static_cast<int>((a.x - seen.lower.x) / extent.x * cells),
                      y = static_cast<int>((a.y - seen.lower.y) / extent.y * cells);
            return static_cast<std::size_t>(y * cells + x);
        };
        // Cells of the window, and what falls beside it.
        std::vector<double> expected(cells * cells + 1), counts(expected.size());
        double all = 0;
        const std::vector<double> xs = lines(seen.lower.x, seen.upper.x, 8 * cells),
                                  ys = lines(seen.lower.y, seen.upper.y, 8 * cells);
        for (std::size_t j = 1; j < ys.size(); ++j)
            for (std::size_t i = 1; i < xs.size(); ++i) {
                const Vec2d a{(xs[i - 1] + xs[i]) / 2, (ys[j - 1] + ys[j]) / 2};
                const double e = static_cast<double>(pdf_li({tables.view(), 0}, {.p = v.from},
                                                            {.wi = Vec3f(v.portal.direction(a))})) *
                                 Portal::solid_angle_density(Portal::local_direction(a)) *
                                 (xs[i] - xs[i - 1]) * (ys[j] - ys[j - 1]);
                expected[cell_of(a)] += samples * e;
                all += e;
            }
        EXPECT_NEAR(all, 1, 2e-3);
        for (double& e : expected) e /= all;
        TestUniforms draws(3);
        for (int i = 0; i < samples; ++i) {
            const auto s = sample_li({tables.view(), 0}, 0, at(v.from), draws.next_2f(), wavelengths);
            const auto a = s ? v.portal.angles(Vec3d(s->wi)) : std::nullopt;
            const bool inside = a && seen.contains(*a);
            counts.at(inside ? cell_of(*a) : cells * cells) += 1;
        }
        const TestResult r = chi_squared_test(counts, expected);
        EXPECT_TRUE(r.passes(1e-9)) << r.description;

        TestUniforms uniforms(9);
        int differing = 0;
        for (int i = 0; i < 2000; ++i) {
            const auto s = sample_li({tables.view(), 0}, 0, at(v.from), uniforms.next_2f(), wavelengths);
            ASSERT_TRUE(s);
            ASSERT_FALSE(s->delta);
            ASSERT_TRUE(std::isinf(s->shadow.t_max));
            ASSERT_GT(s->pdf, 0);
            // Rounding may send a direction over the edge of a cell or of the portal.
            const bool same =
                std::abs(pdf_li({tables.view(), 0}, {.p = v.from}, {.wi = s->wi}) / s->pdf - 1) < 1e-3f &&
                std::abs(incident_radiance({tables.view(), 0}, {.p = v.from}, {.wi = s->wi}, wavelengths)[1] -
                         s->radiance[1]) <= 1e-3f * s->radiance[1];
            differing += !same;
        }
        EXPECT_LE(differing, 5);
    });
}

// The whole density lies in the portal, and the light of other directions is black.
TEST(Portals, NothingComesBesideThePortal) {
    for_each_view([](const View& v, const Scene&, const SceneTables& tables, EnvironmentLookup) {
        TestUniforms uniforms(5);
        int inside = 0;
        for (int i = 0; i < 4000; ++i) {
            // Towards points around the portal, some of them in it.
            const Vec3d x = Vec3d(v.portal.corners()[3] - v.portal.corners()[0]),
                        y = Vec3d(v.portal.corners()[1] - v.portal.corners()[0]);
            const Vec2d u = uniforms.next_2d();
            const Vec3d q = Vec3d(v.portal.corners()[0]) + (3 * u.x - 1) * x + (3 * u.y - 1) * y;
            const Vec3f w(normalize(q - Vec3d(v.from)));
            const bool through = meets(v.portal.corners(), v.from, Vec3d(w), -0.01);
            // Corners of single precision make no rectangle to the last digit.
            if (through != meets(v.portal.corners(), v.from, Vec3d(w), 0.01)) continue;
            inside += through;
            ASSERT_EQ(pdf_li({tables.view(), 0}, {.p = v.from}, {.wi = w}) > 0, through);
            if (!through) {
                ASSERT_TRUE(
                    is_black(incident_radiance({tables.view(), 0}, {.p = v.from}, {.wi = w}, wavelengths)));
            }
            ASSERT_EQ(pdf_li({tables.view(), 0}, {.p = v.from}, {.wi = -w}), 0);
            ASSERT_TRUE(
                is_black(incident_radiance({tables.view(), 0}, {.p = v.from}, {.wi = -w}, wavelengths)));
        }
        EXPECT_GT(inside, 200);
    });
}

TEST(Portals, OtherSideAndPlaneAreDark) {
    const Portal portal(corners_of(-1, -1, 1, 1));
    for (int kind = 0; kind < kinds; ++kind) {
        const Scene scene = scene_with(kind, portal);
        const SceneTables tables(scene, settings_of(kind));
        TestUniforms uniforms(1);
        for (Point3f p : {Point3f{0, 0, 0.5f}, {0, 0, 0}, {3, 0.5f, 0}, {9, 9, 20}})
            for (int i = 0; i < 100; ++i) {
                const Vec2f u = uniforms.next_2f();
                EXPECT_FALSE(sample_li({tables.view(), 0}, 0, at(p), u, wavelengths));
                const Vec3f w = normalize(Vec3f{u.x - 0.5f, u.y - 0.5f, i % 2 == 0 ? 0.3f : -0.3f});
                EXPECT_EQ(pdf_li({tables.view(), 0}, {.p = p}, {.wi = w}), 0);
                EXPECT_TRUE(
                    is_black(incident_radiance({tables.view(), 0}, {.p = p}, {.wi = w}, wavelengths)));
            }
        // In front of it light comes along +z.
        EXPECT_FALSE(is_black(
            incident_radiance({tables.view(), 0}, {.p = {0.1f, 0.3f, -2}}, {.wi = {0, 0, 1}}, wavelengths)));
    }
}

// Irradiance by a grid over the sphere, on a plane with normal n that comes through the portal: every
// texel is cut into 60 x 60 parts.
double irradiance_over_sphere(const View& v, Vec3d n, const EnvironmentGrid& grid, const auto& world,
                              const auto& radiance) {
    const int parts = 60;
    double total = 0;
    for (int y = 0; y < grid.height(); ++y)
        for (int x = 0; x < grid.width(); ++x) {
            double sum = 0;
            for (int i = 0; i < parts * parts; ++i) {
                const Vec3d w = world(grid.direction({static_cast<float>(x + (i % parts + 0.5) / parts),
                                                      static_cast<float>(y + (i / parts + 0.5) / parts)}));
                if (meets(v.portal.corners(), v.from, w)) sum += std::max(0.0, dot(w, n)) * radiance(w);
            }
            total += sum / (parts * parts) * grid.solid_angle(y);
        }
    return total;
}

// The same over points of the portal, for portals that are not large beside their distance.
double irradiance_over_portal(const View& v, Vec3d n, const auto& radiance) {
    const auto& c = v.portal.corners();
    const Vec3d x = Vec3d(c[3]) - Vec3d(c[0]), y = Vec3d(c[1]) - Vec3d(c[0]), normal = normalize(cross(x, y));
    const int m = 500;
    double sum = 0;
    for (int i = 0; i < m * m; ++i) {
        const Vec3d d = Vec3d(c[0]) + (i % m + 0.5) / m * x + (i / m + 0.5) / m * y - Vec3d(v.from);
        const Vec3d w = normalize(d);
        sum += std::max(0.0, dot(w, n)) * dot(w, normal) / dot(d, d) * radiance(w);
    }
    return sum / (m * m) * length(cross(x, y));
}

// 256 estimates of 256 samples each.
TEST(Portals, IrradianceIsThatOfTheMapSeenThroughIt) {
    const SampledSpectrum white = RgbIlluminantSpectrum(RgbColorSpace::srgb(), {1, 1, 1}).sample(wavelengths);
    for_each_view([&](const View& v, const Scene& scene, const SceneTables& tables,
                      EnvironmentLookup lookup) {
        const Window2D seen = *v.portal.window(v.from);
        const Vec3d n = normalize(v.portal.direction((seen.lower + seen.upper) / 2.0) +
                                  0.8 * normalize(room.vector(Vec3d{0.5, 0.2, 0.6})));
        const auto* light = std::get_if<ImageInfiniteLight>(&scene.lights[0]);
        const EnvironmentGrid grid = light == nullptr
                                         ? EnvironmentGrid(EnvironmentLayout::equirectangular, 32, 16)
                                         : EnvironmentGrid(light->layout, scene.environments[0].width(),
                                                           scene.environments[0].height());
        const Transform turn = light == nullptr ? Transform() : light->world_from_light;
        auto world = [&](Vec3f w) { return normalize(turn.vector(Vec3d(w))); };
        auto radiance = [&](Vec3d w) {
            if (light == nullptr) return 3.0;
            const Vec2f place = grid.locate(Vec3f(turn.inverse_vector(w)));
            auto texel = [&](std::size_t i) {
                return 2 * static_cast<double>(scene.environments[0].value_at(3 * i));
            };
            if (lookup == EnvironmentLookup::nearest) return texel(grid.texel(place));
            const EnvironmentGrid::Blend blend = grid.blend(place);
            double sum = 0;
            for (std::size_t k = 0; k < 4; ++k)
                sum += static_cast<double>(blend.share[k]) * texel(blend.texel[k]);
            return sum;
        };
        const double truth = v.name == "wide" ? irradiance_over_sphere(v, n, grid, world, radiance)
                                              : irradiance_over_portal(v, n, radiance);
        ASSERT_GT(truth, 0);
        const double unit = light == nullptr ? 1 : static_cast<double>(white[0]);
        RunningMoments means;
        for (std::uint64_t seed = 0; seed < 256; ++seed) {
            TestUniforms uniforms(100 + seed);
            double sum = 0;
            for (int i = 0; i < 256; ++i) {
                const auto s = sample_li({tables.view(), 0}, 0, at(v.from), uniforms.next_2f(), wavelengths);
                if (s)
                    sum += std::max(0.0, dot(Vec3d(s->wi), n)) *
                           static_cast<double>(s->radiance[0] / s->pdf) / unit;
            }
            means.add(sum / 256);
        }
        EXPECT_NEAR(means.mean() / truth, 1, 6.5 * means.standard_error() / truth + 1e-3);
        EXPECT_LT(means.standard_error() / truth, 0.02);
    });
}

} // namespace
} // namespace montelux::portals
