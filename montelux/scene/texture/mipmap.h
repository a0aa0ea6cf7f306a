// MipMap: an image pyramid for filtered look-ups into an image texture.
#pragma once

#include <array>
#include <vector>

#include "montelux/image/image.h"
#include "montelux/scene/texture/texture.h"

namespace montelux {

// Texture coordinates: (0, 0) is the lower left corner of the image, (1, 1) the upper right. Colours are
// linear. The finest level is the image itself, which must outlive the pyramid; coarser ones halve it by box
// averages. Alpha is decoded as the colours are, as in pbrt-v4.
class MipMap {
  public:
    explicit MipMap(const Image& image, ImageChannels channels = ImageChannels::color);

    bool is_color() const { return channels_[1] >= 0; }
    // Memory of all levels but those that are the image's own.
    std::size_t bytes() const {
        std::size_t sum = converted_.byte_count();
        for (const Image& level : levels_) sum += level.byte_count();
        return sum;
    }
    // dst0, dst1: the sides of a pixel in texture coordinates; the filter point ignores them.
    Vec3f lookup(Point2f st, Vec2f dst0, Vec2f dst1, TextureFilter filter, TextureWrap wrap,
                 float max_anisotropy) const;

  private:
    int level_count() const { return static_cast<int>(levels_.size()) + 1; }
    const Image& base() const { return converted_.empty() ? *image_ : converted_; }
    const Image& level(int i) const { return i == 0 ? base() : levels_[static_cast<std::size_t>(i) - 1]; }
    Vec3f texel(int level, int x, int y, TextureWrap wrap) const;
    Vec3f bilinear(int level, Point2f st, TextureWrap wrap) const;
    Vec3f trilinear(Point2f st, float width, TextureWrap wrap) const;
    Vec3f ewa(Point2f st, Vec2f dst0, Vec2f dst1, TextureWrap wrap, float max_anisotropy) const;
    Vec3f ewa_level(int level, Point2f st, Vec2f dst0, Vec2f dst1, TextureWrap wrap) const;
    // log2 of the footprint in texels of the finest level; negative when magnified.
    float level_of(float width) const;

    const Image* image_;
    Image converted_; // the image as linear floats, when its own samples are slow to decode
    std::vector<Image> levels_;
    std::array<int, 3> channels_{0, -1, -1};
    std::array<float, 256> decode8_{};
};

} // namespace montelux
