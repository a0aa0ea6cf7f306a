// SipHash-2-4 with 128 bits of output: a checksum of bytes added in pieces.
#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace montelux {

// Aumasson and Bernstein, "SipHash: a fast short-input PRF" (2012); the longer output follows the authors'
// reference code. Under a fixed key random damage goes unnoticed with a probability of 2^-128. It does not
// guard against forgery: the key is known.
class SipHash128 {
  public:
    SipHash128(std::uint64_t key0, std::uint64_t key1);

    void add(std::span<const std::uint8_t> bytes);
    // Digest of all bytes added so far; more may follow.
    std::array<std::uint64_t, 2> digest() const;

  private:
    struct State {
        std::uint64_t v0, v1, v2, v3;
        void round();
        void compress(std::uint64_t word);
        std::uint64_t finalise();
    };
    State state_;
    std::uint64_t partial_ = 0, length_ = 0; // bytes that fill no word yet; bytes in all
};

} // namespace montelux
