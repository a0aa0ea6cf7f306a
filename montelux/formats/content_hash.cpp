#include "montelux/formats/content_hash.h"

#include <cstdint>

#define XXH_INLINE_ALL // nothing to link
#include <xxhash.h>

namespace montelux {

// XXH3 (Collet 2020, https://xxhash.com) of each piece, chained by XXH3 of both digests and the size.
void ContentHash::add(const void* data, std::size_t size) {
    const XXH128_hash_t piece = XXH3_128bits(data, size);
    const std::uint64_t link[] = {digest_.high, digest_.low, piece.high64, piece.low64, size};
    const XXH128_hash_t joined = XXH3_128bits(link, sizeof link);
    digest_ = {joined.high64, joined.low64};
}

} // namespace montelux
