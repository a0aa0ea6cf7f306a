// Files that the library itself does not write: EXR of every kind, and JPEG.
#pragma once

#include <cstdint>
#include <string>

namespace montelux {

struct ExrKind {
    int compression = 3; // the number in the file format: 0 none ... 9 DWAB
    bool tiled = false;
    int level_mode = 0; // 0 one level, 1 mipmap, 2 ripmap
    bool round_up = false;
    int parts = 1;
    bool decreasing_lines = false;
};

// 70 x 50 pixels from (-3, 5) of channels "B", "G", "R" (half), "Z" (float) and "id" (uint) with the values
// of exr_sample; the data window lies inside a larger display window. More parts hold another picture.
std::string make_exr(const ExrKind& kind);
float exr_sample(const std::string& channel, int x, int y);

// A luminance channel and colour at half resolution.
std::string make_subsampled_exr();
std::string make_deep_exr();

// Sample (x, y, c) is 3 x + y + 40 c, before compression at quality 100.
std::string make_jpeg(int width, int height, int components, bool progressive);

} // namespace montelux
