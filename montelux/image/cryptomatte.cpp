#include "montelux/image/cryptomatte.h"

#include <bit>
#include <cstdio>
#include <cstring>
#include <set>

namespace montelux {
namespace {

std::string hexadecimal_id(std::uint32_t id) {
    char text[9];
    std::snprintf(text, sizeof text, "%08x", id);
    return text;
}

// A string of JSON.
std::string in_json(std::string_view text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') out += '\\';
        if (static_cast<unsigned char>(c) < 0x20) {
            char code[7];
            std::snprintf(code, sizeof code, "\\u%04x", static_cast<unsigned>(c));
            out += code;
        } else {
            out += c;
        }
    }
    return out + '"';
}

} // namespace

std::uint32_t murmur_hash_3(std::string_view bytes, std::uint32_t seed) {
    constexpr std::uint32_t c1 = 0xcc9e2d51, c2 = 0x1b873593;
    const auto scrambled = [](std::uint32_t k) { return std::rotl(k * c1, 15) * c2; };
    std::uint32_t h = seed;
    std::size_t i = 0;
    for (; i + 4 <= bytes.size(); i += 4) {
        std::uint32_t k = 0;
        std::memcpy(&k, bytes.data() + i, 4);
        h = std::rotl(h ^ scrambled(k), 13) * 5 + 0xe6546b64;
    }
    std::uint32_t tail = 0;
    for (std::size_t j = bytes.size(); j > i; --j) tail = tail << 8 | static_cast<std::uint8_t>(bytes[j - 1]);
    h ^= scrambled(tail);
    h ^= static_cast<std::uint32_t>(bytes.size());
    h = (h ^ h >> 16) * 0x85ebca6b;
    h = (h ^ h >> 13) * 0xc2b2ae35;
    return h ^ h >> 16;
}

std::uint32_t cryptomatte_id(std::string_view name) {
    const std::uint32_t hash = murmur_hash_3(name), exponent = hash >> 23 & 255;
    return exponent == 0 || exponent == 255 ? hash ^ 1u << 23 : hash;
}

std::vector<std::string> cryptomatte_channels(std::string_view layer) {
    std::vector<std::string> names;
    for (std::size_t rank = 0; rank < cryptomatte_ranks; ++rank) {
        const std::string level = std::string(layer) + "0" + std::to_string(rank / 2);
        names.push_back(level + (rank % 2 == 0 ? ".R" : ".B"));
        names.push_back(level + (rank % 2 == 0 ? ".G" : ".A"));
    }
    return names;
}

void add_cryptomatte_metadata(Image& image, std::string_view layer,
                              const std::map<std::uint32_t, std::string>& names) {
    std::set<std::uint32_t> ids;
    const std::vector<std::string> channels = cryptomatte_channels(layer);
    for (std::size_t c = 0; c < channels.size(); c += 2)
        if (const auto channel = image.find_channel(channels[c]))
            for (int y = 0; y < image.height(); ++y)
                for (int x = 0; x < image.width(); ++x)
                    ids.insert(std::bit_cast<std::uint32_t>(image.value(x, y, *channel)));
    std::string manifest = "{";
    for (const std::uint32_t id : ids)
        if (const auto found = names.find(id); found != names.end())
            manifest +=
                (manifest.size() > 1 ? "," : "") + in_json(found->second) + ":\"" + hexadecimal_id(id) + '"';
    const std::string key = "cryptomatte/" + hexadecimal_id(murmur_hash_3(layer)).substr(0, 7) + "/";
    Attributes& a = image.attributes();
    a[key + "name"] = std::string(layer);
    a[key + "hash"] = std::string("MurmurHash3_32");
    a[key + "conversion"] = std::string("uint32_to_float32");
    a[key + "manifest"] = manifest + "}";
}

} // namespace montelux
