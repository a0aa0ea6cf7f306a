// Evaluations per second on a device and on the processor, for the test integrands of m-Cubes (Sakiotis, Arumugam,
// Paterno, Ranjan, Terzic, Zubair 2022, "m-Cubes: An efficient and portable implementation of Multi-Dimensional
// Integration for GPUs", section 6), which are those of Genz with fixed parameters.
//
//     accelerator [DEVICE [EVALUATIONS]]       cuda and 1e8, or emulated to check
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

Timed timed(const Integrand& f, int dimensions, const std::string& method, std::uint64_t evaluations) {
    const auto begin = std::chrono::steady_clock::now();
    IntegrationResult result =
        integrate(f, Domain::unit_cube(dimensions), Method::named(method), {.evaluations = evaluations});
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

void run(const std::string& name, std::uint64_t evaluations) {
    const std::shared_ptr<Device> device = Device::open(name);
    std::printf("device: %s; processor: %d threads; %.3g evaluations\n\n", device->description().c_str(),
                thread_count(), static_cast<double>(evaluations));
    std::printf("| integrand | method | value | processor, evaluations/s | device, evaluations/s | ratio | "
                "difference, "
                "errors |\n|---|---|---|---:|---:|---:|---:|\n");
    for (const TestIntegrand& f : integrands) {
        const Integrand here = [&f](std::span<const double> x) {
            return f.here(static_cast<int>(x.size()), x.data());
        };
        const auto compiled = std::make_shared<const DeviceFunction>(
            device, FunctionSource{.text = f.there, .file = f.name}, f.dimensions);
        const Integrand there = Integrand::compiled(compiled);
        std::printf("| %s, %d variables | points alone | | | %.3g | | |\n", f.name, f.dimensions,
                    rate_alone(compiled, evaluations));
        for (const char* method : {"basic", "quasi", "vegas", "vegas_sobol", "adaptive"}) {
            timed(there, f.dimensions, method, 100'000); // the device's memory
            const Timed a = timed(here, f.dimensions, method, evaluations);
            const Timed b = timed(there, f.dimensions, method, evaluations);
            const double error = std::hypot(a.result.standard_error[0], b.result.standard_error[0]);
            std::printf("| %s, %d variables | %s | %s | %.3g | %.3g | %.2f | %.2g |\n", f.name, f.dimensions,
                        method, to_string(b.result.estimate()).c_str(), a.rate, b.rate, b.rate / a.rate,
                        std::abs(a.result.value[0] - b.result.value[0]) / error);
            std::fflush(stdout);
        }
    }
}

} // namespace

int main(int argc, char** argv) {
    const std::string device = argc > 1 ? argv[1] : "cuda";
    const double evaluations = argc > 2 ? std::atof(argv[2]) : 1e8;
    if (!(evaluations >= 1000 && evaluations <= 1e15)) {
        std::fprintf(stderr, "accelerator: expected 1000 to 1e15 evaluations\n");
        return 2;
    }
    try {
        run(device, static_cast<std::uint64_t>(evaluations));
    } catch (const std::exception& error) {
        std::fprintf(stderr, "accelerator: %s\n", error.what());
        return 1;
    }
    return 0;
}
