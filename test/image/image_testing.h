// Helpers of the image tests: pictures with known contents, expected sentences.
#pragma once

#include "test/temporary_folder.h"
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <string>
#include <unistd.h>

#include "montelux/image/cube_map.h"
#include "montelux/image/image.h"
#include "montelux/mc/math/error.h"

namespace montelux {

inline void write_bytes(const std::filesystem::path& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
}

inline std::string read_bytes(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

// A fixed sequence that looks random: the mixing function of splitmix64 (Steele et al. 2014).
inline double noise(std::uint64_t i) {
    std::uint64_t z = (i + 1) * 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    z ^= z >> 31;
    return static_cast<double>(z >> 11) * 0x1p-53;
}

// Light between 1/256 and 4, another value at each place.
inline CubeMapChain chain_of_noise(int size, int levels) {
    CubeMapChain chain;
    std::uint64_t i = 0;
    for (int level = 0; level < levels; ++level) {
        chain.levels.push_back(make_cube_map(level_size(size, level)));
        for (Image& face : chain.levels.back().faces)
            for (float& v : face.f32()) v = static_cast<float>(std::exp2(10 * noise(++i) - 8));
    }
    return chain;
}

// Positive and negative values over many orders of magnitude.
inline Image make_picture(int width, int height, std::vector<std::string> channels) {
    Image image(width, height, std::move(channels));
    for (std::size_t i = 0; i < image.sample_count(); ++i)
        image.f32()[i] = static_cast<float>((noise(2 * i) - 0.3) * std::exp2(40 * (noise(2 * i + 1) - 0.5)));
    return image;
}

inline bool same_bits(std::span<const float> a, std::span<const float> b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size_bytes()) == 0;
}

// Runs `action`, which must throw an Error that mentions all of `parts`.
template <typename Action>
void expect_error(Action action, std::initializer_list<std::string> parts) {
    try {
        action();
    } catch (const Error& e) {
        for (const std::string& part : parts)
            EXPECT_NE(std::string(e.what()).find(part), std::string::npos)
                << "'" << part << "' is missing in: " << e.what();
        return;
    }
    ADD_FAILURE() << "no Error was thrown";
}

} // namespace montelux
