#include <csetjmp>
#include <cstring>
#include <exception>
#include <png.h>

#include "montelux/image/encoders.h"
#include "montelux/mc/math/error.h"

namespace montelux {

namespace {

// libpng leaves through longjmp, which must not jump over destructors: everything that owns memory lives
// here.
struct PngWriter {
    png_structp png = nullptr;
    png_infop info = nullptr;
    AtomicFile& file;
    std::exception_ptr exception;
    char message[200] = "";

    explicit PngWriter(AtomicFile& f) : file(f) {}
    ~PngWriter() { png_destroy_write_struct(&png, &info); }
    PngWriter(const PngWriter&) = delete;
    PngWriter& operator=(const PngWriter&) = delete;
};

void on_write_error(png_structp png, png_const_charp message) {
    auto* writer = static_cast<PngWriter*>(png_get_error_ptr(png));
    std::strncpy(writer->message, message, sizeof writer->message - 1);
    longjmp(png_jmpbuf(png), 1);
}

void on_write_warning(png_structp, png_const_charp) {}

bool try_write(PngWriter& writer, png_bytep data, std::size_t size) {
    try {
        writer.file.write(data, size);
        return true;
    } catch (...) {
        writer.exception = std::current_exception();
        return false;
    }
}

void on_write(png_structp png, png_bytep data, std::size_t size) {
    if (!try_write(*static_cast<PngWriter*>(png_get_io_ptr(png)), data, size))
        png_error(png, "writing failed");
}

void on_flush(png_structp) {}

bool write_all(PngWriter& w, png_uint_32 width, png_uint_32 height, int depth, int color_type, bool linear,
               png_bytepp rows) {
    if (setjmp(png_jmpbuf(w.png))) return false;
    png_set_write_fn(w.png, &w, on_write, on_flush);
    png_set_IHDR(w.png, w.info, width, height, depth, color_type, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_BASE, PNG_FILTER_TYPE_BASE);
    if (linear)
        png_set_gAMA(w.png, w.info, 1.0);
    else
        png_set_sRGB(w.png, w.info, PNG_sRGB_INTENT_RELATIVE);
    png_write_info(w.png, w.info);
    if (depth == 16) png_set_swap(w.png);
    png_write_image(w.png, rows);
    png_write_end(w.png, nullptr);
    return true;
}

} // namespace

void encode_png(AtomicFile& file, const std::string& name, const Image& image, const WriteOptions& options) {
    Image picture = coded_picture(name, image, options.tone, options.png_bits);
    bool wide = picture.format() == PixelFormat::u16;
    png_bytep first = wide ? reinterpret_cast<png_bytep>(picture.u16().data()) : picture.u8().data();
    std::size_t row_bytes = picture.byte_count() / static_cast<std::size_t>(picture.height());
    std::vector<png_bytep> rows(picture.height());
    for (std::size_t y = 0; y < rows.size(); ++y) rows[y] = first + y * row_bytes;
    static constexpr int color_types[] = {PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA, PNG_COLOR_TYPE_RGB,
                                          PNG_COLOR_TYPE_RGB_ALPHA};

    PngWriter writer(file);
    writer.png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &writer, on_write_error, on_write_warning);
    if (writer.png) writer.info = png_create_info_struct(writer.png);
    if (!writer.info) throw std::bad_alloc();
    if (!write_all(writer, static_cast<png_uint_32>(picture.width()),
                   static_cast<png_uint_32>(picture.height()), wide ? 16 : 8,
                   color_types[picture.channels() - 1], picture.encoding() == ColorEncoding::linear(),
                   rows.data())) {
        if (writer.exception) std::rethrow_exception(writer.exception);
        throw Error(name, std::string("cannot be written: ") + writer.message);
    }
}

} // namespace montelux
