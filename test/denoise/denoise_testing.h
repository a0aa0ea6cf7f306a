// A noisy picture whose truth is known, and stand-ins for the library, for the tests of denoising.
#pragma once

#include <cmath>
#include <cstdint>
#include <gtest/gtest.h>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "montelux/denoise/denoiser.h"
#include "montelux/mc/math/error.h"

namespace montelux::denoise_testing {

// Uniform on [0, 1): SplitMix64 of Steele, Lea and Flood, "Fast splittable pseudorandom number generators".
inline double uniform(std::uint64_t index) {
    std::uint64_t z = (index + 1) * 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

// A floor that grows brighter to the right, and on its left half-plane of light a darker square with a sharp
// rim; the noise is multiplicative with mean 1 and standard deviation 0.5.
struct Synthetic {
    int width, height;
    std::vector<float> truth, noisy, albedo, normal;

    explicit Synthetic(int w = 96, int h = 64) : width(w), height(h) {
        for (int y = 0; y < h; ++y)
            for (int x = 0; x < w; ++x) {
                bool square = in_square(x, y);
                float light = 0.5f + 2.0f * static_cast<float>(x) / static_cast<float>(w);
                for (int c = 0; c < 3; ++c) {
                    float a = square ? 0.1f : 0.8f - 0.1f * static_cast<float>(c);
                    float n = c == (square ? 0 : 2) ? 1.0f : 0.0f;
                    double u = uniform(truth.size());
                    truth.push_back(a * light);
                    noisy.push_back(a * light * static_cast<float>(1 + 0.5 * std::sqrt(12.0) * (u - 0.5)));
                    albedo.push_back(a);
                    normal.push_back(n);
                }
            }
    }
    bool in_square(int x, int y) const {
        return x >= width / 3 && x < 2 * width / 3 && y >= height / 4 && y < 3 * height / 4;
    }
    DenoiserInput input() const { return {width, height, noisy, albedo, normal}; }
};

// Root mean square difference relative to the truth.
inline double relative_error(const std::vector<float>& picture, const std::vector<float>& truth) {
    double sum = 0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
        double d = (double(picture[i]) - double(truth[i])) / double(truth[i]);
        sum += d * d;
    }
    return std::sqrt(sum / static_cast<double>(truth.size()));
}

// The message of the Error that f throws; empty when it throws none.
template <typename F>
std::string error_of(const F& f) {
    try {
        f();
    } catch (const Error& e) {
        return e.what();
    }
    return "";
}

// The real library, where this machine has it.
class RealDenoiser : public ::testing::Test {
  protected:
    void SetUp() override {
        try {
            denoiser_.emplace(Denoiser::load(2));
        } catch (const Error& e) {
            GTEST_SKIP() << e.what();
        }
    }
    std::optional<Denoiser> denoiser_;
};

// What a stand-in for the library does, and the calls that it received.
struct StandIn {
    int version = 20501;
    std::string fail_at; // the name of the call that fails next
    bool no_device = false, no_filter = false;
    float output = 0.25f;

    int devices = 0, filters = 0, threads = -1;
    bool affinity = true;
    bool bad_input = false;        // a number that is not finite, or a colour below 0, reached the filter
    std::vector<std::string> runs; // the images and switches of each execution
    // Inputs by name, from the first execution that has them.
    std::map<std::string, std::vector<float>> inputs;
    std::string error;
};

// Calls go to the one stand-in that was set up last.
OidnApi api_of(StandIn& stand_in);

} // namespace montelux::denoise_testing
