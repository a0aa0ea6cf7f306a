// Ids of Cryptomatte: published hashes, ids that are normal floats, metadata.
#include <bit>
#include <cmath>
#include <gtest/gtest.h>
#include <string>

#include "montelux/image/cryptomatte.h"

namespace montelux {
namespace {

// Test vectors in circulation for MurmurHash3_x86_32, of all lengths of the tail.
TEST(Cryptomatte, MurmurHash3HasItsPublishedValues) {
    struct Vector {
        std::string_view text;
        std::uint32_t seed, hash;
    };
    using namespace std::literals;
    for (const Vector& v : {Vector{"", 0, 0},
                            {"", 1, 0x514e28b7},
                            {"", 0xffffffff, 0x81f16f39},
                            {"\xff\xff\xff\xff", 0, 0x76293b50},
                            {"\x21\x43\x65\x87", 0, 0xf55b516b},
                            {"\x21\x43\x65\x87", 0x5082edee, 0x2362f9de},
                            {"\x21\x43\x65", 0, 0x7e4a8634},
                            {"\x21\x43", 0, 0xa0f7b07a},
                            {"\x21", 0, 0x72661cf4},
                            {"\0\0\0\0"sv, 0, 0x2362f9de},
                            {"\0\0\0"sv, 0, 0x85f0b427},
                            {"\0\0"sv, 0, 0x30f4c306},
                            {"\0"sv, 0, 0x514e28b7},
                            {"test", 0, 0xba6bd213},
                            {"Hello, world!", 0, 0xc0363e43},
                            {"The quick brown fox jumps over the lazy dog", 0, 0x2e4ff723}})
        EXPECT_EQ(murmur_hash_3(v.text, v.seed), v.hash) << v.text;
}

TEST(Cryptomatte, IdsAreNormalFloats) {
    int turned = 0;
    for (int i = 0; i < 20000; ++i) {
        const std::string name = "shape-" + std::to_string(i);
        const std::uint32_t id = cryptomatte_id(name), hash = murmur_hash_3(name);
        EXPECT_TRUE(std::isnormal(std::bit_cast<float>(id)));
        if (id == hash) continue;
        ++turned;
        EXPECT_EQ(id ^ hash, 1u << 23);
        EXPECT_FALSE(std::isnormal(std::bit_cast<float>(hash)));
    }
    EXPECT_GT(turned, 100); // about 2 in 256
}

TEST(Cryptomatte, MetadataNamesWhatTheImageContains) {
    // Keys of files in circulation.
    EXPECT_EQ(murmur_hash_3("crypto_object") >> 4, 0xf834d0au);
    EXPECT_EQ(murmur_hash_3("crypto_material") >> 4, 0xbda530au);
    EXPECT_EQ(cryptomatte_id("default"), 0x42c9679fu);
    Image image(2, 1, cryptomatte_channels("crypto_object"));
    EXPECT_EQ(image.channel_names()[0], "crypto_object00.R");
    EXPECT_EQ(image.channel_names()[11], "crypto_object02.A");
    const std::uint32_t bunny = cryptomatte_id("bunny"), quoted = cryptomatte_id("a \"b\"\n");
    image.set(0, 0, *image.find_channel("crypto_object00.R"), std::bit_cast<float>(bunny));
    image.set(1, 0, *image.find_channel("crypto_object02.B"), std::bit_cast<float>(quoted));
    add_cryptomatte_metadata(image, "crypto_object",
                             {{bunny, "bunny"}, {quoted, "a \"b\"\n"}, {cryptomatte_id("absent"), "absent"}});
    const auto text = [&](const char* key) {
        return std::get<std::string>(image.attributes().at(std::string("cryptomatte/f834d0a/") + key));
    };
    EXPECT_EQ(text("name"), "crypto_object");
    EXPECT_EQ(text("hash"), "MurmurHash3_32");
    EXPECT_EQ(text("conversion"), "uint32_to_float32");
    EXPECT_NE(text("manifest").find("\"bunny\":\"13851a76\""), std::string::npos) << text("manifest");
    EXPECT_NE(text("manifest").find("\"a \\\"b\\\"\\u000a\":\""), std::string::npos) << text("manifest");
    EXPECT_EQ(text("manifest").find("absent"), std::string::npos);
}

} // namespace
} // namespace montelux
