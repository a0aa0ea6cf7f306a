// How the levels of a pyramid are made, in memory or in a file.
#include <algorithm>
#include <cstring>
#include <span>
#include <string>

#include "montelux/image/texel_file.h"
#include "montelux/mc/parallel/parallel_for.h"
#include "montelux/scene/texture/mipmap.h"

namespace montelux {
namespace {

int part(int i, int size, int parts) { return static_cast<int>(std::int64_t{i} * size / parts); }

} // namespace

class MipMap::Builder {
  public:
    Builder(MipMap& map, const Image& image, ImageChannels channels)
        : map_(map), image_(image), alpha_(channels == ImageChannels::alpha) {
        std::vector<int> color = image.color_channels();
        if (alpha_) color = {image.find_channel("A").value()};
        if (color.empty()) color = {0};
        for (std::size_t i = 0; i < 3; ++i)
            channels_[i] = color.size() == 3 ? color[i] : (i == 0 ? color[0] : -1);
        components_ = color.size() == 3 ? 3 : 1;
        const bool linear = image.encoding().kind() == ColorEncoding::Kind::linear;
        if (!alpha_ && image.format() == PixelFormat::u8) {
            for (std::size_t i = 0; i < 256; ++i) map.decode8_[i] = static_cast<float>(i) / 255;
            if (!linear) map.decode8_ = image.encoding().table8();
            by_table_ = !Image::is_alpha(image.channel_names()[static_cast<std::size_t>(channels_[0])]);
        } else {
            converts_ = alpha_ || !linear || image.format() == PixelFormat::u16;
        }
        int w = image.width(), h = image.height();
        for (;;) {
            map.levels_.push_back({.width = w, .height = h, .stride = components_});
            if (w == 1 && h == 1) break;
            w = std::max(1, w / 2);
            h = std::max(1, h / 2);
        }
        if (!converts_) map.levels_[0].format = image.format();
    }

    void build_in_memory() {
        map_.channels_ = channels_;
        if (!converts_) {
            TexelLevel& finest = map_.levels_[0];
            finest.samples = samples_of(image_);
            finest.stride = image_.channels();
        }
        for (std::size_t i = converts_ ? 0 : 1; i < map_.levels_.size(); ++i) {
            TexelLevel& level = map_.levels_[i];
            Image made(level.width, level.height,
                       components_ == 3 ? std::vector<std::string>{"R", "G", "B"}
                                        : std::vector<std::string>{"Y"});
            float* out = made.f32().data();
            for (int y = 0; y < level.height; ++y)
                for (int x = 0; x < level.width; ++x, out += components_) make_texel<RowLayout>(i, x, y, out);
            level.samples = samples_of(made);
            map_.owned_.push_back(std::move(made));
        }
        if (converts_) use_all_channels();
    }

    void build_in_file(TexelFile& file) {
        std::vector<std::size_t> offsets;
        std::size_t bytes = 0;
        for (TexelLevel& level : map_.levels_) {
            offsets.push_back(bytes);
            bytes += (TileLayout::arrange(level) + file_alignment - 1) / file_alignment * file_alignment;
        }
        map_.block_ = file.allocate(bytes);
        for (std::size_t i = 0; i < offsets.size(); ++i) {
            TexelLevel& level = map_.levels_[i];
            level.samples = map_.block_->bytes().data() + offsets[i];
            const std::size_t tile_bytes = TileLayout::tile_texels(level) * level.texel_bytes();
            parallel_for(std::int64_t{level.tiles_x} * TileLayout::tiles_y(level), [&](std::int64_t t) {
                std::vector<std::byte> tile(tile_bytes);
                fill_tile(i, static_cast<int>(t % level.tiles_x) << level.x_bits,
                          static_cast<int>(t / level.tiles_x) << level.y_bits, tile);
                map_.block_->write(offsets[i] + static_cast<std::size_t>(t) * tile_bytes, tile);
            });
        }
        use_all_channels();
        image_.give_back();
        map_.block_->give_back();
    }

  private:
    static constexpr std::size_t file_alignment = 16; // of samples

    static const void* samples_of(const Image& image) {
        switch (image.format()) {
        case PixelFormat::u8:
            return image.u8().data();
        case PixelFormat::u16:
        case PixelFormat::f16:
            return image.u16().data();
        case PixelFormat::f32:
            break;
        }
        return image.f32().data();
    }
    void use_all_channels() {
        map_.channels_ = components_ == 3 ? std::array{0, 1, 2} : std::array{0, -1, -1};
    }

    float decoded(int x, int y, int component) const {
        const int channel = channels_[static_cast<std::size_t>(component)];
        if (by_table_) return map_.decode8_[image_.u8()[image_.index(x, y, channel)]];
        return alpha_ ? image_.encoding().to_linear(image_.value(x, y, channel))
                      : image_.linear(x, y, channel);
    }

    // Of a level whose next finer one is made; of the finest, if it is converted.
    template <typename Layout>
    void make_texel(std::size_t i, int x, int y, float* out) const {
        if (i == 0) {
            for (int c = 0; c < components_; ++c) out[c] = decoded(x, y, c);
            return;
        }
        const TexelLevel &level = map_.levels_[i], &finer = map_.levels_[i - 1];
        // The last cell of an odd size takes three texels.
        const int x0 = part(x, finer.width, level.width), x1 = part(x + 1, finer.width, level.width),
                  y0 = part(y, finer.height, level.height), y1 = part(y + 1, finer.height, level.height);
        const bool from_image = i == 1 && !converts_;
        for (int c = 0; c < components_; ++c) {
            float sum = 0;
            for (int yy = y0; yy < y1; ++yy)
                for (int xx = x0; xx < x1; ++xx)
                    sum += from_image ? decoded(xx, yy, c) : finer.at<float>(Layout::index(finer, xx, yy))[c];
            out[c] = sum / static_cast<float>((x1 - x0) * (y1 - y0));
        }
    }

    void fill_tile(std::size_t i, int x0, int y0, std::span<std::byte> tile) const {
        const TexelLevel& level = map_.levels_[i];
        const int x1 = std::min(x0 + (1 << level.x_bits), level.width),
                  y1 = std::min(y0 + (1 << level.y_bits), level.height);
        const std::size_t size = bytes_per_sample(level.format);
        for (int y = y0; y < y1; ++y)
            for (int x = x0; x < x1; ++x) {
                std::byte* out =
                    tile.data() +
                    static_cast<std::size_t>(((y - y0) << level.x_bits) + (x - x0)) * level.texel_bytes();
                if (i == 0 && !converts_) {
                    const auto* from = static_cast<const std::byte*>(samples_of(image_));
                    for (int c = 0; c < components_; ++c)
                        std::memcpy(out + static_cast<std::size_t>(c) * size,
                                    from + image_.index(x, y, channels_[static_cast<std::size_t>(c)]) * size,
                                    size);
                } else {
                    std::array<float, 3> texel;
                    make_texel<TileLayout>(i, x, y, texel.data());
                    std::memcpy(out, texel.data(), level.texel_bytes());
                }
            }
    }

    MipMap& map_;
    const Image& image_;
    bool alpha_;
    bool converts_ = false; // the finest level, to linear floats
    bool by_table_ = false; // decode8_ is what decoding each sample would give
    int components_ = 1;
    std::array<int, 3> channels_{0, -1, -1}; // of the image
};

MipMap::MipMap(const Image& image, ImageChannels channels) {
    Builder builder(*this, image, channels);
    if (const auto file = image.file())
        builder.build_in_file(*file);
    else
        builder.build_in_memory();
}

} // namespace montelux
