// STL meshes.
#include "test/fuzz/fuzz_target.h"

#include "montelux/formats/stl.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    return montelux::read_or_refuse([&] { montelux::parse_stl({data, size}, "a.stl"); });
}
