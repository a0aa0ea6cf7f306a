// Image: a rectangle of pixels with named channels, kept in the precision in which it was stored.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "montelux/image/color_encoding.h"
#include "montelux/image/sample_array.h"
#include "montelux/mc/math/transform.h"

namespace montelux {

// Integers mean v / 255 and v / 65535. A texture keeps its 8 bits: a quarter of the memory of floats.
enum class PixelFormat { u8, u16, f16, f32 };
std::size_t bytes_per_sample(PixelFormat format);
std::string_view name_of(PixelFormat format);

// A header entry. A Matrix4 is in Montelux's convention (points are columns); EXR files hold the transpose
// (points are rows), and reading and writing convert.
using Attribute = std::variant<std::string, int, float, double, Matrix4, std::vector<float>>;
using Attributes = std::map<std::string, Attribute, std::less<>>;

// Row y = 0 is the top one; samples are interleaved: index = (y * width + x) * channels + c.
class Image {
  public:
    // Largest number of pixels on a side.
    static constexpr int max_dimension = 1 << 16;
    static constexpr int max_channels = 1024;

    Image() = default;
    // All samples 0. Throws Error when a size is not positive or too large, or a channel is named twice.
    Image(int width, int height, std::vector<std::string> channels, PixelFormat format = PixelFormat::f32,
          ColorEncoding encoding = ColorEncoding::linear());

    int width() const { return width_; }
    int height() const { return height_; }
    int channels() const { return static_cast<int>(names_.size()); }
    bool empty() const { return width_ == 0; }
    std::size_t pixel_count() const { return static_cast<std::size_t>(width_) * height_; }
    std::size_t sample_count() const { return pixel_count() * names_.size(); }
    std::size_t byte_count() const { return sample_count() * bytes_per_sample(format_); }
    // Those of the samples that are not in a file.
    std::size_t memory_bytes() const { return file() ? 0 : byte_count(); }

    PixelFormat format() const { return format_; }
    // Applies to colour channels; an alpha channel ("A" or "*.A") is always linear.
    ColorEncoding encoding() const { return encoding_; }
    void set_encoding(ColorEncoding encoding) { encoding_ = encoding; }
    static bool is_alpha(std::string_view channel);

    const std::vector<std::string>& channel_names() const { return names_; }
    std::optional<int> find_channel(std::string_view name) const;
    // Indices of `layer`R, G, B (for example layer "stderr."); or the single channel `layer`Y, unless there
    // are also X and Z (CIE XYZ); else empty.
    std::vector<int> color_channels(std::string_view layer = "") const;

    Attributes& attributes() { return attributes_; }
    const Attributes& attributes() const { return attributes_; }

    std::size_t index(int x, int y, int channel = 0) const {
        return (static_cast<std::size_t>(y) * width_ + x) * names_.size() + channel;
    }
    // The stored number as a float: integers divided by their maximum, encoding not undone.
    float value(int x, int y, int channel) const { return value_at(index(x, y, channel)); }
    float value_at(std::size_t i) const;
    // Linear light: value() with the encoding undone.
    float linear(int x, int y, int channel) const;
    // Only for f32 images.
    void set(int x, int y, int channel, float v) { f32_.writable()[index(x, y, channel)] = v; }

    // The samples of the format that the image has; the other spans are empty. f16 samples are their bits.
    std::span<float> f32() { return f32_.writable(); }
    std::span<const float> f32() const { return f32_.span(); }
    std::span<std::uint16_t> u16() { return u16_.writable(); }
    std::span<const std::uint16_t> u16() const { return u16_.span(); }
    std::span<std::uint8_t> u8() { return u8_.writable(); }
    std::span<const std::uint8_t> u8() const { return u8_.span(); }

    // Writes the samples to a file and frees their memory. Spans that were taken before become invalid; nothing else
    // changes. Functions that write samples bring them back into memory.
    void move_to(TexelFile& file);
    // After a read of all samples that will not be read again soon: frees what of a file is resident.
    void give_back() const;
    // Null: the samples are in memory.
    std::shared_ptr<TexelFile> file() const;

    // A 32-bit linear copy with the same channels and attributes.
    Image to_linear_f32() const;
    // A copy of some channels in the order given, in the same format. Throws Error on an unknown name.
    Image select(std::span<const std::string> channels) const;
    // Adds the channels of an image of the same size and format; throws Error when they do not fit.
    void append(const Image& other, std::string_view prefix = "");

  private:
    int width_ = 0, height_ = 0;
    PixelFormat format_ = PixelFormat::f32;
    ColorEncoding encoding_ = ColorEncoding::linear();
    std::vector<std::string> names_;
    // Null if the samples are in memory.
    const TexelBlock* block() const;

    Attributes attributes_;
    SampleArray<float> f32_;
    SampleArray<std::uint16_t> u16_;
    SampleArray<std::uint8_t> u8_;
};

} // namespace montelux
