// CudaDevice against a driver and a compiler that run on the processor (fake/fake_cuda.cpp): the calls, their order and
// their arguments, and what is said where one fails. Whether a GPU computes the same is not tested here.
#include <cmath>
#include <cstdlib>
#include <gtest/gtest.h>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "montelux/mc/device/device_function.h"
#include "montelux/mc/device/device_sampler.h"
#include "montelux/mc/io/shared_library.h"
#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

class CudaDeviceTest : public testing::Test {
  protected:
    void SetUp() override {
        std::string reason;
        if (SharedLibrary::open("libcuda.so.1", reason) && !loaded)
            GTEST_SKIP() << "a real driver is installed";
        if (std::system("c++ --version >/dev/null 2>&1") != 0) GTEST_SKIP() << "no C++ compiler";
        // Its name within is libcuda.so.1, so that the device finds it from here on.
        ASSERT_TRUE(SharedLibrary::open(MONTELUX_FAKE_CUDA_LIBRARY, reason)) << reason;
        loaded = true;
        ::setenv("MONTELUX_STAND_IN_DRIVER", "1", 1); // NvrtcTest asks
        ::setenv("MONTELUX_NVRTC", MONTELUX_FAKE_CUDA_LIBRARY, 1);
    }
    void TearDown() override {
        ::unsetenv("MONTELUX_FAKE_CUDA");
        ::unsetenv("MONTELUX_NVRTC");
    }
    static inline bool loaded = false;
};

const FunctionSource square{.text = "double integrand(int, const double* x) { return x[0] * x[0] + x[1]; }"};

std::vector<double> random_values(const std::string& device) {
    DeviceSampler sampler(std::make_shared<const DeviceFunction>(Device::open(device), square, 2));
    const std::vector<double> ends{0, 2, -1, 1};
    sampler.set_ranges(ends, 0);
    const DeviceSampler::Block block = sampler.random(1234, 5, 10, 1000, false);
    std::vector<double> all(block.values, block.values + block.count);
    all.insert(all.end(), block.volume, block.volume + block.count);
    return all;
}

TEST_F(CudaDeviceTest, ComputesWhatTheEmulationComputes) {
    EXPECT_EQ(Device::open("cuda")->description(), "Fake GPU, compute capability 9.0");
    EXPECT_EQ(random_values("cuda"), random_values("emulated"));
}

TEST_F(CudaDeviceTest, SumsWhatTheEmulationSums) {
    const auto summaries = [](const std::string& device) {
        DeviceSampler sampler(std::make_shared<const DeviceFunction>(Device::open(device), square, 2));
        sampler.set_summaries(true);
        const DeviceSampler::Block block = sampler.random(1234, 5, 10, 50'000, false);
        std::vector<double> all;
        for (std::size_t b = 0; b < block.batches; ++b) {
            const DeviceSummary& s = block.summaries[b];
            all.insert(all.end(), {s.sum, s.squares, s.mean, s.squared_deviations, s.least, s.greatest});
        }
        // Values are copied when they are asked for.
        sampler.fetch_values(49'900, 100);
        all.insert(all.end(), block.values + 49'900, block.values + 50'000);
        return all;
    };
    const std::vector<double> there = summaries("cuda");
    EXPECT_EQ(there.size(), 6u * 49 + 100);
    EXPECT_EQ(there, summaries("emulated"));
    EXPECT_NEAR(there[2], 5 / 6., 0.1);
}

// Of a uniform channel and a Gaussian: coordinates and densities of points, 0 outside the cube.
std::vector<double> mixture_points(const std::string& device) {
    const FunctionSource coordinates{
        .text = "void integrand(int, const double* x, int, double* y) { y[0] = x[0]; y[1] = x[1]; }",
        .components = 2};
    DeviceSampler sampler(std::make_shared<const DeviceFunction>(Device::open(device), coordinates, 2));
    std::vector<std::uint32_t> columns(64), keys{11, 22, 33, 44};
    for (std::size_t k = 0; k < columns.size(); ++k) columns[k] = 1u << (k % 32); // van der Corput's sequence
    sampler.set_sobol(keys, columns);
    sampler.set_mixture({.shares = {0.5, 0.5},
                         .gaussians = {-1.1, 0.4, 0.9, 0.2, 0, 0.1, 0.3, 5, 0, -1.5, 1 / 0.3},
                         .channel_begin = {0, 100, 500},
                         .channel_first = {7, 30},
                         .map_channel = 1,
                         .first_gaussian = 1});
    const DeviceSampler::Block block = sampler.mixture(0, 500);
    std::vector<double> all;
    for (std::size_t i = 0; i < block.count; ++i) {
        all.push_back(block.density[i]);
        for (const std::size_t c : {0, 1})
            all.push_back(block.density[i] > 0 ? block.values[c * block.count + i] : 0);
    }
    return all;
}

TEST_F(CudaDeviceTest, DrawsTheMixturesThatTheEmulationDraws) {
    const std::vector<double> here = mixture_points("emulated"), there = mixture_points("cuda");
    ASSERT_EQ(there.size(), here.size());
    std::size_t outside = 0;
    for (std::size_t i = 0; i < here.size(); ++i) {
        // The quantile of the normal law differs in its last bits.
        ASSERT_NEAR(there[i], here[i], 1e-13 * std::abs(here[i])) << i;
        outside += i % 3 == 0 && here[i] == 0;
    }
    EXPECT_GT(outside, 100u);
    EXPECT_LT(outside, 300u);
}

TEST_F(CudaDeviceTest, ServesManyThreads) {
    const DeviceFunction f(Device::open("cuda"), square, 2);
    std::vector<double> sums(4);
    std::vector<std::thread> threads;
    for (std::size_t t = 0; t < sums.size(); ++t)
        threads.emplace_back([&, t] {
            for (int i = 0; i < 50; ++i) {
                const double x[2] = {static_cast<double>(t), static_cast<double>(i)};
                double y = 0;
                f.at(x, 1, 1, &y, 1);
                sums[t] += y;
            }
        });
    for (std::thread& thread : threads) thread.join();
    for (std::size_t t = 0; t < sums.size(); ++t)
        EXPECT_EQ(sums[t], 50.0 * static_cast<double>(t * t) + 1225);
}

TEST_F(CudaDeviceTest, LeavesTheCallersContextCurrent) {
    std::string reason;
    const std::optional<SharedLibrary> driver = SharedLibrary::open("libcuda.so.1", reason);
    const auto push = driver->find<int (*)(void*)>("cuCtxPushCurrent_v2");
    const auto pop = driver->find<int (*)(void**)>("cuCtxPopCurrent_v2");
    const auto get = driver->find<int (*)(void**)>("cuCtxGetCurrent");
    int theirs = 0; // its address is the context
    void* found = nullptr;
    const auto expect_current = [&](const void* context, const char* when) {
        get(&found);
        EXPECT_EQ(found, context) << when;
    };
    random_values("cuda");
    expect_current(nullptr, "without a context");
    ASSERT_EQ(push(&theirs), 0);
    {
        DeviceSampler sampler(std::make_shared<const DeviceFunction>(Device::open("cuda"), square, 2));
        expect_current(&theirs, "compiled");
        sampler.random(1234, 5, 10, 1000, false);
        expect_current(&theirs, "evaluated");
    }
    expect_current(&theirs, "released");
    for (const char* failure : {"cuMemAlloc:2", "cuModuleGetFunction:500", "cuLaunchKernel:1"}) {
        ::setenv("MONTELUX_FAKE_CUDA", failure, 1);
        EXPECT_THROW(random_values("cuda"), Error);
        expect_current(&theirs, failure);
    }
    pop(&found);
    EXPECT_EQ(found, &theirs);
}

TEST_F(CudaDeviceTest, SaysWhatFails) {
    const auto expect_said = [](const char* failure, const std::string& what) {
        ::setenv("MONTELUX_FAKE_CUDA", failure, 1);
        try {
            random_values("cuda");
            ADD_FAILURE() << failure;
        } catch (const Error& error) {
            EXPECT_NE(std::string(error.what()).find(what), std::string::npos)
                << failure << ": " << error.what();
        }
    };
    expect_said("cuInit:100", "the NVIDIA driver shows no GPU");
    expect_said("count:1", "the NVIDIA driver shows no GPU");
    expect_said("cuInit:803", "different versions; restart the machine");
    expect_said("cuInit:999", "the driver cannot be started: without a description (an unknown error, 999)");
    expect_said("cuDevicePrimaryCtxRetain:2", "no context can be made on the GPU");
    expect_said("cuCtxPushCurrent:1", "the GPU's context cannot be entered");
    expect_said("nvrtcCompileProgram:6", "integrand.cu: NVRTC cannot compile it:\nthe log of the compiler");
    expect_said("nvrtcCompileProgram:1", "the compilation failed: an error of NVRTC");
    expect_said("cuModuleLoadData:222", "the NVIDIA driver is too old for the code that this NVRTC makes");
    expect_said("cuModuleGetFunction:500", "the kernels cannot be found");
    expect_said("cuMemAlloc:2", "there is no memory for 32 bytes on the GPU");
    expect_said("cuMemAllocHost:2", "on the processor, for copies");
    expect_said("cuMemcpyHtoD:1", "numbers cannot be copied to the GPU");
    expect_said("cuLaunchKernel:1", "a kernel cannot be started");
    expect_said("cuCtxSynchronize:719", "unspecified launch failure (CUDA_ERROR_LAUNCH_FAILED, 719)");
    expect_said("cuCtxSynchronize:702", "this GPU also drives a screen");
    expect_said("cuMemcpyDtoH:1", "numbers cannot be copied from the GPU");
}

} // namespace
} // namespace montelux
