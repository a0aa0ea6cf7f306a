// WebP pictures: what is read, and damaged files.
#include <array>
#include <cstdint>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#ifdef MONTELUX_WEBP
#include <webp/encode.h>
#endif

#include "montelux/image/image_read.h"
#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

using Bytes = std::vector<std::uint8_t>;

std::string webp_error(const Bytes& bytes, const ReadOptions& options = {}) {
    try {
        read_image(bytes, "a.webp", options);
    } catch (const Error& e) {
        return e.what();
    }
    return {};
}

#ifdef MONTELUX_WEBP

Bytes encoded(const Bytes& pixels, int columns, int rows, bool alpha) {
    std::uint8_t* out = nullptr;
    const std::size_t size = alpha ? WebPEncodeLosslessRGBA(pixels.data(), columns, rows, 4 * columns, &out)
                                   : WebPEncodeLosslessRGB(pixels.data(), columns, rows, 3 * columns, &out);
    Bytes bytes(out, out + size);
    WebPFree(out);
    return bytes;
}
Bytes noise(std::size_t count) {
    Bytes pixels(count);
    std::uint32_t state = 1;
    for (std::uint8_t& v : pixels) {
        state = state * 1664525u + 1013904223u;
        v = static_cast<std::uint8_t>(state >> 24);
    }
    return pixels;
}

TEST(Webp, LosslessPicturesAreExact) {
    for (const bool alpha : {false, true}) {
        Bytes pixels = noise(7 * 5 * (alpha ? 4 : 3));
        if (alpha) // colours below no opacity are not kept
            for (std::size_t i = 3; i < pixels.size(); i += 4) pixels[i] |= 1;
        const Image image = read_image(encoded(pixels, 7, 5, alpha), "a.webp");
        EXPECT_EQ(image.width(), 7);
        EXPECT_EQ(image.height(), 5);
        EXPECT_EQ(image.channels(), alpha ? 4 : 3);
        EXPECT_EQ(image.encoding(), ColorEncoding::srgb());
        EXPECT_TRUE(std::equal(pixels.begin(), pixels.end(), image.u8().begin()));
    }
}

TEST(Webp, LossyPicturesAreClose) {
    const Bytes grey(16 * 16 * 3, 128);
    std::uint8_t* out = nullptr;
    const std::size_t size = WebPEncodeRGB(grey.data(), 16, 16, 48, 90, &out);
    const Image image = read_image(Bytes(out, out + size), "a.webp");
    WebPFree(out);
    EXPECT_NEAR(image.value(8, 8, 1), 128.0f / 255, 0.02f);
}

TEST(Webp, DamagedFilesAreRefused) {
    const Bytes good = encoded(noise(12 * 10 * 3), 12, 10, false);
    EXPECT_EQ(webp_error(good), "");
    EXPECT_TRUE(is_picture(good));
    int refused = 0;
    for (std::size_t size = 12; size < good.size(); ++size) {
        const std::string error =
            webp_error(Bytes(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size)));
        EXPECT_TRUE(error.starts_with("a.webp: the WebP file is damaged")) << size << error;
    }
    Bytes bytes = good;
    for (std::size_t i = 12; i < bytes.size(); ++i) {
        bytes[i] ^= 0xff;
        refused += webp_error(bytes).empty() ? 0 : 1;
        bytes[i] ^= 0xff;
    }
    EXPECT_GT(refused, 0);
    EXPECT_NE(webp_error(good, {.max_pixel_bytes = 100}).find("the limit is"), std::string::npos);
}

#else

TEST(Webp, MissingLibraryIsNamed) {
    const std::string head = "RIFF....WEBPVP8 ";
    EXPECT_EQ(webp_error({head.begin(), head.end()}),
              "a.webp: is a WebP picture, which is not read: Montelux was built without libwebp");
}

#endif

} // namespace
} // namespace montelux
