#include "montelux/bake/cell_estimate.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "montelux/mc/math/constants.h"
#include "montelux/mc/random/philox.h"
#include "montelux/mc/random/uniform_bits.h"

namespace montelux {
namespace {

constexpr int samples_per_cell = 2;
constexpr double least_allowed = 1e-30; // in units of the map's energy times the kernel: nothing

float half_square(float chord) { return 0.5f * chord * chord; }

MapCell child(const MapCell& p, int k) { return {p.level - 1, 2 * p.x + (k & 1), 2 * p.y + (k >> 1)}; }

} // namespace

void CellEstimator::split(const Cell& parent) {
    const MapCell& p = parent.cell;
    if (p.level > 0) {
        const auto sums = map_.children_sums(p);
        for (int k = 0; k < 4; ++k)
            if (sums[static_cast<std::size_t>(k)] > 0)
                next_.push_back({child(p, k), sums[static_cast<std::size_t>(k)], 0});
    } else {
        for (int k = 0; k < 4; ++k) next_.push_back({child(p, k), parent.sum * 0.25f, 0});
    }
}

void CellEstimator::cut(Vec3f direction, float allowed, std::size_t most) {
    cells_.clear();
    open_.clear();
    const MapCell whole{map_.top_level(), 0, 0};
    if (map_.energy_sum(whole) > 0) open_.push_back({whole, map_.energy_sum(whole), 0});
    const float width = std::min(1.0f, 2 * std::sqrt(kernel_.a));
    // Coarse to fine, so that a limit on their number leaves no part of the map out.
    while (!open_.empty()) {
        next_.clear();
        for (std::size_t i = 0; i < open_.size(); ++i) {
            Cell& cell = open_[i];
            const EnvironmentMap::Ball ball = map_.ball(cell.cell);
            const float chord = length(ball.centre - direction);
            cell.kernel = kernel_(half_square(chord));
            const float nearest = kernel_(half_square(std::max(0.0f, chord - ball.radius)));
            const float farthest = kernel_(std::min(2.0f, half_square(chord + ball.radius)));
            const bool fine = allowed > 0 ? cell.sum * (nearest - farthest) <= allowed
                                          : nearest == 0 || ball.radius < 0.5f * (chord + width);
            const std::size_t waiting = open_.size() - i + next_.size();
            if (fine || cell.cell.level <= map_.lowest_level() || cells_.size() + waiting + 3 > most)
                cells_.push_back(cell);
            else
                split(cell);
        }
        std::swap(open_, next_);
    }
}

Vec3f CellEstimator::energy_of(const MapCell& cell) const {
    if (cell.level >= 0) return map_.energy(cell);
    const int down = -cell.level;
    return map_.energy({0, cell.x >> down, cell.y >> down}) * std::ldexp(1.0f, -2 * down);
}

TexelEstimate CellEstimator::sample_cells(Vec3f direction, std::uint64_t key, std::uint32_t round) const {
    Vec3d value, variance;
    const std::array<std::uint32_t, 2> key_words{static_cast<std::uint32_t>(key),
                                                 static_cast<std::uint32_t>(key >> 32)};
    for (std::size_t i = 0; i < cells_.size(); ++i) {
        const Cell& cell = cells_[i];
        const Vec3f energy = energy_of(cell.cell);
        std::array<Vec3f, samples_per_cell> beyond;
        for (std::uint32_t k = 0; k < samples_per_cell; ++k) {
            const auto bits = philox4x32<>({static_cast<std::uint32_t>(i), k, round, 0}, key_words);
            MapCell at = cell.cell;
            Vec3f drawn = energy;
            if (at.level > 0) {
                at = map_.draw_texel(cell.cell, unit_double((std::uint64_t{bits[0]} << 32) | bits[1]));
                drawn = map_.energy(at) * (cell.sum / map_.energy_sum(at));
            }
            const Vec3f w = map_.direction(at, unit_float(bits[2]), unit_float(bits[3]));
            beyond[k] = drawn * (kernel_(half_square(length(w - direction))) - cell.kernel);
        }
        const Vec3d half_difference = Vec3d(beyond[0] - beyond[1]) * 0.5;
        value += Vec3d(energy) * static_cast<double>(cell.kernel) + Vec3d(beyond[0] + beyond[1]) * 0.5;
        variance += multiply(half_difference, half_difference);
    }
    TexelEstimate estimate;
    const auto unit = static_cast<double>(map_.unit());
    estimate.value = value * unit;
    estimate.standard_error =
        Vec3d{std::sqrt(variance.x), std::sqrt(variance.y), std::sqrt(variance.z)} * unit;
    estimate.samples = cells_.size() * samples_per_cell;
    return estimate;
}

TexelEstimate CellEstimator::estimate(Vec3f direction, const TexelGoal& goal, std::uint64_t key) {
    const auto unit = static_cast<double>(map_.unit());
    const std::size_t most =
        static_cast<std::size_t>(std::max<std::uint64_t>(1, goal.samples / samples_per_cell));
    cut(direction, 0, std::min<std::size_t>(most, 1024));
    double guess = 0; // sum of channels
    for (const Cell& cell : cells_) guess += static_cast<double>(cell.sum) * static_cast<double>(cell.kernel);
    const double floor = 3 * goal.floor / unit;
    const double relative = goal.target_error > 0 ? goal.target_error : 0.01;
    double allowed = relative * std::max(guess, floor);
    if (goal.target_error <= 0) {
        // The finest cut that stays below the number.
        bool too_many = false;
        for (int attempt = 0; attempt < 60; ++attempt) {
            cut(direction, static_cast<float>(std::max(allowed, least_allowed)), most);
            if (cells_.size() + 3 >= most) {
                too_many = true;
                allowed *= 1.5;
            } else if (!too_many && 2 * cells_.size() < most && allowed > least_allowed) {
                allowed *= 0.35;
            } else {
                break;
            }
        }
        return sample_cells(direction, key, 0);
    }
    std::uint64_t samples = 0;
    for (std::uint32_t round = 0;; ++round) {
        cut(direction, static_cast<float>(std::max(allowed, least_allowed)), most);
        TexelEstimate estimate = sample_cells(direction, key, round);
        samples += estimate.samples;
        const double missed = missed_by(estimate, goal, relative);
        estimate.met = missed <= 1;
        const bool exhausted = cells_.size() + 3 >= most;
        if (estimate.met || exhausted || round == 30) {
            estimate.samples = samples;
            return estimate;
        }
        // The error goes with the power 2/3 of what is allowed: a cell's share is its area times its width.
        allowed *= std::pow(std::max(1.1, 1.25 * missed), -1.5);
    }
}

} // namespace montelux
