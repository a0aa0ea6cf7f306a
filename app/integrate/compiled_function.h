// CompiledFunction: an integrand in C, from a shared library, or from a source that the system's compiler translates.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "montelux/mc/device/kernel_text.h"
#include "montelux/mc/integrate/points.h"
#include "montelux/mc/io/shared_library.h"

namespace montelux::app {

// The function is `double f(int n, const double *x)`, or, of several components,
// `void f(int n, const double *x, int m, double *y)`, where x holds the n coordinates of a point and y takes the m
// values. Where parameters are given, a further argument `const double *parameters` follows. It is called from many
// threads at once.
class CompiledFunction {
  public:
    // `components` is 0 for a function that returns its value. `parameters` may be empty.
    struct Form {
        int components = 0;
        std::vector<double> parameters{};
    };

    // `place`: FILE:FUNCTION, or FILE alone, whose function is `integrand`. Throw Error naming `place` where there is
    // no such file or function. A library does not tell how its function is declared: the form is not checked.
    static CompiledFunction from_library(const std::string& place, Form form);
    // A file in C or C++. $CC or cc, and $CXX or c++, translate it, with -O2 and the words of $CFLAGS or $CXXFLAGS.
    // What the compiler prints goes to standard error. Throws UsageError for a function of another form.
    static CompiledFunction from_source(const std::string& place, Form form);

    // The text of a file, for a device: CUDA C++ (.cu), C or C++.
    static FunctionSource read_source(const std::string& place, const Form& form);
    // Of a function with so many components, 0 for one that returns its value: f, or f[0], f[1].
    static std::vector<std::string> names(const std::string& function, int components);

    // The file's part of a place.
    static std::string file_of(const std::string& place);
    static bool is_cuda(const std::string& place);
    // The same place, of a file by its absolute path.
    static std::string absolute(const std::string& place);

    int count() const { return form_.components > 0 ? form_.components : 1; }
    std::vector<std::string> names() const { return names(function_, form_.components); }
    void operator()(const PointBatch& x, ValueBatch y) const;

  private:
    CompiledFunction(const std::string& file, std::string function, Form form, const std::string& place);

    std::shared_ptr<const SharedLibrary> library_;
    std::string function_;
    Form form_;
    // One of these, as the form has it.
    double (*value_)(int, const double*) = nullptr;
    double (*value_with_parameters_)(int, const double*, const double*) = nullptr;
    void (*values_)(int, const double*, int, double*) = nullptr;
    void (*values_with_parameters_)(int, const double*, int, double*, const double*) = nullptr;
};

} // namespace montelux::app
