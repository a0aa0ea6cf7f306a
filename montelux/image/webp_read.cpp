#include <string>

#ifdef MONTELUX_WEBP
#include <webp/decode.h>
#endif

#include "montelux/image/decoders.h"
#include "montelux/mc/math/error.h"

namespace montelux {

#ifdef MONTELUX_WEBP

bool reads_webp() { return true; }

Image decode_webp(const EncodedImage& file) {
    WebPBitstreamFeatures features;
    if (WebPGetFeatures(file.bytes.data(), file.bytes.size(), &features) != VP8_STATUS_OK)
        throw Error(file.name, "the WebP file is damaged: its header");
    if (features.has_animation != 0)
        throw Error(file.name, "is an animated WebP picture; one of a single frame is expected");
    const bool alpha = features.has_alpha != 0;
    const int channels = alpha ? 4 : 3;
    check_image_size(file, static_cast<std::uint64_t>(features.width),
                     static_cast<std::uint64_t>(features.height), static_cast<std::uint64_t>(channels), 1);
    Image image(features.width, features.height,
                alpha ? std::vector<std::string>{"R", "G", "B", "A"}
                      : std::vector<std::string>{"R", "G", "B"},
                PixelFormat::u8, ColorEncoding::srgb());
    const auto decode = alpha ? WebPDecodeRGBAInto : WebPDecodeRGBInto;
    const std::span<std::uint8_t> pixels = image.u8();
    if (decode(file.bytes.data(), file.bytes.size(), pixels.data(), pixels.size(),
               channels * features.width) == nullptr)
        throw Error(file.name, "the WebP file is damaged, or ends too early");
    return image;
}

#else

bool reads_webp() { return false; }

Image decode_webp(const EncodedImage& file) {
    throw Error(file.name, "is a WebP picture, which is not read: Montelux was built without libwebp");
}

#endif

} // namespace montelux
