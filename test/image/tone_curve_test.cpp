#include "test/image/image_testing.h"
#include <cmath>
#include <limits>

#include "montelux/image/tone_curve.h"

namespace montelux {
namespace {

constexpr ToneKind kinds[] = {ToneKind::linear, ToneKind::srgb, ToneKind::aces, ToneKind::agx,
                              ToneKind::filmic};

TEST(ToneCurve, ExposesThenEncodes) {
    EXPECT_EQ(ToneCurve{0}(1), 1);
    EXPECT_EQ(ToneCurve{0}(7), 1);
    EXPECT_EQ(ToneCurve{0}(-1), 0);
    EXPECT_EQ(ToneCurve{0}(std::numeric_limits<float>::quiet_NaN()), 0);
    EXPECT_FLOAT_EQ(ToneCurve{2}(0.05f), linear_to_srgb(0.2f));
    Image image(2, 1, {"R", "G", "B", "A", "other"});
    for (int c = 0; c < 3; ++c) image.set(0, 0, c, 0.25f);
    image.set(0, 0, 3, 0.5f);
    Image out = apply_tone_curve(image, {1});
    EXPECT_EQ(out.channel_names(), (std::vector<std::string>{"R", "G", "B", "A"}));
    EXPECT_EQ(out.u8()[0], 188); // 255 * srgb(0.5) = 187.5
    EXPECT_EQ(out.u8()[3], 128); // alpha is neither exposed nor curved
    EXPECT_EQ(out.u8()[4], 0);
    EXPECT_EQ(apply_tone_curve(image, {1}, 16).u16()[0], std::lround(65535 * linear_to_srgb(0.5)));
    expect_error([&] { apply_tone_curve(image, {}, 10); }, {"8 or 16"});
}

// The formulas of the sources in double precision, by hand.
TEST(ToneCurve, HasThePublishedValues) {
    struct Case {
        ToneKind kind;
        Vec3f light;
        double r, g, b;
    };
    const Vec3f grey{0.18f, 0.18f, 0.18f}, red{1, 0.2f, 0.05f}, bright{16, 4, 0.5f};
    const Case cases[] = {
        {ToneKind::linear, bright, 1, 1, 0.5},
        {ToneKind::linear, red, 1, 0.2, 0.05},
        {ToneKind::srgb, grey, 0.461356, 0.461356, 0.461356},
        {ToneKind::aces, grey, 0.358457, 0.358457, 0.358456},
        {ToneKind::aces, {1, 1, 1}, 0.808954, 0.808954, 0.808950},
        {ToneKind::aces, red, 0.840115, 0.417558, 0.187018},
        {ToneKind::aces, bright, 1, 0.965935, 0.857059},
        {ToneKind::agx, grey, 0.500460, 0.500531, 0.500535},
        {ToneKind::agx, {1, 1, 1}, 0.791773, 0.791911, 0.791919},
        {ToneKind::agx, red, 0.828553, 0.540656, 0.362169},
        {ToneKind::agx, bright, 1, 0.946990, 0.821287},
        {ToneKind::filmic, grey, 0.393471, 0.393471, 0.393471},
        {ToneKind::filmic, {5.6f, 5.6f, 5.6f}, 1, 1, 1}, // Hable's linear white, 11.2 after the doubling
        {ToneKind::filmic, red, 0.730674, 0.411600, 0.214873},
        {ToneKind::filmic, bright, 1, 0.963067, 0.587631},
    };
    for (const Case& c : cases) {
        SCOPED_TRACE(tone_names()[static_cast<std::size_t>(c.kind)]);
        const Vec3f code = ToneCurve{0, c.kind}(c.light);
        EXPECT_NEAR(code.x, c.r, 3e-6);
        EXPECT_NEAR(code.y, c.g, 3e-6);
        EXPECT_NEAR(code.z, c.b, 3e-6);
        // The exposure is a factor of the light.
        const Vec3f exposed = ToneCurve{3, c.kind}(c.light * 0.125f);
        for (int i = 0; i < 3; ++i) EXPECT_EQ(exposed[i], code[i]);
    }
}

TEST(ToneCurve, RisesFromBlackAndKeepsGreysGrey) {
    constexpr float endless = std::numeric_limits<float>::infinity(),
                    nan = std::numeric_limits<float>::quiet_NaN();
    for (const ToneKind kind : kinds) {
        SCOPED_TRACE(tone_names()[static_cast<std::size_t>(kind)]);
        const ToneCurve curve{0, kind};
        EXPECT_EQ(curve(0), 0);
        EXPECT_EQ(curve(-1), 0);
        EXPECT_EQ(curve(nan), 0);
        EXPECT_GT(curve(endless), 0.99f);
        EXPECT_LE(curve(endless), 1.00001f);
        float before = 0;
        for (float stops = -20; stops <= 20; stops += 0.125f) {
            const float light = std::exp2(stops);
            const Vec3f code = curve(Vec3f{light, light, light});
            const float v = curve(light);
            EXPECT_GE(v, before - 1e-6f) << light;
            EXPECT_NEAR(code.x, code.y, 3e-4) << light;
            EXPECT_NEAR(code.z, code.y, 3e-4) << light;
            for (int i = 0; i < 3; ++i) EXPECT_TRUE(code[i] >= 0 && code[i] <= 1) << light;
            before = v;
        }
        EXPECT_GT(before, 0.99f);
        // What is not a colour of the screen stays within it.
        for (const Vec3f& odd : {Vec3f{100, -5, 0}, Vec3f{nan, endless, -endless}, Vec3f{0, 0, endless}})
            for (int i = 0; i < 3; ++i) EXPECT_TRUE(curve(odd)[i] >= 0 && curve(odd)[i] <= 1);
    }
}

TEST(ToneCurve, CodesAreTheCurvesRounded) {
    Image color(3, 1, {"R", "G", "B"}), grey(3, 1, {"Y"});
    const float light[] = {0.01f, 0.3f, 2};
    for (int x = 0; x < 3; ++x) {
        for (int c = 0; c < 3; ++c) color.set(x, 0, c, light[(x + c) % 3]);
        grey.set(x, 0, 0, light[x]);
    }
    for (const ToneKind kind : kinds) {
        SCOPED_TRACE(tone_names()[static_cast<std::size_t>(kind)]);
        const ToneCurve curve{0.5f, kind};
        const Image eight = apply_tone_curve(color, curve), sixteen = apply_tone_curve(color, curve, 16);
        const Image grey8 = apply_tone_curve(grey, curve);
        EXPECT_EQ(eight.encoding(),
                  kind == ToneKind::linear ? ColorEncoding::linear() : ColorEncoding::srgb());
        for (int x = 0; x < 3; ++x) {
            const Vec3f code = curve(Vec3f{light[x], light[(x + 1) % 3], light[(x + 2) % 3]});
            for (int c = 0; c < 3; ++c) {
                EXPECT_EQ(eight.u8()[eight.index(x, 0, c)], std::lround(code[c] * 255));
                EXPECT_EQ(sixteen.u16()[sixteen.index(x, 0, c)], std::lround(code[c] * 65535));
            }
            EXPECT_EQ(grey8.u8()[grey8.index(x, 0)], std::lround(curve(light[x]) * 255));
        }
    }
}

TEST(ToneCurve, NamesAreThoseOfTheKinds) {
    for (std::size_t i = 0; i < std::size(kinds); ++i) EXPECT_EQ(tone_named(tone_names()[i]), kinds[i]);
    EXPECT_EQ(tone_names().size(), std::size(kinds));
    EXPECT_FALSE(tone_named("reinhard"));
}

} // namespace
} // namespace montelux
