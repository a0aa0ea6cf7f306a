#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticitiesAttribute.h>
#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfFloatVectorAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfVecAttribute.h>
#include <algorithm>
#include <cstring>
#include <exception>
#include <optional>
#include <type_traits>
#include <vector>

#include "montelux/image/encoders.h"
#include "montelux/image/half.h"
#include "montelux/image/placement.h"
#include "montelux/mc/math/error.h"

namespace montelux {

namespace {

// The library swallows exceptions while it closes a file; AtomicFile remembers the error, and commit() fails.
class FileStream final : public Imf::OStream {
  public:
    FileStream(AtomicFile& file, const char* name) : OStream(name), file_(file) {}
    void write(const char c[], int n) override { file_.write(c, static_cast<std::size_t>(n)); }
    std::uint64_t tellp() override { return file_.position(); }
    void seekp(std::uint64_t position) override { file_.seek(position); }

  private:
    AtomicFile& file_;
};

// Its last column and row are inside.
Imath::Box2i box_of(const PixelWindow& w) { return {{w.x0, w.y0}, {w.x1 - 1, w.y1 - 1}}; }

Imf::Compression compression_of(ExrCompression c) {
    switch (c) {
    case ExrCompression::uncompressed:
        return Imf::NO_COMPRESSION;
    case ExrCompression::rle:
        return Imf::RLE_COMPRESSION;
    case ExrCompression::zips:
        return Imf::ZIPS_COMPRESSION;
    case ExrCompression::piz:
        return Imf::PIZ_COMPRESSION;
    case ExrCompression::zip:
        break;
    }
    return Imf::ZIP_COMPRESSION;
}

void insert_vector(Imf::Header& header, const std::string& name, const std::vector<float>& v) {
    if (name == "chromaticities" && v.size() == 8)
        header.insert(name, Imf::ChromaticitiesAttribute(
                                Imf::Chromaticities({v[0], v[1]}, {v[2], v[3]}, {v[4], v[5]}, {v[6], v[7]})));
    else if (v.size() == 2)
        header.insert(name, Imf::V2fAttribute({v[0], v[1]}));
    else if (v.size() == 3)
        header.insert(name, Imf::V3fAttribute({v[0], v[1], v[2]}));
    else
        header.insert(name, Imf::FloatVectorAttribute(v));
}

void insert(Imf::Header& header, const std::string& name, const Attribute& attribute) {
    std::visit(
        [&](const auto& v) {
            using T = std::decay_t<decltype(v)>;
            if constexpr (std::is_same_v<T, std::string>) {
                header.insert(name, Imf::StringAttribute(v));
            } else if constexpr (std::is_same_v<T, int>) {
                header.insert(name, Imf::IntAttribute(v));
            } else if constexpr (std::is_same_v<T, float>) {
                header.insert(name, Imf::FloatAttribute(v));
            } else if constexpr (std::is_same_v<T, double>) {
                header.insert(name, Imf::DoubleAttribute(v));
            } else if constexpr (std::is_same_v<T, Matrix4>) {
                Imath::M44f m;
                for (int i = 0; i < 4; ++i)
                    for (int j = 0; j < 4; ++j) m[i][j] = static_cast<float>(v.m[j][i]);
                header.insert(name, Imf::M44fAttribute(m));
            } else {
                insert_vector(header, name, v);
            }
        },
        attribute);
}

// A channel as 16-bit floats, row by row.
struct HalfChannel {
    int index = 0;
    std::vector<std::uint16_t> bits;
};
std::vector<HalfChannel> half_channels(const Image& image, const std::vector<std::string>& names) {
    std::vector<HalfChannel> halves;
    for (const std::string& name : names) {
        const std::optional<int> c = image.find_channel(name);
        if (!c || std::ranges::find(halves, *c, &HalfChannel::index) != halves.end()) continue;
        HalfChannel& half = halves.emplace_back();
        half.index = *c;
        half.bits.reserve(image.pixel_count());
        const auto stride = static_cast<std::size_t>(image.channels());
        for (std::size_t i = static_cast<std::size_t>(*c); i < image.sample_count(); i += stride)
            half.bits.push_back(clamped_half(image.f32()[i]));
    }
    return halves;
}

} // namespace

void encode_exr(AtomicFile& file, const std::string& name, const Image& image, const WriteOptions& options) {
    bool half = image.format() == PixelFormat::f16 && image.encoding() == ColorEncoding::linear();
    Image converted;
    if (!half && (image.format() != PixelFormat::f32 || image.encoding() != ColorEncoding::linear()))
        converted = image.to_linear_f32();
    const Image& source = converted.empty() ? image : converted;

    try {
        const Placement placement = placement_of(image);
        const Imath::Box2i window = box_of(placement.data);
        Imf::Header header(box_of(placement.display), window);
        header.compression() = compression_of(options.exr_compression);
        for (const auto& [key, value] : image.attributes())
            if (!is_of_placement(key)) insert(header, key, value);
        const Imf::PixelType type = half ? Imf::HALF : Imf::FLOAT;
        std::vector<HalfChannel> halves; // of a 32-bit image
        if (!half) halves = half_channels(source, options.exr_half);
        std::size_t sample = half ? 2 : 4, pixel = sample * source.channels(), row = pixel * source.width();
        // The library only reads from the buffer, but its slices are not const.
        const char* data = half ? reinterpret_cast<const char*>(source.u16().data())
                                : reinterpret_cast<const char*>(source.f32().data());
        char* base = const_cast<char*>(data);
        Imf::FrameBuffer buffer;
        for (int c = 0; c < source.channels(); ++c) {
            const std::string& channel = source.channel_names()[c];
            if (const auto found = std::ranges::find(halves, c, &HalfChannel::index); found != halves.end()) {
                header.channels().insert(channel, Imf::Channel(Imf::HALF));
                buffer.insert(channel, Imf::Slice::Make(Imf::HALF, found->bits.data(), window, 2,
                                                        2 * static_cast<std::size_t>(source.width())));
                continue;
            }
            header.channels().insert(channel, Imf::Channel(type));
            buffer.insert(channel, Imf::Slice::Make(type, base + c * sample, window, pixel, row));
        }
        FileStream stream(file, name.c_str());
        Imf::OutputFile output(stream, header, 0);
        output.setFrameBuffer(buffer);
        output.writePixels(image.height());
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const Error& e) {
        throw;
    } catch (const std::exception& e) {
        throw Error(name, std::string("cannot be written: ") + e.what());
    }
}

} // namespace montelux
