// BSDFs of Mitsuba scenes that change other BSDFs: sides, masks, blends, bumps, normal maps.
#include "test/formats/mitsuba/material_text.h"
#include <gtest/gtest.h>

#include "montelux/scene/material/conductor_material.h"
#include "montelux/scene/material/dielectric_material.h"
#include "montelux/scene/material/diffuse_material.h"
#include "montelux/scene/material/interface_material.h"
#include "montelux/scene/material/mix_material.h"
#include "montelux/scene/material/sided_material.h"
#include "montelux/scene/material/thin_dielectric_material.h"

namespace montelux::mitsuba_materials_test {
namespace {

TEST(MitsubaTwosided, HasAMaterialOnEachSide) {
    One<DiffuseMaterial> one(bsdf("twosided", bsdf("diffuse")));
    EXPECT_FALSE(one.one_sided);
    One<SidedMaterial> two(
        bsdf("twosided", bsdf("diffuse", number("reflectance", "0.1")) + bsdf("conductor")));
    EXPECT_FLOAT_EQ(two.looks.material<DiffuseMaterial>(two->front.index).reflectance.value.constant, 0.1f);
    EXPECT_EQ(two.looks.material<ConductorMaterial>(two->back.index).metal.k.value.constant, 1);
    expect_says(material_error(bsdf("twosided", bsdf("dielectric"))),
                "the bsdf 'dielectric' has two sides already");
    expect_says(material_error(bsdf("twosided", bsdf("null"))), "lets light through");
    expect_says(material_error(bsdf("twosided", bsdf("mask", bsdf("diffuse")))), "lets light through");
    expect_says(material_error(bsdf("twosided")), "has 0 BSDFs within it; expected one or two");
    One<DielectricMaterial> allowed(
        bsdf("twosided", "<boolean name=\"allow_transmission\" value=\"true\"/>" + bsdf("dielectric")));
    EXPECT_FALSE(allowed.one_sided);
}

TEST(MitsubaNull, IsAnInterface) {
    One<InterfaceMaterial> m(bsdf("null"));
    EXPECT_FALSE(m.one_sided);
    EXPECT_TRUE(m.look.alpha.is_constant());
    EXPECT_EQ(m.look.alpha.value, 1);
}

TEST(MitsubaMask, IsTheOpacityOfTheShape) {
    One<DiffuseMaterial> m(bsdf("mask", bsdf("diffuse")));
    EXPECT_TRUE(m.one_sided);
    EXPECT_FLOAT_EQ(m.look.alpha.value, 0.5f);
    One<DiffuseMaterial> nested(
        bsdf("mask", number("opacity", "0.8") +
                         bsdf("mask", four_colors("opacity") + bsdf("twosided", bsdf("diffuse")))));
    EXPECT_FALSE(nested.one_sided);
    const double luminance = dot(RgbColorSpace::srgb().luminance_weights(), Vec3d(test::upper_left));
    EXPECT_NEAR(nested.looks.value(nested.look.alpha, {0.25f, 0.25f}), 0.8 * luminance, 1e-6);
    expect_says(material_error(bsdf("mask")), "the bsdf 'mask' needs a BSDF within it");
    expect_says(material_error(bsdf("mask", number("opacity", "1.2") + bsdf("diffuse"))), "'opacity' is 1.2");
}

TEST(MitsubaBlend, IsAMix) {
    One<MixMaterial> m(bsdf("blendbsdf", number("weight", "0.3") + bsdf("diffuse") + bsdf("conductor")));
    EXPECT_TRUE(m.one_sided);
    EXPECT_FLOAT_EQ(m->amount.value, 0.3f);
    m.looks.material<DiffuseMaterial>(m->materials.first.index);
    m.looks.material<ConductorMaterial>(m->materials.second.index);
    // The diffuse part alone is black from behind.
    One<MixMaterial> mixed(bsdf("blendbsdf", four_colors("weight") + bsdf("diffuse") + bsdf("dielectric")));
    EXPECT_FALSE(mixed.one_sided);
    EXPECT_FALSE(mixed->amount.is_constant());
    mixed.looks.material<SidedMaterial>(mixed->materials.first.index);
    mixed.looks.material<DielectricMaterial>(mixed->materials.second.index);
    expect_says(material_error(bsdf("blendbsdf", number("weight", "1") + bsdf("diffuse"))),
                "has 1 BSDFs within it");
    expect_says(material_error(bsdf("blendbsdf", bsdf("diffuse") + bsdf("diffuse"))),
                "needs the property 'weight'");
}

TEST(MitsubaBlend, WithNullIsAMask) {
    One<DiffuseMaterial> second(bsdf("blendbsdf", number("weight", "0.3") + bsdf("null") + bsdf("diffuse")));
    EXPECT_FLOAT_EQ(second.look.alpha.value, 0.3f);
    One<DiffuseMaterial> first(bsdf("blendbsdf", four_colors("weight") + bsdf("diffuse") + bsdf("null")));
    const double luminance = dot(RgbColorSpace::srgb().luminance_weights(), Vec3d(test::upper_left));
    EXPECT_NEAR(first.looks.value(first.look.alpha, {0.25f, 0.25f}), 1 - luminance, 1e-6);
    One<InterfaceMaterial>(bsdf("blendbsdf", number("weight", "0.3") + bsdf("null") + bsdf("null")));
}

// Of all light 0.7 x 0.5 meets the first, and 0.3 x 0.9 the second.
TEST(MitsubaBlend, OfMasks) {
    const std::string first = bsdf("mask", bsdf("diffuse")),
                      second = bsdf("mask", number("opacity", "0.9") + bsdf("conductor"));
    One<MixMaterial> m(bsdf("blendbsdf", number("weight", "0.3") + first + second));
    EXPECT_FLOAT_EQ(m.look.alpha.value, 0.62f);
    EXPECT_FLOAT_EQ(m->amount.value, 0.27f / 0.62f);
    expect_says(material_error(bsdf("blendbsdf", four_colors("weight") + first + second)),
                "different masks is not supported");
}

TEST(MitsubaBumpmap, IsADisplacementOfEachPart) {
    One<DiffuseMaterial> m(bsdf("bumpmap", number("scale", "0.1") + four_colors("any") + bsdf("diffuse")));
    EXPECT_TRUE(m.one_sided);
    const double luminance = dot(RgbColorSpace::srgb().luminance_weights(), Vec3d(test::upper_left));
    EXPECT_NEAR(m.looks.value(m->detail.displacement, {0.25f, 0.25f}), 0.1 * luminance, 1e-6);
    EXPECT_TRUE(m->detail.shadowed);
    One<MixMaterial> blend(
        bsdf("bumpmap", four_colors("any") + bsdf("blendbsdf", number("weight", "0.3") + bsdf("diffuse") +
                                                                   bsdf("conductor"))));
    EXPECT_FALSE(blend.looks.material<DiffuseMaterial>(blend->materials.first.index).detail.is_flat());
    EXPECT_FALSE(blend.looks.material<ConductorMaterial>(blend->materials.second.index).detail.is_flat());
    expect_says(material_error(bsdf("bumpmap", bsdf("diffuse"))), "needs a texture within it");
    expect_says(material_error(
                    bsdf("bumpmap", four_colors("a") + bsdf("bumpmap", four_colors("b") + bsdf("diffuse")))),
                "bump maps within one another are not supported");
}

// A BSDF that is used with bumps and without is two materials.
TEST(MitsubaBumpmap, LeavesTheBsdfAsItIs) {
    Looks looks("<bsdf type=\"diffuse\" id=\"plain\"/><bsdf type=\"bumpmap\">" + four_colors("any") +
                "<ref id=\"plain\"/></bsdf>");
    const mitsuba::SurfaceLook plain = looks.look();
    std::optional<mitsuba::Plugin> bumpy;
    for (std::size_t i = 0; i < looks.graph.objects.size(); ++i)
        if (looks.graph.objects[i].type == "bumpmap") bumpy.emplace(looks.graph, i);
    const mitsuba::SurfaceLook bumps = looks.materials.of(*bumpy);
    const auto detail = [&](const mitsuba::SurfaceLook& look) {
        return looks.material<DiffuseMaterial>(looks.material<SidedMaterial>(look.material).front.index)
            .detail;
    };
    EXPECT_TRUE(detail(plain).is_flat());
    EXPECT_FALSE(detail(bumps).is_flat());
    EXPECT_TRUE(detail(bumps).shadowed);
    EXPECT_EQ(looks.scene.material_names.at(plain.material), "plain");
}

TEST(MitsubaNormalmap, IsAMapOfEachPart) {
    One<DiffuseMaterial> m(
        bsdf("normalmap", four_colors("normalmap", "<boolean name=\"raw\" value=\"true\"/>") +
                              bsdf("twosided", bsdf("diffuse"))));
    ASSERT_TRUE(m->detail.normal_map.is_given());
    EXPECT_TRUE(m.looks.scene.normal_maps.at(m->detail.normal_map.map).right_handed);
    One<DiffuseMaterial> unshadowed(
        bsdf("normalmap", "<boolean name=\"use_shadowing_function\" value=\"false\"/>" +
                              four_colors("normalmap") + bsdf("diffuse")));
    EXPECT_FALSE(unshadowed->detail.shadowed);
    expect_says(material_error(bsdf("normalmap", bsdf("diffuse"))), "needs a texture 'normalmap'");
    expect_says(material_error(bsdf("normalmap",
                                    "<texture type=\"checkerboard\" name=\"normalmap\"/>" + bsdf("diffuse"))),
                "a normal map is a texture 'bitmap' or 'rawconstant'");
    expect_says(
        material_error(bsdf("normalmap", four_colors("normalmap") +
                                             bsdf("normalmap", four_colors("normalmap") + bsdf("diffuse")))),
        "normal maps within one another are not supported");
}

} // namespace
} // namespace montelux::mitsuba_materials_test
