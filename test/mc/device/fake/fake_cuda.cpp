// A driver and a compiler of CUDA for tests, on the processor: the device's memory is the processor's, the "machine code"
// is the source, and loading it has the system's compiler translate it. MONTELUX_FAKE_CUDA=CALL:RESULT lets a call fail.
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <dlfcn.h>
#include <fstream>
#include <string>
#include <unistd.h>
#include <vector>

namespace {

// The result that a call shall have.
int result_of(const char* call) {
    const char* const failing = std::getenv("MONTELUX_FAKE_CUDA");
    if (failing == nullptr) return 0;
    const std::string text = failing;
    const std::size_t colon = text.find(':');
    return text.substr(0, colon) == call ? std::atoi(text.c_str() + colon + 1) : 0;
}

int context = 0;                          // its address is the context
thread_local std::vector<void*> contexts; // the last one is current
constexpr int no_context = 201;

void* current() { return contexts.empty() ? nullptr : contexts.back(); }
int in_context(const char* call) { return current() == &context ? result_of(call) : no_context; }

std::string program_text, program_log;

// CUDA's normcdfinv: the root of the distribution function, by bisection.
double normal_quantile(double p) {
    double low = -40, high = 40;
    for (int i = 0; i < 100; ++i) {
        const double middle = (low + high) / 2;
        (std::erfc(-middle / std::sqrt(2.0)) / 2 < p ? low : high) = middle;
    }
    return low;
}

} // namespace

#define EXPORT extern "C" __attribute__((visibility("default")))

EXPORT int cuInit(unsigned int flags) { return flags == 0 ? result_of("cuInit") : 1; }
EXPORT int cuDeviceGetCount(int* count) {
    *count = result_of("count") == 0 ? 1 : 0;
    return 0;
}
EXPORT int cuDeviceGet(int* device, int ordinal) {
    *device = 7;
    return ordinal == 0 ? result_of("cuDeviceGet") : 101;
}
EXPORT int cuDeviceGetName(char* name, int length, int device) {
    std::strncpy(name, "Fake GPU", static_cast<std::size_t>(length));
    return device == 7 ? 0 : 101;
}
EXPORT int cuDeviceGetAttribute(int* value, int attribute, int device) {
    *value = attribute == 75 ? 9 : attribute == 76 ? 0 : -1;
    return device == 7 ? 0 : 101;
}
EXPORT int cuDevicePrimaryCtxRetain(void** made, int) {
    *made = &context;
    return result_of("cuDevicePrimaryCtxRetain");
}
EXPORT int cuDevicePrimaryCtxRelease_v2(int) { return 0; }
EXPORT int cuCtxPushCurrent_v2(void* made) {
    if (const int result = result_of("cuCtxPushCurrent")) return result;
    contexts.push_back(made);
    return 0;
}
EXPORT int cuCtxPopCurrent_v2(void** left) {
    if (contexts.empty()) return no_context;
    *left = contexts.back();
    contexts.pop_back();
    return 0;
}
EXPORT int cuCtxGetCurrent(void** made) {
    *made = current();
    return 0;
}
EXPORT int cuCtxSynchronize() { return in_context("cuCtxSynchronize"); }
EXPORT int cuModuleLoadData(void** module, const void* image) {
    if (const int result = in_context("cuModuleLoadData")) return result;
    char folder[] = "/tmp/montelux-fake-XXXXXX";
    if (::mkdtemp(folder) == nullptr) return 304;
    const std::string base = folder;
    std::ofstream(base + "/k.cpp") << static_cast<const char*>(image);
    const std::string command = "c++ -std=c++17 -O1 -ffp-contract=off -shared -fPIC -o " + base + "/k.so " +
                                base + "/k.cpp && rm " + base + "/k.cpp";
    if (std::system(command.c_str()) != 0) return 200;
    *module = ::dlopen((base + "/k.so").c_str(), RTLD_NOW | RTLD_LOCAL);
    ::unlink((base + "/k.so").c_str());
    ::rmdir(base.c_str());
    return *module != nullptr ? 0 : 200;
}
EXPORT int cuModuleUnload(void* module) { return ::dlclose(module); }
EXPORT int cuModuleGetFunction(void** function, void* module, const char* name) {
    const std::string kernel = name;
    *function = kernel == "montelux_evaluate"    ? ::dlsym(module, "montelux_run_grid")
                : kernel == "montelux_summarise" ? ::dlsym(module, "montelux_run_summaries")
                                                 : nullptr;
    return *function != nullptr ? in_context("cuModuleGetFunction") : 500;
}
EXPORT int cuLaunchKernel(void* function, unsigned int grid_x, unsigned int grid_y, unsigned int grid_z,
                          unsigned int block_x, unsigned int block_y, unsigned int block_z,
                          unsigned int shared, void* stream, void** parameters, void** extra) {
    if (const int result = in_context("cuLaunchKernel")) return result;
    if (grid_y != 1 || grid_z != 1 || block_y != 1 || block_z != 1 || shared != 0 || stream != nullptr ||
        extra != nullptr || grid_x == 0 || block_x == 0 || block_x > 1024)
        return 1;
    using RunGrid = void (*)(const void*, unsigned int, unsigned int, double (*)(double));
    reinterpret_cast<RunGrid>(function)(parameters[0], grid_x, block_x, normal_quantile);
    return 0;
}
EXPORT int cuMemAlloc_v2(unsigned long long* memory, std::size_t bytes) {
    if (const int result = in_context("cuMemAlloc")) return result;
    if (bytes == 0) return 1;
    *memory = reinterpret_cast<unsigned long long>(std::malloc(bytes));
    return 0;
}
EXPORT int cuMemFree_v2(unsigned long long memory) {
    std::free(reinterpret_cast<void*>(memory));
    return in_context("cuMemFree");
}
EXPORT int cuMemAllocHost_v2(void** memory, std::size_t bytes) {
    if (const int result = in_context("cuMemAllocHost")) return result;
    *memory = std::malloc(bytes);
    return 0;
}
EXPORT int cuMemFreeHost(void* memory) {
    std::free(memory);
    return in_context("cuMemFreeHost");
}
EXPORT int cuMemcpyHtoD_v2(unsigned long long to, const void* from, std::size_t bytes) {
    if (const int result = in_context("cuMemcpyHtoD")) return result;
    std::memcpy(reinterpret_cast<void*>(to), from, bytes);
    return 0;
}
EXPORT int cuMemcpyDtoH_v2(void* to, unsigned long long from, std::size_t bytes) {
    if (const int result = in_context("cuMemcpyDtoH")) return result;
    std::memcpy(to, reinterpret_cast<const void*>(from), bytes);
    return 0;
}
EXPORT int cuGetErrorName(int result, const char** name) {
    *name = result == 719 ? "CUDA_ERROR_LAUNCH_FAILED" : nullptr;
    return result == 719 ? 0 : 1;
}
EXPORT int cuGetErrorString(int result, const char** text) {
    *text = result == 719 ? "unspecified launch failure" : nullptr;
    return result == 719 ? 0 : 1;
}

EXPORT int nvrtcCreateProgram(void** program, const char* source, const char*, int, const char* const*,
                              const char* const*) {
    program_text = source;
    *program = &program_text;
    return 0;
}
EXPORT int nvrtcDestroyProgram(void** program) {
    *program = nullptr;
    return 0;
}
EXPORT int nvrtcCompileProgram(void*, int options, const char* const* texts) {
    bool architecture = false;
    for (int i = 0; i < options; ++i) architecture = architecture || std::string(texts[i]) == "-arch=sm_90";
    program_log = "the log of the compiler";
    return architecture ? result_of("nvrtcCompileProgram") : 5;
}
EXPORT int nvrtcGetProgramLogSize(void*, std::size_t* size) {
    *size = program_log.size() + 1;
    return 0;
}
EXPORT int nvrtcGetProgramLog(void*, char* log) {
    std::memcpy(log, program_log.c_str(), program_log.size() + 1);
    return 0;
}
EXPORT int nvrtcGetCUBINSize(void*, std::size_t* size) {
    *size = program_text.size() + 1;
    return 0;
}
EXPORT int nvrtcGetCUBIN(void*, char* code) {
    std::memcpy(code, program_text.c_str(), program_text.size() + 1);
    return 0;
}
EXPORT int nvrtcGetPTXSize(void* program, std::size_t* size) { return nvrtcGetCUBINSize(program, size); }
EXPORT int nvrtcGetPTX(void* program, char* code) { return nvrtcGetCUBIN(program, code); }
EXPORT int nvrtcGetNumSupportedArchs(int* count) {
    *count = 2;
    return 0;
}
EXPORT int nvrtcGetSupportedArchs(int* list) {
    list[0] = 80;
    list[1] = 90;
    return 0;
}
EXPORT const char* nvrtcGetErrorString(int) { return "an error of NVRTC"; }
