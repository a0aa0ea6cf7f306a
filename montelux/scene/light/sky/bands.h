// Bands: values at the wavelengths of the sky model: 360, 370, ... 830 nm.
#pragma once

#include <algorithm>
#include <array>
#include <concepts>

#include "montelux/spectrum/float4.h"
#include "montelux/spectrum/wavelengths.h"

namespace montelux {

struct Bands {
    static constexpr int count = 48, vectors = count / 4;
    static constexpr float step = 10; // nm
    static constexpr float wavelength(int i) { return lambda_min + step * static_cast<float>(i); }

    std::array<Float4, vectors> v{};

    Bands() = default;
    explicit Bands(float c) { v.fill(broadcast(c)); }
    // The values of f at the wavelengths.
    template <typename F>
    requires std::invocable<F, float>
    static Bands from(F&& f) {
        Bands b;
        for (int i = 0; i < count; ++i) b.set(i, static_cast<float>(f(wavelength(i))));
        return b;
    }

    float operator[](int i) const { return v[static_cast<std::size_t>(i / 4)][i % 4]; }
    void set(int i, float x) { v[static_cast<std::size_t>(i / 4)][i % 4] = x; }

    Bands& operator+=(const Bands& b) {
        for (std::size_t i = 0; i < vectors; ++i) v[i] += b.v[i];
        return *this;
    }
    Bands& operator*=(const Bands& b) {
        for (std::size_t i = 0; i < vectors; ++i) v[i] *= b.v[i];
        return *this;
    }
    Bands& operator*=(float c) {
        for (Float4& x : v) x *= c;
        return *this;
    }
    // += c b
    void add(float c, const Bands& b) {
        for (std::size_t i = 0; i < vectors; ++i) v[i] += c * b.v[i];
    }
    friend Bands operator+(Bands a, const Bands& b) { return a += b; }
    friend Bands operator*(Bands a, const Bands& b) { return a *= b; }
    friend Bands operator*(float c, Bands b) { return b *= c; }
    friend Bands operator*(Bands b, float c) { return b *= c; }
    friend Bands operator/(Bands a, const Bands& b) {
        for (std::size_t i = 0; i < vectors; ++i) a.v[i] /= b.v[i];
        return a;
    }
    friend Bands exp(Bands b) {
        for (Float4& x : b.v) x = exp(x);
        return b;
    }
    friend float max_value(const Bands& b) {
        Float4 m = b.v[0];
        for (const Float4& x : b.v) m = max(m, x);
        return std::max(std::max(m[0], m[1]), std::max(m[2], m[3]));
    }
};

} // namespace montelux
