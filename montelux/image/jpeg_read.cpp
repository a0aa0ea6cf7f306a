// jpeglib.h needs <cstdio> before it, and jerror.h needs jpeglib.h.
// clang-format off
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <jpeglib.h>
#include <jerror.h>
// clang-format on

#include "montelux/image/decoders.h"
#include "montelux/mc/math/error.h"

namespace montelux {

namespace {

// A progressive file can require a pass over the whole picture per scan, and a scan can be a few bytes long:
// this many pixel visits take some seconds.
constexpr std::uint64_t max_progressive_work = 1'500'000'000;

// libjpeg leaves through longjmp, which must not jump over destructors: everything that owns memory lives
// here.
struct JpegReader {
    jpeg_decompress_struct jpeg{};
    jpeg_error_mgr errors{};
    jpeg_progress_mgr progress{};
    std::jmp_buf escape;
    char message[JMSG_LENGTH_MAX + 1] = "";

    JpegReader() = default;
    ~JpegReader() { jpeg_destroy_decompress(&jpeg); }
    JpegReader(const JpegReader&) = delete;
    JpegReader& operator=(const JpegReader&) = delete;
};

[[noreturn]] void leave(j_common_ptr jpeg) {
    auto* reader = static_cast<JpegReader*>(jpeg->client_data);
    if (!reader->message[0]) jpeg->err->format_message(jpeg, reader->message);
    longjmp(reader->escape, 1);
}

void on_message(j_common_ptr jpeg, int level) {
    if (level >= 0) return;
    // After these warnings the library would continue with invented pixels.
    switch (jpeg->err->msg_code) {
    case JWRN_JPEG_EOF:
    case JWRN_HIT_MARKER:
    case JWRN_HUFF_BAD_CODE:
    case JWRN_ARITH_BAD_CODE:
    case JWRN_MUST_RESYNC:
        leave(jpeg);
    default:
        break;
    }
}

void on_output(j_common_ptr) {}

void on_progress(j_common_ptr common) {
    auto* jpeg = reinterpret_cast<j_decompress_ptr>(common);
    std::uint64_t work = std::uint64_t{jpeg->image_width} * jpeg->image_height *
                         static_cast<std::uint64_t>(jpeg->input_scan_number);
    if (jpeg->input_scan_number > 16 && work > max_progressive_work) {
        auto* reader = static_cast<JpegReader*>(common->client_data);
        std::strcpy(reader->message, "it has too many scans");
        leave(common);
    }
}

bool read_header(JpegReader& r, std::span<const std::uint8_t> bytes) {
    r.jpeg.err = jpeg_std_error(&r.errors);
    r.errors.error_exit = leave;
    r.errors.emit_message = on_message;
    r.errors.output_message = on_output;
    r.jpeg.client_data = &r;
    if (setjmp(r.escape)) return false;
    jpeg_create_decompress(&r.jpeg);
    r.jpeg.client_data = &r;
    r.progress.progress_monitor = on_progress;
    r.jpeg.progress = &r.progress;
    jpeg_mem_src(&r.jpeg, bytes.data(), static_cast<unsigned long>(bytes.size()));
    jpeg_read_header(&r.jpeg, TRUE);
    return true;
}

bool read_pixels(JpegReader& r, std::uint8_t* out) {
    if (setjmp(r.escape)) return false;
    jpeg_start_decompress(&r.jpeg);
    std::size_t row = std::size_t{r.jpeg.output_width} * static_cast<std::size_t>(r.jpeg.output_components);
    while (r.jpeg.output_scanline < r.jpeg.output_height) {
        JSAMPROW line = out + row * r.jpeg.output_scanline;
        jpeg_read_scanlines(&r.jpeg, &line, 1);
    }
    jpeg_finish_decompress(&r.jpeg);
    return true;
}

} // namespace

Image decode_jpeg(const EncodedImage& file) {
    JpegReader reader;
    auto damaged = [&] {
        return Error(file.name, std::string("the JPEG file is damaged: ") + reader.message);
    };
    if (!read_header(reader, file.bytes)) throw damaged();
    jpeg_decompress_struct& jpeg = reader.jpeg;
    bool grey = jpeg.jpeg_color_space == JCS_GRAYSCALE;
    bool cmyk = jpeg.jpeg_color_space == JCS_CMYK || jpeg.jpeg_color_space == JCS_YCCK;
    jpeg.out_color_space = grey ? JCS_GRAYSCALE : cmyk ? JCS_CMYK : JCS_RGB;
    int channels = grey ? 1 : cmyk ? 4 : 3;
    check_image_size(file, jpeg.image_width, jpeg.image_height, static_cast<std::uint64_t>(channels), 1);
    if (cmyk)
        throw Error(file.name, "is a CMYK picture, which needs a colour profile; convert it to RGB first");
    // The coefficients of a progressive picture are all held at once, 2 bytes each.
    if (jpeg.progressive_mode)
        check_image_size(file, jpeg.image_width, jpeg.image_height, static_cast<std::uint64_t>(channels), 3);
    Image image(static_cast<int>(jpeg.image_width), static_cast<int>(jpeg.image_height),
                grey ? std::vector<std::string>{"Y"} : std::vector<std::string>{"R", "G", "B"},
                PixelFormat::u8, ColorEncoding::srgb());
    if (!read_pixels(reader, image.u8().data())) throw damaged();
    return image;
}

} // namespace montelux
