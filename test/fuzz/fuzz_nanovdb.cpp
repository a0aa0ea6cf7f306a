// NanoVDB files: the table of contents and the grid "density". A grid has tables of 256 kB, nearly all zeros, which
// no fuzzer gets through: an input that begins with 'Z' is a file with its runs of zeros packed.
#include "test/fuzz/fuzz_target.h"
#include <vector>

#include "montelux/formats/nanovdb_file.h"

namespace {

// A zero byte and a byte n stand for n + 1 zeros, or (n - 127) * 4096 from n = 128 on.
std::vector<std::uint8_t> unpack_zeros(std::span<const std::uint8_t> packed) {
    constexpr std::size_t most = std::size_t{2} << 20;
    std::vector<std::uint8_t> file;
    for (std::size_t i = 0; i < packed.size() && file.size() < most; ++i) {
        if (packed[i] == 0 && i + 1 < packed.size()) {
            const std::size_t n = packed[++i];
            file.insert(file.end(), n < 128 ? n + 1 : (n - 127) * 4096, 0);
        } else {
            file.push_back(packed[i]);
        }
    }
    file.shrink_to_fit(); // so that the address sanitizer sees reads beyond the end
    return file;
}

} // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    std::span<const std::uint8_t> bytes(data, size);
    std::vector<std::uint8_t> unpacked;
    if (size > 0 && data[0] == 'Z') bytes = unpacked = unpack_zeros(bytes.subspan(1));
    return montelux::read_or_refuse([&] {
        const montelux::NanovdbFile file(bytes, "a.nvdb");
        file.grid_names();
        file.read("density");
    });
}
