// A test of the material of docs/tutorials/bsdf.md, after the page's own files; page_files.awk puts them before it.
#pragma once

namespace montelux::testing {
namespace {

TEST(DustMaterial, MakesTheBsdfOfItsParameter) {
    DustMaterial m;
    int parameters = 0;
    DustMaterial::visit_parameters(m, [&](const ParameterInfo& info, const auto&) {
        EXPECT_EQ(info.pbrt_name(), "albedo");
        ++parameters;
    });
    EXPECT_EQ(parameters, 1);
    SampledWavelengths lambda = SampledWavelengths::sample_visible(0.3f);
    EXPECT_EQ(m.bsdf(ParameterEvaluator({}, 0, {}, lambda)).grains[0], 0.3f);
}

} // namespace
} // namespace montelux::testing
