// Evaluations per second on a device and on the processor, for the test integrands of m-Cubes (Sakiotis, Arumugam,
// Paterno, Ranjan, Terzic, Zubair 2022, "m-Cubes: An efficient and portable implementation of Multi-Dimensional
// Integration for GPUs", section 6), which are those of Genz with fixed parameters.
//
//     accelerator [DEVICE [EVALUATIONS [THREADS]]]       cuda, 1e8 and 2; emulated to check
//
// The processor computes a tenth of the evaluations on that many threads. The device's results are summed on as many,
// then on all that there are.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>
#include <span>
#include <string>

#include "montelux/mc/device/device_function.h"
#include "montelux/mc/device/device_sampler.h"
#include "montelux/mc/integrate/integrate.h"
#include "montelux/mc/parallel/parallel_for.h"

namespace {

using namespace montelux; // NOLINT(google-build-using-namespace): a program

struct TestIntegrand {
    const char* name;
    int dimensions;
    double (*here)(int, const double*);
    const char* there;
};

// A function, and its text for the device.
#define FUNCTION(name, ...)                                                                                  \
    double name(int n, const double* x) __VA_ARGS__ constexpr const char name##_text[] =                     \
        "double integrand(int n, const double* x) " #__VA_ARGS__;

// clang-format off
FUNCTION(f1, {
    double s = 0;
    for (int i = 0; i < n; ++i) s += (i + 1) * x[i];
    return cos(s);
})
FUNCTION(f2, {
    double p = 1;
    for (int i = 0; i < n; ++i) p /= 1 / 2500.0 + (x[i] - 0.5) * (x[i] - 0.5);
    return p;
})
FUNCTION(f3, {
    double s = 1;
    for (int i = 0; i < n; ++i) s += (i + 1) * x[i];
    return pow(s, -n - 1);
})
FUNCTION(f4, {
    double s = 0;
    for (int i = 0; i < n; ++i) s += (x[i] - 0.5) * (x[i] - 0.5);
    return exp(-625 * s);
})
FUNCTION(f5, {
    double s = 0;
    for (int i = 0; i < n; ++i) s += fabs(x[i] - 0.5);
    return exp(-10 * s);
})
FUNCTION(f6, {
    double s = 0;
    for (int i = 0; i < n; ++i) {
        if (x[i] > (4 + i) / 10.0) return 0;
        s += (i + 5) * x[i];
    }
    return exp(s);
})
// clang-format on

constexpr TestIntegrand integrands[] = {{"f1", 8, f1, f1_text}, {"f2", 6, f2, f2_text},
                                        {"f3", 8, f3, f3_text}, {"f4", 8, f4, f4_text},
                                        {"f5", 8, f5, f5_text}, {"f6", 6, f6, f6_text}};

struct Timed {
    IntegrationResult result;
    double rate; // evaluations per second
};

Timed timed(const Integrand& f, int dimensions, const std::string& method, std::uint64_t evaluations,
            int threads) {
    const auto begin = std::chrono::steady_clock::now();
    IntegrationResult result = integrate(f, Domain::unit_cube(dimensions), Method::named(method),
                                         {.evaluations = evaluations}, {.threads = threads});
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
    const double rate = static_cast<double>(result.evaluations) / seconds.count();
    return {std::move(result), rate};
}

// Random points per second that the device draws, evaluates and copies to the processor, which leaves them alone.
double rate_alone(const std::shared_ptr<const DeviceFunction>& f, std::uint64_t evaluations) {
    DeviceSampler sampler(f);
    constexpr std::uint64_t block = 1 << 20;
    sampler.random(1, 0, 0, block, false);
    const auto begin = std::chrono::steady_clock::now();
    for (std::uint64_t done = 0; done < evaluations; done += block) sampler.random(1, 0, done, block, false);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
    return static_cast<double>((evaluations + block - 1) / block * block) / seconds.count();
}

void run(const std::string& name, std::uint64_t evaluations, int threads) {
    const std::shared_ptr<Device> device = Device::open(name);
    const int all = thread_count();
    std::printf("device: %s; %.3g evaluations; evaluations per second\n\n", device->description().c_str(),
                static_cast<double>(evaluations));
    std::printf(
        "| integrand | method | value | processor, %d threads | device, %d threads | ratio | "
        "device, %d threads | ratio | difference, errors |\n|---|---|---|---:|---:|---:|---:|---:|---:|\n",
        threads, threads, all);
    for (const TestIntegrand& f : integrands) {
        const Integrand here = [&f](std::span<const double> x) {
            return f.here(static_cast<int>(x.size()), x.data());
        };
        const auto compiled = std::make_shared<const DeviceFunction>(
            device, FunctionSource{.text = f.there, .file = f.name}, f.dimensions);
        const Integrand there = Integrand::compiled(compiled);
        std::printf("| %s, %d variables | points alone | | | %.3g | | | | |\n", f.name, f.dimensions,
                    rate_alone(compiled, evaluations));
        for (const char* method : {"basic", "quasi", "vegas", "vegas_sobol", "adaptive"}) {
            timed(there, f.dimensions, method, 100'000, 0); // the device's memory
            const Timed here_few = timed(here, f.dimensions, method, evaluations / 10, threads);
            const Timed there_few = timed(there, f.dimensions, method, evaluations, threads);
            const Timed there_all = timed(there, f.dimensions, method, evaluations, all);
            const IntegrationResult &a = here_few.result, &b = there_all.result;
            std::printf("| %s, %d variables | %s | %s | %.3g | %.3g | %.1f | %.3g | %.1f | %.2g |\n", f.name,
                        f.dimensions, method, to_string(b.estimate()).c_str(), here_few.rate, there_few.rate,
                        there_few.rate / here_few.rate, there_all.rate, there_all.rate / here_few.rate,
                        std::abs(a.value[0] - b.value[0]) /
                            std::hypot(a.standard_error[0], b.standard_error[0]));
            std::fflush(stdout);
        }
    }
}

} // namespace

int main(int argc, char** argv) {
    const std::string device = argc > 1 ? argv[1] : "cuda";
    const double evaluations = argc > 2 ? std::atof(argv[2]) : 1e8;
    const int threads = argc > 3 ? std::atoi(argv[3]) : 2;
    if (!(evaluations >= 10'000 && evaluations <= 1e15) || threads < 1 || threads > 1000) {
        std::fprintf(stderr, "accelerator: expected 10000 to 1e15 evaluations, and 1 to 1000 threads\n");
        return 2;
    }
    try {
        run(device, static_cast<std::uint64_t>(evaluations), threads);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "accelerator: %s\n", error.what());
        return 1;
    }
    return 0;
}
