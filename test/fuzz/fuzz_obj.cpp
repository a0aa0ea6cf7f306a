// OBJ and MTL files: the first byte says which.
#include "test/fuzz/fuzz_target.h"

#include "montelux/formats/obj/mtl.h"
#include "montelux/formats/obj/obj.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    montelux::Warnings warnings;
    const std::span<const std::uint8_t> bytes{data, size};
    const bool is_mtl = size > 0 && data[0] == 'n'; // newmtl
    return montelux::read_or_refuse([&] {
        is_mtl ? static_cast<void>(montelux::parse_mtl(bytes, "a.mtl", warnings))
               : static_cast<void>(montelux::parse_obj(bytes, "a.obj", warnings));
    });
}
