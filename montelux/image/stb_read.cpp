#include <cstring>
#include <memory>

#define STBI_ONLY_TGA
#define STBI_ONLY_BMP
#define STBI_NO_STDIO
#define STBI_NO_LINEAR
#define STBI_NO_HDR
#define STBI_MAX_DIMENSIONS 65536
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#if defined(__GNUC__)
#pragma GCC diagnostic ignored "-Wunused-function"
#endif
#include <stb_image.h>

#include "montelux/image/decoders.h"
#include "montelux/mc/math/error.h"

namespace montelux {

namespace {

// stb_image reads zeros after the end of a file; this detects it.
struct Source {
    std::span<const std::uint8_t> bytes;
    std::size_t at = 0;
    bool overrun = false;
};

int on_read(void* user, char* out, int size) {
    auto& s = *static_cast<Source*>(user);
    std::size_t n = std::min(static_cast<std::size_t>(size), s.bytes.size() - s.at);
    if (n == 0 && size > 0) s.overrun = true;
    if (n > 0) std::memcpy(out, s.bytes.data() + s.at, n);
    s.at += n;
    return static_cast<int>(n);
}

void on_skip(void* user, int n) {
    auto& s = *static_cast<Source*>(user);
    auto target = static_cast<std::int64_t>(s.at) + n;
    if (target < 0 || target > static_cast<std::int64_t>(s.bytes.size())) {
        s.overrun = true;
        target = static_cast<std::int64_t>(s.bytes.size());
    }
    s.at = static_cast<std::size_t>(target);
}

int at_end(void* user) {
    const auto& s = *static_cast<Source*>(user);
    return s.at == s.bytes.size();
}

constexpr stbi_io_callbacks callbacks{on_read, on_skip, at_end};

} // namespace

Image decode_stb(const EncodedImage& file) {
    auto damaged = [&](const char* what) {
        return Error(file.name, std::string("the picture is damaged: ") + (what ? what : "no reason given"));
    };
    int width = 0, height = 0, channels = 0;
    Source source{file.bytes};
    if (!stbi_info_from_callbacks(&callbacks, &source, &width, &height, &channels))
        throw damaged(stbi_failure_reason());
    if (width < 1 || height < 1 || channels < 1 || channels > 4) throw damaged("it has no pixels");
    check_image_size(file, static_cast<std::uint64_t>(width), static_cast<std::uint64_t>(height),
                     static_cast<std::uint64_t>(channels), 2); // stb_image's pixels and ours
    // Run-length coding turns a pixel's bytes and a count into 128 pixels; a colour may be one byte.
    if (static_cast<std::uint64_t>(width) * height / 128 > file.bytes.size())
        throw damaged("it is too short for its size");

    source = Source{file.bytes};
    int w = 0, h = 0, c = 0;
    std::unique_ptr<stbi_uc, decltype(&stbi_image_free)> pixels(
        stbi_load_from_callbacks(&callbacks, &source, &w, &h, &c, channels), stbi_image_free);
    if (!pixels) throw damaged(stbi_failure_reason());
    if (source.overrun) throw damaged("it ends too early");
    if (w != width || h != height) throw damaged("its size is not certain");
    static const std::vector<std::string> names[] = {
        {"Y"}, {"Y", "A"}, {"R", "G", "B"}, {"R", "G", "B", "A"}};
    Image image(width, height, names[channels - 1], PixelFormat::u8, ColorEncoding::srgb());
    std::memcpy(image.u8().data(), pixels.get(), image.byte_count());
    return image;
}

} // namespace montelux
