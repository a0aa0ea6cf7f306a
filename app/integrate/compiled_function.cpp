#include "app/integrate/compiled_function.h"

#include "app/integrate/function_form.h"
#include "app/interrupt.h"
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string_view>
#include <type_traits>
#include <utility>

#include "montelux/mc/io/file.h"
#include "montelux/mc/io/system_compiler.h"
#include "montelux/mc/math/error.h"

namespace montelux::app {
namespace {

namespace fs = std::filesystem;

struct Place {
    std::string file, function;
};

Place read_place(const std::string& text) {
    const std::size_t colon = text.rfind(':');
    std::error_code ignored;
    if (colon == std::string::npos || fs::exists(text, ignored)) return {text, "integrand"};
    return {text.substr(0, colon), text.substr(colon + 1)};
}

void check_file(const std::string& file) {
    std::error_code failure;
    if (!fs::exists(file, failure)) throw Error(file, "there is no such file");
    if (fs::is_directory(file, failure)) throw Error(file, "is a folder; expected FILE:FUNCTION");
}

// Translates a source to a shared library at `library`.
void compile(const std::string& source, const fs::path& library) {
    const std::string extension = fs::path(source).extension().string();
    const bool c = extension == ".c";
    constexpr std::array<std::string_view, 4> of_cpp{".cpp", ".cc", ".cxx", ".C"};
    bool cpp = false;
    for (const std::string_view known : of_cpp) cpp = cpp || extension == known;
    if (CompiledFunction::is_cuda(source))
        throw Error(source,
                    "is a CUDA source, for `montelux integrate --device cuda`; expected one in C (.c) or C++ "
                    "(.cpp, .cc, .cxx)");
    if (!c && !cpp)
        throw Error(source,
                    "is not a source in C (.c) or C++ (.cpp, .cc, .cxx); other languages: make a shared "
                    "library of it, and pass that with --library");
    montelux::compile({.source = source,
                       .library = library,
                       .language = c ? Compilation::Language::c : Compilation::Language::cpp});
}

} // namespace

std::string CompiledFunction::file_of(const std::string& place) { return read_place(place).file; }

bool CompiledFunction::is_cuda(const std::string& place) {
    return fs::path(file_of(place)).extension() == ".cu";
}

std::string CompiledFunction::absolute(const std::string& place) {
    const Place at = read_place(place);
    return fs::absolute(at.file).lexically_normal().string() + ":" + at.function;
}

CompiledFunction CompiledFunction::from_library(const std::string& place, Form form) {
    const Place at = read_place(place);
    check_file(at.file);
    return {fs::absolute(at.file).string(), at.function, std::move(form), at.file};
}

CompiledFunction CompiledFunction::from_source(const std::string& place, Form form) {
    const Place at = read_place(place);
    check_file(at.file);
    const WaitingSignals until_removed;
    const BuildFolder folder;
    const fs::path library = folder.path() / "integrand.so";
    compile(at.file, library);
    const FunctionForm declared{.components = form.components > 0, .parameters = !form.parameters.empty()};
    CompiledFunction function{library.string(), at.function, std::move(form), at.file};
    check_form(at.file, at.function, declared, folder.path());
    return function;
}

CompiledFunction::CompiledFunction(const std::string& file, std::string function, Form form,
                                   const std::string& place)
    : function_(std::move(function)), form_(std::move(form)) {
    std::string reason;
    std::optional<SharedLibrary> opened = SharedLibrary::open(file, reason);
    if (!opened) throw Error(place, "is not a shared library that can be loaded: " + reason);
    library_ = std::make_shared<const SharedLibrary>(std::move(*opened));
    bool found = false;
    const auto find = [&](auto& f) {
        f = library_->find<std::remove_reference_t<decltype(f)>>(function_.c_str());
        found = f != nullptr;
    };
    const bool parameters = !form_.parameters.empty();
    if (form_.components == 0)
        parameters ? find(value_with_parameters_) : find(value_);
    else
        parameters ? find(values_with_parameters_) : find(values_);
    if (!found)
        throw Error(place, "has no function '" + function_ +
                               "'; FILE:FUNCTION names another one, and functions of C++ need extern \"C\"");
}

FunctionSource CompiledFunction::read_source(const std::string& place, const Form& form) {
    constexpr std::size_t most_bytes = 1 << 24;
    const Place at = read_place(place);
    check_file(at.file);
    const std::vector<std::uint8_t> bytes = read_file_bytes(at.file, most_bytes);
    return {.text = std::string(bytes.begin(), bytes.end()),
            .file = at.file,
            .function = at.function,
            .components = form.components,
            .parameters = form.parameters};
}

std::vector<std::string> CompiledFunction::names(const std::string& function, int components) {
    if (components == 0) return {function};
    std::vector<std::string> names;
    for (int c = 0; c < components; ++c) names.push_back(function + "[" + std::to_string(c) + "]");
    return names;
}

void CompiledFunction::operator()(const PointBatch& x, ValueBatch y) const {
    const int n = x.dimensions(), m = form_.components;
    std::vector<double> point(static_cast<std::size_t>(n)), values(static_cast<std::size_t>(m));
    const double *const p = point.data(), *const parameters = form_.parameters.data();
    for (std::size_t i = 0; i < x.count(); ++i) {
        x.gather(i, point.data());
        // What a function forgets to write is not the value of another point.
        std::ranges::fill(values, std::numeric_limits<double>::quiet_NaN());
        if (value_ != nullptr)
            y(i, 0) = value_(n, p);
        else if (value_with_parameters_ != nullptr)
            y(i, 0) = value_with_parameters_(n, p, parameters);
        else if (values_ != nullptr)
            values_(n, p, m, values.data());
        else
            values_with_parameters_(n, p, m, values.data(), parameters);
        for (int c = 0; c < m; ++c) y(i, c) = values[static_cast<std::size_t>(c)];
    }
}

} // namespace montelux::app
