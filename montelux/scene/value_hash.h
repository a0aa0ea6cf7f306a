// ValueHash: one 128-bit digest of a sequence of plain values.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "montelux/scene/content_digest.h"

namespace montelux {

// Protects against mistakes (a scene that changed between two runs), not against forgery. Floats count by
// their bits. What has a length of its own adds that first, so that no two sequences run together alike.
class ValueHash {
  public:
    template <typename T>
    requires(std::is_arithmetic_v<T> || std::is_enum_v<T>) void add(T value) {
        add_bytes(&value, sizeof value);
    }
    void add_bytes(const void* data, std::size_t size) {
        if (size > buffer_.size() - used_) return add_slowly(data, size);
        std::memcpy(buffer_.data() + used_, data, size);
        used_ += size;
    }
    // Of all values so far.
    ContentDigest value() const;

  private:
    void add_slowly(const void* data, std::size_t size);
    void flush();

    ContentDigest digest_; // of all but what is in the buffer
    std::array<std::uint8_t, 4096> buffer_;
    std::size_t used_ = 0;
};

} // namespace montelux
