#include "montelux/mc/device/cuda_driver.h"

#include <optional>
#include <type_traits>
#include <utility>

#include "montelux/mc/math/error.h"

namespace montelux {

CudaDriver::CudaDriver() {
    std::string reason;
    std::optional<SharedLibrary> opened = SharedLibrary::open("libcuda.so.1", reason);
    if (!opened)
        throw Error("device 'cuda'", "there is no NVIDIA driver (" + reason +
                                         "); expected a machine with an NVIDIA GPU and its driver");
    library_.push_back(std::move(*opened));
    const auto find = [&](auto& function, const char* name) {
        function = library_[0].find<std::remove_reference_t<decltype(function)>>(name);
        if (function == nullptr)
            throw Error("device 'cuda'", std::string("the NVIDIA driver is too old: it has no ") + name +
                                             "; expected one for CUDA 11.2 or later");
    };
    // Suffixes are versions of the calls, as cuda.h maps their names.
    find(init, "cuInit");
    find(device_count, "cuDeviceGetCount");
    find(device, "cuDeviceGet");
    find(device_name, "cuDeviceGetName");
    find(device_attribute, "cuDeviceGetAttribute");
    find(retain_context, "cuDevicePrimaryCtxRetain");
    find(release_context, "cuDevicePrimaryCtxRelease_v2");
    find(push_context, "cuCtxPushCurrent_v2");
    find(pop_context, "cuCtxPopCurrent_v2");
    find(synchronise, "cuCtxSynchronize");
    find(load_module, "cuModuleLoadData");
    find(unload_module, "cuModuleUnload");
    find(find_function, "cuModuleGetFunction");
    find(launch, "cuLaunchKernel");
    find(allocate, "cuMemAlloc_v2");
    find(release, "cuMemFree_v2");
    find(allocate_host, "cuMemAllocHost_v2");
    find(release_host, "cuMemFreeHost");
    find(copy_in, "cuMemcpyHtoD_v2");
    find(copy_out, "cuMemcpyDtoH_v2");
    find(error_name, "cuGetErrorName");
    find(error_text, "cuGetErrorString");
}

void CudaDriver::check(Result result, const std::string& what) const {
    if (result == 0) return;
    const char *name = nullptr, *text = nullptr;
    // They fail for numbers that they do not know, and then leave the text alone or set it to null.
    if (error_name(result, &name) != 0 || name == nullptr) name = "an unknown error";
    if (error_text(result, &text) != 0 || text == nullptr) text = "without a description";
    throw Error("device 'cuda'", what + ": " + text + " (" + name + ", " + std::to_string(result) + ")");
}

} // namespace montelux
