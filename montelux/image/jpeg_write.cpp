// jpeglib.h needs <cstdio> before it.
// clang-format off
#include <csetjmp>
#include <cstdio>
#include <exception>
#include <jpeglib.h>
// clang-format on

#include "montelux/image/encoders.h"
#include "montelux/mc/math/error.h"

namespace montelux {

namespace {

// libjpeg leaves through longjmp, which must not jump over destructors: everything that owns memory lives
// here.
struct JpegWriter {
    jpeg_compress_struct jpeg{};
    jpeg_error_mgr errors{};
    jpeg_destination_mgr destination{};
    std::jmp_buf escape;
    char message[JMSG_LENGTH_MAX] = "";
    JOCTET buffer[1 << 14];
    AtomicFile& file;
    std::exception_ptr exception;

    explicit JpegWriter(AtomicFile& f) : file(f) {}
    ~JpegWriter() { jpeg_destroy_compress(&jpeg); }
    JpegWriter(const JpegWriter&) = delete;
    JpegWriter& operator=(const JpegWriter&) = delete;
};

[[noreturn]] void leave_writer(j_common_ptr jpeg) {
    auto* writer = static_cast<JpegWriter*>(jpeg->client_data);
    jpeg->err->format_message(jpeg, writer->message);
    longjmp(writer->escape, 1);
}

void on_writer_message(j_common_ptr, int) {}
void on_writer_output(j_common_ptr) {}

void start_buffer(j_compress_ptr jpeg) {
    auto* writer = static_cast<JpegWriter*>(jpeg->client_data);
    writer->destination.next_output_byte = writer->buffer;
    writer->destination.free_in_buffer = sizeof writer->buffer;
}

bool try_flush(JpegWriter& writer, std::size_t size) {
    try {
        writer.file.write(writer.buffer, size);
        return true;
    } catch (...) {
        writer.exception = std::current_exception();
        return false;
    }
}

boolean on_full_buffer(j_compress_ptr jpeg) {
    auto* writer = static_cast<JpegWriter*>(jpeg->client_data);
    // The library calls this with a full buffer, whatever free_in_buffer says.
    if (!try_flush(*writer, sizeof writer->buffer)) longjmp(writer->escape, 1);
    start_buffer(jpeg);
    return TRUE;
}

void on_end(j_compress_ptr jpeg) {
    auto* writer = static_cast<JpegWriter*>(jpeg->client_data);
    if (!try_flush(*writer, sizeof writer->buffer - writer->destination.free_in_buffer))
        longjmp(writer->escape, 1);
}

bool write_lines(JpegWriter& w, JDIMENSION width, JDIMENSION height, int channels, int quality,
                 JSAMPROW pixels) {
    w.jpeg.err = jpeg_std_error(&w.errors);
    w.errors.error_exit = leave_writer;
    w.errors.emit_message = on_writer_message;
    w.errors.output_message = on_writer_output;
    w.jpeg.client_data = &w;
    if (setjmp(w.escape)) return false;
    jpeg_create_compress(&w.jpeg);
    w.jpeg.client_data = &w;
    w.destination.init_destination = start_buffer;
    w.destination.empty_output_buffer = on_full_buffer;
    w.destination.term_destination = on_end;
    w.jpeg.dest = &w.destination;
    w.jpeg.image_width = width;
    w.jpeg.image_height = height;
    w.jpeg.input_components = channels;
    w.jpeg.in_color_space = channels == 1 ? JCS_GRAYSCALE : JCS_RGB;
    jpeg_set_defaults(&w.jpeg);
    jpeg_set_quality(&w.jpeg, quality, TRUE);
    w.jpeg.optimize_coding = TRUE;
    // Colours at full resolution: renders have sharp coloured edges.
    w.jpeg.comp_info[0].h_samp_factor = w.jpeg.comp_info[0].v_samp_factor = 1;
    jpeg_start_compress(&w.jpeg, TRUE);
    const std::size_t row = std::size_t{width} * static_cast<std::size_t>(channels);
    while (w.jpeg.next_scanline < height) {
        JSAMPROW line = pixels + row * w.jpeg.next_scanline;
        jpeg_write_scanlines(&w.jpeg, &line, 1);
    }
    jpeg_finish_compress(&w.jpeg);
    return true;
}

} // namespace

void encode_jpeg(AtomicFile& file, const std::string& name, const Image& image, const WriteOptions& options) {
    if (options.jpeg_quality < 1 || options.jpeg_quality > 100)
        throw Error(name, "cannot be written: the quality of a JPEG file is from 1 to 100, not " +
                              std::to_string(options.jpeg_quality));
    std::vector<std::string> colors;
    for (const int c : require_color_channels(name, image)) colors.push_back(image.channel_names()[c]);
    Image picture = coded_picture(name, image.select(colors), options.tone, 8);
    JpegWriter writer(file);
    if (!write_lines(writer, static_cast<JDIMENSION>(picture.width()),
                     static_cast<JDIMENSION>(picture.height()), picture.channels(), options.jpeg_quality,
                     picture.u8().data())) {
        if (writer.exception) std::rethrow_exception(writer.exception);
        throw Error(name, std::string("cannot be written: ") + writer.message);
    }
}

} // namespace montelux
