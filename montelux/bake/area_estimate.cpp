#include "montelux/bake/area_estimate.h"

#include <algorithm>
#include <cmath>

#include "montelux/mc/math/constants.h"
#include "montelux/mc/random/philox.h"
#include "montelux/mc/random/uniform_bits.h"

namespace montelux {
namespace {

constexpr std::uint32_t finest = 1u << 24; // parts along a texel's edge
constexpr std::uint64_t samples_per_part = 2;
// Limit in any case: with a target, which keeps the parts, some 150 MB per thread.
constexpr std::size_t most_parts = std::size_t{1} << 19;

Vec3f lower(Vec3f a, Vec3f b) { return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)}; }
Vec3f upper(Vec3f a, Vec3f b) { return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)}; }

// Parts along the edge, so that a part is at most half as wide as a texel of the map.
std::uint32_t first_cut(const EnvironmentMap& map, int size) {
    return static_cast<std::uint32_t>(
        std::clamp(std::ceil(pi / size / map.grid().texel_angle()), 2.0, 256.0));
}

} // namespace

AreaEstimator::Place AreaEstimator::place(double u, double v) const {
    const CubePoint p{texel_.face, (texel_.x + u) / size_, (texel_.y + v) / size_};
    const Vec2f grid = map_.grid().locate(Vec3f(frame_.to_map(cube_direction(p))));
    return {grid,
            map_.radiance(MapCell{0, static_cast<std::int32_t>(grid.x), static_cast<std::int32_t>(grid.y)})};
}

void AreaEstimator::finish(Part& part) const {
    part.low = part.high = part.middle.radiance;
    const EnvironmentGrid& grid = map_.grid();
    const auto width = static_cast<float>(grid.width());
    const bool around = grid.layout() == EnvironmentLayout::equirectangular;
    Vec2f first, last; // beside the middle
    for (const Place& corner : part.corners) {
        part.low = lower(part.low, corner.radiance);
        part.high = upper(part.high, corner.radiance);
        Vec2f d = corner.grid - part.middle.grid;
        if (around && std::abs(d.x) > 0.5f * width) d.x -= std::copysign(width, d.x);
        first = {std::min(first.x, d.x), std::min(first.y, d.y)};
        last = {std::max(last.x, d.x), std::max(last.y, d.y)};
    }
    // All texels between the corners, and a little more, since sides are curved on the map. If there are far
    // more than such a part can cover, it contains a pole or an edge of the octahedron, and its corners are
    // far apart only on the map.
    const double across = 0.5 * pi / (size_ * static_cast<double>(part.resolution) * grid.texel_angle());
    const Vec2f margin = (last - first) * 0.05f;
    const Vec2f begin = part.middle.grid + first - margin, end = part.middle.grid + last + margin;
    const bool seen =
        static_cast<double>((end.x - begin.x) * (end.y - begin.y)) < 64 * std::max(1.0, across * across);
    if (seen) {
        const int y0 = std::max(0, static_cast<int>(std::floor(begin.y)));
        const int y1 = std::min(grid.height() - 1, static_cast<int>(std::floor(end.y)));
        for (int y = y0; y <= y1; ++y)
            for (int x = static_cast<int>(std::floor(begin.x)); x <= static_cast<int>(std::floor(end.x));
                 ++x) {
                const int column =
                    around ? (x + grid.width()) % grid.width() : std::clamp(x, 0, grid.width() - 1);
                const Vec3f radiance = map_.radiance(MapCell{0, column, y});
                part.low = lower(part.low, radiance);
                part.high = upper(part.high, radiance);
            }
    }
    const auto resolution = static_cast<float>(part.resolution);
    part.weighted_range = max_component(part.high - part.low) / (resolution * resolution);
    // Finer parts touch only the texels of their corners and middle.
    part.is_known = seen || across < 1;
}

void AreaEstimator::cut_evenly(std::uint32_t n) {
    parts_.clear();
    std::vector<Place> corners((n + 1) * (n + 1));
    for (std::uint32_t y = 0; y <= n; ++y)
        for (std::uint32_t x = 0; x <= n; ++x) corners[y * (n + 1) + x] = place(double(x) / n, double(y) / n);
    for (std::uint32_t y = 0; y < n; ++y)
        for (std::uint32_t x = 0; x < n; ++x) {
            const std::size_t corner = y * (n + 1) + x;
            Part part{
                x,
                y,
                n,
                {corners[corner], corners[corner + 1], corners[corner + n + 1], corners[corner + n + 2]},
                place((x + 0.5) / n, (y + 0.5) / n),
                {},
                {},
                0,
                true};
            finish(part);
            parts_.push_back(part);
        }
}

bool AreaEstimator::refine(float allowed, std::size_t most) {
    for (bool again = true; again;) {
        again = false;
        next_.clear();
        for (std::size_t i = 0; i < parts_.size(); ++i) {
            const Part& p = parts_[i];
            if ((p.weighted_range <= allowed && p.is_known) || p.resolution >= finest) {
                next_.push_back(p);
                continue;
            }
            if (next_.size() + (parts_.size() - i) + 3 > most) {
                next_.insert(next_.end(), parts_.begin() + static_cast<std::ptrdiff_t>(i), parts_.end());
                std::swap(parts_, next_);
                return false;
            }
            const std::uint32_t fine = 2 * p.resolution;
            std::array<Place, 9> at; // corners of the quarters, row by row
            for (std::uint32_t k = 0; k < 9; ++k)
                if (k % 2 == 1) at[k] = place(double(2 * p.x + k % 3) / fine, double(2 * p.y + k / 3) / fine);
            at[0] = p.corners[0], at[2] = p.corners[1], at[6] = p.corners[2], at[8] = p.corners[3];
            at[4] = p.middle;
            for (std::uint32_t k = 0; k < 4; ++k) {
                const std::uint32_t x = 2 * p.x + k % 2, y = 2 * p.y + k / 2, c = 3 * (k / 2) + k % 2;
                Part quarter{x,
                             y,
                             fine,
                             {at[c], at[c + 1], at[c + 3], at[c + 4]},
                             place((x + 0.5) / fine, (y + 0.5) / fine),
                             {},
                             {},
                             0,
                             true};
                finish(quarter);
                again |= (quarter.weighted_range > allowed || !quarter.is_known) && fine < finest;
                next_.push_back(quarter);
            }
        }
        std::swap(parts_, next_);
    }
    return true;
}

TexelEstimate AreaEstimator::sample(std::uint64_t key, std::uint32_t round) const {
    const std::array<std::uint32_t, 2> key_words{static_cast<std::uint32_t>(key),
                                                 static_cast<std::uint32_t>(key >> 32)};
    const double solid_angle = cube_texel_solid_angle(texel_.x, texel_.y, size_);
    const Vec3f centre = place(0.5, 0.5).radiance;
    StratifiedSum sum;
    Vec3d by_range;
    for (std::uint32_t i = 0; i < parts_.size(); ++i) {
        const Part& p = parts_[i];
        const auto bits = philox4x32<>({i, round, 0, 0}, key_words);
        const double width = 2.0 / (static_cast<double>(size_) * p.resolution);
        std::array<Vec3d, samples_per_part> beyond;
        Vec3f low = p.low, high = p.high;
        double share = 0;
        for (std::size_t k = 0; k < samples_per_part; ++k) {
            const double u = (p.x + unit_double(bits[2 * k])) / p.resolution;
            const double v = (p.y + unit_double(bits[2 * k + 1])) / p.resolution;
            const double a = 2 * (texel_.x + u) / size_ - 1, b = 2 * (texel_.y + v) / size_ - 1,
                         r2 = 1 + a * a + b * b;
            share = width * width / (r2 * std::sqrt(r2) * solid_angle);
            const Vec3f radiance = place(u, v).radiance;
            low = lower(low, radiance);
            high = upper(high, radiance);
            beyond[k] = Vec3d(radiance - centre) * share;
        }
        sum.add(beyond);
        const Vec3d range = Vec3d(high - low) * share;
        by_range += multiply(range, range) * (1.0 / (6 * samples_per_part));
    }
    TexelEstimate estimate;
    estimate.value = Vec3d(centre) + sum.value();
    const Vec3d by_pairs = sum.standard_error();
    for (int c = 0; c < 3; ++c) estimate.standard_error[c] = std::max(by_pairs[c], std::sqrt(by_range[c]));
    estimate.samples = samples_per_part * parts_.size();
    return estimate;
}

TexelEstimate AreaEstimator::estimate(const CubeTexel& texel, int size, const TexelTarget& target,
                                      std::uint64_t key) {
    texel_ = texel;
    size_ = size;
    const auto most =
        static_cast<std::size_t>(std::clamp<std::uint64_t>(target.samples / samples_per_part, 1, most_parts));
    const auto most_along = static_cast<std::uint32_t>(std::sqrt(static_cast<double>(most)));
    if (target.target_error <= 0) {
        cut_evenly(most_along);
        return sample(key, 0);
    }
    cut_evenly(std::min(first_cut(map_, size), most_along));
    double aim =
        0.9 * target.target_error; // by ranges, so that the error by samples is seldom above the target
    std::uint64_t samples = 0;
    bool room = true;
    for (std::uint32_t round = 0;; ++round) {
        while (room) {
            double squares = 0, mean = 0;
            float widest = 0;
            bool known = true;
            for (const Part& p : parts_) {
                const auto range = static_cast<double>(p.weighted_range);
                squares += range * range;
                mean += static_cast<double>(p.middle.radiance.x + p.middle.radiance.y + p.middle.radiance.z) /
                        (3.0 * p.resolution * p.resolution);
                widest = std::max(widest, p.weighted_range);
                known &= p.is_known;
            }
            const double error = std::sqrt(squares / (6 * samples_per_part));
            const bool fine = error <= aim * std::max(mean, target.floor);
            if (fine && known) break;
            room = refine(fine ? widest : 0.5f * widest, most);
            // Nothing left to cut.
            if (room && std::all_of(parts_.begin(), parts_.end(), [](const Part& p) {
                    return (p.weighted_range == 0 && p.is_known) || p.resolution >= finest;
                }))
                room = false;
        }
        TexelEstimate estimate = sample(key, round);
        samples += estimate.samples;
        estimate.met = meets(estimate, target) &&
                       std::all_of(parts_.begin(), parts_.end(), [](const Part& p) { return p.is_known; });
        if (estimate.met || !room || round == 30) {
            estimate.samples = samples;
            return estimate;
        }
        aim *= 0.6;
    }
}

} // namespace montelux
