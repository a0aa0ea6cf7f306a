#include <array>
#include <gtest/gtest.h>
#include <string>
#include <zlib.h>

#include "montelux/formats/content_hash.h"
#include "montelux/formats/gunzip.h"
#include "montelux/formats/nearest_name.h"
#include "montelux/formats/warnings.h"
#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

std::vector<std::uint8_t> gzip(const std::string& text) {
    std::vector<std::uint8_t> out(text.size() + 1000);
    z_stream z{};
    EXPECT_EQ(deflateInit2(&z, 6, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY), Z_OK);
    z.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
    z.avail_in = static_cast<uInt>(text.size());
    z.next_out = out.data();
    z.avail_out = static_cast<uInt>(out.size());
    EXPECT_EQ(deflate(&z, Z_FINISH), Z_STREAM_END);
    out.resize(z.total_out);
    deflateEnd(&z);
    return out;
}

TEST(NearestName, FindsMisspeltNames) {
    constexpr std::array<std::string_view, 4> names = {"roughness", "uroughness", "reflectance", "fov"};
    EXPECT_EQ(nearest_name("roughnes", names), "roughness");
    EXPECT_EQ(nearest_name("Reflectance", names), "reflectance");
    EXPECT_EQ(nearest_name("refelctance", names), "reflectance");
    EXPECT_EQ(nearest_name("fvo", names), "fov");
    EXPECT_EQ(nearest_name("illuminance", names), "");
    EXPECT_EQ(nearest_name("", names), "");
    EXPECT_EQ(did_you_mean("roughnes", names), " (did you mean 'roughness'?)");
    EXPECT_EQ(did_you_mean("zzz", names), "");
}

TEST(Warnings, KeepsEachMessageOnceAndIsBounded) {
    Warnings w;
    w.add("a:1:1", "first");
    w.add("a:1:1", "first");
    w.add("", "no place");
    EXPECT_EQ(w.messages(), (std::vector<std::string>{"a:1:1: first", "no place"}));
    for (int i = 0; i < 2000; ++i) w.add("b", std::to_string(i));
    EXPECT_EQ(w.messages().size(), Warnings::max_messages);
    EXPECT_EQ(w.left_out(), 2002 - Warnings::max_messages);
}

TEST(ContentHash, DependsOnBytesOrderAndBorders) {
    auto hash = [](std::initializer_list<std::string> pieces) {
        ContentHash h;
        for (const std::string& p : pieces) h.add(p.data(), p.size());
        return h.value();
    };
    EXPECT_EQ(hash({"some scene"}), hash({"some scene"}));
    EXPECT_NE(hash({"some scene"}), hash({"some scenf"}));
    EXPECT_NE(hash({"ab", "c"}), hash({"a", "bc"}));
    EXPECT_NE(hash({"a", "b"}), hash({"b", "a"}));
    EXPECT_NE(hash({"a"}), hash({std::string("a\0", 2)}));
    EXPECT_NE(hash({}), hash({""}));
}

TEST(Gunzip, UnpacksAllMembers) {
    std::string text;
    for (int i = 0; i < 100000; ++i) text += std::to_string(i);
    std::vector<std::uint8_t> packed = gzip(text), second = gzip("tail");
    EXPECT_EQ(gunzip(packed, "x", 1 << 20).size(), text.size());
    packed.insert(packed.end(), second.begin(), second.end());
    std::vector<std::uint8_t> all = gunzip(packed, "x", 1 << 20);
    EXPECT_EQ(std::string(all.begin(), all.end()), text + "tail");
}

TEST(Gunzip, RefusesDamageTruncationAndBombs) {
    std::vector<std::uint8_t> packed = gzip("a text that is long enough to be packed, packed, packed");
    for (std::size_t n = 0; n < packed.size(); ++n)
        EXPECT_THROW(gunzip(std::span(packed).first(n), "x", 1000), Error) << n;
    std::vector<std::uint8_t> damaged = packed;
    damaged[packed.size() - 6] ^= 1; // in the checksum
    EXPECT_THROW(gunzip(damaged, "x", 1000), Error);
    EXPECT_THROW(gunzip(gzip(std::string(20000, 'a')), "x", 19999), Error);
    EXPECT_EQ(gunzip(gzip(std::string(20000, 'a')), "x", 20000).size(), 20000u);
}

} // namespace
} // namespace montelux
