#include "test/formats/gzip.h"
#include <array>
#include <gtest/gtest.h>
#include <string>

#include "montelux/formats/gunzip.h"
#include "montelux/formats/warnings.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/math/nearest_name.h"

namespace montelux {
namespace {

TEST(NearestName, FindsMisspeltNames) {
    constexpr std::array<std::string_view, 4> names = {"roughness", "uroughness", "reflectance", "fov"};
    EXPECT_EQ(nearest_name("roughnes", names), "roughness");
    EXPECT_EQ(nearest_name("Reflectance", names), "reflectance");
    EXPECT_EQ(nearest_name("refelctance", names), "reflectance");
    EXPECT_EQ(nearest_name("fvo", names), "fov");
    EXPECT_EQ(nearest_name("illuminance", names), "");
    EXPECT_EQ(nearest_name("", names), "");
    const std::string_view options[] = {"--spp", "--max-spp", "--time", "--sampler"},
                           arguments[] = {"spp", "max_spp"};
    EXPECT_EQ(nearest_name("--samples", options), "--spp");
    EXPECT_EQ(nearest_name("--spp-max", options), "--max-spp");
    EXPECT_EQ(nearest_name("--seconds", options), "--time");
    EXPECT_EQ(nearest_name("max_samples", arguments), "max_spp");
    EXPECT_EQ(nearest_name("seconds", arguments), ""); // ours is not among them
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

// The proportion counts from 16 MiB on.
TEST(Gunzip, RefusesWhatIsOutOfProportion) {
    constexpr std::size_t free = std::size_t{16} << 20, limit = std::size_t{1} << 30;
    EXPECT_EQ(gunzip(gzip(std::string(free, ' ')), "x", limit).size(), free);
    EXPECT_THROW(gunzip(gzip(std::string(free + 1, ' ')), "x", limit), Error);
    // Text that repeats itself more than any real one.
    std::string text;
    for (std::size_t i = 0; text.size() < 2 * free; ++i)
        text += std::to_string(i % 100000) + std::string(500, '0') + "\n";
    const std::vector<std::uint8_t> packed = gzip(text);
    EXPECT_GT(text.size() / packed.size(), 30u);
    EXPECT_EQ(gunzip(packed, "x", limit).size(), text.size());
}

} // namespace
} // namespace montelux
