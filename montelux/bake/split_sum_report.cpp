#include "montelux/bake/split_sum_report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "montelux/bake/brdf_integrals.h"
#include "montelux/bake/cell_estimate.h"
#include "montelux/mc/integrate/mis.h"
#include "montelux/mc/math/constants.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/math/frame.h"
#include "montelux/mc/parallel/parallel_for.h"
#include "montelux/mc/random/hash.h"
#include "montelux/mc/random/philox_stream.h"
#include "montelux/mc/stats/moments.h"
#include "montelux/mc/warp/sphere.h"
#include "montelux/scene/bsdf/ggx.h"

namespace montelux {
namespace {

struct Place {
    Vec3f normal, view; // unit vectors in the map's frame
};

struct Sides {
    TexelEstimate full, split;
};

// f n.l.
float reflected(const Ggx& ggx, Vec3f v, Vec3f l, float f0) {
    if (!(l.z > 0)) return 0;
    const Vec3f h = normalize(v + l);
    const float x = 1 - dot(v, h), x2 = x * x;
    return (f0 + (1 - f0) * x2 * x2 * x) * ggx.d(h) * ggx.g(v, l) / (4 * v.z);
}

class Comparison {
  public:
    Comparison(const EnvironmentMap& map, const SplitSumSettings& settings) : map_(map) {
        const Vec3d mean = map.mean_radiance();
        target_.target_error = settings.target_error;
        target_.floor = (mean.x + mean.y + mean.z) / 3;
        target_.samples = settings.samples_max;
    }

    Sides at(const Place& place, double roughness, double f0, std::uint64_t key) const {
        const double alpha = roughness * roughness;
        Sides sides;
        sides.full = full(place, alpha, f0, key);
        const Vec3f mirror = place.normal * (2 * dot(place.normal, place.view)) - place.view;
        CellEstimator cells(map_, RadialKernel::ggx(alpha));
        const double n_dot_v = std::clamp(static_cast<double>(dot(place.normal, place.view)), 1e-3, 1.0);
        const SplitSumTerms terms = integrals_.ggx(n_dot_v, alpha);
        const double factor = f0 * terms.scale + terms.bias;
        sides.split = cells.estimate(normalize(mirror), target_, hash_key(key, 1));
        sides.split.value *= factor;
        sides.split.standard_error *= factor;
        return sides;
    }

  private:
    TexelEstimate full(const Place& place, double alpha, double f0, std::uint64_t key) const {
        const Frame frame = Frame::from_normal(place.normal);
        const Ggx ggx{static_cast<float>(alpha), static_cast<float>(alpha)};
        Vec3f v = frame.to_local(place.view);
        v.z = std::max(v.z, 1e-3f);
        v = normalize(v);
        const auto f0_f = static_cast<float>(f0);
        PhiloxStream stream(hash_key(key, 0));
        const MapCell whole{map_.top_level(), 0, 0};
        const bool lit = map_.energy_sum(whole) > 0;
        Moments3 moments;
        for (std::uint64_t stop = 256;; stop *= 2) {
            while (lit && moments.count() < std::min(stop, target_.samples)) {
                Vec3d sum;
                const Vec2f u = stream.next_2d();
                const Vec3f m = ggx.sample_visible(v, u);
                add(ggx, v, m * (2 * dot(v, m)) - v, frame, f0_f, sum, true);
                const double texel_u = stream.next_double();
                const Vec2f within = stream.next_2d();
                const Vec3f w = map_.direction(map_.draw_texel(whole, texel_u), within.x, within.y);
                add(ggx, v, frame.to_local(w), frame, f0_f, sum, false);
                moments.add(sum);
            }
            TexelEstimate e;
            e.value = {moments.mean(0), moments.mean(1), moments.mean(2)};
            e.standard_error = {moments.standard_error(0), moments.standard_error(1),
                                moments.standard_error(2)};
            if (!lit) e.standard_error = {};
            e.samples = moments.count();
            e.met = !lit || missed_by(e, target_, target_.target_error) <= 1;
            if (e.met || stop >= target_.samples) return e;
        }
    }

    // The contribution of a direction drawn by either technique.
    void add(const Ggx& ggx, Vec3f v, Vec3f l, const Frame& frame, float f0, Vec3d& sum, bool by_lobe) const {
        if (!(l.z > 0)) return;
        const Vec3f h = normalize(v + l), w = frame.to_world(l);
        const double lobe = static_cast<double>(ggx.visible_pdf(v, h) / (4 * dot(v, h))),
                     light = map_.density(w);
        const double own = by_lobe ? lobe : light, other = by_lobe ? light : lobe;
        if (!(own > 0)) return;
        const double weight = balance_heuristic(1, own, 1, other);
        sum += Vec3d(map_.radiance(w)) * (static_cast<double>(reflected(ggx, v, l, f0)) * weight / own);
    }

    const EnvironmentMap& map_;
    BrdfIntegrals integrals_;
    TexelTarget target_;
};

double mean_of(Vec3d v) { return (v.x + v.y + v.z) / 3; }

Place random_place(double n_dot_v, std::uint64_t key) {
    PhiloxStream stream(key);
    const Vec2f u = stream.next_2d();
    const float turn = two_pi_f * stream.next_1d();
    const Vec3f normal = sample_uniform_sphere(u);
    const Frame frame = Frame::from_normal(normal);
    const auto cosine = static_cast<float>(n_dot_v);
    const float sine = std::sqrt(std::max(0.0f, 1 - cosine * cosine));
    return {normal, normalize(frame.to_world({sine * std::cos(turn), sine * std::sin(turn), cosine}))};
}

SplitSumRow row_of(const Comparison& comparison, const SplitSumSettings& settings, SplitSumRow row,
                   std::uint64_t key) {
    RunningMoments full, difference;
    double squares = 0;
    for (int i = 0; i < settings.orientations; ++i) {
        const std::uint64_t own = hash_key(key, i);
        const Sides s =
            comparison.at(random_place(row.n_dot_v, hash_key(own, 7)), row.roughness, row.f0, own);
        const double f = mean_of(s.full.value), d = mean_of(s.split.value) - f;
        full.add(f);
        difference.add(d);
        // Channels of one estimate are correlated: the sum bounds their error.
        const double e1 = mean_of(s.full.standard_error), e2 = mean_of(s.split.standard_error);
        squares += d * d - e1 * e1 - e2 * e2;
    }
    row.full = full.mean();
    if (!(row.full > 0)) return row;
    row.bias = difference.mean() / row.full;
    row.bias_error = difference.standard_error() / row.full;
    row.rms = std::sqrt(std::max(0.0, squares / settings.orientations)) / row.full;
    return row;
}

void put(Image& image, int x, int y, Vec3d value, Vec3d error) {
    const std::array<double, 6> v{value.x, value.y, value.z, error.x, error.y, error.z};
    for (int c = 0; c < 6; ++c) image.set(x, y, c, static_cast<float>(v[static_cast<std::size_t>(c)]));
}

void check(const SplitSumSettings& s) {
    auto within = [](const std::vector<double>& values, double lower) {
        return !values.empty() &&
               std::all_of(values.begin(), values.end(), [&](double v) { return v >= lower && v <= 1; });
    };
    if (!within(s.roughness, 0.03)) throw Error("split-sum report", "roughness is expected in 0.03 to 1");
    if (!within(s.n_dot_v, 0.01)) throw Error("split-sum report", "n.v is expected in 0.01 to 1");
    if (!within(s.f0, 0)) throw Error("split-sum report", "F0 is expected in 0 to 1");
    if (s.orientations < 2 || s.sphere_size < 0 || !(s.target_error > 0) || s.samples_max < 2)
        throw Error("split-sum report", "at least 2 orientations, 2 samples and a target above 0 are needed");
}

} // namespace

SplitSumReport split_sum_report(const EnvironmentMap& map, const SplitSumSettings& settings) {
    check(settings);
    const Comparison comparison(map, settings);
    SplitSumReport report;
    for (double roughness : settings.roughness)
        for (double n_dot_v : settings.n_dot_v)
            for (double f0 : settings.f0) report.rows.push_back({roughness, n_dot_v, f0});

    const int size = settings.sphere_size, columns = static_cast<int>(settings.roughness.size());
    if (size > 0)
        report.spheres = Image(size * columns, 3 * size, {"R", "G", "B", "stderr.R", "stderr.G", "stderr.B"});
    const auto rows = static_cast<std::int64_t>(report.rows.size());
    const std::int64_t tasks = rows + static_cast<std::int64_t>(size) * columns;

    auto sphere_row = [&](int column, int y) {
        const double roughness = settings.roughness[static_cast<std::size_t>(column)];
        for (int x = 0; x < size; ++x) {
            const double a = 2 * (x + 0.5) / size - 1, b = 1 - 2 * (y + 0.5) / size, r2 = a * a + b * b;
            if (r2 >= 1) continue;
            const Place place{Vec3f(settings.frame.to_map({a, b, -std::sqrt(1 - r2)})),
                              Vec3f(settings.frame.to_map({0, 0, -1}))};
            const Sides s = comparison.at(place, roughness, settings.sphere_f0,
                                          hash_key(settings.seed, 2, column, y * size + x));
            const int at = column * size + x;
            put(report.spheres, at, y, s.full.value, s.full.standard_error);
            put(report.spheres, at, size + y, s.split.value, s.split.standard_error);
            const Vec3d e1 = s.full.standard_error, e2 = s.split.standard_error;
            put(report.spheres, at, 2 * size + y, abs(s.split.value - s.full.value),
                {std::hypot(e1.x, e2.x), std::hypot(e1.y, e2.y), std::hypot(e1.z, e2.z)});
        }
    };
    constexpr std::int64_t at_a_time = 32;
    for (std::int64_t begin = 0; begin < tasks; begin += at_a_time) {
        const std::int64_t end = std::min(tasks, begin + at_a_time);
        const bool complete = parallel_for(
            end - begin,
            [&](std::int64_t k) {
                const std::int64_t i = begin + k;
                if (i < rows) {
                    SplitSumRow& row = report.rows[static_cast<std::size_t>(i)];
                    row = row_of(comparison, settings, row, hash_key(settings.seed, 1, i));
                } else {
                    sphere_row(static_cast<int>((i - rows) / size), static_cast<int>((i - rows) % size));
                }
            },
            settings.cancel);
        if (!complete) {
            report.cancelled = true;
            return report;
        }
        if (settings.progress) settings.progress(static_cast<double>(end) / static_cast<double>(tasks));
    }
    return report;
}

} // namespace montelux
