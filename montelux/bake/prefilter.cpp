#include "montelux/bake/prefilter.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "montelux/bake/area_estimate.h"
#include "montelux/bake/cell_estimate.h"
#include "montelux/bake/lobe_estimate.h"
#include "montelux/bake/radial_kernel.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/parallel/parallel_for.h"
#include "montelux/mc/random/hash.h"

namespace montelux {
namespace {

constexpr int largest_face = 8192;
constexpr std::uint32_t irradiance_stream = 1000; // levels have their number

// Settings of one level; `roughness` below 0 means the cosine.
struct LevelTask {
    int level = 0, size = 0;
    double roughness = 0;
    std::uint32_t stream = 0;
};

std::uint64_t texel_count(int size) {
    return std::uint64_t{cube_faces} * static_cast<std::uint64_t>(size) * size;
}

// Progress over all levels.
struct Progress {
    double done = 0, total = 0;
    const std::function<void(double)>& report;

    void add(double texels) {
        done += texels;
        if (report) report(done / total);
    }
};

void set(CubeMap& map, const CubeTexel& t, Vec3d v) {
    Image& face = map.faces[static_cast<std::size_t>(t.face)];
    face.set(t.x, t.y, 0, static_cast<float>(v.x));
    face.set(t.x, t.y, 1, static_cast<float>(v.y));
    face.set(t.x, t.y, 2, static_cast<float>(v.z));
}

struct Tally {
    std::uint64_t samples = 0, missed = 0;
    double error_sum = 0, largest = 0;
};
Tally operator+(Tally a, const Tally& b) {
    a.samples += b.samples;
    a.missed += b.missed;
    a.error_sum += b.error_sum;
    a.largest = std::max(a.largest, b.largest);
    return a;
}

// False when it was cancelled.
bool bake_level(const EnvironmentMap& map, const LevelTask& task, const BakeSettings& settings,
                BakedCubes& baked, Progress& progress) {
    TexelTarget target;
    target.target_error = settings.target_error.value_or(0);
    target.samples = settings.samples;
    const Vec3d mean = map.mean_radiance();
    target.floor = settings.dark_floor * (mean.x + mean.y + mean.z) / 3;

    CubeMap value = make_cube_map(task.size), error = make_cube_map(task.size);
    const double alpha = task.roughness * task.roughness;
    const RadialKernel kernel =
        task.roughness < 0 ? RadialKernel::cosine() : RadialKernel::ggx(std::max(alpha, 1e-8));
    const bool by_lobe = settings.sampling == PrefilterSampling::lobe && task.roughness > 0;
    const LobeEstimator lobe(map, by_lobe ? alpha : 1, settings.source_mips);

    const std::uint64_t texels = texel_count(task.size);
    // Texels that share their working memory, and blocks after which progress is reported.
    constexpr std::uint64_t run = 16, block = 512 * run;
    Tally tally;
    for (std::uint64_t begin = 0; begin < texels; begin += block) {
        const std::uint64_t end = std::min(texels, begin + block);
        auto bake_run = [&](std::int64_t r) {
            Tally local;
            CellEstimator cells(map, kernel);
            AreaEstimator areas(map, settings.frame);
            const std::uint64_t first = begin + static_cast<std::uint64_t>(r) * run;
            for (std::uint64_t i = first; i < std::min(end, first + run); ++i) {
                const auto size = static_cast<std::uint64_t>(task.size);
                const CubeTexel texel{static_cast<int>(i / (size * size)), static_cast<int>(i % size),
                                      static_cast<int>(i / size % size)};
                const std::uint64_t key = hash_key(settings.seed, task.stream, i);
                TexelEstimate e;
                if (task.roughness == 0) {
                    e = areas.estimate(texel, task.size, target, key);
                } else {
                    const Vec3f direction(settings.frame.to_map(cube_texel_direction(texel, task.size)));
                    e = by_lobe ? lobe.estimate(direction, target, key)
                                : cells.estimate(direction, target, key);
                }
                const double relative = missed_by(e, target, 1);
                if (std::isinf(relative)) e.standard_error = {relative, relative, relative};
                set(value, texel, e.value);
                set(error, texel, e.standard_error);
                const bool met = e.met && std::isfinite(relative);
                local = local + Tally{e.samples, met ? 0u : 1u, relative, relative};
            }
            return local;
        };
        const auto runs = static_cast<std::int64_t>((end - begin + run - 1) / run);
        const auto sum = parallel_reduce_ordered(
            runs, bake_run, [](const Tally& a, const Tally& b) { return a + b; }, settings.cancel);
        if (!sum) return false;
        tally = tally + *sum;
        progress.add(static_cast<double>(end - begin));
    }
    baked.value.levels.push_back(std::move(value));
    baked.standard_error.levels.push_back(std::move(error));
    baked.levels.push_back({task.size, task.roughness, tally.samples, tally.missed,
                            tally.error_sum / static_cast<double>(texels), tally.largest});
    return true;
}

BakedCubes bake_levels(const EnvironmentMap& map, const std::vector<LevelTask>& tasks,
                       const BakeSettings& settings) {
    if (settings.target_error && !(*settings.target_error > 0 && std::isfinite(*settings.target_error)))
        throw Error("baking", "the target error is not above 0");
    if (settings.samples < 1) throw Error("baking", "no samples are to be taken");
    if (!(settings.dark_floor >= 0 && std::isfinite(settings.dark_floor)))
        throw Error("baking", "the share of the mean that dark texels are measured by is negative");
    Progress progress{0, 0, settings.progress};
    for (const LevelTask& task : tasks) progress.total += static_cast<double>(texel_count(task.size));
    BakedCubes baked;
    for (const LevelTask& task : tasks)
        if (!bake_level(map, task, settings, baked, progress)) {
            baked.cancelled = true;
            break;
        }
    return baked;
}

void check_size(int size) {
    if (size < 1 || size > largest_face)
        throw Error("baking", "faces of " + std::to_string(size) + " texels; expected 1 to " +
                                  std::to_string(largest_face));
}

} // namespace

std::vector<double> roughness_by_rule(RoughnessRule rule, std::optional<int> levels, int size) {
    check_size(size);
    const int most = level_count(size);
    const int count = levels.value_or(rule == RoughnessRule::babylon ? most : std::max(1, most - 4));
    if (count < 1 || count > most)
        throw Error("baking", std::to_string(count) + " levels; expected 1 to " + std::to_string(most) +
                                  ", as many as faces of " + std::to_string(size) + " texels have");
    std::vector<double> roughness;
    for (int i = 0; i < count; ++i) {
        const double part = count == 1 ? 0 : static_cast<double>(i) / (count - 1);
        switch (rule) {
        case RoughnessRule::linear:
            roughness.push_back(part);
            break;
        case RoughnessRule::filament:
            roughness.push_back(1 - std::sqrt(1 - part));
            break;
        case RoughnessRule::babylon:
            roughness.push_back(i == 0 ? 0 : std::sqrt(std::min(1.0, std::exp2(i / 0.8) / size)));
            break;
        }
    }
    return roughness;
}

BakedCubes prefilter_environment(const EnvironmentMap& map, int size, const std::vector<double>& roughness,
                                 const BakeSettings& settings) {
    check_size(size);
    const int levels = static_cast<int>(roughness.size());
    if (levels < 1 || levels > level_count(size))
        throw Error("baking", std::to_string(levels) + " levels; faces of " + std::to_string(size) +
                                  " texels have 1 to " + std::to_string(level_count(size)));
    std::vector<LevelTask> tasks;
    for (int level = 0; level < levels; ++level) {
        const double r = roughness[static_cast<std::size_t>(level)];
        if (!(r >= 0 && r <= 1))
            throw Error("baking", "level " + std::to_string(level) + " has the roughness " +
                                      std::to_string(r) + "; expected 0 to 1");
        tasks.push_back({level, level_size(size, level), r, static_cast<std::uint32_t>(level)});
    }
    return bake_levels(map, tasks, settings);
}

BakedCubes irradiance_cube(const EnvironmentMap& map, int size, const BakeSettings& settings) {
    check_size(size);
    return bake_levels(map, {{0, size, -1, irradiance_stream}}, settings);
}

} // namespace montelux
