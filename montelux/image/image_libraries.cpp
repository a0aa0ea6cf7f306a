#include "montelux/image/image_libraries.h"

#include <OpenEXRConfig.h>
#include <cstdio> // jpeglib.h needs it
#include <jpeglib.h>
#include <png.h>
#include <string>
#ifdef MONTELUX_WEBP
#include <webp/decode.h>
#endif

namespace montelux {

namespace {

std::string numbers(int major, int minor, int patch) {
    return std::to_string(major) + "." + std::to_string(minor) + "." + std::to_string(patch);
}

LibraryVersion jpeg() {
#ifdef LIBJPEG_TURBO_VERSION_NUMBER
    const int v = LIBJPEG_TURBO_VERSION_NUMBER;
    return {"libjpeg-turbo", numbers(v / 1000000, v / 1000 % 1000, v % 1000)};
#else
    return {"libjpeg", std::to_string(JPEG_LIB_VERSION)};
#endif
}

LibraryVersion webp() {
#ifdef MONTELUX_WEBP
    const int v = WebPGetDecoderVersion();
    return {"libwebp", numbers(v >> 16, v >> 8 & 255, v & 255)};
#else
    return {"libwebp", ""};
#endif
}

} // namespace

std::vector<LibraryVersion> image_libraries() {
    return {{"OpenEXR", OPENEXR_VERSION_STRING}, {"libpng", PNG_LIBPNG_VER_STRING}, jpeg(), webp()};
}

} // namespace montelux
