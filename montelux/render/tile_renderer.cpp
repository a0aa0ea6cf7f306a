#include "montelux/render/tile_renderer.h"

namespace montelux {

std::vector<PixelBounds> tiles_of(const PixelBounds& crop, int size) {
    std::vector<PixelBounds> tiles;
    for (int y = crop.y0; y < crop.y1; y += size)
        for (int x = crop.x0; x < crop.x1; x += size)
            tiles.push_back({x, y, std::min(x + size, crop.x1), std::min(y + size, crop.y1)});
    return tiles;
}

void TileTally::merge(const TileTally& other) {
    rays.merge(other.rays);
    bad.merge(other.bad);
    cpu_seconds += other.cpu_seconds;
    samples += other.samples;
    clamped_samples += other.clamped_samples;
}

void TileTally::add_to(RenderReport& report) const {
    report.rays.merge(rays);
    report.bad.merge(bad);
    report.cpu_seconds += cpu_seconds;
    report.samples += samples;
    report.clamped_samples += clamped_samples;
}

TileRenderer::SampleBatch& TileRenderer::batch_of_this_thread() {
    thread_local SampleBatch batch; // its memory is allocated once
    return batch;
}

void TileRenderer::take(RayTracer& tracer, SampleBatch& batch, TileTally& tally, const TileView& tile) const {
    SplatFilm* const splats = tile.splats;
    batch.results.resize(batch.keys.size());
    context_.take(tracer, batch.keys, batch.memory, batch.results);
    const FilmLayers& layers = context_.layers();
    const bool has_sums = layers.sums() > 0;
    for (std::size_t k = 0; k < batch.keys.size(); ++k) {
        const SampleContext::Result& r = batch.results[k];
        const SampleContext::Key& key = batch.keys[k];
        Pixel& pixel = *batch.places[k].pixel;
        if (r.bad) {
            pixel.count_bad();
            tally.bad.add({*r.bad, key.x, key.y, key.index});
        } else {
            pixel.add_sample(r.film);
            if (has_sums)
                layers.add(batch.places[k].layer_sums, &batch.memory.layer_values[k * layers.values()]);
            if (splats != nullptr)
                for (const SampleContext::FilmSplat& s : batch.memory.splats_of(k))
                    splats->add_filtered(context_.filter(), s.film, Vec3d(s.rgb));
            if (tile.bias != nullptr) tile.bias->add(key.x, key.y, Vec3d(r.narrower));
        }
        if (r.clamped != 0) {
            ++tally.clamped_samples;
            pixel.add_clamped(r.clamped);
        }
        const std::span<BucketMoments> buckets = batch.places[k].buckets;
        if (!buckets.empty()) add_sample(buckets, batch.memory.spectral[k]);
        if (splats == nullptr && order_.closed(batch.places[k].number + 1)) {
            for (BucketMoments& b : buckets)
                b.end_replicate(pixel.open_samples(), pixel.replicates().count() + 1);
            if (has_sums) layers.end_replicate(batch.places[k].layer_sums, pixel.open_samples());
            pixel.end_replicate();
        }
    }
    tally.samples += batch.keys.size();
    batch.clear();
}

} // namespace montelux
