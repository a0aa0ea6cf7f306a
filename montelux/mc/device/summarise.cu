// Sums of the values of an integrand of one component, batch by batch, so that few numbers are copied to the processor.
// One thread takes one batch; terms are added in the order of lane_sum and SampleMoments.

namespace montelux {

// Value number k of a batch whose first one is that of point `begin`, times the change of volume, as Evaluator::scale.
__device__ inline double scaled_value(const DeviceJob& job, montelux_long begin, int k) {
    const double v = job.values[begin + (montelux_long)k];
    if (!job.volume) return v * job.factor;
    return v == 0 ? 0 : v * job.volume[begin + (montelux_long)k];
}

__device__ inline void summarise_batch(const DeviceJob& job, montelux_long batch) {
    const montelux_long in_run = (job.points_each + device_batch - 1) / device_batch;
    const montelux_long first = batch % in_run * device_batch, left = job.points_each - first;
    const montelux_long begin = batch / in_run * job.points_each + first;
    const int n = (int)(left < device_batch ? left : device_batch);
    DeviceSummary s;
    s.finite = 1;
    s.raw_least = s.raw_greatest = job.values[begin];
    s.least = s.greatest = scaled_value(job, begin, 0);
    double sums[8] = {0, 0, 0, 0, 0, 0, 0, 0}, squares[8] = {0, 0, 0, 0, 0, 0, 0, 0};
    for (int i = 0; i < n; i += 8)
        for (int l = 0; l < 8; ++l) {
            if (i + l >= n) break;
            const double raw = job.values[begin + (montelux_long)(i + l)], v = scaled_value(job, begin, i + l);
            if (!is_finite(raw) || !is_finite(v)) s.finite = 0;
            s.raw_least = raw < s.raw_least ? raw : s.raw_least;
            s.raw_greatest = raw > s.raw_greatest ? raw : s.raw_greatest;
            s.least = v < s.least ? v : s.least;
            s.greatest = v > s.greatest ? v : s.greatest;
            sums[l] += v;
            squares[l] += v * v;
        }
    s.sum = ((sums[0] + sums[4]) + (sums[1] + sums[5])) + ((sums[2] + sums[6]) + (sums[3] + sums[7]));
    s.squares = ((squares[0] + squares[4]) + (squares[1] + squares[5])) +
                ((squares[2] + squares[6]) + (squares[3] + squares[7]));
    double sum = 0;
    for (int l = 0; l < 8; ++l) sum += sums[l];
    s.mean = sum / (double)n;
    double deviations[8] = {0, 0, 0, 0, 0, 0, 0, 0};
    for (int i = 0; i < n; i += 8)
        for (int l = 0; l < 8; ++l) {
            if (i + l >= n) break;
            const double d = scaled_value(job, begin, i + l) - s.mean;
            deviations[l] += d * d;
        }
    s.squared_deviations = 0;
    for (int l = 0; l < 8; ++l) s.squared_deviations += deviations[l];
    job.summaries[batch] = s;
}

} // namespace montelux

extern "C" __global__ void montelux_summarise(DeviceJob job) {
    const montelux_long batch = (montelux_long)blockIdx.x * blockDim.x + threadIdx.x;
    if (batch < job.batches) montelux::summarise_batch(job, batch);
}

#ifndef __CUDACC__
extern "C" void montelux_run_summaries(const DeviceJob* job, unsigned int blocks, unsigned int threads,
                                       double (*)(double)) {
    blockDim.x = threads;
    for (blockIdx.x = 0; blockIdx.x < blocks; ++blockIdx.x)
        for (threadIdx.x = 0; threadIdx.x < threads; ++threadIdx.x) montelux_summarise(*job);
}
#endif
