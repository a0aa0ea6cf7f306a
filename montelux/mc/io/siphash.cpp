#include "montelux/mc/io/siphash.h"

#include <bit>
#include <cstring>

namespace montelux {

static_assert(std::endian::native == std::endian::little, "words are read as they are in memory");

SipHash128::SipHash128(std::uint64_t key0, std::uint64_t key1)
    : state_{key0 ^ 0x736f6d6570736575, key1 ^ 0x646f72616e646f6d ^ 0xee, key0 ^ 0x6c7967656e657261,
             key1 ^ 0x7465646279746573} {}

inline void SipHash128::State::round() {
    v0 += v1, v2 += v3;
    v1 = std::rotl(v1, 13) ^ v0, v3 = std::rotl(v3, 16) ^ v2;
    v0 = std::rotl(v0, 32);
    v2 += v1, v0 += v3;
    v1 = std::rotl(v1, 17) ^ v2, v3 = std::rotl(v3, 21) ^ v0;
    v2 = std::rotl(v2, 32);
}

inline void SipHash128::State::compress(std::uint64_t word) {
    v3 ^= word;
    round();
    round();
    v0 ^= word;
}

std::uint64_t SipHash128::State::finalise() {
    for (int i = 0; i < 4; ++i) round();
    return v0 ^ v1 ^ v2 ^ v3;
}

void SipHash128::add(std::span<const std::uint8_t> bytes) {
    std::size_t i = 0;
    auto add_byte = [&] {
        partial_ |= std::uint64_t{bytes[i++]} << (8 * (length_ % 8));
        if (++length_ % 8 != 0) return;
        state_.compress(partial_);
        partial_ = 0;
    };
    while (i < bytes.size() && length_ % 8 != 0) add_byte();
    State state = state_; // in registers
    const std::size_t words = (bytes.size() - i) / 8;
    for (std::size_t w = 0; w < words; ++w, i += 8) {
        std::uint64_t word = 0;
        std::memcpy(&word, bytes.data() + i, sizeof word);
        state.compress(word);
    }
    state_ = state;
    length_ += 8 * words;
    while (i < bytes.size()) add_byte();
}

std::array<std::uint64_t, 2> SipHash128::digest() const {
    State state = state_;
    state.compress(partial_ | length_ << 56);
    state.v2 ^= 0xee;
    const std::uint64_t first = state.finalise();
    state.v1 ^= 0xdd;
    const std::uint64_t second = state.finalise();
    return {first, second};
}

} // namespace montelux
