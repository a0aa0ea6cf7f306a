// Files of measured BRDFs (.bsdf).
#include "test/fuzz/fuzz_target.h"

#include "montelux/formats/measured_brdf_file.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    return montelux::read_or_refuse([&] { montelux::read_measured_brdf({data, size}, "a.bsdf"); });
}
