// The kernel that draws points, maps them and evaluates the integrand at them; one thread takes one point.
// A C++ compiler translates it, too: then a loop stands for the grid (montelux_run_grid). MONTELUX_COMPONENTS are those
// of the integrand; 0 components: it returns its value. MONTELUX_PARAMETERS: whether it takes parameters.
// MONTELUX_MIXTURE: whether the points are those of a mixture. That kernel is compiled where it is used, since it takes
// long, and needs more registers.

#define MONTELUX_VALUES (MONTELUX_COMPONENTS > 0 ? MONTELUX_COMPONENTS : 1)

namespace montelux {

// f(x) as the values of point i.
__device__ inline void evaluate_integrand(const DeviceJob& job, montelux_long i, const double* x) {
#if MONTELUX_COMPONENTS == 0 && !MONTELUX_PARAMETERS
    job.values[i] = MONTELUX_FUNCTION(MONTELUX_DIMENSIONS, x);
#elif MONTELUX_COMPONENTS == 0
    job.values[i] = MONTELUX_FUNCTION(MONTELUX_DIMENSIONS, x, job.parameters);
#else
    double y[MONTELUX_VALUES];
    // What a function forgets to write is not the value of another point.
    for (int c = 0; c < MONTELUX_VALUES; ++c) y[c] = nan("");
#if MONTELUX_PARAMETERS
    MONTELUX_FUNCTION(MONTELUX_DIMENSIONS, x, MONTELUX_COMPONENTS, y, job.parameters);
#else
    MONTELUX_FUNCTION(MONTELUX_DIMENSIONS, x, MONTELUX_COMPONENTS, y);
#endif
    for (int c = 0; c < MONTELUX_VALUES; ++c) job.values[(montelux_long)c * job.count + i] = y[c];
#endif
}

// The same at a point of the unit cube, which is moved to the ranges.
__device__ inline void evaluate_in_ranges(const DeviceJob& job, montelux_long i, double* x) {
    const double volume = job.ranges ? map_to_ranges(job, x) : 1;
    if (job.volume) job.volume[i] = volume;
    evaluate_integrand(job, i, x);
}

#if MONTELUX_MIXTURE
__device__ inline void evaluate_point(const DeviceJob& job, montelux_long i) {
    double x[MONTELUX_DIMENSIONS];
    const double density = mixture_point(job, job.first + i, x);
    if (job.density) job.density[i] = density;
    if (density > 0) evaluate_in_ranges(job, i, x);
}
#else
__device__ inline void evaluate_point(const DeviceJob& job, montelux_long i) {
    double x[MONTELUX_DIMENSIONS];
    if (job.kind == device_given_points) {
        for (int d = 0; d < MONTELUX_DIMENSIONS; ++d) x[d] = job.given[(montelux_long)d * job.count + i];
        return evaluate_integrand(job, i, x);
    }
    if (job.kind == device_random_points)
        random_point(job, job.first + i, x);
    else
        sobol_point(job, job.sobol_keys + i / job.points_each * MONTELUX_DIMENSIONS,
                    job.first + i % job.points_each, x);
    if (job.box_begin) place_in_box(job, job.first + i, x);
    const double jacobian = job.edges ? map_adaptively(job, x) : 1;
    if (job.jacobian) job.jacobian[i] = jacobian;
    evaluate_in_ranges(job, i, x);
}
#endif

} // namespace montelux

extern "C" __global__ void montelux_evaluate(DeviceJob job) {
    const montelux_long i = (montelux_long)blockIdx.x * blockDim.x + threadIdx.x;
    if (i < job.count) montelux::evaluate_point(job, i);
}

#ifndef __CUDACC__
// The threads of a grid one after another. `quantile` is that of the standard normal law.
extern "C" void montelux_run_grid(const DeviceJob* job, unsigned int blocks, unsigned int threads,
                                  double (*quantile)(double)) {
    montelux::normcdfinv = quantile;
    blockDim.x = threads;
    for (blockIdx.x = 0; blockIdx.x < blocks; ++blockIdx.x)
        for (threadIdx.x = 0; threadIdx.x < threads; ++threadIdx.x) montelux_evaluate(*job);
}
#endif
