// Cryptomatte: ids of named things in the channels of a picture, and their metadata.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "montelux/image/image.h"

namespace montelux {

// Friedman and Jones 2015, "Fully Automatic ID Mattes with Support for Motion Blur and Transparency"; Psyop's
// specification, version 1.2. A layer NAME has the channels NAME00.R, G, B, A, NAME01.R ...: id and coverage of the
// names that cover the pixel most, in pairs, the largest coverage first.
inline constexpr std::size_t cryptomatte_ranks = 6;

// MurmurHash3_x86_32 (Austin Appleby, public domain) of the bytes.
std::uint32_t murmur_hash_3(std::string_view bytes, std::uint32_t seed = 0);
// The id of a name: its hash, with the lowest bit of the exponent turned where the bits would be those of no normal
// float. The layers hold the float of these bits.
std::uint32_t cryptomatte_id(std::string_view name);

std::vector<std::string> cryptomatte_channels(std::string_view layer);

// Sets the attributes cryptomatte/KEY/name, hash, conversion and manifest for a layer of the image. The manifest
// lists those of `names` (by id) that the image contains.
void add_cryptomatte_metadata(Image& image, std::string_view layer,
                              const std::map<std::uint32_t, std::string>& names);

} // namespace montelux
