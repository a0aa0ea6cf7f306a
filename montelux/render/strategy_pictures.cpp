#include "montelux/render/strategy_pictures.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>
#include <string>

#include "montelux/film/splat_film.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/parallel/parallel_for.h"
#include "montelux/render/sample_context.h"
#include "montelux/render/sample_order.h"
#include "montelux/render/tile_renderer.h"
#include "montelux/scene/setting_names.h"

namespace montelux {
namespace {

constexpr double most_gibibytes = 4;

// Number of a strategy among all that find paths of at least two vertices, by length.
std::size_t place_of(std::size_t s, std::size_t t) {
    const std::size_t length = s + t;
    return length * (length - 1) / 2 - 1 + s;
}

std::size_t longest_path(const IntegratorSettings& integrator) {
    return static_cast<std::size_t>(std::max(integrator.max_depth, 0)) + 2;
}

void check_strategies(const Renderer& renderer) {
    const IntegratorSettings& integrator = renderer.description().integrator;
    const auto refuse = [](const std::string& what) { throw Error("strategy pictures", what); };
    if (!traces_light(integrator.method))
        refuse("the integrator '" + std::string(name_of(integrator.method)) +
               "' has none; choose 'bidirectional'");
    if (merges(integrator)) refuse("merging is no strategy that they can show; leave it out");
    if (renderer.scene().has_media()) refuse("scenes with media have none");
    if (integrator.max_depth > most_strategy_depth)
        refuse("max_depth is " + std::to_string(integrator.max_depth) + "; expected at most " +
               std::to_string(most_strategy_depth));
    const double bytes = static_cast<double>(place_of(0, longest_path(integrator) + 1)) *
                         static_cast<double>(pixel_count(renderer.description().film.crop)) *
                         double{2 * (sizeof(Vec3d) + sizeof(Vec3f))};
    if (const double gibibytes = bytes / 0x1p30; gibibytes > most_gibibytes)
        refuse("they would take " + std::to_string(std::lround(gibibytes)) +
               " GiB; render fewer pixels, or lower max_depth");
}

// Sums over samples. Those of pixels are added by the thread that has the pixel's row, splats by any.
struct StrategySums {
    std::vector<Vec3d> weighted, unweighted;
    std::optional<SplatFilm> weighted_splats, unweighted_splats; // t = 1
    std::atomic<bool> found = false;
};

} // namespace

std::vector<StrategyPicture> strategy_pictures(const Renderer& renderer, const std::function<bool()>& stop) {
    check_strategies(renderer);
    const SceneDescription& d = renderer.description();
    const PixelBounds& crop = d.film.crop;
    const auto width = static_cast<std::size_t>(crop.width());
    const std::size_t longest = longest_path(d.integrator);
    const std::size_t pixels = pixel_count(crop);
    std::vector<StrategySums> sums(place_of(0, longest + 1));
    for (std::size_t length = 2; length <= longest; ++length)
        for (std::size_t s = 0; s < length; ++s) {
            StrategySums& of = sums[place_of(s, length - s)];
            of.weighted.resize(pixels);
            of.unweighted.resize(pixels);
            if (length - s > 1) continue;
            of.weighted_splats.emplace(crop);
            of.unweighted_splats.emplace(crop);
        }
    const SampleContext context(d, renderer.sampler(), renderer.scene(), renderer.camera());
    const SampleOrder order(renderer.sampler(), renderer.target().slice);
    std::atomic<bool> stopped{false};
    parallel_for(crop.height(), [&](std::int64_t row) {
        RayTracer tracer(renderer.accelerator());
        BidirectionalMemory memory;
        for (std::size_t column = 0; column < width; ++column) {
            if (stopped || (stop && stop())) {
                stopped = true;
                return;
            }
            const std::size_t pixel = static_cast<std::size_t>(row) * width + column;
            const auto visit = [&](const SampleContext::FilmPath& path) {
                const Vec3d rgb(path.rgb);
                if (!std::isfinite(rgb.x + rgb.y + rgb.z)) return; // samples with such a path are left out
                StrategySums& of = sums[place_of(path.s, path.t)];
                of.found.store(true, std::memory_order_relaxed);
                if (path.film != nullptr) {
                    of.weighted_splats->add_filtered(context.filter(), *path.film, rgb * path.weight);
                    of.unweighted_splats->add_filtered(context.filter(), *path.film, rgb);
                } else {
                    of.weighted[pixel] += rgb * path.weight;
                    of.unweighted[pixel] += rgb;
                }
            };
            for (std::uint64_t i = 0; i < order.share(); ++i)
                context.find_paths(
                    tracer,
                    {crop.x0 + static_cast<int>(column), crop.y0 + static_cast<int>(row), order.index(i)},
                    memory, visit);
        }
    });
    if (stopped) return {};
    const auto samples = static_cast<double>(order.share());
    const auto splat_share = 1 / (samples * static_cast<double>(pixels));
    std::vector<StrategyPicture> pictures;
    for (std::size_t length = 2; length <= longest; ++length)
        for (std::size_t s = 0; s < length; ++s) {
            const StrategySums& of = sums[place_of(s, length - s)];
            if (!of.found) continue;
            StrategyPicture& picture = pictures.emplace_back(StrategyPicture{s, length - s, {}, {}});
            const auto develop = [&](const std::vector<Vec3d>& sum, const std::optional<SplatFilm>& splats) {
                std::vector<Vec3f> values(pixels);
                for (std::size_t i = 0; i < pixels; ++i)
                    values[i] = Vec3f(splats ? splats->sum(crop.x0 + static_cast<int>(i % width),
                                                           crop.y0 + static_cast<int>(i / width)) *
                                                   splat_share
                                             : sum[i] / samples);
                return values;
            };
            picture.weighted = develop(of.weighted, of.weighted_splats);
            picture.unweighted = develop(of.unweighted, of.unweighted_splats);
        }
    return pictures;
}

} // namespace montelux
