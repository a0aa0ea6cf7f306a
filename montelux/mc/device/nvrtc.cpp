#include "montelux/mc/device/nvrtc.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <optional>
#include <utility>

#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

constexpr int compilation_failed = 6; // NVRTC_ERROR_COMPILATION
constexpr std::array library_names{"libnvrtc.so.13", "libnvrtc.so.12", "libnvrtc.so.11.2", "libnvrtc.so"};

SharedLibrary open_library() {
    std::string reason;
    if (const char* const given = std::getenv("MONTELUX_NVRTC"); given != nullptr && *given != '\0') {
        if (std::optional<SharedLibrary> library = SharedLibrary::open(given, reason))
            return std::move(*library);
        throw Error("MONTELUX_NVRTC", "names no library that can be loaded: " + reason);
    }
    for (const char* const name : library_names)
        if (std::optional<SharedLibrary> library = SharedLibrary::open(name, reason))
            return std::move(*library);
    throw Error("device 'cuda'", "NVRTC, CUDA's compiler, is not installed (libnvrtc.so); install it (pip: "
                                 "nvidia-cuda-nvrtc-cu12) and "
                                 "name the file in MONTELUX_NVRTC where the system does not find it");
}

// Without the characters at its end that are none of its text.
std::string trimmed(std::string text) {
    while (!text.empty() && (text.back() == '\0' || text.back() == '\n')) text.pop_back();
    return text;
}

} // namespace

Nvrtc::Nvrtc() {
    library_.push_back(open_library());
    const auto find = [&](auto& function, const char* name) {
        function = library_[0].find<std::remove_reference_t<decltype(function)>>(name);
        if (function == nullptr)
            throw Error("NVRTC", std::string("has no function ") + name + "; expected version 11.2 or later");
    };
    find(f_.create, "nvrtcCreateProgram");
    find(f_.destroy, "nvrtcDestroyProgram");
    find(f_.compile, "nvrtcCompileProgram");
    find(f_.log_size, "nvrtcGetProgramLogSize");
    find(f_.log, "nvrtcGetProgramLog");
    find(f_.ptx_size, "nvrtcGetPTXSize");
    find(f_.ptx, "nvrtcGetPTX");
    find(f_.cubin_size, "nvrtcGetCUBINSize");
    find(f_.cubin, "nvrtcGetCUBIN");
    find(f_.count_architectures, "nvrtcGetNumSupportedArchs");
    find(f_.list_architectures, "nvrtcGetSupportedArchs");
    find(f_.error_text, "nvrtcGetErrorString");
}

void Nvrtc::check(Result result, const char* what) const {
    if (result != 0) throw Error("NVRTC", std::string(what) + ": " + f_.error_text(result));
}

std::vector<int> Nvrtc::architectures() const {
    int count = 0;
    check(f_.count_architectures(&count), "the architectures cannot be counted");
    std::vector<int> list(static_cast<std::size_t>(std::max(0, count)));
    if (!list.empty()) check(f_.list_architectures(list.data()), "the architectures cannot be listed");
    std::ranges::sort(list);
    return list;
}

std::string Nvrtc::compile(const std::string& source, const std::string& file, int architecture) const {
    const std::vector<int> known = architectures();
    const bool native = std::ranges::find(known, architecture) != known.end();
    const auto newest =
        std::ranges::find_if(known.rbegin(), known.rend(), [&](int a) { return a < architecture; });
    if (!native && newest == known.rend())
        throw Error("device 'cuda'", "this NVRTC does not compile for compute capability " +
                                         std::to_string(architecture / 10) + "." +
                                         std::to_string(architecture % 10) +
                                         "; expected an older version of it");
    const std::string target =
        "-arch=" + (native ? "sm_" + std::to_string(architecture) : "compute_" + std::to_string(*newest));
    // Arithmetic as written, so that points have the bits of the CPU's; functions without __device__ run there, too.
    const std::array<const char*, 4> options{target.c_str(), "-std=c++17", "-fmad=false", "-default-device"};
    // Its functions are known without it.
    constexpr std::array header_names{"math.h", "cmath"};
    constexpr std::array header_texts{"", ""};

    Program created = nullptr;
    check(f_.create(&created, source.c_str(), "montelux.cu", static_cast<int>(header_names.size()),
                    header_texts.data(), header_names.data()),
          "the program cannot be created");
    const auto destroy = [this](Program program) { f_.destroy(&program); };
    const std::unique_ptr<struct NvrtcProgram, decltype(destroy)> program(created, destroy);
    const auto text = [&](auto size_of, auto get, const char* what) {
        std::size_t size = 0;
        check(size_of(program.get(), &size), what);
        std::string result(size, '\0');
        check(get(program.get(), result.data()), what);
        return result;
    };
    const Result result = f_.compile(program.get(), static_cast<int>(options.size()), options.data());
    if (result == compilation_failed)
        throw Error(file, "NVRTC cannot compile it:\n" +
                              trimmed(text(f_.log_size, f_.log, "messages cannot be read")));
    check(result, "the compilation failed");
    return native ? text(f_.cubin_size, f_.cubin, "the machine code cannot be read")
                  : text(f_.ptx_size, f_.ptx, "the PTX cannot be read");
}

} // namespace montelux
