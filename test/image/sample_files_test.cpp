// Writes the sample files with the libraries' own encoders, and reads the EXR ones back.
#include "test/image/image_testing.h"
#include "test/image/sample_files.h"
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfDeepFrameBuffer.h>
#include <OpenEXR/ImfDeepScanLineOutputFile.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfTiledOutputFile.h>
#include <OpenEXR/ImfTiledOutputPart.h>
#include <cstdio>
#include <cstring>
#include <jpeglib.h>
#include <vector>

#include "montelux/image/image_read.h"

namespace montelux {

std::string make_jpeg(int width, int height, int components, bool progressive) {
    jpeg_compress_struct jpeg{};
    jpeg_error_mgr errors{};
    jpeg.err = jpeg_std_error(&errors);
    jpeg_create_compress(&jpeg);
    unsigned char* memory = nullptr;
    unsigned long size = 0;
    jpeg_mem_dest(&jpeg, &memory, &size);
    jpeg.image_width = static_cast<JDIMENSION>(width);
    jpeg.image_height = static_cast<JDIMENSION>(height);
    jpeg.input_components = components;
    jpeg.in_color_space = components == 1 ? JCS_GRAYSCALE : components == 3 ? JCS_RGB : JCS_CMYK;
    jpeg_set_defaults(&jpeg);
    jpeg_set_quality(&jpeg, 100, TRUE);
    if (progressive) jpeg_simple_progression(&jpeg);
    jpeg_start_compress(&jpeg, TRUE);
    std::vector<unsigned char> row(width * components);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < components; ++c)
                row[x * components + c] = static_cast<unsigned char>(x * 3 + y + 40 * c);
        JSAMPROW rows = row.data();
        jpeg_write_scanlines(&jpeg, &rows, 1);
    }
    jpeg_finish_compress(&jpeg);
    std::string bytes(reinterpret_cast<char*>(memory), size);
    jpeg_destroy_compress(&jpeg);
    std::free(memory);
    return bytes;
}

namespace {

class StringStream final : public Imf::OStream {
  public:
    StringStream() : OStream("sample") {}
    void write(const char c[], int n) override {
        if (bytes.size() < at_ + n) bytes.resize(at_ + n);
        std::memcpy(bytes.data() + at_, c, static_cast<std::size_t>(n));
        at_ += static_cast<std::size_t>(n);
    }
    std::uint64_t tellp() override { return at_; }
    void seekp(std::uint64_t position) override { at_ = position; }
    std::string bytes;

  private:
    std::size_t at_ = 0;
};

constexpr int min_x = -3, min_y = 5, width = 70, height = 50;
const Imath::Box2i data_window({min_x, min_y}, {min_x + width - 1, min_y + height - 1});

struct Samples {
    std::vector<half> b, g, r;
    std::vector<float> z;
    std::vector<unsigned> id;

    // Levels of a tiled picture have the same pixels in their top left corners.
    explicit Samples(bool other_part)
        : b(width * height), g(b.size()), r(b.size()), z(b.size()), id(b.size()) {
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                std::size_t i = static_cast<std::size_t>(y) * width + x;
                float add = other_part ? 1.0f : 0.0f;
                b[i] = half(exr_sample("B", x, y) + add);
                g[i] = half(exr_sample("G", x, y) + add);
                r[i] = half(exr_sample("R", x, y) + add);
                z[i] = exr_sample("Z", x, y) + add;
                id[i] = static_cast<unsigned>(exr_sample("id", x, y) + add);
            }
    }
    Imf::FrameBuffer buffer() {
        Imf::FrameBuffer f;
        auto add = [&](const char* name, Imf::PixelType type, void* data, std::size_t size) {
            f.insert(name, Imf::Slice::Make(type, data, data_window, size, size * width));
        };
        add("B", Imf::HALF, b.data(), 2);
        add("G", Imf::HALF, g.data(), 2);
        add("R", Imf::HALF, r.data(), 2);
        add("Z", Imf::FLOAT, z.data(), 4);
        add("id", Imf::UINT, id.data(), 4);
        return f;
    }
};

Imf::Header sample_header(const ExrKind& kind) {
    Imf::Header header({{-10, 0}, {99, 99}}, data_window);
    header.compression() = static_cast<Imf::Compression>(kind.compression);
    header.lineOrder() = kind.decreasing_lines ? Imf::DECREASING_Y : Imf::INCREASING_Y;
    for (const char* name : {"B", "G", "R"}) header.channels().insert(name, Imf::Channel(Imf::HALF));
    header.channels().insert("Z", Imf::Channel(Imf::FLOAT));
    header.channels().insert("id", Imf::Channel(Imf::UINT));
    if (kind.tiled)
        header.setTileDescription({16, 12, static_cast<Imf::LevelMode>(kind.level_mode),
                                   kind.round_up ? Imf::ROUND_UP : Imf::ROUND_DOWN});
    return header;
}

template <typename Output>
void write_tiles(Output& out, int level_mode) {
    for (int ly = 0; ly < out.numYLevels(); ++ly)
        for (int lx = 0; lx < out.numXLevels(); ++lx)
            if (level_mode == 2 || lx == ly)
                out.writeTiles(0, out.numXTiles(lx) - 1, 0, out.numYTiles(ly) - 1, lx, ly);
}

} // namespace

float exr_sample(const std::string& channel, int x, int y) {
    // Multiples of 1/4 below 256, which all types and PXR24 hold exactly.
    int base = channel == "B" ? 3 : channel == "G" ? 5 : channel == "R" ? 7 : channel == "Z" ? 11 : 13;
    int n = (x * base + y * y) % 1000;
    return channel == "id" ? static_cast<float>(n) : static_cast<float>(n) / 4;
}

std::string make_exr(const ExrKind& kind) {
    StringStream stream;
    Samples first(false), other(true);
    Imf::FrameBuffer buffer = first.buffer(), other_buffer = other.buffer();
    Imf::Header header = sample_header(kind);
    if (kind.parts > 1) {
        std::vector<Imf::Header> headers(kind.parts, header);
        for (int i = 0; i < kind.parts; ++i) {
            headers[i].setName("part" + std::to_string(i));
            headers[i].setType(kind.tiled ? Imf::TILEDIMAGE : Imf::SCANLINEIMAGE);
        }
        Imf::MultiPartOutputFile file(stream, headers.data(), kind.parts, false, 0);
        for (int i = 0; i < kind.parts; ++i) {
            const Imf::FrameBuffer& pixels = i == 0 ? buffer : other_buffer;
            if (kind.tiled) {
                Imf::TiledOutputPart part(file, i);
                part.setFrameBuffer(pixels);
                write_tiles(part, kind.level_mode);
            } else {
                Imf::OutputPart part(file, i);
                part.setFrameBuffer(pixels);
                part.writePixels(height);
            }
        }
    } else if (kind.tiled) {
        Imf::TiledOutputFile file(stream, header, 0);
        file.setFrameBuffer(buffer);
        write_tiles(file, kind.level_mode);
    } else {
        Imf::OutputFile file(stream, header, 0);
        file.setFrameBuffer(buffer);
        file.writePixels(height);
    }
    return stream.bytes;
}

std::string make_subsampled_exr() {
    StringStream stream;
    Imf::Header header(8, 8);
    header.channels().insert("Y", Imf::Channel(Imf::HALF));
    header.channels().insert("RY", Imf::Channel(Imf::HALF, 2, 2));
    std::vector<half> y(64), ry(16);
    Imf::FrameBuffer buffer;
    buffer.insert("Y", Imf::Slice(Imf::HALF, reinterpret_cast<char*>(y.data()), 2, 16));
    buffer.insert("RY", Imf::Slice(Imf::HALF, reinterpret_cast<char*>(ry.data()), 2, 8, 2, 2));
    {
        Imf::OutputFile file(stream, header, 0);
        file.setFrameBuffer(buffer);
        file.writePixels(8);
    }
    return stream.bytes;
}

std::string make_deep_exr() {
    StringStream stream;
    Imf::Header header(4, 4);
    header.channels().insert("Z", Imf::Channel(Imf::FLOAT));
    header.setType(Imf::DEEPSCANLINE);
    header.compression() = Imf::ZIPS_COMPRESSION;
    std::vector<unsigned> counts(16, 0);
    std::vector<float*> samples(16, nullptr);
    Imf::DeepFrameBuffer buffer;
    buffer.insertSampleCountSlice(Imf::Slice(Imf::UINT, reinterpret_cast<char*>(counts.data()), 4, 16));
    buffer.insert("Z", Imf::DeepSlice(Imf::FLOAT, reinterpret_cast<char*>(samples.data()), 8, 32, 4));
    {
        Imf::DeepScanLineOutputFile file(stream, header, 0);
        file.setFrameBuffer(buffer);
        file.writePixels(4);
    }
    return stream.bytes;
}

namespace {

Image read_sample(const std::string& bytes) {
    return read_image({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}, "sample.exr");
}

void expect_samples(const Image& image, float tolerance, const std::string& kind) {
    ASSERT_EQ(image.channel_names(), (std::vector<std::string>{"R", "G", "B", "Z", "id"})) << kind;
    ASSERT_EQ(image.width(), width);
    ASSERT_EQ(image.height(), height);
    EXPECT_EQ(std::get<int>(image.attributes().at("dataWindow.x")), min_x);
    EXPECT_EQ(std::get<int>(image.attributes().at("dataWindow.y")), min_y);
    double worst = 0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < image.channels(); ++c) {
                double truth = static_cast<double>(exr_sample(image.channel_names()[c], x, y));
                worst = std::max(worst, std::abs(image.value(x, y, c) - truth));
            }
    EXPECT_LE(worst, tolerance) << kind;
}

TEST(ExrKinds, EveryCompressionAndLayoutIsRead) {
    for (int compression = 0; compression <= 9; ++compression)
        for (bool tiled : {false, true})
            for (int parts : {1, 3}) {
                ExrKind kind{.compression = compression, .tiled = tiled, .parts = parts};
                // B44 and DWA lose something; the sawtooth is hard on them.
                float tolerance = compression >= 8 ? 6.0f : compression >= 6 ? 50.0f : 0.0f;
                expect_samples(read_sample(make_exr(kind)), tolerance,
                               std::to_string(compression) + (tiled ? " tiled " : " lines ") +
                                   std::to_string(parts));
            }
}

TEST(ExrKinds, LevelsAndLineOrders) {
    for (int level_mode : {1, 2})
        for (bool round_up : {false, true})
            for (int parts : {1, 2})
                expect_samples(
                    read_sample(make_exr(
                        {.tiled = true, .level_mode = level_mode, .round_up = round_up, .parts = parts})),
                    0, "levels " + std::to_string(level_mode));
    expect_samples(read_sample(make_exr({.decreasing_lines = true})), 0, "decreasing");
    expect_samples(read_sample(make_exr({.compression = 4, .decreasing_lines = true})), 0, "decreasing");
}

TEST(ExrKinds, UnsupportedKindsGiveAMessage) {
    expect_error([] { read_sample(make_subsampled_exr()); }, {"sample.exr", "'RY'", "subsampled", "2 x 2"});
    expect_error([] { read_sample(make_deep_exr()); }, {"sample.exr", "deep"});
    std::string good = make_exr({});
    for (double share : {0.1, 0.3, 0.5, 0.9, 0.999}) {
        std::string cut = good.substr(0, static_cast<std::size_t>(share * static_cast<double>(good.size())));
        expect_error([&] { read_sample(cut); }, {"sample.exr", "damaged"});
    }
    // A picture whose writer was stopped: its table of chunks is still empty at the end.
    std::string unfinished = good;
    auto table = good.find(std::string("screenWindowWidth"));
    table = good.find(std::string("float\0", 6), table) + 6 + 4 + 4 + 1;
    int chunks = (height + 15) / 16;
    std::memset(unfinished.data() + table + 8 * (chunks - 1), 0, 8);
    expect_error([&] { read_sample(unfinished); }, {"incomplete", "chunk 3"});
}

// A header may promise at most what the limits allow, whatever it costs to say.
TEST(ExrKinds, SizesOutOfProportionAreRefused) {
    std::string good = make_exr({.compression = 0});
    auto window = good.find(std::string("dataWindow\0box2i\0", 17)) + 17 + 4;
    auto with_corner = [&](int x, int y) {
        std::string bytes = good;
        std::memcpy(bytes.data() + window + 8, &x, 4);
        std::memcpy(bytes.data() + window + 12, &y, 4);
        return bytes;
    };
    expect_error([&] { read_sample(with_corner(60000, 60000)); }, {"sample.exr"});
    expect_error([&] { read_sample(with_corner(2000000000, 54)); }, {"dataWindow"});
    expect_error([&] { read_sample(with_corner(66, 40000)); }, {"chunks"});
    expect_error([&] { read_sample(with_corner(60000, 54)); }, {"too short"});
    expect_error([&] { read_sample(with_corner(-4, 54)); }, {"dataWindow"});
    std::string bytes = make_exr({});
    expect_error(
        [&] {
            read_image({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}, "sample.exr",
                       {.max_pixel_bytes = 1000});
        },
        {"limit"});
}

} // namespace
} // namespace montelux
