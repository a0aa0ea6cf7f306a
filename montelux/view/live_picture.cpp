#include "montelux/view/live_picture.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "montelux/render/tile_renderer.h"

namespace montelux {

namespace {

constexpr int tile_size = 16;

LivePixel live_pixel(const Pixel& p) {
    LivePixel pixel;
    for (int c = 0; c < 3; ++c) {
        pixel.mean[static_cast<std::size_t>(c)] = static_cast<float>(p.replicates().mean(c));
        pixel.error[static_cast<std::size_t>(c)] = static_cast<float>(p.replicates().standard_error(c));
    }
    pixel.samples = static_cast<float>(p.samples());
    return pixel;
}

} // namespace

LivePicture::LivePicture(const PixelBounds& bounds, std::uint32_t replicate_size,
                         std::span<const std::string> channels, std::shared_ptr<const Image> reference)
    : bounds_(bounds), replicate_size_(replicate_size), layers_(view_layers(channels, reference != nullptr)),
      reference_(std::move(reference)),
      pixels_(static_cast<std::size_t>(bounds.width()) * static_cast<std::size_t>(bounds.height())),
      places_(layers_.size()) {
    if (reference_) reference_error_ = reference_->color_channels("stderr.");
    for (const PixelBounds& b : tiles_of({0, 0, bounds.width(), bounds.height()}, tile_size))
        tiles_.push_back({b, reference_ ? ++clock_ : 0});
}

std::optional<std::size_t> LivePicture::find_layer(std::string_view name) const {
    for (std::size_t i = 0; i < layers_.size(); ++i)
        if (layers_[i].name == name) return i;
    return std::nullopt;
}

void LivePicture::update(const FinishedTile& finished) {
    const PixelBounds& b = finished.bounds;
    // Outside the lock, for which other threads wait.
    std::vector<LivePixel> made;
    made.reserve(pixel_count(b));
    for (int y = b.y0; y < b.y1; ++y)
        for (int x = b.x0; x < b.x1; ++x) {
            Pixel pixel = finished.film->pixel(x, y);
            pixel.end_last_replicate(replicate_size_);
            made.push_back(live_pixel(pixel));
        }
    const int x0 = b.x0 - bounds_.x0, y0 = b.y0 - bounds_.y0;
    const std::lock_guard lock(mutex_);
    for (int row = 0; row < b.height(); ++row)
        std::copy_n(&made[static_cast<std::size_t>(row) * static_cast<std::size_t>(b.width())], b.width(),
                    &pixels_[index(x0, y0 + row)]);
    const std::size_t tiles_in_a_row =
        static_cast<std::size_t>((bounds_.width() + tile_size - 1) / tile_size);
    for (int ty = y0 / tile_size; ty * tile_size < y0 + b.height(); ++ty)
        for (int tx = x0 / tile_size; tx * tile_size < x0 + b.width(); ++tx)
            tiles_[static_cast<std::size_t>(ty) * tiles_in_a_row + static_cast<std::size_t>(tx)].version =
                ++clock_;
}

void LivePicture::update(std::shared_ptr<const Image> picture) {
    const std::vector<int> mean = picture->color_channels(), error = picture->color_channels("stderr.");
    const std::optional<int> samples = picture->find_channel("samples");
    std::vector<LivePixel> made(pixels_.size());
    for (int y = 0; y < bounds_.height(); ++y)
        for (int x = 0; x < bounds_.width(); ++x) {
            LivePixel& p = made[index(x, y)];
            for (std::size_t c = 0; c < 3; ++c) {
                if (mean.size() == 3) p.mean[c] = picture->value(x, y, mean[c]);
                p.error[c] = error.size() == 3 ? picture->value(x, y, error[c])
                                               : std::numeric_limits<float>::infinity();
            }
            if (samples) p.samples = picture->value(x, y, *samples);
        }
    {
        const std::lock_guard lock(mutex_);
        pixels_ = std::move(made);
        for (Tile& tile : tiles_) tile.version = ++clock_;
    }
    update_others(std::move(picture));
}

void LivePicture::update_others(std::shared_ptr<const Image> picture) {
    std::vector<std::vector<int>> places(layers_.size());
    for (std::size_t i = 0; i < layers_.size(); ++i)
        for (const std::string& channel : layers_[i].of)
            if (const std::optional<int> place = picture->find_channel(channel)) places[i].push_back(*place);
    const std::lock_guard lock(mutex_);
    others_ = std::move(picture);
    places_ = std::move(places);
    others_version_ = ++clock_;
}

std::uint64_t LivePicture::version() const {
    const std::lock_guard lock(mutex_);
    return clock_;
}

std::vector<LivePixel> LivePicture::pixels() const {
    const std::lock_guard lock(mutex_);
    return pixels_;
}

LivePixel LivePicture::pixel(int x, int y) const {
    const std::lock_guard lock(mutex_);
    return pixels_[index(x, y)];
}

std::vector<float> LivePicture::values(std::size_t layer, int x, int y) const {
    std::vector<float> out;
    const std::lock_guard lock(mutex_);
    if (is_live(layer) || others_) append_values(layer, {x, y, x + 1, y + 1}, out);
    return out;
}

std::array<float, 3> LivePicture::reference(int x, int y, const std::vector<int>& channels) const {
    std::array<float, 3> rgb{};
    for (std::size_t c = 0; c < channels.size() && c < 3; ++c) rgb[c] = reference_->linear(x, y, channels[c]);
    if (channels.size() == 1) rgb = {rgb[0], rgb[0], rgb[0]};
    return rgb;
}

// Called with the lock held.
void LivePicture::append_values(std::size_t layer, const PixelBounds& b, std::vector<float>& out) const {
    if (is_live(layer)) return append_live_values(static_cast<LiveLayer>(layer), b, out);
    for (int y = b.y0; y < b.y1; ++y)
        for (int x = b.x0; x < b.x1; ++x)
            for (const int channel : places_.at(layer)) out.push_back(others_->value(x, y, channel));
}

void LivePicture::append_live_values(LiveLayer layer, const PixelBounds& b, std::vector<float>& out) const {
    const std::size_t begin = out.size(),
                      channels = static_cast<std::size_t>(layers_[static_cast<std::size_t>(layer)].channels);
    out.resize(begin + pixel_count(b) * channels);
    float* to = &out[begin];
    const auto each = [&](const auto& write) {
        for (int y = b.y0; y < b.y1; ++y)
            for (int x = b.x0; x < b.x1; ++x, to += channels) write(pixels_[index(x, y)], x, y);
    };
    switch (layer) {
    case LiveLayer::mean:
        each([&](const LivePixel& p, int, int) { std::ranges::copy(p.mean, to); });
        break;
    case LiveLayer::error:
        each([&](const LivePixel& p, int, int) { *to = static_cast<float>(luminance(p.error)); });
        break;
    case LiveLayer::relative_error:
        each([&](const LivePixel& p, int, int) {
            const double mean = luminance(p.mean), error = luminance(p.error);
            const double none = error > 0 ? std::numeric_limits<double>::infinity() : 0;
            *to = static_cast<float>(mean > 0 ? error / mean : none);
        });
        break;
    case LiveLayer::samples:
        each([&](const LivePixel& p, int, int) { *to = p.samples; });
        break;
    case LiveLayer::reference:
        each([&](const LivePixel&, int x, int y) {
            std::ranges::copy(reference(x, y, reference_->color_channels()), to);
        });
        break;
    case LiveLayer::z:
        each([&](const LivePixel& p, int x, int y) {
            const double difference =
                luminance(p.mean) - luminance(reference(x, y, reference_->color_channels()));
            const double error = std::hypot(luminance(p.error), luminance(reference(x, y, reference_error_)));
            *to = difference == 0 ? 0.0f : static_cast<float>(difference / error);
        });
        break;
    }
}

std::vector<LiveTile> LivePicture::changes_since(std::size_t layer, std::uint64_t& version,
                                                 std::size_t most_values) const {
    std::vector<LiveTile> changes;
    const std::lock_guard lock(mutex_);
    if (!is_live(layer) && places_[layer].size() != static_cast<std::size_t>(layers_[layer].channels))
        return changes;
    std::vector<const Tile*> changed;
    for (const Tile& tile : tiles_)
        if ((is_live(layer) ? tile.version : others_version_) > version) changed.push_back(&tile);
    if (is_live(layer)) std::ranges::sort(changed, {}, &Tile::version);
    std::size_t values = 0;
    for (const Tile* tile : changed) {
        LiveTile& change = changes.emplace_back(LiveTile{tile->bounds, {}});
        append_values(layer, tile->bounds, change.values);
        version = is_live(layer) ? tile->version : others_version_;
        values += change.values.size();
        // The others have one version for all tiles: they are given whole.
        if (is_live(layer) && values >= most_values) break;
    }
    return changes;
}

} // namespace montelux
