#include "montelux/mc/device/kernel_text.h"

namespace montelux {
namespace {

// NVRTC knows the functions of math.h, but has no headers.
constexpr std::string_view prelude = R"(#ifdef __CUDACC__
#define M_PI 3.14159265358979323846
#define M_E 2.7182818284590452354
#define M_SQRT2 1.41421356237309504880
#define INFINITY (1.0 / 0.0)
#else
#include <math.h>
#define __device__
#define __global__
#define __host__
struct montelux_index {
    unsigned int x, y, z;
};
static thread_local montelux_index blockIdx, blockDim, threadIdx;
#endif
)";

std::string quoted(const std::string& text) {
    std::string result;
    for (const char c : text) {
        if (c == '"' || c == '\\') result += '\\';
        result += c == '\n' ? ' ' : c;
    }
    return result;
}

} // namespace

std::string kernel_text(const FunctionSource& f, int dimensions, KernelPoints points) {
    const bool mixture = points == KernelPoints::mixture;
    std::string text(prelude);
    text += device_job_text;
    text += "#line 1 \"" + quoted(f.file) + "\"\n" + f.text + "\n";
    text += "#define MONTELUX_FUNCTION ::" + f.function + "\n";
    text += "#define MONTELUX_DIMENSIONS " + std::to_string(dimensions) + "\n";
    text += "#define MONTELUX_COMPONENTS " + std::to_string(f.components) + "\n";
    text += std::string("#define MONTELUX_PARAMETERS ") + (f.parameters.empty() ? "0" : "1") + "\n";
    text += std::string("#define MONTELUX_MIXTURE ") + (mixture ? "1" : "0") + "\n";
    const auto add = [&text](const char* name, std::string_view kernel) {
        text += "#line 1 \"montelux/mc/device/" + std::string(name) + "\"\n" + std::string(kernel);
    };
    add("points.cu", points_kernel_text);
    if (mixture) add("mixture.cu", mixture_kernel_text);
    add("evaluate.cu", evaluate_kernel_text);
    add("summarise.cu", summarise_kernel_text);
    return text;
}

} // namespace montelux
