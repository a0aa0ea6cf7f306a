// The judging families by source file, and what several of these files use.
#pragma once

#include "bench/hard/bank.h"
#include "bench/hard/draws.h"
#include "bench/hard/quadrature.h"

namespace montelux::bench {

std::span<const HardFamily> judging_scale_families();
std::span<const HardFamily> judging_statistics_families();
std::span<const HardFamily> judging_model_families();
std::span<const HardFamily> judging_finance_families();
std::span<const HardFamily> judging_jump_families();
std::span<const HardFamily> judging_singular_families();
std::span<const HardFamily> judging_physics_families();

// Density of the standard normal distribution.
inline double normal_density(double z) { return std::exp(-0.5 * z * z) / std::sqrt(2 * pi); }

// Rows of a random orthogonal matrix: Gram and Schmidt on uniform vectors.
inline std::vector<std::vector<double>> random_axes(Draws& draws, int n) {
    std::vector<std::vector<double>> axes;
    while (static_cast<int>(axes.size()) < n) {
        std::vector<double> v = draws.uniforms(n, -1, 1);
        for (int pass = 0; pass < 2; ++pass)
            for (const std::vector<double>& axis : axes) {
                double dot = 0;
                for (int j = 0; j < n; ++j) dot += v[j] * axis[j];
                for (int j = 0; j < n; ++j) v[j] -= dot * axis[j];
            }
        double square = 0;
        for (double component : v) square += component * component;
        if (square < 1e-4) continue;
        for (double& component : v) component /= std::sqrt(square);
        axes.push_back(std::move(v));
    }
    return axes;
}

} // namespace montelux::bench
