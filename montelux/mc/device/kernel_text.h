// The text that a device compiles: an integrand's source and the kernels around it.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace montelux {

// A function in the common part of C, C++ and CUDA C++: `double f(int n, const double *x)`, or, of several components,
// `void f(int n, const double *x, int m, double *y)`; with parameters a further argument `const double *parameters`
// follows. __device__ before it is allowed and not needed; math.h is included.
struct FunctionSource {
    std::string text;
    std::string file = "integrand.cu"; // for errors
    std::string function = "integrand";
    int components = 0; // 0: it returns its value
    std::vector<double> parameters = {};
};

// For points of that many coordinates: of all kinds but those of mixtures, or these alone.
enum class KernelPoints { simple, mixture };
std::string kernel_text(const FunctionSource& f, int dimensions, KernelPoints points = KernelPoints::simple);

// device_job.h and the .cu files.
extern const std::string_view device_job_text, points_kernel_text, mixture_kernel_text, evaluate_kernel_text,
    summarise_kernel_text;

} // namespace montelux
