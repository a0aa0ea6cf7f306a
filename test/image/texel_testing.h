// Blocks of texels with known bytes.
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "montelux/image/texel_file.h"

namespace montelux::testing {

constexpr std::size_t mib = std::size_t{1} << 20;

// The byte at a place, different for neighbours and pages.
inline std::byte byte_at(std::size_t i) { return static_cast<std::byte>(i * 7 + i / 4096 * 13); }

inline std::shared_ptr<TexelBlock> filled_block(TexelFile& file, std::size_t size) {
    auto block = file.allocate(size);
    std::vector<std::byte> part;
    for (std::size_t i = 0; i < size; i += part.size()) {
        part.resize(std::min<std::size_t>(100000, size - i));
        for (std::size_t k = 0; k < part.size(); ++k) part[k] = byte_at(i + k);
        block->write(i, part);
    }
    return block;
}

// One byte of each page.
inline void read_pages(std::span<const std::byte> bytes) {
    volatile std::byte sink{};
    for (std::size_t i = 0; i < bytes.size(); i += 4096) sink = bytes[i];
    static_cast<void>(sink);
}

} // namespace montelux::testing
