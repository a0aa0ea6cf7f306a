#include "montelux/mc/math/gradient_noise.h"

#include <array>
#include <cmath>
#include <cstdint>

namespace montelux {

namespace {

// Perlin's random permutation of 0 to 255.
constexpr std::array<std::uint8_t, 256> permutation = {
    151, 160, 137, 91,  90,  15,  131, 13,  201, 95,  96,  53,  194, 233, 7,   225, 140, 36,  103, 30,
    69,  142, 8,   99,  37,  240, 21,  10,  23,  190, 6,   148, 247, 120, 234, 75,  0,   26,  197, 62,
    94,  252, 219, 203, 117, 35,  11,  32,  57,  177, 33,  88,  237, 149, 56,  87,  174, 20,  125, 136,
    171, 168, 68,  175, 74,  165, 71,  134, 139, 48,  27,  166, 77,  146, 158, 231, 83,  111, 229, 122,
    60,  211, 133, 230, 220, 105, 92,  41,  55,  46,  245, 40,  244, 102, 143, 54,  65,  25,  63,  161,
    1,   216, 80,  73,  209, 76,  132, 187, 208, 89,  18,  169, 200, 196, 135, 130, 116, 188, 159, 86,
    164, 100, 109, 198, 173, 186, 3,   64,  52,  217, 226, 250, 124, 123, 5,   202, 38,  147, 118, 126,
    255, 82,  85,  212, 207, 206, 59,  227, 47,  16,  58,  17,  182, 189, 28,  42,  223, 183, 170, 213,
    119, 248, 152, 2,   44,  154, 163, 70,  221, 153, 101, 155, 167, 43,  172, 9,   129, 22,  39,  253,
    19,  98,  108, 110, 79,  113, 224, 232, 178, 185, 112, 104, 218, 246, 97,  228, 251, 34,  242, 193,
    238, 210, 144, 12,  191, 179, 162, 241, 81,  51,  145, 235, 249, 14,  239, 107, 49,  192, 214, 31,
    181, 199, 106, 157, 184, 84,  204, 176, 115, 121, 50,  45,  127, 4,   150, 254, 138, 236, 205, 93,
    222, 114, 67,  29,  24,  72,  243, 141, 128, 195, 78,  66,  215, 61,  156, 180};

std::uint32_t permuted(std::uint32_t i) { return permutation[i & 255u]; }

// Dot product of d and one of the 12 directions to the edges of a cube, chosen by a hash.
float slope(std::uint32_t hash, Vec3f d) {
    const std::uint32_t h = hash & 15u;
    const bool twelve = h == 12 || h == 13;
    const float u = h < 8 || twelve ? d.x : d.y;
    const float v = h < 4 || twelve ? d.y : d.z;
    return ((h & 1u) != 0 ? -u : u) + ((h & 2u) != 0 ? -v : v);
}

// Weight of the far end at t in [0, 1], with two continuous derivatives.
float fade(float t) { return t * t * t * (t * (t * 6 - 15) + 10); }

float mix(float t, float a, float b) { return (1 - t) * a + t * b; }

} // namespace

float gradient_noise(Point3f p) {
    std::array<std::uint32_t, 3> cell{};
    Vec3f d;
    for (int a = 0; a < 3; ++a) {
        // Far coordinates must fit an integer.
        const float x = std::fmod(p[a], 0x1p30f), floor = std::floor(x);
        cell[static_cast<std::size_t>(a)] = static_cast<std::uint32_t>(static_cast<std::int32_t>(floor));
        d[a] = x - floor;
    }
    const auto corner = [&](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
        const std::uint32_t hash = permuted(permuted(permuted(cell[0] + x) + cell[1] + y) + cell[2] + z);
        return slope(hash, d - Vec3f(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)));
    };
    const float wx = fade(d.x), wy = fade(d.y), wz = fade(d.z);
    const auto plane = [&](std::uint32_t z) {
        return mix(wy, mix(wx, corner(0, 0, z), corner(1, 0, z)), mix(wx, corner(0, 1, z), corner(1, 1, z)));
    };
    return mix(wz, plane(0), plane(1));
}

Vec3f gradient_noise_slope(Point3f p) {
    constexpr float step = 0.01f;
    const float here = gradient_noise(p);
    return Vec3f(gradient_noise(p + Vec3f(step, 0, 0)) - here, gradient_noise(p + Vec3f(0, step, 0)) - here,
                 gradient_noise(p + Vec3f(0, 0, step)) - here) /
           step;
}

} // namespace montelux
