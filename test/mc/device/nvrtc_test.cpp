// The kernels compiled by NVRTC, which needs no GPU. Skipped where it is absent; MONTELUX_NVRTC may name it.
#include <algorithm>
#include <cstdlib>
#include <gtest/gtest.h>
#include <optional>
#include <utility>
#include <vector>

#include "montelux/mc/device/formula_source.h"
#include "montelux/mc/device/kernel_text.h"
#include "montelux/mc/device/nvrtc.h"
#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

class NvrtcTest : public testing::Test {
  protected:
    void SetUp() override {
        // NVRTC would call the stand-in of CudaDeviceTest. CTest gives each test its own process.
        if (std::getenv("MONTELUX_STAND_IN_DRIVER") != nullptr)
            GTEST_SKIP() << "this process has loaded a stand-in for the driver; run these tests alone";
        try {
            nvrtc.emplace();
        } catch (const Error& error) {
            GTEST_SKIP() << error.what();
        }
    }
    std::optional<Nvrtc> nvrtc;
};

const std::string number =
    "double integrand(int n, const double* x) { return exp(-x[0]) + M_PI + x[n - 1]; }\n";

std::vector<FunctionSource> sources() {
    const std::vector<std::string> names{"x", "y"};
    const std::vector<std::string> formulas{
        "erf(x)+erfc(x)+gamma(x)+lgamma(x)+cbrt(y)+hypot(x,y)+mod(x,y)+sign(x)",
        "x^2+y^-3+min(x,y,1)+avg(x,y)+rint(x)+log2(x)+atanh(y)+expm1(x)+inf"};
    return {{.text = number},
            {.text = "#include <math.h>\nextern \"C\" __device__ " + number},
            {.text = "double integrand(int, const double* x, const double* parameters) { return "
                     "parameters[0] * x[0]; }",
             .parameters = {2}},
            {.text = "void integrand(int, const double* x, int m, double* y) { for (int c = 0; c < m; ++c) "
                     "y[c] = x[0]; }",
             .components = 3},
            {.text = "void integrand(int, const double*, int, double* y, const double* p) { y[0] = p[1]; }",
             .components = 1,
             .parameters = {1, 2}},
            formula_source(formulas, names)};
}

// All forms for the oldest of these architectures, which can do least; for the others one with each kind of points.
TEST_F(NvrtcTest, CompilesEveryFormOfTheKernels) {
    const std::vector<int> known = nvrtc->architectures();
    ASSERT_FALSE(known.empty());
    const std::vector<FunctionSource> forms = sources();
    const auto expect_compiled = [&](const FunctionSource& source, KernelPoints points, int architecture) {
        const std::string image = nvrtc->compile(kernel_text(source, 2, points), source.file, architecture);
        EXPECT_EQ(image.substr(1, 3), "ELF") << architecture << "\n" << source.text;
        EXPECT_NE(image.find("montelux_evaluate"), std::string::npos);
    };
    bool is_oldest = true;
    for (const int architecture : {70, 80, 90}) {
        if (std::ranges::find(known, architecture) == known.end()) continue;
        if (std::exchange(is_oldest, false)) {
            for (const FunctionSource& source : forms)
                for (const KernelPoints points : {KernelPoints::simple, KernelPoints::mixture})
                    expect_compiled(source, points, architecture);
        } else {
            expect_compiled(forms.back(), KernelPoints::simple, architecture);
            expect_compiled(forms.front(), KernelPoints::mixture, architecture);
        }
    }
}

TEST_F(NvrtcTest, MakesPtxForNewerGpus) {
    const std::string image = nvrtc->compile(kernel_text({.text = number}, 9), "f.cu", 999);
    EXPECT_NE(image.find(".target sm_" + std::to_string(nvrtc->architectures().back())), std::string::npos);
    EXPECT_NE(image.find(".entry montelux_evaluate"), std::string::npos);
}

TEST_F(NvrtcTest, NeverFusesProductsAndSums) {
    // Fused ones round otherwise than the processor's.
    const std::string text = "double integrand(int, const double* x) { return x[0] * x[1] + 1; }";
    const std::string image = nvrtc->compile(kernel_text({.text = text}, 2), "f.cu", 999);
    EXPECT_EQ(image.find("fma."), std::string::npos);
}

TEST_F(NvrtcTest, ErrorsContainTheMessages) {
    try {
        nvrtc->compile(
            kernel_text({.text = "\ndouble integrand(int, const double*) { return unknown_name; }"}, 1),
            "f.cu", nvrtc->architectures().back());
        ADD_FAILURE();
    } catch (const Error& error) {
        const std::string what = error.what();
        EXPECT_NE(what.find("f.cu: NVRTC cannot compile it"), std::string::npos) << what;
        EXPECT_NE(what.find("integrand.cu(2)"), std::string::npos) << what;
        EXPECT_NE(what.find("unknown_name"), std::string::npos) << what;
    }
    EXPECT_THROW(nvrtc->compile(kernel_text({.text = number}, 1), "f.cu", 10), Error);
}

} // namespace
} // namespace montelux
