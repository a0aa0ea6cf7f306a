#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "montelux/bake/brdf_integrals.h"
#include "montelux/bake/brdf_table.h"
#include "montelux/mc/math/constants.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/parallel/parallel_for.h"

namespace montelux {
namespace {

struct Terms {
    double scale = 0, bias = 0;
};

// The same integrals by another way: over the normals visible from the view, as the spherical cap of Dupuy
// and Benyoub 2023, by the midpoint rule, and with masking and shadowing as ratios of G (no Lambda).
Terms over_visible_normals(double n_dot_v, double alpha, int cells) {
    const double cos_v = n_dot_v, sin_v = std::sqrt(1 - cos_v * cos_v);
    // The view in the space where the surface has alpha = 1.
    const double stretch = std::hypot(alpha * sin_v, cos_v);
    const double x = alpha * sin_v / stretch, z = cos_v / stretch;
    auto root = [&](double c) { return std::sqrt(alpha * alpha + (1 - alpha * alpha) * c * c); };
    double scale = 0, bias = 0;
    for (int i = 0; i < cells; ++i) {
        // Squares and their derivatives crowd the cells where the directions come near the horizon.
        const double q = (i + 0.5) / cells, height = (1 + z) * q * q - z;
        const double radius = std::sqrt(std::max(0.0, 1 - height * height));
        for (int j = 0; j < cells; ++j) {
            const double r = (j + 0.5) / cells, phi = pi * (1 - r * r), weight = 4 * q * r;
            double hx = alpha * (radius * std::cos(phi) + x), hy = alpha * radius * std::sin(phi),
                   hz = height + z;
            const double length = std::sqrt(hx * hx + hy * hy + hz * hz);
            hx /= length;
            hz /= length;
            const double v_dot_h = sin_v * hx + cos_v * hz, cos_l = 2 * v_dot_h * hz - cos_v;
            if (cos_l <= 0) continue;
            // G2 / G1(v), with G2 / (4 cos_l cos_v) = 1 / 2 / (cos_v root(cos_l) + cos_l root(cos_v)).
            const double g2 = 2 * cos_l * cos_v / (cos_v * root(cos_l) + cos_l * root(cos_v));
            const double g1 = 2 * cos_v / (cos_v + root(cos_v));
            const double fresnel = std::pow(1 - v_dot_h, 5);
            scale += weight * g2 / g1 * (1 - fresnel);
            bias += weight * g2 / g1 * fresnel;
        }
    }
    const double count = static_cast<double>(cells) * cells;
    return {scale / count, bias / count};
}

TEST(BrdfTable, AgreesWithQuadratureOverVisibleNormals) {
    const BrdfIntegrals integrals;
    const int size = 256;
    double worst = 0;
    for (int y : {0, 1, 3, 10, 32, 45, 77, 128, 200, 255})
        for (int x : {0, 1, 2, 5, 20, 90, 161, 215, 254, 255}) {
            const double n_dot_v = (x + 0.5) / size, roughness = (y + 0.5) / size;
            const SplitSumTerms terms = integrals.ggx(n_dot_v, roughness * roughness);
            const Terms expected = over_visible_normals(n_dot_v, roughness * roughness, 300);
            const double error =
                std::max(std::abs(terms.scale - expected.scale), std::abs(terms.bias - expected.bias));
            worst = std::max(worst, error);
            EXPECT_LT(error, 1e-4) << x << ", " << y;
            EXPECT_LT(terms.error, 1e-4) << x << ", " << y;
        }
    RecordProperty("worst", std::to_string(worst));
}

TEST(BrdfTableSlowTest, EveryTexelAgreesWithQuadratureOverVisibleNormals) {
    const Image table = brdf_table({});
    double worst = 0;
    for (int y = 0; y < table.height(); ++y)
        for (int x = 0; x < table.width(); ++x) {
            const double n_dot_v = (x + 0.5) / 256, roughness = (y + 0.5) / 256;
            const Terms expected = over_visible_normals(n_dot_v, roughness * roughness, 300);
            const double error = std::max(std::abs(table.value(x, y, 0) - expected.scale),
                                          std::abs(table.value(x, y, 1) - expected.bias));
            worst = std::max(worst, error);
            ASSERT_LT(error, 1e-4) << x << ", " << y;
        }
    RecordProperty("worst", std::to_string(worst));
}

TEST(BrdfTable, KnownValues) {
    const BrdfIntegrals integrals;
    // A mirror reflects what Schlick's formula says.
    for (double c : {1 / 512.0, 0.1, 0.5, 0.9, 1.0}) {
        const SplitSumTerms mirror = integrals.ggx(c, 1e-9);
        EXPECT_NEAR(mirror.bias, std::pow(1 - c, 5), 1e-6) << c;
        EXPECT_NEAR(mirror.scale, 1 - std::pow(1 - c, 5), 1e-6) << c;
    }
    // alpha = 1 seen along the normal: D = 1 / pi, G2 = 2 c / (1 + c), so the albedo is
    // 1/2 integral_0^1 2 c / (1 + c) dc = 1 - ln 2.
    const SplitSumTerms rough = integrals.ggx(1, 1);
    EXPECT_NEAR(rough.scale + rough.bias, 1 - std::log(2.0), 1e-7);
    // No more than all light; the rougher, the less.
    double before = 1.000001;
    for (double roughness = 1 / 512.0; roughness <= 1; roughness += 1 / 16.0) {
        const AlbedoTerm mean = integrals.ggx_average_albedo(roughness * roughness);
        EXPECT_LT(mean.value, before) << roughness;
        EXPECT_LT(mean.error, 1e-4);
        before = mean.value;
    }
}

TEST(BrdfTable, AverageAlbedoIsTheMeanOverCosines) {
    const BrdfIntegrals integrals;
    for (double alpha : {0.01, 0.25, 1.0}) {
        double sum = 0;
        const int cells = 200;
        for (int i = 0; i < cells; ++i) {
            const double c = (i + 0.5) / cells;
            const Terms terms = over_visible_normals(c, alpha, 60);
            sum += 2 * c * (terms.scale + terms.bias) / cells;
        }
        EXPECT_NEAR(integrals.ggx_average_albedo(alpha).value, sum, 3e-4) << alpha;
    }
}

// Midpoint rule over the directions of the light, not over half vectors.
double sheen_over_light(double cos_v, double alpha, int cells) {
    const double sin_v = std::sqrt(1 - cos_v * cos_v);
    double sum = 0;
    for (int i = 0; i < cells; ++i) {
        const double c = (i + 0.5) / cells, s = std::sqrt(1 - c * c);
        for (int j = 0; j < cells; ++j) {
            const double phi = pi * (j + 0.5) / cells;
            const double x = sin_v + s * std::cos(phi), y = s * std::sin(phi), z = cos_v + c;
            const double sin2 = (x * x + y * y) / (x * x + y * y + z * z);
            const double d = (2 + 1 / alpha) * std::pow(sin2, 0.5 / alpha) / (2 * pi);
            sum += d / (4 * (c + cos_v - c * cos_v)) * c;
        }
    }
    return sum * 2 * pi / (static_cast<double>(cells) * cells);
}

TEST(BrdfTable, SheenAgreesWithQuadratureOverLight) {
    const BrdfIntegrals integrals;
    for (double roughness : {0.2, 0.5, 1.0})
        for (double n_dot_v : {0.02, 0.3, 0.7, 1.0}) {
            const AlbedoTerm sheen = integrals.charlie_sheen(n_dot_v, roughness * roughness);
            EXPECT_NEAR(sheen.value, sheen_over_light(n_dot_v, roughness * roughness, 500), 1e-4)
                << n_dot_v << ", " << roughness;
            EXPECT_LT(sheen.error, 1e-6);
        }
}

TEST(BrdfTable, TexelsStandWhereTheyShould) {
    const BrdfIntegrals integrals;
    BrdfTableSettings settings;
    settings.size = 5;
    settings.extra = BrdfTableExtra::sheen;
    double progress = 0;
    settings.progress = [&](double fraction) { progress = fraction; };
    const Image table = brdf_table(settings);
    EXPECT_EQ(progress, 1);
    for (auto [x, y] : {std::pair{0, 0}, {4, 0}, {1, 3}}) {
        const double n_dot_v = (x + 0.5) / 5, roughness = (y + 0.5) / 5;
        const SplitSumTerms terms = integrals.ggx(n_dot_v, roughness * roughness);
        EXPECT_EQ(table.value(x, y, 0), static_cast<float>(terms.scale));
        EXPECT_EQ(table.value(x, y, 1), static_cast<float>(terms.bias));
        EXPECT_EQ(table.value(x, y, 2),
                  static_cast<float>(integrals.charlie_sheen(n_dot_v, roughness * roughness).value));
    }
    // The same bits on any number of threads.
    for (int threads : {1, 3}) {
        const Image again = with_threads(threads, [&] { return brdf_table(settings); });
        EXPECT_TRUE(std::ranges::equal(again.f32(), table.f32()));
    }
    settings.extra = BrdfTableExtra::average_albedo;
    const Image average = brdf_table(settings);
    EXPECT_EQ(average.value(0, 2, 2), average.value(4, 2, 2));
    EXPECT_GT(average.value(0, 0, 2), average.value(0, 4, 2));
    CancelFlag cancel;
    cancel.request();
    settings.cancel = &cancel;
    EXPECT_TRUE(brdf_table(settings).empty());
    settings.size = 0;
    EXPECT_THROW(brdf_table(settings), Error);
}

} // namespace
} // namespace montelux
