// LivePicture: the picture of a running render as viewers see it, updated tile by tile.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "montelux/film/film.h"
#include "montelux/image/image.h"
#include "montelux/render/render_control.h"
#include "montelux/view/view_layers.h"

namespace montelux {

// Mean and standard error in linear sRGB, and the number of samples.
struct LivePixel {
    std::array<float, 3> mean{}, error{};
    float samples = 0;
};

// Of the mean, or of the error: errors of channels are strongly correlated, so they add up.
inline double luminance(const std::array<float, 3>& rgb) {
    return dot(Vec3d(double(rgb[0]), double(rgb[1]), double(rgb[2])), luminance_weight);
}

// A tile of a layer, row by row, channels side by side. Its place is counted from the first pixel of the picture.
struct LiveTile {
    PixelBounds bounds;
    std::vector<float> values;
};

// Rendering threads write, any thread reads. Each write of a tile has a version, larger than all before it, so that a
// reader asks for what has changed since its last answer.
class LivePicture {
  public:
    // `replicate_size`: of the render. `channels`: of its pictures. `reference`: of the size of `bounds`, or empty.
    LivePicture(const PixelBounds& bounds, std::uint32_t replicate_size,
                std::span<const std::string> channels, std::shared_ptr<const Image> reference = nullptr);

    const PixelBounds& bounds() const { return bounds_; }
    const std::vector<ViewLayer>& layers() const { return layers_; }
    std::optional<std::size_t> find_layer(std::string_view name) const;

    // The pixels of a tile whose samples are complete for now, from the thread that rendered it.
    void update(const FinishedTile& tile);
    // Replaces all pixels and layers. The picture has the channels given to the constructor.
    void update(std::shared_ptr<const Image> picture);
    // Only the layers that update(FinishedTile) does not compute.
    void update_others(std::shared_ptr<const Image> picture);

    // Version of the last change.
    std::uint64_t version() const;
    // Of all pixels, row by row.
    std::vector<LivePixel> pixels() const;
    LivePixel pixel(int x, int y) const; // counted from the first pixel of the bounds
    // The values of a layer there; empty while nothing is known of it.
    std::vector<float> values(std::size_t layer, int x, int y) const;

    // Tiles of a layer that have changed since a version, oldest change first, of about `most_values` numbers; sets the
    // version to that of the last change among them. Empty: nothing has changed.
    std::vector<LiveTile> changes_since(std::size_t layer, std::uint64_t& version,
                                        std::size_t most_values) const;

  private:
    struct Tile {
        PixelBounds bounds; // counted from the first pixel
        std::uint64_t version = 0;
    };

    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(bounds_.width()) +
               static_cast<std::size_t>(x);
    }
    bool is_live(std::size_t layer) const { return layers_[layer].of.empty(); }
    void append_values(std::size_t layer, const PixelBounds& pixels, std::vector<float>& out) const;
    void append_live_values(LiveLayer layer, const PixelBounds& pixels, std::vector<float>& out) const;
    std::array<float, 3> reference(int x, int y, const std::vector<int>& channels) const;

    PixelBounds bounds_;
    std::uint32_t replicate_size_;
    std::vector<ViewLayer> layers_;
    std::shared_ptr<const Image> reference_;
    std::vector<int> reference_error_; // its channels of standard errors; may be empty

    mutable std::mutex mutex_; // of the members below
    std::vector<LivePixel> pixels_;
    std::vector<Tile> tiles_;              // of the live layers
    std::shared_ptr<const Image> others_;  // null: not known yet
    std::vector<std::vector<int>> places_; // channels of each layer in `others_`
    std::uint64_t others_version_ = 0, clock_ = 0;
};

} // namespace montelux
