#include "montelux/bake/cell_estimate.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "montelux/mc/math/constants.h"
#include "montelux/mc/random/philox.h"
#include "montelux/mc/random/uniform_bits.h"

namespace montelux {
namespace {

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

bool CellEstimator::cut(Vec3f direction, float allowed, std::size_t most) {
    cells_.clear();
    open_.clear();
    const MapCell whole{map_.top_level(), 0, 0};
    if (map_.energy_sum(whole) > 0) open_.push_back({whole, map_.energy_sum(whole), 0});
    const float width = std::min(1.0f, 2 * std::sqrt(kernel_.a));
    std::size_t samples = 0;
    bool limited = false;
    // Coarse to fine, so that with a limit on their number the cells still cover the map.
    while (!open_.empty()) {
        next_.clear();
        for (std::size_t i = 0; i < open_.size(); ++i) {
            Cell& cell = open_[i];
            const EnvironmentMap::Ball ball = map_.ball(cell.cell);
            const float chord = length(ball.centre - direction);
            cell.kernel = kernel_(half_square(chord));
            const float nearest = kernel_(half_square(std::max(0.0f, chord - ball.radius)));
            const float farthest = kernel_(std::min(2.0f, half_square(chord + ball.radius)));
            const float bound = cell.sum * (nearest - farthest);
            const bool fine =
                allowed > 0 ? bound <= allowed : nearest == 0 || ball.radius < 0.5f * (chord + width);
            const std::size_t waiting = open_.size() - i + next_.size();
            const bool full = samples + most_samples * (waiting + 3) > most;
            if (fine || full || cell.cell.level <= map_.lowest_level()) {
                limited |= full && !fine;
                cell.samples = bound > 0.5f * allowed ? most_samples : fewest_samples;
                samples += cell.samples;
                cells_.push_back(cell);
            } else {
                split(cell);
            }
        }
        std::swap(open_, next_);
    }
    return limited;
}

Vec3f CellEstimator::energy_of(const MapCell& cell) const {
    if (cell.level >= 0) return map_.energy(cell);
    const int down = -cell.level;
    return map_.energy({0, cell.x >> down, cell.y >> down}) * std::ldexp(1.0f, -2 * down);
}

TexelEstimate CellEstimator::sample_cells(Vec3f direction, std::uint64_t key, std::uint32_t round) const {
    StratifiedSum beyond;
    Vec3d centres;
    const std::array<std::uint32_t, 2> key_words{static_cast<std::uint32_t>(key),
                                                 static_cast<std::uint32_t>(key >> 32)};
    for (std::size_t i = 0; i < cells_.size(); ++i) {
        const Cell& cell = cells_[i];
        const Vec3f energy = energy_of(cell.cell);
        std::array<Vec3d, most_samples> drawn_here;
        for (std::uint32_t k = 0; k < cell.samples; ++k) {
            const auto bits = philox4x32<>({static_cast<std::uint32_t>(i), k, round, 0}, key_words);
            MapCell at = cell.cell;
            Vec3f drawn = energy;
            if (at.level > 0) {
                at = map_.draw_texel(cell.cell, unit_double((std::uint64_t{bits[0]} << 32) | bits[1]));
                drawn = map_.energy(at) * (cell.sum / map_.energy_sum(at));
            }
            const Vec3f w = map_.direction(at, unit_float(bits[2]), unit_float(bits[3]));
            drawn_here[k] = Vec3d(drawn * (kernel_(half_square(length(w - direction))) - cell.kernel));
        }
        centres += Vec3d(energy) * static_cast<double>(cell.kernel);
        beyond.add(std::span(drawn_here).first(cell.samples));
    }
    TexelEstimate estimate;
    const auto unit = static_cast<double>(map_.unit());
    estimate.value = (centres + beyond.value()) * unit;
    estimate.standard_error = beyond.standard_error() * unit;
    for (const Cell& cell : cells_) estimate.samples += cell.samples;
    return estimate;
}

TexelEstimate CellEstimator::estimate(Vec3f direction, const TexelTarget& target, std::uint64_t key) {
    const auto unit = static_cast<double>(map_.unit());
    const auto most = static_cast<std::size_t>(target.samples);
    cut(direction, 0, std::min<std::size_t>(most, 2048));
    double guess = 0; // sum of channels
    for (const Cell& cell : cells_) guess += static_cast<double>(cell.sum) * static_cast<double>(cell.kernel);
    const double floor = 3 * target.floor / unit;
    const double relative = target.target_error > 0 ? target.target_error : 0.01;
    double allowed = relative * std::max(guess, floor);
    if (target.target_error <= 0) {
        // The finest cut that stays below the number.
        bool too_many = false;
        for (int attempt = 0; attempt < 60; ++attempt) {
            const bool limited = cut(direction, static_cast<float>(std::max(allowed, least_allowed)), most);
            if (limited) {
                too_many = true;
                allowed *= 1.5;
            } else if (!too_many && 4 * cells_.size() < most && allowed > least_allowed) {
                allowed *= 0.35;
            } else {
                break;
            }
        }
        return sample_cells(direction, key, 0);
    }
    std::uint64_t samples = 0;
    for (std::uint32_t round = 0;; ++round) {
        const bool exhausted = cut(direction, static_cast<float>(std::max(allowed, least_allowed)), most);
        TexelEstimate estimate = sample_cells(direction, key, round);
        samples += estimate.samples;
        const double missed = missed_by(estimate, target, relative);
        estimate.met = missed <= 1;
        if (estimate.met || exhausted || round == 30) {
            estimate.samples = samples;
            return estimate;
        }
        // The error is proportional to `allowed`^(2/3): a cell's share is its area times its width.
        allowed *= std::pow(std::max(1.1, 1.25 * missed), -1.5);
    }
}

} // namespace montelux
