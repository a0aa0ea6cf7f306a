#include "montelux/image/image_write.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>

#include "montelux/image/encoders.h"
#include "montelux/image/half.h"
#include "montelux/mc/math/error.h"

namespace montelux {

namespace {

enum class FileFormat { exr, png, jpeg, hdr, pfm };

FileFormat format_of(const std::filesystem::path& path) {
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (extension == ".exr") return FileFormat::exr;
    if (extension == ".png") return FileFormat::png;
    if (extension == ".jpg" || extension == ".jpeg") return FileFormat::jpeg;
    if (extension == ".hdr") return FileFormat::hdr;
    if (extension == ".pfm") return FileFormat::pfm;
    std::string name = path.empty() ? "''" : path.string();
    if (extension.empty())
        throw Error(name,
                    "cannot be written: the name has no extension; expected .exr, .png, .jpg, .hdr or .pfm");
    throw Error(name, "cannot be written: the extension '" + extension +
                          "' is not one of .exr, .png, .jpg, .hdr, .pfm");
}

} // namespace

std::vector<int> require_color_channels(const std::string& name, const Image& image) {
    auto colors = image.color_channels();
    if (!colors.empty()) return colors;
    std::string known;
    for (const std::string& channel : image.channel_names()) known += (known.empty() ? "" : ", ") + channel;
    throw Error(name,
                "cannot be written: this format needs the channels R, G, B or Y, but there are " + known);
}

Image coded_picture(const std::string& name, const Image& image, const ToneCurve& tone, int bits) {
    const std::vector<int> colors = require_color_channels(name, image);
    const bool holds_codes = (image.format() == PixelFormat::u8 && bits == 8) ||
                             (image.format() == PixelFormat::u16 && bits == 16);
    const bool is_ready = holds_codes && tone.exposure == 0 && tone.kind == ToneKind::srgb &&
                          image.encoding() == ColorEncoding::srgb();
    if (!is_ready) return apply_tone_curve(image, tone, bits);
    std::vector<std::string> names;
    names.reserve(colors.size() + 1);
    for (int c : colors) names.push_back(image.channel_names()[c]);
    if (image.find_channel("A")) names.emplace_back("A");
    return image.select(names);
}

void write_image(const std::filesystem::path& path, const Image& image, const WriteOptions& options) {
    FileFormat format = format_of(path);
    if (image.empty()) throw Error(path.string(), "cannot be written: the image has no pixels");
    AtomicFile file(path);
    switch (format) {
    case FileFormat::exr:
        encode_exr(file, path.string(), image, options);
        break;
    case FileFormat::png:
        encode_png(file, path.string(), image, options);
        break;
    case FileFormat::jpeg:
        encode_jpeg(file, path.string(), image, options);
        break;
    case FileFormat::hdr:
        encode_hdr(file, path.string(), image);
        break;
    case FileFormat::pfm:
        encode_pfm(file, path.string(), image);
        break;
    }
    file.commit();
}

std::uint64_t half_overflows(const Image& image, const std::vector<std::string>& channels) {
    std::uint64_t count = 0;
    for (const std::string& name : channels)
        if (const auto c = image.find_channel(name))
            for (int y = 0; y < image.height(); ++y)
                for (int x = 0; x < image.width(); ++x) {
                    const float v = image.value(x, y, *c);
                    count += std::isfinite(v) && std::abs(v) > largest_half;
                }
    return count;
}

bool takes_tone_curve(const std::filesystem::path& path) {
    const FileFormat format = format_of(path);
    return format == FileFormat::png || format == FileFormat::jpeg;
}

void check_writable(const std::filesystem::path& path) {
    format_of(path);
    // Creates and removes a temporary file, since permission bits alone are not conclusive.
    AtomicFile probe(path);
}

void encode_pfm(AtomicFile& file, const std::string& name, const Image& image) {
    auto colors = require_color_channels(name, image);
    std::string header = (colors.size() == 3 ? "PF\n" : "Pf\n") + std::to_string(image.width()) + " " +
                         std::to_string(image.height()) + "\n-1\n";
    file.write(header.data(), header.size());
    std::vector<float> row(image.width() * colors.size());
    for (int y = image.height() - 1; y >= 0; --y) {
        for (int x = 0; x < image.width(); ++x)
            for (std::size_t c = 0; c < colors.size(); ++c)
                row[x * colors.size() + c] = image.linear(x, y, colors[c]);
        file.write(row.data(), row.size() * sizeof(float));
    }
}

namespace {

struct RgbePixel {
    std::uint8_t v[4];
};

// Ward, "Real Pixels", Graphics Gems II: the largest component's exponent serves all three. Rounds to
// nearest.
RgbePixel to_rgbe(float r, float g, float b) {
    float rgb[3] = {r, g, b};
    for (float& v : rgb) v = v > 0 ? std::min(v, 0x1.fep+126f) : 0.0f;
    float largest = std::max({rgb[0], rgb[1], rgb[2]});
    if (largest < 1e-32f) return {};
    int exponent = 0;
    // A mantissa of 255.5 or more would round to 256: take the next exponent.
    if (std::frexp(largest, &exponent) * 256 >= 255.5f) ++exponent;
    RgbePixel out{};
    for (int c = 0; c < 3; ++c)
        out.v[c] = static_cast<std::uint8_t>(std::lround(std::ldexp(rgb[c], 8 - exponent)));
    out.v[3] = static_cast<std::uint8_t>(exponent + 128);
    return out;
}

// One component of a line: runs of at least 4 equal bytes, and stretches of others.
void append_runs(std::vector<std::uint8_t>& out, const std::vector<RgbePixel>& line, int c) {
    std::size_t n = line.size();
    auto run_at = [&](std::size_t i) {
        std::size_t k = i + 1;
        while (k < n && k - i < 127 && line[k].v[c] == line[i].v[c]) ++k;
        return k - i;
    };
    for (std::size_t i = 0; i < n;) {
        std::size_t run = run_at(i);
        if (run >= 4) {
            out.push_back(static_cast<std::uint8_t>(128 + run));
            out.push_back(line[i].v[c]);
            i += run;
            continue;
        }
        std::size_t end = i;
        while (end < n && end - i < 128 && run_at(end) < 4) ++end;
        out.push_back(static_cast<std::uint8_t>(end - i));
        for (; i < end; ++i) out.push_back(line[i].v[c]);
    }
}

} // namespace

void encode_hdr(AtomicFile& file, const std::string& name, const Image& image) {
    auto colors = require_color_channels(name, image);
    if (colors.size() == 1) colors = {colors[0], colors[0], colors[0]};
    std::string header = "#?RADIANCE\nSOFTWARE=Montelux\nFORMAT=32-bit_rle_rgbe\n\n-Y " +
                         std::to_string(image.height()) + " +X " + std::to_string(image.width()) + "\n";
    file.write(header.data(), header.size());
    std::size_t n = static_cast<std::size_t>(image.width());
    std::vector<RgbePixel> line(n);
    std::vector<std::uint8_t> bytes;
    for (int y = 0; y < image.height(); ++y) {
        for (std::size_t x = 0; x < n; ++x) {
            int i = static_cast<int>(x);
            line[x] = to_rgbe(image.linear(i, y, colors[0]), image.linear(i, y, colors[1]),
                              image.linear(i, y, colors[2]));
        }
        bytes.clear();
        if (n >= 8 && n <= 0x7fff) {
            bytes = {2, 2, static_cast<std::uint8_t>(n >> 8), static_cast<std::uint8_t>(n & 255)};
            for (int c = 0; c < 4; ++c) append_runs(bytes, line, c);
        } else {
            // No pixel is taken for a repetition, (1, 1, 1, n): the largest mantissa is at least 128.
            for (const RgbePixel& p : line) bytes.insert(bytes.end(), p.v, p.v + 4);
        }
        file.write(bytes);
    }
}

} // namespace montelux
