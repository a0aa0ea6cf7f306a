// Device: where integrands are compiled and run while the program runs: a GPU, or its emulation.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "montelux/mc/device/device_job.h"

namespace montelux {

// Threads in a block of a grid.
inline constexpr unsigned int device_block_threads = 128;
// The same for summaries, of which there are few.
inline constexpr unsigned int device_summary_threads = 32;

// Blocks of a grid for that many threads.
constexpr unsigned int device_blocks(unsigned long long all, unsigned int threads) {
    return static_cast<unsigned int>((all + threads - 1) / threads);
}

// The kernels of one integrand, compiled.
class DeviceProgram {
  public:
    virtual ~DeviceProgram() = default;
    // Evaluates the points of a job, summarises them where that is asked for, and returns when it is done. Throws Error.
    virtual void run(const DeviceJob& job) = 0;
};

// All functions may be called from any thread, and throw Error.
class Device {
  public:
    // The device of a name of `names`: "cuda", the first GPU that the driver shows (CUDA_VISIBLE_DEVICES chooses), or
    // "emulated", the same kernels compiled by the system's C++ compiler and run by one thread of the processor, to
    // check them. Throws Error where it does not exist.
    static std::shared_ptr<Device> open(std::string_view name);
    static std::span<const std::string_view> names();

    virtual ~Device() = default;
    // For reports: "NVIDIA H100 PCIe, compute capability 9.0".
    virtual std::string description() const = 0;
    // `source` is what `kernel_text` made; `file` names the user's part in errors, which contain the compiler's
    // messages.
    virtual std::unique_ptr<DeviceProgram> compile(const std::string& source, const std::string& file) = 0;

    virtual void* allocate(std::size_t bytes) = 0;
    virtual void release(void* memory) noexcept = 0;
    // Memory of the processor that the device copies to fast.
    virtual void* allocate_host(std::size_t bytes) = 0;
    virtual void release_host(void* memory) noexcept = 0;
    virtual void copy_in(void* to, const void* from, std::size_t bytes) = 0;
    virtual void copy_out(void* to, const void* from, std::size_t bytes) = 0;
};

// "cuda" and "emulated"; each throws Error where it does not exist.
std::shared_ptr<Device> open_cuda_device();
std::shared_ptr<Device> open_emulated_device();

} // namespace montelux
