#include "montelux/render/integrator_pilot.h"

#include <mutex>
#include <utility>

#include "montelux/mc/parallel/parallel_for.h"
#include "montelux/render/metropolis/chain_renderer.h"
#include "montelux/render/tile_renderer.h"

namespace montelux {
namespace {

constexpr std::uint32_t most_tile_pixels = 1024;

double luminance(Vec3d rgb) { return dot(rgb, luminance_weight); }

// Mean of the pixel's samples so far, without splats.
double mean_luminance(Pixel pixel) {
    pixel.end_replicate();
    double sum = 0;
    for (int c = 0; c < 3; ++c) sum += luminance_weight[c] * pixel.replicates().mean(c);
    return sum;
}

template <typename Visit>
void for_each_pixel(std::span<const PixelBounds> tiles, const Visit& visit) {
    for (const PixelBounds& tile : tiles)
        for (int y = tile.y0; y < tile.y1; ++y)
            for (int x = tile.x0; x < tile.x1; ++x) visit(x, y);
}

// Appends the means of the pixels.
void append_means(const Film& film, std::span<const PixelBounds> tiles, std::vector<float>& to) {
    for_each_pixel(tiles,
                   [&](int x, int y) { to.push_back(static_cast<float>(mean_luminance(film.pixel(x, y)))); });
}

// Appends the splats in the pixels, per sample.
void append_splats(const SplatFilm& splats, std::span<const PixelBounds> tiles, double samples,
                   std::vector<float>& to) {
    for_each_pixel(tiles, [&](int x, int y) {
        to.push_back(static_cast<float>(luminance(splats.sum(x, y)) / samples));
    });
}

} // namespace

IntegratorPilot::IntegratorPilot(const Renderer& renderer, std::span<const PixelBounds> tiles)
    : renderer_(renderer), tiles_(tiles), state_(renderer.description()) {
    picture_.is_evidence = !renderer.sampler().chains;
}

void IntegratorPilot::count(const RenderReport& before, const RenderReport& after) {
    rays_ += static_cast<double>(after.rays.rays() - before.rays.rays());
    samples_ += static_cast<double>(after.samples - before.samples);
    cpu_seconds_ += after.cpu_seconds - before.cpu_seconds;
}

bool IntegratorPilot::sweep(const TileRenderer& renderer, RenderState& state, std::size_t end,
                            const CancelFlag* cancel) {
    const RenderReport before = state.report;
    const PixelBounds& film = state.film.bounds();
    const auto stride = static_cast<std::size_t>(film.width());
    const std::vector<std::uint32_t> targets(most_tile_pixels, 1);
    std::mutex mutex; // of the report
    const bool complete = parallel_for(
        static_cast<std::int64_t>(end - taken_),
        [&](std::int64_t t) {
            const PixelBounds& tile = tiles_[taken_ + static_cast<std::size_t>(t)];
            const std::size_t place = static_cast<std::size_t>(tile.y0 - film.y0) * stride +
                                      static_cast<std::size_t>(tile.x0 - film.x0);
            const std::size_t buckets = state.film.buckets_per_pixel();
            TileTally tally;
            const auto never = [] { return false; };
            renderer.render(
                {.bounds = tile,
                 .pixels = &state.film.pixels()[place],
                 .stride = stride,
                 .buckets = buckets > 0 ? &state.film.buckets()[place * buckets] : nullptr,
                 .bucket_count = buckets,
                 .target_samples = targets.data(),
                 .target_stride = static_cast<std::size_t>(tile.width()),
                 .layer_sums = state.film.layer_sums().data() + place * state.film.layers().sums(),
                 .splats = state.splats ? &*state.splats : nullptr},
                tally, never, never);
            std::lock_guard lock(mutex);
            tally.add_to(state.report);
        },
        cancel);
    count(before, state.report);
    return complete;
}

bool IntegratorPilot::take_tiles(std::size_t count, const CancelFlag* cancel) {
    const std::span<const PixelBounds> tiles = tiles_.subspan(taken_, count - taken_);
    if (tiles.empty()) return true;
    bool complete = false;
    renderer_.serve([&](const SampleTakers& takers) {
        // The first samples of other replicates: only replicates are independent of each other.
        const TileRenderer others(takers.context, renderer_.accelerator(),
                                  SampleOrder(renderer_.sampler(), {.index = 1, .count = 2}));
        RenderState other(renderer_.description());
        if (!sweep(takers.tiles, state_, count, cancel) || !sweep(others, other, count, cancel)) return;
        picture_.parts.resize(state_.splats ? 2 : 1);
        append_means(state_.film, tiles, picture_.parts[0].first);
        append_means(other.film, tiles, picture_.parts[0].second);
        if (state_.splats) {
            PilotPart& part = picture_.parts[1];
            double pixels = 0;
            for (const PixelBounds& tile : tiles) pixels += static_cast<double>(pixel_count(tile));
            append_splats(*state_.splats, tiles, pixels, part.first);
            append_splats(*other.splats, tiles, pixels, part.second);
            // Light paths start from these tiles alone, and reach the whole film.
            part.samples = pixels / static_cast<double>(state_.film.pixels().size());
        }
        complete = true;
    });
    taken_ = count;
    return complete;
}

bool IntegratorPilot::take_groups(std::size_t count, const CancelFlag* cancel) {
    const std::span<const PixelBounds> tiles = tiles_.first(count);
    const auto cancelled = [cancel] { return cancel != nullptr && cancel->requested(); };
    const ChainWatch watch{
        {cancelled, [](std::uint64_t) {}}, cancelled, [](const std::function<void()>& change) { change(); }};
    bool complete = false;
    renderer_.serve([&](const SampleTakers& takers) {
        const std::uint32_t size = takers.chains->order().replicate_size();
        std::vector<float> first;
        takers.chains->run(state_, size, watch);
        if (cancelled()) return;
        append_means(state_.film, tiles, first);
        const RenderReport before = state_.report; // the first group has made the plan
        takers.chains->run(state_, 2 * size, watch);
        if (cancelled()) return;
        this->count(before, state_.report);
        cpu_seconds_ = state_.report.cpu_seconds;
        PilotPart& part = picture_.parts.emplace_back();
        append_means(state_.film, tiles, part.second); // of both
        for (std::size_t i = 0; i < first.size(); ++i) part.second[i] = 2 * part.second[i] - first[i];
        part.first = std::move(first);
        part.samples = size;
        complete = true;
    });
    return complete;
}

} // namespace montelux
