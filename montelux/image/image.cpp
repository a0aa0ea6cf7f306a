#include "montelux/image/image.h"

#include <algorithm>
#include <set>

#include "montelux/image/half.h"
#include "montelux/image/texel_file.h"
#include "montelux/mc/math/error.h"

namespace montelux {

std::size_t bytes_per_sample(PixelFormat format) {
    switch (format) {
    case PixelFormat::u8:
        return 1;
    case PixelFormat::u16:
    case PixelFormat::f16:
        return 2;
    case PixelFormat::f32:
        break;
    }
    return 4;
}

std::string_view name_of(PixelFormat format) {
    switch (format) {
    case PixelFormat::u8:
        return "8-bit integer";
    case PixelFormat::u16:
        return "16-bit integer";
    case PixelFormat::f16:
        return "16-bit float";
    case PixelFormat::f32:
        break;
    }
    return "32-bit float";
}

Image::Image(int width, int height, std::vector<std::string> channels, PixelFormat format,
             ColorEncoding encoding)
    : width_(width), height_(height), format_(format), encoding_(encoding), names_(std::move(channels)) {
    auto size = std::to_string(width) + " x " + std::to_string(height);
    if (width < 1 || height < 1) throw Error("image", "the size must be positive, but is " + size);
    if (width > max_dimension || height > max_dimension)
        throw Error("image",
                    "no side may be longer than " + std::to_string(max_dimension) + ", but it is " + size);
    if (names_.empty() || names_.size() > max_channels)
        throw Error("image", "the number of channels must be 1 to " + std::to_string(max_channels) +
                                 ", but is " + std::to_string(names_.size()));
    std::set<std::string_view> seen;
    for (const std::string& name : names_)
        if (name.empty() || !seen.insert(name).second)
            throw Error("image", name.empty() ? std::string("a channel has no name")
                                              : "channel '" + name + "' is named twice");
    switch (format) {
    case PixelFormat::u8:
        u8_.resize(sample_count());
        break;
    case PixelFormat::u16:
    case PixelFormat::f16:
        u16_.resize(sample_count());
        break;
    case PixelFormat::f32:
        f32_.resize(sample_count());
        break;
    }
}

bool Image::is_alpha(std::string_view channel) { return channel == "A" || channel.ends_with(".A"); }

std::optional<int> Image::find_channel(std::string_view name) const {
    auto it = std::find(names_.begin(), names_.end(), name);
    if (it == names_.end()) return std::nullopt;
    return static_cast<int>(it - names_.begin());
}

float Image::value_at(std::size_t i) const {
    switch (format_) {
    case PixelFormat::u8:
        return static_cast<float>(u8_[i]) / 255;
    case PixelFormat::u16:
        return static_cast<float>(u16_[i]) / 65535;
    case PixelFormat::f16:
        return half_to_float(u16_[i]);
    case PixelFormat::f32:
        break;
    }
    return f32_[i];
}

float Image::linear(int x, int y, int channel) const {
    const float v = value(x, y, channel);
    return encoding_.kind() == ColorEncoding::Kind::linear || is_alpha(names_[channel])
               ? v
               : encoding_.to_linear(v);
}

std::vector<int> Image::color_channels(std::string_view layer) const {
    auto find = [&](const char* last) { return find_channel(std::string(layer) + last); };
    auto r = find("R"), g = find("G"), b = find("B");
    if (r && g && b) return {*r, *g, *b};
    if (auto y = find("Y"); y && !(find("X") && find("Z"))) return {*y};
    return {};
}

void Image::move_to(TexelFile& file) {
    f32_.move_to(file);
    u16_.move_to(file);
    u8_.move_to(file);
}

const TexelBlock* Image::block() const {
    for (const auto* block : {&f32_.block(), &u16_.block(), &u8_.block()})
        if (*block) return block->get();
    return nullptr;
}

std::shared_ptr<TexelFile> Image::file() const { return block() ? block()->file() : nullptr; }

void Image::give_back() const {
    if (const TexelBlock* samples = block()) samples->give_back();
}

Image Image::to_linear_f32() const {
    Image out(width_, height_, names_, PixelFormat::f32);
    out.attributes_ = attributes_;
    std::vector<bool> encoded(names_.size());
    for (std::size_t c = 0; c < names_.size(); ++c)
        encoded[c] = encoding_.kind() != ColorEncoding::Kind::linear && !is_alpha(names_[c]);
    std::vector<float> table;
    if (format_ == PixelFormat::u8) {
        auto t = encoding_.table8();
        table.assign(t.begin(), t.end());
    }
    std::size_t channel_count = names_.size();
    const std::span<float> samples = out.f32();
    for (std::size_t i = 0, c = 0; i < sample_count(); ++i, c = c + 1 == channel_count ? 0 : c + 1) {
        if (!encoded[c])
            samples[i] = value_at(i);
        else
            samples[i] = table.empty() ? encoding_.to_linear(value_at(i)) : table[u8_[i]];
    }
    return out;
}

namespace {

// Copies channel `from` of one interleaved array to channel `to` of another.
template <typename T>
void copy_channel(const SampleArray<T>& source, std::size_t from, std::size_t source_channels,
                  SampleArray<T>& target_samples, std::size_t to, std::size_t target_channels) {
    if (source.empty()) return;
    const std::span<T> target = target_samples.writable();
    std::size_t pixels = source.size() / source_channels;
    for (std::size_t i = 0; i < pixels; ++i)
        target[i * target_channels + to] = source[i * source_channels + from];
}

} // namespace

Image Image::select(std::span<const std::string> channels) const {
    Image out(width_, height_, {channels.begin(), channels.end()}, format_, encoding_);
    out.attributes_ = attributes_;
    std::size_t n = names_.size(), m = channels.size();
    for (std::size_t c = 0; c < m; ++c) {
        auto from = find_channel(channels[c]);
        if (!from) {
            std::string known;
            for (const std::string& name : names_) known += (known.empty() ? "" : ", ") + name;
            throw Error("image", "there is no channel '" + channels[c] + "'; there are " + known);
        }
        copy_channel(f32_, *from, n, out.f32_, c, m);
        copy_channel(u16_, *from, n, out.u16_, c, m);
        copy_channel(u8_, *from, n, out.u8_, c, m);
    }
    return out;
}

void Image::append(const Image& other, std::string_view prefix) {
    if (other.width_ != width_ || other.height_ != height_ || other.format_ != format_)
        throw Error("image", "layers of one image must have the same size and format");
    std::vector<std::string> names = names_;
    for (const std::string& name : other.names_) names.push_back(std::string(prefix) + name);
    Image out(width_, height_, std::move(names), format_, encoding_);
    out.attributes_ = std::move(attributes_);
    std::size_t n = names_.size(), m = other.names_.size();
    for (std::size_t c = 0; c < n + m; ++c) {
        const Image& source = c < n ? *this : other;
        std::size_t from = c < n ? c : c - n, source_channels = c < n ? n : m;
        copy_channel(source.f32_, from, source_channels, out.f32_, c, n + m);
        copy_channel(source.u16_, from, source_channels, out.u16_, c, n + m);
        copy_channel(source.u8_, from, source_channels, out.u8_, c, n + m);
    }
    *this = std::move(out);
}

} // namespace montelux
