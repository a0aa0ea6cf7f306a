#include "montelux/mc/stats/autocovariance.h"

#include <bit>
#include <complex>
#include <cstddef>
#include <utility>

#include "montelux/mc/math/constants.h"

namespace montelux {
namespace {

using Complex = std::complex<double>;

// Cooley and Tukey 1965, "An Algorithm for the Machine Calculation of Complex Fourier Series", radix 2, in place.
void transform(std::span<Complex> a) {
    const std::size_t n = a.size();
    for (std::size_t i = 1, j = 0; i < n; ++i) {
        std::size_t bit = n >> 1;
        for (; j & bit; bit >>= 1) j ^= bit;
        j ^= bit;
        if (i < j) std::swap(a[i], a[j]);
    }
    std::vector<Complex> roots(n / 2);
    for (std::size_t k = 0; k < roots.size(); ++k)
        roots[k] = std::polar(1.0, -2 * pi * static_cast<double>(k) / static_cast<double>(n));
    for (std::size_t length = 2; length <= n; length *= 2) {
        const std::size_t half = length / 2, step = n / length;
        for (std::size_t begin = 0; begin < n; begin += length)
            for (std::size_t k = 0; k < half; ++k) {
                const Complex even = a[begin + k], odd = a[begin + half + k] * roots[k * step];
                a[begin + k] = even + odd;
                a[begin + half + k] = even - odd;
            }
    }
}

} // namespace

std::vector<double> autocovariance(std::span<const double> x) {
    if (x.empty()) return {};
    const auto count = static_cast<double>(x.size());
    double mean = 0;
    for (double v : x) mean += v / count;
    std::vector<Complex> a(std::bit_ceil(2 * x.size()));
    for (std::size_t i = 0; i < x.size(); ++i) a[i] = x[i] - mean;
    // The autocovariance is the transform of the power spectrum, which is real and even: forwards and backwards
    // are the same.
    transform(a);
    for (Complex& v : a) v = std::norm(v);
    transform(a);
    std::vector<double> result(x.size());
    for (std::size_t k = 0; k < x.size(); ++k)
        result[k] = a[k].real() / static_cast<double>(a.size()) / count;
    return result;
}

} // namespace montelux
