// PLY meshes.
#include "test/fuzz/fuzz_target.h"

#include "montelux/formats/ply.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    return montelux::read_or_refuse([&] { montelux::parse_ply({data, size}, "a.ply"); });
}
