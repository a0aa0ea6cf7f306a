// Which BSDFs count as narrow.
#include "test/scene/bsdf_testing.h"
#include <gtest/gtest.h>
#include <map>
#include <string>

#include "montelux/scene/bsdf/narrow_lobes.h"

namespace montelux::testing {
namespace {

TEST(NarrowLobes, GlossyBsdfsHaveNoOthers) {
    std::map<std::string, bool> glossy;
    for (const BsdfCase& c : all_bsdf_cases())
        glossy[c.name] = std::visit([](const auto& b) { return is_glossy(b); }, c.make());
    for (const char* name : {"conductor_smooth", "conductor_0_1", "conductor_anisotropic", "dielectric_0_2",
                             "layered_conductor", "hair", "measured", "dielectric_tilted"})
        EXPECT_TRUE(glossy.at(name)) << name;
    for (const char* name : {"diffuse", "conductor_0_5", "dielectric_0_6", "diffuse_transmission",
                             "diffuse_transmission_tilted", "coated_diffuse_0_1", "layered_diffuse_0_4",
                             "layered_conductor_fog", "subsurface", "disney", "disney_sheet"})
        EXPECT_FALSE(glossy.at(name)) << name;
}

// Those that consist of others ask them.
TEST(NarrowLobes, BsdfsSayWhetherTheyHaveDiffuseLobes) {
    std::map<std::string, bool> diffuse;
    for (const BsdfCase& c : all_bsdf_cases())
        diffuse[c.name] = std::visit([](const auto& b) { return b.has_diffuse(); }, c.make());
    for (const char* name :
         {"diffuse", "diffuse_transmission", "diffuse_transmission_tilted", "coated_diffuse_0_1",
          "layered_diffuse_0_4", "layered_conductor_fog", "subsurface", "disney", "disney_sheet"})
        EXPECT_TRUE(diffuse.at(name)) << name;
    for (const char* name : {"conductor_smooth", "conductor_0_5", "dielectric_0_6", "layered_conductor",
                             "hair", "measured", "dielectric_tilted"})
        EXPECT_FALSE(diffuse.at(name)) << name;
}

TEST(NarrowLobes, PrincipledBsdfsByTheirLobes) {
    PrincipledBsdf<true> b{};
    b.layers.interface.ggx = {0.1f, 0.1f};
    b.layers.coat_ggx = {0.1f, 0.1f};
    const SampledSpectrum black(0), grey(0.3f);
    PrincipledLayers& l = b.layers;
    l.diffuse = l.transmitting = l.sheen_color = black;
    EXPECT_TRUE(is_glossy(b));
    for (SampledSpectrum* lobe : {&l.diffuse, &l.transmitting, &l.sheen_color}) {
        *lobe = grey;
        EXPECT_FALSE(is_glossy(b));
        *lobe = black;
    }
    DisneySheetBsdf sheet{};
    sheet.lobes.base.color = sheet.lobes.base.sheen_color = sheet.lobes.transmitting = black;
    EXPECT_TRUE(is_glossy(sheet));
    sheet.lobes.transmitting = grey;
    EXPECT_FALSE(is_glossy(sheet));
}

TEST(NarrowLobes, LeastAlphaIsThatOfTheNarrowest) {
    const SampledSpectrum one(1);
    EXPECT_EQ(least_alpha(DiffuseBsdf{one}), 1);
    EXPECT_FLOAT_EQ(least_alpha(ConductorBsdf{one, one, {0.1f, 0.4f}}), 0.2f);
    EXPECT_EQ(least_alpha(ConductorBsdf{one, one, {0, 0}}), 1); // a delta
}

} // namespace
} // namespace montelux::testing
