#include "montelux/image/image_read.h"

#include <algorithm>
#include <cctype>
#include <new>
#include <string_view>

#include "montelux/image/decoders.h"
#include "montelux/mc/io/file.h"
#include "montelux/mc/math/error.h"

namespace montelux {

void check_image_size(const EncodedImage& file, std::uint64_t width, std::uint64_t height,
                      std::uint64_t channels, std::uint64_t sample_bytes) {
    auto size = std::to_string(width) + " x " + std::to_string(height);
    if (width < 1 || height < 1) throw Error(file.name, "the picture has no pixels (" + size + ")");
    if (width > Image::max_dimension || height > Image::max_dimension)
        throw Error(file.name, "the picture is " + size + "; the longest side allowed is " +
                                   std::to_string(Image::max_dimension));
    if (channels < 1 || channels > Image::max_channels)
        throw Error(file.name, "the picture has " + std::to_string(channels) + " channels; 1 to " +
                                   std::to_string(Image::max_channels) + " are allowed");
    std::uint64_t bytes = width * height * channels * sample_bytes;
    if (bytes > file.options.max_pixel_bytes)
        throw Error(file.name, "the picture (" + size + ", " + std::to_string(channels) +
                                   " channels) would need " + std::to_string(bytes >> 20) +
                                   " MiB; the limit is " +
                                   std::to_string(file.options.max_pixel_bytes >> 20) + " MiB");
    // No photograph or render compresses this far, only a small file made to keep a reader busy.
    constexpr std::uint64_t unsuspicious_bytes = std::uint64_t{256} << 20, largest_ratio = 256;
    if (bytes > unsuspicious_bytes && bytes / largest_ratio > file.bytes.size())
        throw Error(file.name, "the picture (" + size + ") would need " + std::to_string(bytes >> 20) +
                                   " MiB, which is out of proportion to a file of " +
                                   std::to_string(file.bytes.size()) + " bytes");
}

namespace {

std::string lower_extension(const std::string& name) {
    std::string extension = std::filesystem::path(name).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return extension;
}

using Decoder = Image (*)(const EncodedImage&);

// By the first bytes; null for TGA, which has no mark, and for what is no picture.
Decoder decoder_of(std::span<const std::uint8_t> bytes) {
    std::string_view head(reinterpret_cast<const char*>(bytes.data()),
                          std::min<std::size_t>(bytes.size(), 16));
    auto second = [&](std::string_view set) {
        return head.size() > 2 && set.find(head[1]) != std::string_view::npos &&
               (std::isspace(static_cast<unsigned char>(head[2])) || head[2] == '#');
    };
    if (head.starts_with("\x76\x2f\x31\x01")) return decode_exr;
    if (head.starts_with("\x89PNG\r\n\x1a\n")) return decode_png;
    if (head.starts_with("\xff\xd8\xff")) return decode_jpeg;
    if (head.starts_with("#?")) return decode_hdr;
    if (head.starts_with('P') && second("Ff")) return decode_pfm;
    if (head.starts_with('P') && second("123456")) return decode_pnm;
    if (head.size() >= 12 && head.starts_with("RIFF") && head.substr(8).starts_with("WEBP"))
        return decode_webp;
    if (head.starts_with("BM")) return decode_stb;
    return nullptr;
}

Image decode(const EncodedImage& file) {
    if (file.bytes.empty()) throw Error(file.name, "is empty");
    if (const Decoder decoder = decoder_of(file.bytes)) return decoder(file);
    if (lower_extension(file.name) == ".tga") return decode_stb(file);
    throw Error(file.name,
                "is not a picture of a known format (EXR, PNG, JPEG, Radiance HDR, PFM, PNM, WebP, BMP; "
                "TGA with the extension .tga)");
}

} // namespace

Image read_image(std::span<const std::uint8_t> bytes, const std::string& name, const ReadOptions& options) {
    try {
        return decode({bytes, name, options});
    } catch (const std::bad_alloc&) {
        throw Error(name, "there is not enough memory to read this picture");
    } catch (const std::length_error&) {
        throw Error(name, "there is not enough memory to read this picture");
    }
}

Image read_image(const std::filesystem::path& path, const ReadOptions& options) {
    std::vector<std::uint8_t> bytes;
    try {
        bytes = read_file_bytes(path, options.max_file_bytes);
    } catch (const std::bad_alloc&) {
        throw Error(path.string(), "there is not enough memory to read this file");
    }
    return read_image(bytes, path.string(), options);
}

bool is_picture(std::span<const std::uint8_t> bytes) { return decoder_of(bytes) != nullptr; }

} // namespace montelux
