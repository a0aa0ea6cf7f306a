// TileRenderer: takes the samples of a tile's pixels up to their target sample counts.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <ctime>
#include <vector>

#include "montelux/accel/accelerator.h"
#include "montelux/film/film.h"
#include "montelux/render/bad_sample_report.h"
#include "montelux/render/render_state.h"
#include "montelux/render/sample_context.h"
#include "montelux/render/sample_order.h"

namespace montelux {

// Rectangles of at most `size` x `size` pixels that cover `crop`, row by row.
std::vector<PixelBounds> tiles_of(const PixelBounds& crop, int size);
inline std::size_t pixel_count(const PixelBounds& b) {
    return static_cast<std::size_t>(b.width()) * static_cast<std::size_t>(b.height());
}

// The statistics of a tile's samples, beside the film. Trivially copyable.
struct TileTally {
    RayStatistics rays;
    BadSampleReport bad;
    double cpu_seconds = 0;
    std::uint64_t samples = 0, clamped_samples = 0;

    void merge(const TileTally& other);
    void add_to(RenderReport& report) const;
};

// Pixels in rows that are `stride` elements apart, and their target sample counts in rows that are
// `target_stride` apart.
struct TileView {
    PixelBounds bounds;
    Pixel* pixels = nullptr;
    std::size_t stride = 0;
    const std::uint32_t* target_samples = nullptr;
    std::size_t target_stride = 0;
    // At most this many new samples per pixel.
    std::uint32_t most = ~std::uint32_t{0};
};

class TileRenderer {
  public:
    // The context and the accelerator must outlive it.
    TileRenderer(const SampleContext& context, const Accelerator& accelerator, SampleOrder order)
        : context_(context), accelerator_(accelerator), order_(order) {}

    const SampleOrder& order() const { return order_; }

    // Adds its statistics to `tally`. Stops early when stop(), called before each pixel, or check(), called
    // every few samples, returns true. Stops only between samples, so pixels are always consistent.
    template <typename Stop, typename Check>
    void render(const TileView& tile, TileTally& tally, const Stop& stop, const Check& check) const {
        const double begin = thread_cpu_seconds();
        RayTracer tracer(accelerator_);
        for (int y = tile.bounds.y0; y < tile.bounds.y1; ++y)
            for (int x = tile.bounds.x0; x < tile.bounds.x1; ++x) {
                if (stop()) break;
                const auto row = static_cast<std::size_t>(y - tile.bounds.y0);
                const auto column = static_cast<std::size_t>(x - tile.bounds.x0);
                Pixel& pixel = tile.pixels[row * tile.stride + column];
                const std::uint64_t target =
                    std::min<std::uint64_t>(tile.target_samples[row * tile.target_stride + column],
                                            std::uint64_t{pixel.samples()} + tile.most);
                render_pixel(tracer, pixel, x, y, target, tally, check);
            }
        tally.rays.merge(tracer.statistics);
        tally.cpu_seconds += thread_cpu_seconds() - begin;
    }

  private:
    static constexpr std::uint64_t samples_between_checks = 1024;

    // CPU time of the calling thread: other programs do not affect it.
    static double thread_cpu_seconds() {
        timespec t{};
        clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
        return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
    }

    template <typename Check>
    void render_pixel(RayTracer& tracer, Pixel& pixel, int x, int y, std::uint64_t target, TileTally& tally,
                      const Check& check) const {
        for (std::uint64_t i = pixel.samples(); i < target; ++i) {
            if (tally.samples % samples_between_checks == samples_between_checks - 1 && check()) return;
            const std::uint64_t index = order_.index(i);
            const SampleContext::Result r = context_.take(tracer, x, y, index);
            if (r.bad) {
                pixel.count_bad();
                tally.bad.add({*r.bad, x, y, index});
            } else {
                pixel.add_sample(r.film);
            }
            if (r.clamped != 0) {
                ++tally.clamped_samples;
                pixel.add_clamped(r.clamped);
            }
            if (order_.closed(i + 1)) pixel.end_replicate();
            ++tally.samples;
        }
    }

    const SampleContext& context_;
    const Accelerator& accelerator_;
    SampleOrder order_;
};

} // namespace montelux
