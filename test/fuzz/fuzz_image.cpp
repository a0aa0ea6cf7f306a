// Pictures other than EXR: PNG, JPEG, Radiance HDR, PFM, PNM, BMP; anything else is read as TGA, which has no
// signature.
#include "test/fuzz/fuzz_target.h"
#include <cstring>

#include "montelux/image/image_read.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size >= 4 && std::memcmp(data, "\x76\x2f\x31\x01", 4) == 0) return 0; // fuzz_exr
    return montelux::read_or_refuse([&] { montelux::read_image({data, size}, "a.tga"); });
}
