#include <csetjmp>
#include <cstring>
#include <png.h>

#include "montelux/image/decoders.h"
#include "montelux/mc/math/error.h"

namespace montelux {

namespace {

// libpng leaves through longjmp, which must not jump over destructors: everything that owns memory lives
// here.
struct PngReader {
    png_structp png = nullptr;
    png_infop info = nullptr;
    std::span<const std::uint8_t> bytes;
    std::size_t at = 0;
    char message[200] = "";
    png_uint_32 width = 0, height = 0;
    int depth = 0, color_type = 0, channels = 0;
    double gamma = 0;
    bool has_gamma = false;

    explicit PngReader(std::span<const std::uint8_t> b) : bytes(b) {}
    ~PngReader() { png_destroy_read_struct(&png, &info, nullptr); }
    PngReader(const PngReader&) = delete;
    PngReader& operator=(const PngReader&) = delete;
};

void on_read_error(png_structp png, png_const_charp message) {
    auto* reader = static_cast<PngReader*>(png_get_error_ptr(png));
    std::strncpy(reader->message, message, sizeof reader->message - 1);
    longjmp(png_jmpbuf(png), 1);
}

void on_read_warning(png_structp, png_const_charp) {}

void on_read(png_structp png, png_bytep out, std::size_t size) {
    auto* reader = static_cast<PngReader*>(png_get_io_ptr(png));
    if (size > reader->bytes.size() - reader->at) png_error(png, "it ends too early");
    std::memcpy(out, reader->bytes.data() + reader->at, size);
    reader->at += size;
}

bool read_header(PngReader& r) {
    if (setjmp(png_jmpbuf(r.png))) return false;
    png_set_read_fn(r.png, &r, on_read);
    png_set_user_limits(r.png, Image::max_dimension, Image::max_dimension);
    png_set_chunk_malloc_max(r.png, 1 << 20);
    png_set_chunk_cache_max(r.png, 64);
    // Texts, profiles and the like are skipped.
    static constexpr png_byte ignored[] = "tEXt\0zTXt\0iTXt\0iCCP\0eXIf\0sPLT\0hIST\0pCAL\0sCAL";
    png_set_keep_unknown_chunks(r.png, PNG_HANDLE_CHUNK_NEVER, ignored, sizeof ignored / 5);
    png_read_info(r.png, r.info);
    r.width = png_get_image_width(r.png, r.info);
    r.height = png_get_image_height(r.png, r.info);
    r.has_gamma = png_get_gAMA(r.png, r.info, &r.gamma) != 0;
    png_set_expand(r.png); // palettes to RGB, fewer bits to 8, a transparent colour to alpha
    png_set_swap(r.png);   // 16-bit samples are big-endian in the file
    png_set_interlace_handling(r.png);
    png_read_update_info(r.png, r.info);
    r.depth = png_get_bit_depth(r.png, r.info);
    r.channels = png_get_channels(r.png, r.info);
    return true;
}

bool read_pixels(PngReader& r, png_bytepp rows) {
    if (setjmp(png_jmpbuf(r.png))) return false;
    png_read_image(r.png, rows);
    png_read_end(r.png, nullptr);
    return true;
}

} // namespace

Image decode_png(const EncodedImage& file) {
    PngReader reader(file.bytes);
    auto damaged = [&] {
        return Error(file.name, std::string("the PNG file is damaged: ") +
                                    (reader.message[0] ? reader.message : "no reason given"));
    };
    reader.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &reader, on_read_error, on_read_warning);
    if (reader.png) reader.info = png_create_info_struct(reader.png);
    if (!reader.info) throw std::bad_alloc();
    if (!read_header(reader)) throw damaged();
    bool wide = reader.depth == 16;
    check_image_size(file, reader.width, reader.height, reader.channels, wide ? 2 : 1);
    // Deflate packs at most 1032 to 1.
    std::uint64_t row_bytes = png_get_rowbytes(reader.png, reader.info);
    if (row_bytes * reader.height / 8 / 1032 > file.bytes.size())
        throw Error(file.name, "the PNG file is damaged: it is too short for " +
                                   std::to_string(reader.width) + " x " + std::to_string(reader.height) +
                                   " pixels");
    static const std::vector<std::string> names[] = {
        {"Y"}, {"Y", "A"}, {"R", "G", "B"}, {"R", "G", "B", "A"}};
    Image image(static_cast<int>(reader.width), static_cast<int>(reader.height), names[reader.channels - 1],
                wide ? PixelFormat::u16 : PixelFormat::u8, ColorEncoding::srgb());
    if (reader.has_gamma) image.attributes()["png.gamma"] = static_cast<float>(reader.gamma);
    std::vector<png_bytep> rows(reader.height);
    png_bytep first = wide ? reinterpret_cast<png_bytep>(image.u16().data()) : image.u8().data();
    for (std::size_t y = 0; y < rows.size(); ++y) rows[y] = first + y * row_bytes;
    if (!read_pixels(reader, rows.data())) throw damaged();
    return image;
}

} // namespace montelux
