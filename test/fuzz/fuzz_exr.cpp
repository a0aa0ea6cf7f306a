// EXR pictures: headers, and pixels in every compression.
#include "test/fuzz/fuzz_target.h"
#include <cstring>

#include "montelux/image/image_read.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size < 4 || std::memcmp(data, "\x76\x2f\x31\x01", 4) != 0) return 0;
    return montelux::read_or_refuse([&] { montelux::read_image({data, size}, "a.exr"); });
}
