// A spectrum's values at the four wavelengths that one camera path carries.
#pragma once

#include "montelux/spectrum/float4.h"

namespace montelux {

// Number of wavelengths that a path carries.
inline constexpr int spectrum_samples = 4;

// The owner defines the meaning of the values (radiance in W/(m^2 sr nm), reflectance, throughput, a
// density); a SampledWavelengths has their wavelengths.
struct alignas(16) SampledSpectrum {
    Float4 values{};

    SampledSpectrum() = default;
    explicit SampledSpectrum(float c) : values(broadcast(c)) {}
    explicit SampledSpectrum(Float4 v) : values(v) {}
    SampledSpectrum(float a, float b, float c, float d) : values{a, b, c, d} {}

    float operator[](int i) const { return values[i]; }
    void set(int i, float v) { values[i] = v; }

    bool operator==(const SampledSpectrum& b) const { return !any(values != b.values); }

    friend SampledSpectrum operator+(SampledSpectrum a, SampledSpectrum b) {
        return SampledSpectrum(a.values + b.values);
    }
    friend SampledSpectrum operator-(SampledSpectrum a, SampledSpectrum b) {
        return SampledSpectrum(a.values - b.values);
    }
    friend SampledSpectrum operator*(SampledSpectrum a, SampledSpectrum b) {
        return SampledSpectrum(a.values * b.values);
    }
    friend SampledSpectrum operator/(SampledSpectrum a, SampledSpectrum b) {
        return SampledSpectrum(a.values / b.values);
    }
    friend SampledSpectrum operator+(SampledSpectrum a, float b) { return SampledSpectrum(a.values + b); }
    friend SampledSpectrum operator+(float a, SampledSpectrum b) { return SampledSpectrum(a + b.values); }
    friend SampledSpectrum operator-(SampledSpectrum a, float b) { return SampledSpectrum(a.values - b); }
    friend SampledSpectrum operator-(float a, SampledSpectrum b) { return SampledSpectrum(a - b.values); }
    friend SampledSpectrum operator*(SampledSpectrum a, float b) { return SampledSpectrum(a.values * b); }
    friend SampledSpectrum operator*(float a, SampledSpectrum b) { return SampledSpectrum(a * b.values); }
    friend SampledSpectrum operator/(SampledSpectrum a, float b) {
        return SampledSpectrum(a.values * (1.0f / b));
    }
    friend SampledSpectrum operator/(float a, SampledSpectrum b) { return SampledSpectrum(a / b.values); }
    SampledSpectrum operator-() const { return SampledSpectrum(-values); }
    SampledSpectrum& operator+=(SampledSpectrum b) { return *this = *this + b; }
    SampledSpectrum& operator-=(SampledSpectrum b) { return *this = *this - b; }
    SampledSpectrum& operator*=(SampledSpectrum b) { return *this = *this * b; }
    SampledSpectrum& operator/=(SampledSpectrum b) { return *this = *this / b; }
    SampledSpectrum& operator*=(float b) { return *this = *this * b; }
    SampledSpectrum& operator/=(float b) { return *this = *this / b; }
};

// a / b where b is not zero, and 0 where it is.
inline SampledSpectrum safe_div(SampledSpectrum a, SampledSpectrum b) {
    Int4 zero = b.values == Float4{};
    return SampledSpectrum(select(zero, Float4{}, a.values / select(zero, broadcast(1.0f), b.values)));
}

inline float max_value(SampledSpectrum s) { return std::max(std::max(s[0], s[1]), std::max(s[2], s[3])); }
inline float min_value(SampledSpectrum s) { return std::min(std::min(s[0], s[1]), std::min(s[2], s[3])); }
inline float average(SampledSpectrum s) { return 0.25f * sum(s.values); }
// True when every value is zero; NaN is not black.
inline bool is_black(SampledSpectrum s) { return !any(s.values != Float4{}); }
inline bool has_nan(SampledSpectrum s) { return any(s.values != s.values); }
// No value is infinite or NaN.
inline bool all_finite(SampledSpectrum s) { return !any((s.values - s.values) != Float4{}); }
inline bool has_negative(SampledSpectrum s) { return any(s.values < Float4{}); }

inline SampledSpectrum exp(SampledSpectrum s) { return SampledSpectrum(exp(s.values)); }
// 1 - e^-x for x >= 0, with a small relative error.
inline SampledSpectrum one_minus_exp(SampledSpectrum s) {
    const Float4 x = s.values;
    const Float4 series = x * (1.0f - x * (0.5f - x * (1.0f / 6 - x * (1.0f / 24))));
    return SampledSpectrum(select(x < broadcast(0.01f), series, 1.0f - exp(-x)));
}
inline SampledSpectrum sqrt(SampledSpectrum s) { return SampledSpectrum(sqrt(s.values)); }
inline SampledSpectrum min(SampledSpectrum a, SampledSpectrum b) {
    return SampledSpectrum(min(a.values, b.values));
}
inline SampledSpectrum max(SampledSpectrum a, SampledSpectrum b) {
    return SampledSpectrum(max(a.values, b.values));
}
inline SampledSpectrum clamp_zero(SampledSpectrum s) { return SampledSpectrum(max(s.values, Float4{})); }
inline SampledSpectrum clamp(SampledSpectrum s, float low, float high) {
    return SampledSpectrum(min(max(s.values, broadcast(low)), broadcast(high)));
}
// (1 - t) a + t b
inline SampledSpectrum lerp(float t, SampledSpectrum a, SampledSpectrum b) { return (1 - t) * a + t * b; }
inline SampledSpectrum lerp(SampledSpectrum t, SampledSpectrum a, SampledSpectrum b) {
    return (1.0f - t) * a + t * b;
}

} // namespace montelux
