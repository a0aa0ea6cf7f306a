// Tests of integrands that the emulated device has compiled; skipped where there is no compiler.
#pragma once

#include <cstdlib>
#include <gtest/gtest.h>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "montelux/mc/device/device_function.h"
#include "montelux/mc/integrate/integrand.h"

namespace montelux {

class OnEmulatedDevice : public testing::Test {
  protected:
    void SetUp() override {
        if (std::system("${CXX:-c++} --version >/dev/null 2>&1") != 0) GTEST_SKIP() << "no C++ compiler";
    }
    static std::shared_ptr<const DeviceFunction> compiled(const FunctionSource& source, int dimensions) {
        return std::make_shared<const DeviceFunction>(Device::open("emulated"), source, dimensions);
    }
    static Integrand integrand(const std::string& text, int dimensions, int components = 0,
                               std::vector<double> parameters = {}) {
        return Integrand::compiled(compiled(
            {.text = text, .components = components, .parameters = std::move(parameters)}, dimensions));
    }
};

// The coordinates of a point as the components of a value.
inline std::string coordinates(int n) {
    std::string text = "void integrand(int n, const double* x, int, double* y) {\n";
    for (int d = 0; d < n; ++d) text += "y[" + std::to_string(d) + "] = x[" + std::to_string(d) + "];\n";
    return text + "}\n";
}

} // namespace montelux
