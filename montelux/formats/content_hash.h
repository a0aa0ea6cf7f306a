// One 64-bit fingerprint of everything that a scene was read from.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace montelux {

// A fast fingerprint against mistakes (a file that changed between two runs), not against forgery.
// Depends on the bytes, on the order of the pieces and on where one piece ends and the next begins.
// The step is the multiply-rotate one of MurmurHash3 (Appleby 2011), the end its 64-bit finaliser.
class ContentHash {
  public:
    void add(const void* data, std::size_t size) {
        const auto* bytes = static_cast<const unsigned char*>(data);
        mix(size);
        std::size_t i = 0;
        for (; i + 8 <= size; i += 8) {
            std::uint64_t word;
            std::memcpy(&word, bytes + i, 8);
            mix(word);
        }
        std::uint64_t tail = 0;
        if (i < size) std::memcpy(&tail, bytes + i, size - i);
        mix(tail);
    }
    std::uint64_t value() const {
        std::uint64_t h = state_;
        h = (h ^ (h >> 33)) * 0xff51afd7ed558ccdULL;
        h = (h ^ (h >> 33)) * 0xc4ceb9fe1a85ec53ULL;
        return h ^ (h >> 33);
    }

  private:
    void mix(std::uint64_t word) {
        word *= 0x87c37b91114253d5ULL;
        word = std::rotl(word, 31) * 0x4cf5ad432745937fULL;
        state_ = std::rotl(state_ ^ word, 27) * 5 + 0x52dce729ULL;
    }
    std::uint64_t state_ = 0;
};

} // namespace montelux
