// Points that a device draws beside the processor's, and an integrand for both.
#pragma once

#include "test/mc/integrate/on_emulated_device.h"
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <gtest/gtest.h>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include "montelux/mc/device/device_function.h"
#include "montelux/mc/device/device_sampler.h"
#include "montelux/mc/integrate/device_values.h"
#include "montelux/mc/integrate/unit_points.h"
#include "montelux/mc/random/hash.h"

namespace montelux {

inline const std::string peak_source = "double integrand(int n, const double* x) {\n"
                                       "    double s = 0;\n"
                                       "    for (int d = 0; d < n; ++d) s += (x[d] - 0.3) * (x[d] - 0.3);\n"
                                       "    return exp(-20 * s);\n"
                                       "}\n";
inline double peak_here(std::span<const double> x) {
    double s = 0;
    for (double v : x) s += (v - 0.3) * (v - 0.3);
    return std::exp(-20 * s);
}
// A function whose values are the coordinates of its points.
inline std::shared_ptr<const DeviceFunction> coordinates_on(std::shared_ptr<Device> device, int dimensions) {
    return std::make_shared<const DeviceFunction>(
        std::move(device), FunctionSource{.text = coordinates(dimensions), .components = dimensions},
        dimensions);
}

// The processor's bits, also where the counter of a point passes 2^32.
inline void expect_random_points(const std::shared_ptr<Device>& device, std::size_t n) {
    for (const int dimensions : {1, 3, 4, 9}) {
        DeviceSampler sampler(coordinates_on(device, dimensions));
        for (const std::uint64_t first :
             {std::uint64_t{0}, std::uint64_t{12345}, (std::uint64_t{1} << 32) - 100}) {
            PointBuffer u(n, dimensions);
            fill_random(u, 77, 5, first);
            const DeviceSampler::Block block = sampler.random(hash_key(77, 5), 5, first, n, false);
            for (int d = 0; d < dimensions; ++d)
                for (std::size_t i = 0; i < n; ++i)
                    ASSERT_EQ(block.values[static_cast<std::size_t>(d) * n + i], u(i, d)) << d << " " << i;
        }
    }
}

inline void expect_sobol_points(const std::shared_ptr<Device>& device, std::size_t each) {
    constexpr int dimensions = 7, replicates = 3;
    const Evaluator g(Integrand::compiled(coordinates_on(device, dimensions)), Domain::unit_cube(dimensions));
    const auto there = DeviceValues::of(g);
    there->set_replicates(11, 4, replicates);
    for (const std::uint64_t first :
         {std::uint64_t{0}, std::uint64_t{1000}, (std::uint64_t{1} << 32) - each}) {
        there->draw_sobol(first, each);
        for (std::uint32_t r = 0; r < replicates; ++r) {
            PointBuffer u(each, dimensions);
            ScrambledSobol(dimensions, 11, 4 + r).fill(u, first);
            ValueBuffer values(each, dimensions);
            NonFiniteCount none;
            there->read(r * each, values, {}, none);
            for (int d = 0; d < dimensions; ++d)
                for (std::size_t i = 0; i < each; ++i)
                    ASSERT_EQ(std::as_const(values)(i, d), u(i, d)) << r << " " << d << " " << i;
        }
    }
}

} // namespace montelux
