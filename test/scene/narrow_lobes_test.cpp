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
    for (const char* name :
         {"diffuse", "conductor_0_5", "dielectric_0_6", "diffuse_transmission", "diffuse_transmission_tilted",
          "coated_diffuse_0_1", "layered_diffuse_0_4", "subsurface"})
        EXPECT_FALSE(glossy.at(name)) << name;
}

TEST(NarrowLobes, LeastAlphaIsThatOfTheNarrowest) {
    const SampledSpectrum one(1);
    EXPECT_EQ(least_alpha(DiffuseBsdf{one}), 1);
    EXPECT_FLOAT_EQ(least_alpha(ConductorBsdf{one, one, {0.1f, 0.4f}}), 0.2f);
    EXPECT_EQ(least_alpha(ConductorBsdf{one, one, {0, 0}}), 1); // a delta
}

} // namespace
} // namespace montelux::testing
