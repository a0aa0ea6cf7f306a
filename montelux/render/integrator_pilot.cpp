#include "montelux/render/integrator_pilot.h"

#include <mutex>
#include <optional>

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

// Appends what each pixel's mean became: that after the first sample, and that of the second one alone.
class PixelMeans {
  public:
    explicit PixelMeans(std::span<const PixelBounds> tiles) : tiles_(tiles) {}
    void after_first(const Film& film) {
        for_each_pixel(tiles_, [&](int x, int y) { first_.push_back(mean_luminance(film.pixel(x, y))); });
    }
    void after_second(const Film& film, PilotPart& part) const {
        std::size_t i = 0;
        for_each_pixel(tiles_, [&](int x, int y) {
            const double both = mean_luminance(film.pixel(x, y));
            part.first.push_back(static_cast<float>(first_[i]));
            part.second.push_back(static_cast<float>(2 * both - first_[i]));
            ++i;
        });
    }

  private:
    std::span<const PixelBounds> tiles_;
    std::vector<double> first_;
};

std::vector<double> splat_luminances(const SplatFilm& splats, std::span<const PixelBounds> tiles) {
    std::vector<double> sums;
    for_each_pixel(tiles, [&](int x, int y) { sums.push_back(luminance(splats.sum(x, y))); });
    return sums;
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

bool IntegratorPilot::sweep(const SampleTakers& takers, RenderState& state, std::size_t first,
                            std::size_t end, std::uint32_t target, const CancelFlag* cancel) {
    const RenderReport before = state.report;
    const PixelBounds& film = state.film.bounds();
    const auto stride = static_cast<std::size_t>(film.width());
    const std::vector<std::uint32_t> targets(most_tile_pixels, target);
    std::mutex mutex; // of the report
    const bool complete = parallel_for(
        static_cast<std::int64_t>(end - first),
        [&](std::int64_t t) {
            const PixelBounds& tile = tiles_[first + static_cast<std::size_t>(t)];
            const std::size_t place = static_cast<std::size_t>(tile.y0 - film.y0) * stride +
                                      static_cast<std::size_t>(tile.x0 - film.x0);
            const std::size_t buckets = state.film.buckets_per_pixel();
            TileTally tally;
            const auto never = [] { return false; };
            takers.tiles.render(
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
        PixelMeans means(tiles);
        if (!sweep(takers, state_, taken_, count, 1, cancel)) return;
        means.after_first(state_.film);
        std::vector<double> splats_of_first;
        if (state_.splats) splats_of_first = splat_luminances(*state_.splats, tiles);
        const bool pass_ends = state_.splats && takers.tiles.order().closed(1);
        const bool keeps = !pass_ends && renderer_.description().integrator.guiding == Guiding::off;
        std::optional<RenderState> copy;
        if (!keeps) copy = state_;
        RenderState& state = keeps ? state_ : *copy;
        if (!sweep(takers, state, taken_, count, 2, cancel)) return;
        if (!keeps) state_.report.cpu_seconds = state.report.cpu_seconds;
        picture_.parts.resize(state.splats ? 2 : 1);
        means.after_second(state.film, picture_.parts[0]);
        if (state.splats) {
            const std::vector<double> both = splat_luminances(*state.splats, tiles);
            PilotPart& part = picture_.parts[1];
            double pixels = 0;
            for (const PixelBounds& tile : tiles) pixels += static_cast<double>(pixel_count(tile));
            for (std::size_t i = 0; i < both.size(); ++i) {
                part.first.push_back(static_cast<float>(splats_of_first[i] / pixels));
                part.second.push_back(static_cast<float>((both[i] - splats_of_first[i]) / pixels));
            }
            // Light paths start from these tiles alone, and reach the whole film.
            part.samples = pixels / static_cast<double>(state.film.pixels().size());
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
        PixelMeans means(tiles);
        takers.chains->run(state_, size, watch);
        if (cancelled()) return;
        means.after_first(state_.film);
        const RenderReport before = state_.report; // the first group has made the plan
        takers.chains->run(state_, 2 * size, watch);
        if (cancelled()) return;
        this->count(before, state_.report);
        cpu_seconds_ = state_.report.cpu_seconds;
        picture_.parts.resize(1);
        means.after_second(state_.film, picture_.parts[0]);
        picture_.parts[0].samples = size;
        complete = true;
    });
    return complete;
}

} // namespace montelux
