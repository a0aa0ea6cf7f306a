// ValueHash: one 128-bit digest of a sequence of plain values.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "montelux/scene/content_digest.h"

namespace montelux {

// Protects against mistakes (a scene that changed between two runs), not against forgery. Floats are hashed
// by their bits. A sequence of variable length is preceded by its length, so different sequences differ.
class ValueHash {
  public:
    template <typename T>
    requires(std::is_arithmetic_v<T> || std::is_enum_v<T>) void add(T value) {
        add_bytes(&value, sizeof value);
    }
    // `data` may be null where there is none.
    void add_bytes(const void* data, std::size_t size) {
        if (size == 0) return;
        if (size > buffer_.size() - used_) return add_slowly(data, size);
        std::memcpy(buffer_.data() + used_, data, size);
        used_ += size;
    }
    // Hash of all values so far.
    ContentDigest value() const;

  private:
    void add_slowly(const void* data, std::size_t size);
    void flush();

    ContentDigest digest_; // without the buffer
    std::array<std::uint8_t, 4096> buffer_;
    std::size_t used_ = 0;
};

} // namespace montelux
