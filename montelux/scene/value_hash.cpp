#include "montelux/scene/value_hash.h"

#define XXH_INLINE_ALL // header only
#include <xxhash.h>

namespace montelux {
namespace {

// XXH3 (Collet 2020, https://xxhash.com) of each piece, chained by XXH3 of both digests and the size.
ContentDigest chained(ContentDigest before, const void* data, std::size_t size) {
    const XXH128_hash_t piece = XXH3_128bits(data, size);
    const std::uint64_t link[] = {before.high, before.low, piece.high64, piece.low64, size};
    const XXH128_hash_t joined = XXH3_128bits(link, sizeof link);
    return {joined.high64, joined.low64};
}

} // namespace

void ValueHash::flush() {
    if (used_ == 0) return;
    digest_ = chained(digest_, buffer_.data(), used_);
    used_ = 0;
}

void ValueHash::add_slowly(const void* data, std::size_t size) {
    flush();
    if (size <= buffer_.size())
        add_bytes(data, size);
    else
        digest_ = chained(digest_, data, size);
}

ContentDigest ValueHash::value() const { return chained(digest_, buffer_.data(), used_); }

} // namespace montelux
