// A strict reader of KTX 2.0 files for the tests, written from the specification and not from the writer.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace montelux {

struct Ktx2Contents {
    std::uint32_t format = 0, type_size = 0, width = 0, height = 0, faces = 0;
    std::uint32_t color_primaries = 0;
    std::vector<std::uint32_t> descriptor; // with its total size
    std::map<std::string, std::string> notes;
    std::vector<std::string> levels; // level 0 first: its faces one after the other

    int level_width(int level) const { return width >> level > 0 ? width >> level : 1; }
};

// Throws std::runtime_error that names the rule which the bytes break: sizes, offsets, order, alignment,
// padding, descriptor, key/value data. Volumes, arrays and supercompression count as broken here.
Ktx2Contents read_ktx2(const std::string& bytes);

// Texel (x, y) of a face as light, decoded by the definition of the format. Where the format has fewer than
// four numbers, the rest is 0, 0, 1.
struct Texel {
    double v[4];
};
Texel ktx2_texel(const Ktx2Contents& file, int level, int face, int x, int y);

double decode_half(std::uint32_t bits);
// 5 bits of exponent above `mantissa` bits.
double decode_small_float(std::uint32_t bits, int mantissa);

} // namespace montelux
