// CudaDriver: the calls of NVIDIA's driver that a device needs, loaded while the program runs (libcuda.so.1).
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "montelux/mc/io/shared_library.h"

namespace montelux {

// Types and numbers as the documentation of the CUDA driver API declares them (docs.nvidia.com/cuda/cuda-driver-api).
struct CudaDriver {
    using Result = int; // 0: success
    using DeviceNumber = int;
    using Context = struct CudaContext*;
    using Module = struct CudaModule*;
    using Function = struct CudaFunction*;
    using Stream = struct CudaStream*;
    using Pointer = unsigned long long; // CUdeviceptr

    static constexpr Result out_of_memory = 2, no_device = 100, no_binary = 209, invalid_ptx = 218,
                            unsupported_ptx = 222, launch_timeout = 702, system_driver_mismatch = 803;
    static constexpr int capability_major = 75, capability_minor = 76; // CUdevice_attribute

    // Throws Error where there is no driver, or one that lacks a function.
    CudaDriver();
    // Throws Error with `what` and the driver's own text where a call failed.
    void check(Result result, const std::string& what) const;

    Result (*init)(unsigned int flags) = nullptr;
    Result (*device_count)(int*) = nullptr;
    Result (*device)(DeviceNumber*, int ordinal) = nullptr;
    Result (*device_name)(char*, int length, DeviceNumber) = nullptr;
    Result (*device_attribute)(int*, int attribute, DeviceNumber) = nullptr;
    Result (*retain_context)(Context*, DeviceNumber) = nullptr;
    Result (*release_context)(DeviceNumber) = nullptr;
    Result (*push_context)(Context) = nullptr; // onto the calling thread's stack, whose top is current
    Result (*pop_context)(Context*) = nullptr;
    Result (*synchronise)() = nullptr;
    Result (*load_module)(Module*, const void* image) = nullptr;
    Result (*unload_module)(Module) = nullptr;
    Result (*find_function)(Function*, Module, const char* name) = nullptr;
    Result (*launch)(Function, unsigned int grid_x, unsigned int grid_y, unsigned int grid_z,
                     unsigned int block_x, unsigned int block_y, unsigned int block_z,
                     unsigned int shared_bytes, Stream, void** parameters, void** extra) = nullptr;
    Result (*allocate)(Pointer*, std::size_t bytes) = nullptr;
    Result (*release)(Pointer) = nullptr;
    Result (*allocate_host)(void**, std::size_t bytes) = nullptr;
    Result (*release_host)(void*) = nullptr;
    Result (*copy_in)(Pointer to, const void* from, std::size_t bytes) = nullptr;
    Result (*copy_out)(void* to, Pointer from, std::size_t bytes) = nullptr;
    Result (*error_name)(Result, const char**) = nullptr;
    Result (*error_text)(Result, const char**) = nullptr;

  private:
    std::vector<SharedLibrary> library_; // one
};

} // namespace montelux
