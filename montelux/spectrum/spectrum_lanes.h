// Spectra and wavelengths of many paths at a time.
#pragma once

#include "montelux/mc/math/lanes.h"
#include "montelux/spectrum/spectrum_of.h"

namespace montelux {

// The SampledSpectrum of W paths, with its operations.
template <int W>
struct SpectrumLanes {
    using T = Lanes<W>;
    T v[spectrum_samples];

    SpectrumLanes() = default;
    explicit SpectrumLanes(T all) : v{all, all, all, all} {}
    SpectrumLanes(T a, T b, T c, T d) : v{a, b, c, d} {}

    T operator[](int i) const { return v[i]; }
    SampledSpectrum lane(int i) const { return {v[0][i], v[1][i], v[2][i], v[3][i]}; }
    void set_lane(int i, SampledSpectrum s) {
        for (int k = 0; k < spectrum_samples; ++k) v[k].set(i, s[k]);
    }

    friend SpectrumLanes operator+(SpectrumLanes a, SpectrumLanes b) {
        return {a.v[0] + b.v[0], a.v[1] + b.v[1], a.v[2] + b.v[2], a.v[3] + b.v[3]};
    }
    friend SpectrumLanes operator-(SpectrumLanes a, SpectrumLanes b) {
        return {a.v[0] - b.v[0], a.v[1] - b.v[1], a.v[2] - b.v[2], a.v[3] - b.v[3]};
    }
    friend SpectrumLanes operator*(SpectrumLanes a, SpectrumLanes b) {
        return {a.v[0] * b.v[0], a.v[1] * b.v[1], a.v[2] * b.v[2], a.v[3] * b.v[3]};
    }
    friend SpectrumLanes operator/(SpectrumLanes a, SpectrumLanes b) {
        return {a.v[0] / b.v[0], a.v[1] / b.v[1], a.v[2] / b.v[2], a.v[3] / b.v[3]};
    }
    friend SpectrumLanes operator+(SpectrumLanes a, T b) { return a + SpectrumLanes(b); }
    friend SpectrumLanes operator+(T a, SpectrumLanes b) { return SpectrumLanes(a) + b; }
    friend SpectrumLanes operator-(SpectrumLanes a, T b) { return a - SpectrumLanes(b); }
    friend SpectrumLanes operator-(T a, SpectrumLanes b) { return SpectrumLanes(a) - b; }
    friend SpectrumLanes operator*(SpectrumLanes a, T b) { return a * SpectrumLanes(b); }
    friend SpectrumLanes operator*(T a, SpectrumLanes b) { return SpectrumLanes(a) * b; }
    friend SpectrumLanes operator/(SpectrumLanes a, T b) { return a * SpectrumLanes(T(1) / b); }
    SpectrumLanes& operator*=(SpectrumLanes b) { return *this = *this * b; }
    SpectrumLanes& operator*=(T b) { return *this = *this * b; }
    SpectrumLanes& operator/=(T b) { return *this = *this / b; }
};

template <int W>
Lanes<W> max_value(const SpectrumLanes<W>& s) {
    return max(max(s.v[0], s.v[1]), max(s.v[2], s.v[3]));
}
template <int W>
LaneMask<W> is_black(const SpectrumLanes<W>& s) {
    return (s.v[0] == 0) & (s.v[1] == 0) & (s.v[2] == 0) & (s.v[3] == 0);
}
template <int W>
SpectrumLanes<W> select(LaneMask<W> m, const SpectrumLanes<W>& a, const SpectrumLanes<W>& b) {
    return {select(m, a.v[0], b.v[0]), select(m, a.v[1], b.v[1]), select(m, a.v[2], b.v[2]),
            select(m, a.v[3], b.v[3])};
}
template <int W>
SpectrumLanes<W> clamp(const SpectrumLanes<W>& s, float low, float high) {
    auto one = [&](Lanes<W> x) {
        // As min and max of Float4.
        x = select(x > low, x, Lanes<W>(low));
        return select(x < high, x, Lanes<W>(high));
    };
    return {one(s.v[0]), one(s.v[1]), one(s.v[2]), one(s.v[3])};
}

template <int W>
struct SpectrumTraits<Lanes<W>> {
    using Spectrum = SpectrumLanes<W>;
};
} // namespace montelux
