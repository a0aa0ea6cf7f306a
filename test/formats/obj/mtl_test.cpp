// The reader of MTL files.
#include <gtest/gtest.h>
#include <string>

#include "montelux/formats/obj/mtl.h"
#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

class MtlFile : public ::testing::Test {
  protected:
    std::vector<MtlMaterial> parse(const std::string& text) {
        return parse_mtl({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, "a.mtl",
                         warnings_);
    }
    std::string mtl_error(const std::string& text) {
        try {
            parse(text);
        } catch (const Error& e) {
            return e.what();
        }
        return {};
    }

    Warnings warnings_;
};

TEST_F(MtlFile, StatementsAreRead) {
    const std::vector<MtlMaterial> all =
        parse("# exported\nnewmtl dark oak\nKa 1 1 1\nKd 0.1 0.2 0.3\nKs 0.5\nKe 1 2 3\nNs 96\nNi 1.45\nd "
              "0.5\nillum 2\n"
              "Pr 0.25\nPm 1\nPc 0.5\nPcr 0.1\naniso 0.2\nanisor 0.25\nPs 0.75\nnewmtl second\nTr 0.25\n");
    ASSERT_EQ(all.size(), 2u);
    const MtlMaterial& m = all[0];
    EXPECT_EQ(m.name, "dark oak");
    EXPECT_EQ(m.line, 2u);
    EXPECT_EQ(*m.diffuse, (Vec3f{0.1f, 0.2f, 0.3f}));
    EXPECT_EQ(*m.specular, (Vec3f{0.5f, 0.5f, 0.5f}));
    EXPECT_EQ(*m.emission, (Vec3f{1, 2, 3}));
    EXPECT_EQ(*m.exponent, 96);
    EXPECT_EQ(*m.ior, 1.45f);
    EXPECT_EQ(m.opacity, 0.5f);
    EXPECT_EQ(*m.illumination, 2);
    EXPECT_EQ(*m.roughness, 0.25f);
    EXPECT_EQ(*m.metallic, 1);
    EXPECT_EQ(m.coat, 0.5f);
    EXPECT_EQ(m.coat_roughness, 0.1f);
    EXPECT_EQ(m.anisotropy, 0.2f);
    EXPECT_EQ(m.anisotropy_turns, 0.25f);
    EXPECT_EQ(*m.sheen, 0.75f);
    EXPECT_EQ(all[1].opacity, 0.75f);
    EXPECT_FALSE(all[1].diffuse);
    EXPECT_TRUE(warnings_.messages().empty());
}

TEST_F(MtlFile, PicturesHaveOptions) {
    const MtlMaterial m =
        parse("newmtl a\nmap_Kd -s 2 3 1 -o 0.5 -clamp on -blendu on C:\\my files\\oak.png\n"
              "map_Bump -bm 0.25 h.png\nmap_d -imfchan m mask.png\nnorm n.png\n")[0];
    EXPECT_EQ(m.diffuse_map.file, "C:\\my files\\oak.png");
    EXPECT_EQ(m.diffuse_map.scale, (Vec2f{2, 3}));
    EXPECT_EQ(m.diffuse_map.offset, (Vec2f{0.5f, 0}));
    EXPECT_TRUE(m.diffuse_map.clamp);
    EXPECT_EQ(m.bump_map.bumps, 0.25f);
    EXPECT_EQ(m.bump_map.line, 3u);
    EXPECT_EQ(m.opacity_map.file, "mask.png");
    EXPECT_EQ(m.normal_map.file, "n.png");
    EXPECT_EQ(warnings_.messages(), std::vector<std::string>{"a.mtl:4: option '-imfchan' is ignored"});
}

TEST_F(MtlFile, WhatIsIgnoredIsToldOnce) {
    parse("newmtl a\nmap_Ks a.png\nmap_Ks b.png\nfoo\nd -halo 0.5\nKd spectral a.rfl\n");
    const std::vector<std::string> expected{
        "a.mtl:2: 'map_Ks' is ignored", "a.mtl:4: 'foo' is unknown and ignored",
        "a.mtl:5: 'd -halo' is ignored: opacity does not depend on the direction",
        "a.mtl:6: 'Kd' is ignored: expected 3 numbers (R G B)"};
    EXPECT_EQ(warnings_.messages(), expected);
}

TEST_F(MtlFile, MistakesAreSentences) {
    const struct {
        const char *text, *sentence;
    } cases[] = {
        {"Kd 1 1 1\n", "a.mtl:1: read 'Kd' before the first material; expected 'newmtl'"},
        {"newmtl a\nKd\n", "a.mtl:2: the line ends early; expected 3 numbers (R G B) for 'Kd'"},
        {"newmtl a\nKd 1 x 1\n", "a.mtl:2: read 'x'; expected 3 numbers (R G B)"},
        {"newmtl a\nKd red\n", "a.mtl:2: read 'red'; expected 3 numbers (R G B) for 'Kd'"},
        {"newmtl a\nKs 1 1 -1\n", "a.mtl:2: a colour has a negative component"},
        {"newmtl a\nd 2\n", "a.mtl:2: 'd' is 2; expected 0 to 1"},
        {"newmtl a\nTr -1\n", "a.mtl:2: 'Tr' is -1; expected 0 to 1"},
        {"newmtl a\nillum twelve\n", "a.mtl:2: read 'twelve'; expected a number for 'illum'"},
        {"newmtl a\nillum 12\n", "a.mtl:2: 'illum' is 12; expected 0 to 10"},
        {"newmtl a\nNs -5\n", "a.mtl:2: 'Ns' is -5; expected 0 to 1e+09"},
        {"newmtl a\nPr 1.5\n", "a.mtl:2: 'Pr' is 1.5; expected 0 to 1"},
        {"newmtl a\nmap_Kd\n", "a.mtl:2: the line ends early; expected the name of a picture"},
        {"newmtl a\nmap_Kd -wrap on a.png\n", "a.mtl:2: unknown option '-wrap' of a picture"},
        {"newmtl a\nmap_Kd -bm a.png\n", "a.mtl:2: read 'a.png'; expected a number"},
    };
    for (const auto& c : cases) EXPECT_EQ(mtl_error(c.text), c.sentence) << c.text;
}

} // namespace
} // namespace montelux
