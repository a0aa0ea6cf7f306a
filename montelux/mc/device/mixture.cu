// Points of a mixture density on the unit cube, and the density there. Arithmetic is that of MixtureDensity, MonotoneMap,
// Gaussian and boundary_density.cpp, operation by operation.

namespace montelux {

__device__ inline double least_of(double a, double b) { return b < a ? b : a; }
__device__ inline double greatest_of(double a, double b) { return a < b ? b : a; }
__device__ inline double between(double x, double low, double high) {
    return x < low ? low : high < x ? high : x;
}

__device__ inline double boundary_pdf(double x) {
    const double root = cbrt(2 * greatest_of(least_of(x, 1 - x), 0x1p-160));
    return 1 / (3 * root * root);
}

__device__ inline double boundary_quantile(double u) {
    const double root = 2 * least_of(u, 1 - u), distance = 0.5 * root * root * root;
    return between(u < 0.5 ? distance : 1 - distance, 0x1p-160, 1 - 0x1p-53);
}

// Of dimension d, the last one that starts at or below `at` in u (number 0 of a bin) or in x (number 2).
__device__ inline const double* bin_of(const DeviceMixture& mixture, int d, int number, double at) {
    int first = mixture.bin_begin[d], count = mixture.bin_begin[d + 1] - first;
    while (count > 1) {
        const int half = count / 2;
        first += mixture.bins[(first + half) * 6 + number] <= at ? half : 0;
        count -= half;
    }
    return mixture.bins + first * 6;
}

__device__ inline bool is_power(const DeviceMixture& mixture, int d, const double* bin) {
    return mixture.powers[d] < 1 && bin == mixture.bins + mixture.bin_begin[d] * 6;
}

__device__ inline double map_quantile(const DeviceMixture& mixture, int d, double u, double* density) {
    const double* bin = bin_of(mixture, d, 0, u);
    const double u0 = bin[0], du = bin[1], x0 = bin[2], dx = bin[3], slope0 = bin[4], slope1 = bin[5];
    if (is_power(mixture, d, bin)) {
        const double power = mixture.powers[d], y = greatest_of(pow(u / du, 1 / power), 1e-290 / dx);
        *density = du / dx * power * pow(y, power - 1);
        return dx * least_of(y, 1.0);
    }
    const double slope = dx / du, t = between((u - u0) / du, 0.0, 1.0), s = 1 - t;
    const double denominator = slope + (slope0 + slope1 - 2 * slope) * t * s;
    const double x = x0 + dx * t * (slope * t + slope0 * s) / denominator;
    *density =
        denominator * denominator / (slope * slope * (slope1 * t * t + 2 * slope * t * s + slope0 * s * s));
    return between(x, 0x1p-53, 1 - 0x1p-53);
}

__device__ inline double map_pdf(const DeviceMixture& mixture, int d, double x) {
    const double* bin = bin_of(mixture, d, 2, x);
    const double du = bin[1], x0 = bin[2], dx = bin[3], slope0 = bin[4], slope1 = bin[5];
    if (is_power(mixture, d, bin)) {
        const double power = mixture.powers[d];
        return du / dx * power * pow(greatest_of(x, 1e-290) / dx, power - 1);
    }
    const double slope = dx / du, y = between((x - x0) / dx, 0.0, 1.0);
    const double bend = slope0 + slope1 - 2 * slope;
    const double qa = slope - slope0 + y * bend, qb = slope0 - y * bend, qc = -slope * y;
    const double root = sqrt(greatest_of(0.0, qb * qb - 4 * qa * qc));
    const double t = between(-2 * qc / (qb + root), 0.0, 1.0), s = 1 - t;
    const double denominator = slope + bend * t * s;
    return denominator * denominator / (slope * slope * (slope1 * t * t + 2 * slope * t * s + slope0 * s * s));
}

// A Gaussian is the logarithm of its norm, its mean, its factor L and the inverse of L, row by row.
__device__ inline const double* gaussian_of(const DeviceMixture& mixture, int channel) {
    const montelux_long n = MONTELUX_DIMENSIONS;
    return mixture.gaussians + (montelux_long)(channel - mixture.first_gaussian) * (1 + n + 2 * n * n);
}

// x = mean + L z in place of the uniform numbers.
__device__ inline void place_by_gaussian(const double* gaussian, double* x) {
    const int n = MONTELUX_DIMENSIONS;
    const double *mean = gaussian + 1, *factor = mean + n;
    for (int d = 0; d < n; ++d) x[d] = normcdfinv(x[d]);
    for (int d = n - 1; d >= 0; --d) {
        double v = mean[d];
        for (int k = 0; k <= d; ++k) v += factor[d * n + k] * x[k];
        x[d] = v;
    }
}

__device__ inline double gaussian_pdf(const double* gaussian, const double* x) {
    const int n = MONTELUX_DIMENSIONS;
    const double *mean = gaussian + 1, *inverse = mean + n + n * n;
    double result = gaussian[0];
    for (int i = 0; i < n; ++i) {
        double z = 0;
        for (int j = 0; j <= i; ++j) z += inverse[i * n + j] * (x[j] - mean[j]);
        result -= 0.5 * z * z;
    }
    return result > -700 ? exp(result) : 0;
}

__device__ inline double channel_pdf(const DeviceMixture& mixture, int channel, const double* x) {
    if (channel >= mixture.first_gaussian) return gaussian_pdf(gaussian_of(mixture, channel), x);
    double density = 1;
    for (int d = 0; d < MONTELUX_DIMENSIONS; ++d)
        density *= channel < mixture.map_channel ? boundary_pdf(x[d]) : map_pdf(mixture, d, x[d]);
    return density;
}

// Point `index` of all replicates, as MixtureDensity::sample; returns the density there, 0 outside the cube.
__device__ inline double mixture_point(const DeviceJob& job, montelux_long index, double* x) {
    const DeviceMixture& mixture = job.mixture;
    const montelux_long each = mixture.channel_begin[mixture.channels];
    const montelux_long replicate = index / each, number = index % each;
    const int channel = (int)run_of(mixture.channel_begin, (montelux_long)mixture.channels, number);
    sobol_point(job,
                job.sobol_keys +
                    (replicate * (montelux_long)mixture.channels + (montelux_long)channel) *
                        MONTELUX_DIMENSIONS,
                mixture.channel_first[channel] + (number - mixture.channel_begin[channel]), x);
    double density = 0;
    int known = -1; // the channel whose density is known from drawing the point
    if (channel < mixture.first_gaussian) {
        known = channel;
        density = 1;
        for (int d = 0; d < MONTELUX_DIMENSIONS && channel > 0; ++d) {
            if (channel < mixture.map_channel) {
                x[d] = boundary_quantile(x[d]);
                density *= boundary_pdf(x[d]);
            } else {
                double p;
                x[d] = map_quantile(mixture, d, x[d], &p);
                density *= p;
            }
        }
        if (mixture.channels == 1) return density;
        density *= mixture.shares[channel];
    } else {
        place_by_gaussian(gaussian_of(mixture, channel), x);
        for (int d = 0; d < MONTELUX_DIMENSIONS; ++d)
            if (!(x[d] > 0 && x[d] < 1)) return 0;
    }
    for (int k = 0; k < mixture.channels; ++k) {
        const double share = mixture.shares[k];
        if (k == known || share == 0) continue;
        density += k == 0 ? share : share * channel_pdf(mixture, k, x);
    }
    return density;
}

} // namespace montelux
