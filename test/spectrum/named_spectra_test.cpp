#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>

#include "montelux/mc/math/error.h"
#include "montelux/spectrum/illuminants.h"
#include "montelux/spectrum/named_spectra.h"
#include "montelux/spectrum/spd_file.h"

namespace montelux {
namespace {

TEST(NamedSpectra, IlluminantsHaveTheirPublishedChromaticities) {
    // CIE 015:2018, table 11 and 8.1; ACES: TB-2018-001.
    const struct {
        const char* name;
        double x, y;
    } whites[] = {{"stdillum-A", 0.44758, 0.40745},   {"stdillum-D50", 0.34567, 0.35851},
                  {"stdillum-D65", 0.31272, 0.32903}, {"illum-acesD60", 0.32168, 0.33767},
                  {"stdillum-F1", 0.3131, 0.3371},    {"stdillum-F2", 0.3721, 0.3751},
                  {"stdillum-F3", 0.4091, 0.3941},    {"stdillum-F4", 0.4402, 0.4031},
                  {"stdillum-F5", 0.3138, 0.3452},    {"stdillum-F6", 0.3779, 0.3882},
                  {"stdillum-F7", 0.3129, 0.3292},    {"stdillum-F8", 0.3458, 0.3586},
                  {"stdillum-F9", 0.3741, 0.3727},    {"stdillum-F10", 0.3458, 0.3588},
                  {"stdillum-F11", 0.3805, 0.3769},   {"stdillum-F12", 0.4370, 0.4042}};
    for (const auto& white : whites) {
        auto s = find_named_spectrum(white.name);
        ASSERT_TRUE(s) << white.name;
        Vec2d xy = chromaticity(to_xyz(*s));
        EXPECT_NEAR(xy.x, white.x, 4e-4) << white.name;
        EXPECT_NEAR(xy.y, white.y, 4e-4) << white.name;
        EXPECT_NEAR(to_photometric(*s), cie_y_integral, 1e-3) << white.name;
    }
}

TEST(NamedSpectra, MetalsAndGlassesHaveTheirMeasuredValues) {
    const struct {
        const char* name;
        float lambda, value;
    } spots[] = {{"metal-Ag-eta", 450.851562f, 0.151063f}, {"metal-Ag-k", 590.400818f, 3.66f},
                 {"metal-Al-eta", 551.040771f, 0.963f},    {"metal-Al-k", 729.318665f, 8.57f},
                 {"metal-Au-eta", 476.862213f, 1.242f},    {"metal-Au-k", 652.548279f, 3.15f},
                 {"metal-Cu-eta", 576.670593f, 0.645875f}, {"metal-Cu-k", 381.489777f, 2.121562f},
                 {"metal-CuZn-eta", 500, 0.686f},          {"metal-CuZn-k", 830, 5.115f},
                 {"metal-MgO-eta", 589.258972f, 1.73737f}, {"metal-MgO-k", 500, 0},
                 {"metal-TiO2-eta", 539.044006f, 2.95f},   {"metal-TiO2-k", 359.988007f, 0.251f},
                 {"glass-BK7", 520, 1.5201596882463f},     {"glass-BAF10", 586, 1.6701073530462f},
                 {"glass-FK51A", 709, 1.483726544853f},    {"glass-LASF9", 455, 1.877863643024f},
                 {"glass-SF5", 604, 1.6710248234743f},     {"glass-F10", 549, 1.7337260730259f},
                 {"glass-SF11", 774, 1.7661717683505f},    {"glass-SF11", 362, 1.8700216173234f}};
    for (const auto& spot : spots) {
        auto s = find_named_spectrum(spot.name);
        ASSERT_TRUE(s) << spot.name;
        EXPECT_NEAR((*s)(spot.lambda), spot.value, 1e-5) << spot.name;
    }
}

TEST(NamedSpectra, MetalsAgreeWithIndependentFiles) {
    std::filesystem::path folder = std::filesystem::path(MONTELUX_SHARED_DIR) / "scenes/mitsuba/ior";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is absent";
    for (std::string metal : {"Ag", "Al", "Au", "Cu"})
        for (std::string part : {"eta", "k"}) {
            PiecewiseLinear file = read_spd_file(folder / (metal + "." + part + ".spd"));
            auto s = find_named_spectrum("metal-" + metal + "-" + part);
            ASSERT_TRUE(s);
            for (float lambda = 360; lambda <= 830; lambda += 0.7f)
                EXPECT_NEAR((*s)(lambda), file(lambda), 1e-5) << metal << part << lambda;
        }
}

TEST(NamedSpectra, EveryNameIsFoundAndOthersAreSuggested) {
    EXPECT_EQ(named_spectrum_names().size(), 16u + 14u + 10u);
    for (auto name : named_spectrum_names()) {
        auto s = find_named_spectrum(name);
        ASSERT_TRUE(s);
        for (float lambda = 360; lambda <= 830; ++lambda) {
            ASSERT_TRUE(std::isfinite((*s)(lambda))) << name;
            ASSERT_GE((*s)(lambda), 0) << name;
        }
    }
    EXPECT_FALSE(find_named_spectrum("metal-Ag"));
    EXPECT_FALSE(find_named_spectrum(""));
    EXPECT_EQ(nearest_spectrum_name("metal-ag-eta"), "metal-Ag-eta");
    EXPECT_EQ(nearest_spectrum_name("stdilum-D65"), "stdillum-D65");
    EXPECT_EQ(nearest_spectrum_name("glas-bk7"), "glass-BK7");
}

TEST(Illuminants, DaylightReachesItsChromaticity) {
    for (float t : {4500.0f, 5500.0f, 6500.0f, 7500.0f, 12000.0f}) {
        Vec2d xy = chromaticity(integrate_xyz(daylight(t)));
        // The CIE's daylight locus.
        EXPECT_NEAR(xy.y, -3 * xy.x * xy.x + 2.87 * xy.x - 0.275, 2e-4) << t;
    }
    Vec2d d65 = chromaticity(integrate_xyz(daylight(6500)));
    EXPECT_NEAR(d65.x, 0.31272, 1e-4);
    EXPECT_NEAR(d65.y, 0.32903, 1e-4);
    EXPECT_NEAR(illuminant_a(500), 59.8611, 1e-4);
    // Below 4000 K a black body: redder than any daylight.
    EXPECT_GT(chromaticity(integrate_xyz(daylight(2856))).x, 0.44);
}

TEST(Spd, ReadsPairsAndComments) {
    PiecewiseLinear s = parse_spd("# silver\n400 1.5 # first\n\t500,2.5e0\r\n600 +3\n", "a.spd");
    EXPECT_FLOAT_EQ(s(400), 1.5f);
    EXPECT_FLOAT_EQ(s(450), 2);
    EXPECT_FLOAT_EQ(s(600), 3);
    EXPECT_EQ(s(601), 0);
}

void expect_error(const char* text, const char* part) {
    try {
        parse_spd(text, "a.spd");
        FAIL() << "no error for " << text;
    } catch (const Error& e) {
        EXPECT_NE(std::string(e.what()).find(part), std::string::npos) << e.what();
    }
}

TEST(Spd, BadFilesGetASentence) {
    expect_error("# nothing\n", "a.spd: the file holds no numbers");
    expect_error("400 1\n500", "a.spd:2: the last wavelength has no value");
    expect_error("400 1\n\n399 2", "a.spd:3: the wavelength 399");
    expect_error("400 1\n400 2", "a.spd:2");
    expect_error("400 1\n500 abc", "a.spd:2: read \"abc\"");
    expect_error("400 nan", "a.spd:1: read \"nan\"");
    expect_error("400 1 500 2 600 1e99", "a.spd:1: read \"1e99\"");
    EXPECT_THROW(read_spd_file("/does/not/exist.spd"), Error);
}

} // namespace
} // namespace montelux
