#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <algorithm>
#include <cstring>
#include <exception>

#include "montelux/image/decoders.h"
#include "montelux/image/exr_channel_order.h"
#include "montelux/image/exr_layout.h"
#include "montelux/mc/math/error.h"

namespace montelux {

namespace {

class MemoryStream final : public Imf::IStream {
  public:
    MemoryStream(std::span<const std::uint8_t> bytes, const char* name) : IStream(name), bytes_(bytes) {}

    bool read(char c[], int n) override {
        if (n < 0 || static_cast<std::size_t>(n) > bytes_.size() - at_)
            throw Error("the file ends too early");
        std::memcpy(c, bytes_.data() + at_, static_cast<std::size_t>(n));
        at_ += static_cast<std::size_t>(n);
        return at_ < bytes_.size();
    }
    std::uint64_t tellg() override { return at_; }
    void seekg(std::uint64_t position) override {
        if (position > bytes_.size()) throw Error("a position lies outside the file");
        at_ = position;
    }
    void clear() override {}

  private:
    std::span<const std::uint8_t> bytes_;
    std::size_t at_ = 0;
};

} // namespace

Image decode_exr(const EncodedImage& file) {
    std::vector<std::uint8_t> bytes(file.bytes.begin(), file.bytes.end());
    ExrLayout layout = parse_exr(bytes, file.name, file.options);

    bool all_half = std::all_of(layout.channels.begin(), layout.channels.end(),
                                [](const ExrChannel& c) { return c.type == 1; });
    PixelFormat format = all_half ? PixelFormat::f16 : PixelFormat::f32;
    std::vector<std::string> names;
    for (const ExrChannel& c : layout.channels) names.push_back(c.name);
    std::sort(names.begin(), names.end(), channel_before);
    check_image_size(file, layout.width, layout.height, names.size(), bytes_per_sample(format));
    Image image(layout.width, layout.height, names, format);
    image.attributes() = std::move(layout.attributes);
    set_placement(image, layout.min_x, layout.min_y, layout.display);

    try {
        MemoryStream stream(bytes, file.name.c_str());
        Imf::MultiPartInputFile input(stream, 0, false);
        Imf::InputPart part(input, 0);
        Imath::Box2i window({layout.min_x, layout.min_y},
                            {layout.min_x + layout.width - 1, layout.min_y + layout.height - 1});
        // The picture has the size that was checked; pixels of another one would be written beyond it.
        if (part.header().dataWindow() != window) throw Error("its data window can be read in two ways");
        std::size_t sample = bytes_per_sample(format), pixel = sample * names.size(),
                    row = pixel * layout.width;
        char* base = all_half ? reinterpret_cast<char*>(image.u16().data())
                              : reinterpret_cast<char*>(image.f32().data());
        Imf::FrameBuffer buffer;
        for (std::size_t c = 0; c < names.size(); ++c)
            buffer.insert(names[c], Imf::Slice::Make(all_half ? Imf::HALF : Imf::FLOAT, base + c * sample,
                                                     window, pixel, row));
        part.setFrameBuffer(buffer);
        part.readPixels(window.min.y, window.max.y);
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& e) {
        // Strips the beginning of the library's message, which repeats file and action.
        std::string what = e.what(), quoted = "\"" + file.name + "\". ";
        if (auto at = what.find(quoted); at != std::string::npos) what.erase(0, at + quoted.size());
        throw Error(file.name, "the EXR file is damaged: " + what);
    }
    return image;
}

} // namespace montelux
