// Lanes: several floats side by side in one vector register, with the arithmetic of one.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <concepts>
#include <cstdint>

#include "montelux/mc/math/number.h"

namespace montelux {

// A number type of formulas (number.h). Every operation is that of one float in each lane, rounded the same:
// a lane has the bits that float would have.

// Floats in a vector register of the processor that is compiled for.
#if defined(__AVX512F__) && defined(__AVX512DQ__) && defined(__AVX512BW__)
inline constexpr int native_lanes = 16;
#elif defined(__AVX2__)
inline constexpr int native_lanes = 8;
#else
inline constexpr int native_lanes = 4;
#endif

// The compiler's own vector types: + - * / and comparisons work lane by lane.
template <int W>
struct VectorTypes;
template <>
struct VectorTypes<4> {
    typedef float Float __attribute__((vector_size(16)));
    typedef std::int32_t Int __attribute__((vector_size(16)));
    typedef std::uint32_t Bits __attribute__((vector_size(16)));
};
template <>
struct VectorTypes<8> {
    typedef float Float __attribute__((vector_size(32)));
    typedef std::int32_t Int __attribute__((vector_size(32)));
    typedef std::uint32_t Bits __attribute__((vector_size(32)));
};
template <>
struct VectorTypes<16> {
    typedef float Float __attribute__((vector_size(64)));
    typedef std::int32_t Int __attribute__((vector_size(64)));
    typedef std::uint32_t Bits __attribute__((vector_size(64)));
};

// One condition per lane.
template <int W>
struct LaneMask {
    using Vector = typename VectorTypes<W>::Int;
    Vector v; // -1 or 0

    LaneMask() = default;
    explicit LaneMask(Vector mask) : v(mask) {}
    LaneMask(bool all) : v(Vector{} - static_cast<std::int32_t>(all)) {}
    // The first n lanes.
    static LaneMask first(int n) {
        Vector mask;
        for (int i = 0; i < W; ++i) mask[i] = i < n ? -1 : 0;
        return LaneMask(mask);
    }

    bool operator[](int lane) const { return v[lane] != 0; }
    void set(int lane, bool value) { v[lane] = value ? -1 : 0; }
    friend LaneMask operator&(LaneMask a, LaneMask b) { return LaneMask(a.v & b.v); }
    friend LaneMask operator|(LaneMask a, LaneMask b) { return LaneMask(a.v | b.v); }
    friend LaneMask operator!(LaneMask a) { return LaneMask(~a.v); }
};

// One unsigned integer of 32 bits per lane.
template <int W>
struct LaneBits {
    using Vector = typename VectorTypes<W>::Bits;
    Vector v;

    LaneBits() = default;
    explicit LaneBits(Vector bits) : v(bits) {}
    LaneBits(std::uint32_t bits) : v(Vector{} + bits) {}

    std::uint32_t operator[](int lane) const { return v[lane]; }
    void set(int lane, std::uint32_t bits) { v[lane] = bits; }
    friend LaneBits operator+(LaneBits a, LaneBits b) { return LaneBits(a.v + b.v); }
    friend LaneBits operator*(LaneBits a, LaneBits b) { return LaneBits(a.v * b.v); }
    friend LaneBits operator&(LaneBits a, LaneBits b) { return LaneBits(a.v & b.v); }
    friend LaneBits operator|(LaneBits a, LaneBits b) { return LaneBits(a.v | b.v); }
    friend LaneBits operator^(LaneBits a, LaneBits b) { return LaneBits(a.v ^ b.v); }
    friend LaneBits operator<<(LaneBits a, int bits) { return LaneBits(a.v << bits); }
    friend LaneBits operator>>(LaneBits a, int bits) { return LaneBits(a.v >> bits); }
    friend LaneMask<W> operator==(LaneBits a, LaneBits b) { return LaneMask<W>(a.v == b.v); }
};

template <int W>
struct Lanes {
    using Vector = typename VectorTypes<W>::Float;
    Vector v{};

    Lanes() = default;
    explicit Lanes(Vector values) : v(values) {}
    Lanes(float all) : v(all - Vector{}) {} // adding would lose the sign of -0
    template <typename F>
    requires std::invocable<F, int>
    static Lanes from(F&& value_of_lane) {
        Lanes r;
        for (int i = 0; i < W; ++i) r.v[i] = value_of_lane(i);
        return r;
    }

    float operator[](int lane) const { return v[lane]; }
    void set(int lane, float value) { v[lane] = value; }
    friend Lanes operator+(Lanes a, Lanes b) { return Lanes(a.v + b.v); }
    friend Lanes operator-(Lanes a, Lanes b) { return Lanes(a.v - b.v); }
    friend Lanes operator*(Lanes a, Lanes b) { return Lanes(a.v * b.v); }
    friend Lanes operator/(Lanes a, Lanes b) { return Lanes(a.v / b.v); }
    Lanes operator-() const { return Lanes(-v); }
    Lanes& operator+=(Lanes b) { return *this = *this + b; }
    Lanes& operator-=(Lanes b) { return *this = *this - b; }
    Lanes& operator*=(Lanes b) { return *this = *this * b; }
    Lanes& operator/=(Lanes b) { return *this = *this / b; }
    friend LaneMask<W> operator<(Lanes a, Lanes b) { return LaneMask<W>(a.v < b.v); }
    friend LaneMask<W> operator>(Lanes a, Lanes b) { return LaneMask<W>(a.v > b.v); }
    friend LaneMask<W> operator<=(Lanes a, Lanes b) { return LaneMask<W>(a.v <= b.v); }
    friend LaneMask<W> operator>=(Lanes a, Lanes b) { return LaneMask<W>(a.v >= b.v); }
    friend LaneMask<W> operator==(Lanes a, Lanes b) { return LaneMask<W>(a.v == b.v); }
    friend LaneMask<W> operator!=(Lanes a, Lanes b) { return LaneMask<W>(a.v != b.v); }
};

template <int W>
Lanes<W> select(LaneMask<W> m, Lanes<W> a, Lanes<W> b) {
    return Lanes<W>(m.v ? a.v : b.v);
}
template <int W>
LaneBits<W> select(LaneMask<W> m, LaneBits<W> a, LaneBits<W> b) {
    return LaneBits<W>(m.v ? a.v : b.v);
}

// As the functions of the same names in std, ties and NaN included; unqualified calls find both.
template <int W>
Lanes<W> min(Lanes<W> a, Lanes<W> b) {
    return Lanes<W>(b.v < a.v ? b.v : a.v);
}
template <int W>
Lanes<W> max(Lanes<W> a, Lanes<W> b) {
    return Lanes<W>(a.v < b.v ? b.v : a.v);
}
template <int W>
LaneBits<W> bits_of(Lanes<W> a) {
    return LaneBits<W>(std::bit_cast<typename LaneBits<W>::Vector>(a.v));
}
template <int W>
Lanes<W> of_bits(LaneBits<W> a) {
    return Lanes<W>(std::bit_cast<typename Lanes<W>::Vector>(a.v));
}
template <int W>
Lanes<W> abs(Lanes<W> a) {
    return of_bits(bits_of(a) & LaneBits<W>(0x7fffffffu));
}
template <int W>
Lanes<W> copysign(Lanes<W> a, Lanes<W> sign) {
    return of_bits((bits_of(a) & LaneBits<W>(0x7fffffffu)) | (bits_of(sign) & LaneBits<W>(0x80000000u)));
}

// Conversions: to_float takes numbers below 2^31, to_bits cuts off fractions of numbers in [0, 2^31).
template <int W>
Lanes<W> to_float(LaneBits<W> a) {
    return Lanes<W>(
        __builtin_convertvector(std::bit_cast<typename LaneMask<W>::Vector>(a.v), typename Lanes<W>::Vector));
}
template <int W>
LaneBits<W> to_bits(Lanes<W> a) {
    return LaneBits<W>(std::bit_cast<typename LaneBits<W>::Vector>(
        __builtin_convertvector(a.v, typename LaneMask<W>::Vector)));
}

template <int W>
struct NumberTraits<Lanes<W>> {
    using Scalar = float;
    using Mask = LaneMask<W>;
    using Bits = LaneBits<W>;
    static constexpr int lanes = W;
};

} // namespace montelux
