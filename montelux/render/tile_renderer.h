// TileRenderer: takes the samples of a tile's pixels up to their target sample counts.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "montelux/accel/accelerator.h"
#include "montelux/film/film.h"
#include "montelux/film/splat_film.h"
#include "montelux/mc/parallel/cpu_time.h"
#include "montelux/render/bad_sample_report.h"
#include "montelux/render/merging_bias.h"
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
    // Of a spectral film, `bucket_count` for each pixel and in the order of the pixels; or null.
    BucketMoments* buckets = nullptr;
    std::size_t bucket_count = 0;
    const std::uint32_t* target_samples = nullptr;
    std::size_t target_stride = 0;
    // FilmLayers::sums() numbers for each pixel, in the same rows; unused if that is 0.
    double* layer_sums = nullptr;
    // Of integrators that trace light; null otherwise. Replicates then stay open until the pass ends.
    SplatFilm* splats = nullptr;
    MergingBias* bias = nullptr; // where paths merge
    // At most this many new samples per pixel.
    std::uint32_t most = ~std::uint32_t{0};
};

class TileRenderer {
  public:
    // The context and the accelerator must outlive it.
    TileRenderer(const SampleContext& context, const Accelerator& accelerator, SampleOrder order)
        : context_(context), accelerator_(accelerator), order_(order) {}

    const SampleOrder& order() const { return order_; }
    const FilmLayers& layers() const { return context_.layers(); }
    std::size_t buckets_per_pixel() const { return context_.buckets_per_pixel(); }
    bool makes_splats() const { return context_.makes_splats(); }
    bool merges() const { return context_.merges(); }

    // Adds its statistics to `tally`. Stops early when stop(), called before each pixel, or check(), called
    // after each full batch of samples, returns true. Pixels are always consistent: a batch is added whole.
    template <typename Stop, typename Check>
    void render(const TileView& tile, TileTally& tally, const Stop& stop, const Check& check) const {
        const double begin = thread_cpu_seconds();
        RayTracer tracer(accelerator_);
        SampleBatch& batch = batch_of_this_thread();
        batch.clear();
        bool stopped = false;
        for (int y = tile.bounds.y0; y < tile.bounds.y1 && !stopped; ++y)
            for (int x = tile.bounds.x0; x < tile.bounds.x1 && !stopped; ++x) {
                if (stop()) {
                    stopped = true;
                    break;
                }
                const auto row = static_cast<std::size_t>(y - tile.bounds.y0);
                const auto column = static_cast<std::size_t>(x - tile.bounds.x0);
                const std::size_t place = row * tile.stride + column;
                Pixel& pixel = tile.pixels[place];
                const std::span<BucketMoments> buckets(
                    tile.buckets != nullptr ? tile.buckets + place * tile.bucket_count : nullptr,
                    tile.bucket_count);
                double* const sums = tile.layer_sums + place * layers().sums();
                const std::uint64_t target =
                    std::min<std::uint64_t>(tile.target_samples[row * tile.target_stride + column],
                                            std::uint64_t{pixel.samples()} + tile.most);
                for (std::uint64_t i = pixel.samples(); i < target && !stopped; ++i) {
                    batch.add(pixel, buckets, sums, i, {x, y, order_.index(i)});
                    if (batch.full()) {
                        take(tracer, batch, tally, tile);
                        stopped = check();
                    }
                }
            }
        if (!stopped && !batch.empty()) take(tracer, batch, tally, tile);
        tally.rays.merge(tracer.statistics);
        tally.cpu_seconds += thread_cpu_seconds() - begin;
    }

  private:
    // Samples that are computed together, and the pixels that they are added to. More would leave the caches.
    struct SampleBatch {
        static constexpr std::size_t capacity = 256;
        struct Place {
            Pixel* pixel = nullptr;
            std::span<BucketMoments> buckets;
            double* layer_sums = nullptr;
            std::uint64_t number = 0; // of the sample among the pixel's
        };
        std::vector<Place> places;
        std::vector<SampleContext::Key> keys;
        std::vector<SampleContext::Result> results;
        SampleContext::Batch memory;

        bool empty() const { return keys.empty(); }
        bool full() const { return keys.size() == capacity; }
        void clear() {
            places.clear();
            keys.clear();
        }
        void add(Pixel& pixel, std::span<BucketMoments> buckets, double* layer_sums, std::uint64_t number,
                 const SampleContext::Key& key) {
            places.push_back({&pixel, buckets, layer_sums, number});
            keys.push_back(key);
        }
    };
    static SampleBatch& batch_of_this_thread();

    void take(RayTracer& tracer, SampleBatch& batch, TileTally& tally, const TileView& tile) const;

    const SampleContext& context_;
    const Accelerator& accelerator_;
    SampleOrder order_;
};

} // namespace montelux
