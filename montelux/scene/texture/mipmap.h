// MipMap: an image pyramid for filtered look-ups into an image texture.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "montelux/image/image.h"
#include "montelux/scene/texture/texel_level.h"
#include "montelux/scene/texture/texture.h"

namespace montelux {

// Texture coordinates: (0, 0) is the lower left corner of the image, (1, 1) the upper right. Colours are
// linear. The finest level is the image itself, which must outlive the pyramid; coarser ones halve it by box
// averages. Alpha is decoded as the colours are, as in pbrt-v4. The pyramid of an image in a TexelFile is
// in the same file, with a copy of the finest level: look-ups have the same bits.
class MipMap {
  public:
    // Levels in a file are made by several threads, each of which needs little memory.
    explicit MipMap(const Image& image, ImageChannels channels = ImageChannels::color);
    MipMap(MipMap&&) = default;
    MipMap& operator=(MipMap&&) = default;
    MipMap(const MipMap&) = delete; // levels_ point to owned_
    MipMap& operator=(const MipMap&) = delete;
    ~MipMap() = default;

    bool is_color() const { return channels_[1] >= 0; }
    // Memory of all levels but those that are the image's own or in a file.
    std::size_t bytes() const {
        std::size_t sum = 0;
        for (const Image& level : owned_) sum += level.byte_count();
        return sum;
    }
    // dst0, dst1: the sides of a pixel in texture coordinates; the filter point ignores them.
    Vec3f lookup(Point2f st, Vec2f dst0, Vec2f dst1, TextureFilter filter, TextureWraps wrap,
                 float max_anisotropy) const;

  private:
    class Builder; // mipmap_builder.cpp

    int level_count() const { return static_cast<int>(levels_.size()); }
    const TexelLevel& level(int i) const { return levels_[static_cast<std::size_t>(i)]; }
    template <typename Layout>
    Vec3f texel(int level, int x, int y, TextureWraps wrap) const;
    template <typename Layout>
    Vec3f bilinear(int level, Point2f st, TextureWraps wrap) const;
    template <typename Layout>
    Vec3f trilinear(Point2f st, float width, TextureWraps wrap) const;
    template <typename Layout>
    Vec3f ewa(Point2f st, Vec2f dst0, Vec2f dst1, TextureWraps wrap, float max_anisotropy) const;
    template <typename Layout>
    Vec3f ewa_level(int level, Point2f st, Vec2f dst0, Vec2f dst1, TextureWraps wrap) const;
    template <typename Layout>
    Vec3f filtered(Point2f st, Vec2f dst0, Vec2f dst1, TextureFilter filter, TextureWraps wrap,
                   float max_anisotropy) const;
    // log2 of the footprint in texels of the finest level; negative when magnified.
    float level_of(float width) const;

    std::vector<TexelLevel> levels_;         // the finest first
    std::array<int, 3> channels_{0, -1, -1}; // of the finest level; coarser ones have no others
    std::array<float, 256> decode8_{};
    // What the levels refer to, beside the image: the image as linear floats where its own samples are slow to decode,
    // and the coarser levels; or else all levels, by tiles.
    std::vector<Image> owned_;
    std::shared_ptr<TexelBlock> block_;
};

} // namespace montelux
