// Points of the unit cube, and where they are moved: random numbers, Sobol' numbers, hypercubes, adaptive maps, ranges.
// Arithmetic is that of the CPU's code, operation by operation, so that points have the same bits.
// MONTELUX_DIMENSIONS is that of the integrand.

using montelux::DeviceJob;
typedef unsigned int montelux_word;
typedef unsigned long long montelux_long;

namespace montelux {

#ifndef __CUDACC__
// The quantile of the standard normal law, which CUDA has and C++ lacks. The integrand may define its own.
static thread_local double (*normcdfinv)(double);
#endif

__device__ inline double unit_double(montelux_long digits) {
    // The middle of a cell of width 2^-52.
    return ((double)digits + 0.5) * 0x1p-52;
}

__device__ inline montelux_word reverse_bits(montelux_word x) {
    x = ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
    x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
    x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
    x = ((x >> 8) & 0x00ff00ffu) | ((x & 0x00ff00ffu) << 8);
    return (x >> 16) | (x << 16);
}

// Philox4x32-7 (Salmon, Moraes, Dror, Shaw 2011), as in fill_random.
__device__ inline void random_point(const DeviceJob& job, montelux_long index, double* u) {
    for (int group = 0; group * 4 < MONTELUX_DIMENSIONS; ++group) {
        montelux_word c0 = (montelux_word)index, c1 = (montelux_word)(index >> 32), c2 = (montelux_word)group,
                      c3 = job.stream;
        montelux_word k0 = (montelux_word)job.key, k1 = (montelux_word)(job.key >> 32);
        for (int round = 0; round < 7; ++round) {
            const montelux_long p0 = (montelux_long)c0 * 0xd2511f53u, p1 = (montelux_long)c2 * 0xcd9e8d57u;
            c0 = (montelux_word)(p1 >> 32) ^ c1 ^ k0;
            c2 = (montelux_word)(p0 >> 32) ^ c3 ^ k1;
            c1 = (montelux_word)p1;
            c3 = (montelux_word)p0;
            k0 += 0x9e3779b9u;
            k1 += 0xbb67ae85u;
        }
        const montelux_word word[4] = {c0, c1, c2, c3};
        for (int j = 0; j < 4 && group * 4 + j < MONTELUX_DIMENSIONS; ++j) {
            const montelux_long low = (montelux_long)word[(j + 1) & 3] * 0x9e3779b9u;
            u[group * 4 + j] = unit_double((montelux_long)word[j] << 20 | ((low >> 12) & 0xfffffu));
        }
    }
}

// Point `index` of a sequence with these keys. Scrambled by Laine and Karras' hash, as in ScrambledSobol.
__device__ inline void sobol_point(const DeviceJob& job, const montelux_word* keys, montelux_long index,
                                   double* u) {
    for (int d = 0; d < MONTELUX_DIMENSIONS; ++d) {
        const montelux_word* columns = job.sobol_columns + d * 32;
        const montelux_word key = keys[d];
        montelux_word x = 0;
        montelux_long bits = index;
        for (int k = 0; bits != 0; bits >>= 1, ++k) x ^= columns[k] & (0u - (montelux_word)(bits & 1u));
        x ^= x * 0x3d20adeau;
        x += key;
        x *= (key >> 16) | 1u;
        x ^= x * 0x05526c56u;
        x ^= x * 0x53a22864u;
        const montelux_word low = (x ^ (x >> 15)) * 0x2c1b3c6du + key;
        u[d] = unit_double((montelux_long)reverse_bits(x) << 20 | low >> 12);
    }
}

__device__ inline double at_most(double x, double most) { return x < most ? x : most; }

// The run that holds point `index`, of runs begin[k] ... begin[k + 1] - 1, k < count.
__device__ inline montelux_long run_of(const montelux_long* begin, montelux_long count, montelux_long index) {
    montelux_long low = 0, high = count; // begin[low] <= index < begin[high]
    while (high - low > 1) {
        const montelux_long middle = low + (high - low) / 2;
        if (begin[middle] <= index)
            low = middle;
        else
            high = middle;
    }
    return low;
}

// Into the box that holds point `index` of the sequence, as Hypercubes::place.
__device__ inline void place_in_box(const DeviceJob& job, montelux_long index, double* u) {
    if (job.boxes == 1) return;
    montelux_long rest = run_of(job.box_begin, job.boxes, index);
    for (int d = 0; d < MONTELUX_DIMENSIONS; ++d) {
        const montelux_long s = (montelux_long)job.strata[d];
        if (s == 1) continue;
        const double inverse = 1 / (double)s;
        u[d] = at_most(((double)(rest % s) + u[d]) * inverse, 1 - 0x1p-53);
        rest /= s;
    }
}

// As AdaptiveMap::map; returns |dx/dy|.
__device__ inline double map_adaptively(const DeviceJob& job, double* u) {
    const double n = job.increments;
    double jacobian = 1;
    for (int d = 0; d < MONTELUX_DIMENSIONS; ++d) {
        const double* edge = job.edges + (montelux_long)d * (montelux_long)(job.increments + 1);
        const double t = u[d] * n;
        const int k = (int)t;
        const double low = edge[k], width = edge[k + 1] - low;
        u[d] = at_most(low + (t - k) * width, 1 - 0x1p-53);
        jacobian *= n * width;
    }
    return jacobian;
}

__device__ inline bool is_finite(double x) { return x - x == 0; }

// As Domain::map of a box; returns |dx/du|.
__device__ inline double map_to_ranges(const DeviceJob& job, double* u) {
    double volume = 1;
    for (int d = 0; d < MONTELUX_DIMENSIONS; ++d) {
        const double lower = job.ranges[2 * d], upper = job.ranges[2 * d + 1];
        const bool from = is_finite(lower), to = is_finite(upper);
        const double v = u[d], w = 1 - v;
        if (from && to) {
            u[d] = lower + (upper - lower) * v;
            volume *= upper - lower;
        } else if (from) {
            u[d] = lower + v / w;
            volume /= w * w;
        } else if (to) {
            u[d] = upper - w / v;
            volume /= v * v;
        } else {
            u[d] = 1 / w - 1 / v;
            volume *= 1 / (w * w) + 1 / (v * v);
        }
    }
    return volume;
}

} // namespace montelux
