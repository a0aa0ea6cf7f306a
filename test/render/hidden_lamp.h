// A room whose lamp is hidden, for guided renders.
#pragma once

#include "test/render/scene_testing.h"
#include <cmath>
#include <cstdint>
#include <gtest/gtest.h>
#include <vector>

#include "montelux/render/render_state.h"

namespace montelux::testing {

// A closed box; a wall across it leaves a slit, behind which a lamp shines. What the camera sees is lit through it.
inline SceneBuilder hidden_lamp(int size, float albedo = 0.7f, double slit = 0.2) {
    SceneBuilder b;
    b.description.film.width = b.description.film.height = size;
    b.description.film.crop = {0, 0, size, size};
    b.description.integrator.max_depth = 12;
    const Index grey = b.add(DiffuseMaterial{gray(albedo)}), black = b.add(DiffuseMaterial{gray(0)});
    const auto wall = [&](const Transform& t, Index material, float emission = 0) {
        b.add_mesh(square(t), material, emission);
    };
    const Transform wide = Transform::scale({2, 1, 1});
    wall(Transform::translate({0, 0, -1}) * wide, grey);
    wall(Transform::translate({0, 0, 1}) * Transform::rotate(180, {1, 0, 0}) * wide, grey);
    wall(Transform::translate({0, 1, 0}) * Transform::rotate(90, {1, 0, 0}) * wide, grey);
    wall(Transform::translate({0, -1, 0}) * Transform::rotate(-90, {1, 0, 0}) * wide, grey);
    wall(Transform::translate({-2, 0, 0}) * Transform::rotate(90, {0, 1, 0}), grey);
    wall(Transform::translate({2, 0, 0}) * Transform::rotate(-90, {0, 1, 0}), grey);
    // Across the box at x = 0.8, but for a slit beside y = 1.
    wall(Transform::translate({0.8, -slit / 2, 0}) * Transform::rotate(90, {0, 1, 0}) *
             Transform::scale({1, 1 - slit / 2, 1}),
         grey);
    wall(Transform::translate({1.95, -0.6, 0}) * Transform::rotate(-90, {0, 1, 0}) *
             Transform::scale({0.2, 0.2, 1}),
         black, 100);
    b.look({0.6, -0.9, 0.4}, {-2, 0.2, -0.5}, 60);
    return b;
}

inline double mean_luminance(const Film& film, double* error = nullptr) {
    double sum = 0, squares = 0;
    for (const Pixel& p : film.pixels()) {
        sum += p.replicates().mean(1);
        squares += std::pow(p.replicates().standard_error(1), 2);
    }
    const double pixels = static_cast<double>(film.pixels().size());
    if (error != nullptr) *error = std::sqrt(squares) / pixels;
    return sum / pixels;
}

inline RenderState render_guided(const SceneDescription& d, const RenderControl& control = {}) {
    RenderState state(d);
    Renderer(d).render(state, control);
    return state;
}

// Pooled over the pixels of several seeds, which the training of each guide differs with.
inline void expect_guiding_is_unbiased(SceneBuilder b) {
    b.description.sampler.spp = 1024;
    b.description.sampler.seed = 1000;
    double reference_error = 0;
    const double reference = mean_luminance(render_guided(b.description).film, &reference_error);
    b.description.integrator.guiding = Guiding::on;
    b.description.sampler.spp = 64;
    std::vector<double> means, errors;
    for (std::uint64_t seed = 0; seed < 12; ++seed) {
        b.description.sampler.seed = seed;
        double error = 0;
        means.push_back(mean_luminance(render_guided(b.description).film, &error));
        errors.push_back(error);
    }
    double sum = 0, variance = 0, claimed = 0;
    for (const double m : means) sum += m / double(means.size());
    for (std::size_t i = 0; i < means.size(); ++i) {
        variance += std::pow(means[i] - sum, 2) / double(means.size() - 1);
        claimed += errors[i] * errors[i] / double(means.size());
    }
    const double error = std::sqrt(claimed / double(means.size()) + reference_error * reference_error);
    EXPECT_LT(std::abs(sum - reference), 5 * error) << sum << " " << reference << " +- " << error;
    EXPECT_LT(error, 0.02 * reference); // so that a bias would be seen
    // Chi-squared of 11 degrees of freedom: beyond 4.2 times its mean in one case of 10^7.
    EXPECT_LT(variance, 4.2 * claimed);
}

} // namespace montelux::testing
