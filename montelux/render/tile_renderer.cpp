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

} // namespace montelux
