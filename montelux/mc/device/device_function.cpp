#include "montelux/mc/device/device_function.h"

#include <algorithm>
#include <cctype>
#include <string>
#include <utility>
#include <vector>

#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

// Their points are arrays of a thread.
constexpr int most_dimensions = 1024, most_components = 1024;

bool is_name(const std::string& text) {
    return !text.empty() && (std::isdigit(static_cast<unsigned char>(text[0])) == 0) &&
           std::ranges::all_of(text,
                               [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == ':'; });
}

std::string declaration(const FunctionSource& f) {
    const std::string parameters = f.parameters.empty() ? "" : ", const double *parameters";
    return f.components == 0
               ? "double " + f.function + "(int n, const double *x" + parameters + ")"
               : "void " + f.function + "(int n, const double *x, int m, double *y" + parameters + ")";
}

std::unique_ptr<DeviceProgram> compile(Device& device, const FunctionSource& source, int dimensions,
                                       KernelPoints points) {
    try {
        return device.compile(kernel_text(source, dimensions, points), source.file);
    } catch (const Error& error) {
        // An error in the kernel is one of the call, since the rest of it always compiles.
        const std::string text = error.what();
        if (text.find("device/evaluate.cu") == std::string::npos) throw;
        throw Error(text + "\n" + source.file + ": expected the function `" + declaration(source) + "`");
    }
}

} // namespace

DeviceFunction::DeviceFunction(std::shared_ptr<Device> device, const FunctionSource& source, int dimensions)
    : device_(std::move(device)), source_(source), dimensions_(dimensions),
      components_(std::max(1, source.components)), parameters_(device_), points_(device_), values_(device_) {
    if (dimensions < 1 || dimensions > most_dimensions)
        throw Error("device", "expected 1 to " + std::to_string(most_dimensions) + " variables, got " +
                                  std::to_string(dimensions));
    if (source.components < 0 || source.components > most_components)
        throw Error("device", "expected at most " + std::to_string(most_components) + " components, got " +
                                  std::to_string(source.components));
    if (!is_name(source.function))
        throw Error(source.file,
                    "'" + source.function +
                        "' is not the name of a function; expected FILE:FUNCTION, or FILE alone for "
                        "the function `integrand`");
    program_ = compile(*device_, source, dimensions, KernelPoints::simple);
    parameters_.assign(source.parameters);
}

void DeviceFunction::run(DeviceJob job) const {
    job.parameters = parameters_.data();
    (job.kind == device_mixture_points ? mixture_program_ : program_)->run(job);
}

void DeviceFunction::prepare_mixtures() const {
    const std::lock_guard lock(mutex_);
    if (!mixture_program_) mixture_program_ = compile(*device_, source_, dimensions_, KernelPoints::mixture);
}

void DeviceFunction::at(const double* x, std::size_t n, std::size_t stride, double* y,
                        std::size_t y_stride) const {
    if (n == 0) return;
    const auto dimensions = static_cast<std::size_t>(dimensions_),
               components = static_cast<std::size_t>(components_);
    std::vector<double> together(n * dimensions);
    for (std::size_t d = 0; d < dimensions; ++d) std::copy_n(x + d * stride, n, together.data() + d * n);
    const std::lock_guard lock(mutex_);
    DeviceJob job{};
    job.count = n;
    job.kind = device_given_points;
    job.given = points_.assign(together);
    job.values = values_.reserve(n * components);
    run(job);
    const double* values = values_.fetch(n * components);
    for (std::size_t c = 0; c < components; ++c) std::copy_n(values + c * n, n, y + c * y_stride);
}

} // namespace montelux
