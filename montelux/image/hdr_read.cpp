#include <algorithm>
#include <cctype>
#include <cmath>

#include "montelux/image/decoders.h"
#include "montelux/image/text_cursor.h"
#include "montelux/mc/math/error.h"

namespace montelux {

namespace {

// Where the pixels of the file go: a file scans along its second axis first.
struct Scan {
    std::uint64_t lines = 0, line_length = 0;
    bool lines_are_rows = true, lines_reversed = false, pixels_reversed = false;

    std::uint64_t width() const { return lines_are_rows ? line_length : lines; }
    std::uint64_t height() const { return lines_are_rows ? lines : line_length; }
    std::size_t pixel(std::uint64_t line, std::uint64_t i) const {
        std::uint64_t a = lines_reversed ? lines - 1 - line : line;
        std::uint64_t b = pixels_reversed ? line_length - 1 - i : i;
        return lines_are_rows ? a * line_length + b : b * lines + a;
    }
};

std::optional<Scan> parse_resolution(const std::string& line) {
    TextCursor words({reinterpret_cast<const std::uint8_t*>(line.data()), line.size()});
    std::string axis[2];
    std::optional<std::uint64_t> size[2];
    for (int i = 0; i < 2; ++i) {
        words.skip_space_and_comments();
        axis[i] = words.word();
        words.skip_space_and_comments();
        size[i] = parse_number<std::uint64_t>(words.word());
        if (axis[i].size() != 2 || (axis[i][0] != '-' && axis[i][0] != '+') || !size[i] ||
            *size[i] > 1'000'000'000)
            return std::nullopt;
    }
    bool rows = axis[0][1] == 'Y' && axis[1][1] == 'X';
    if (!rows && !(axis[0][1] == 'X' && axis[1][1] == 'Y')) return std::nullopt;
    // The usual orientation is "-Y height +X width": top to bottom, left to right.
    Scan s{*size[0], *size[1], rows, false, false};
    s.lines_reversed = axis[0] == "+Y" || axis[0] == "-X";
    s.pixels_reversed = axis[1] == "+Y" || axis[1] == "-X";
    return s;
}

struct Rgbe {
    std::uint8_t v[4];
};

class LineReader {
  public:
    LineReader(std::span<const std::uint8_t> bytes, const std::string& name) : bytes_(bytes), name_(name) {}

    void read(std::vector<Rgbe>& line) {
        std::size_t n = line.size();
        bool marked = bytes_.size() - at_ >= 4 && bytes_[at_] == 2 && bytes_[at_ + 1] == 2 &&
                      (bytes_[at_ + 2] & 0x80) == 0;
        if (n >= 8 && n <= 0x7fff && marked)
            read_components(line);
        else
            read_pixels(line);
    }

  private:
    [[noreturn]] void damaged(const char* what) const {
        throw Error(name_, std::string("the HDR file is damaged: ") + what);
    }
    std::uint8_t next() {
        if (at_ == bytes_.size()) damaged("it ends too early");
        return bytes_[at_++];
    }

    // The newer coding: each of the four components of a line in runs of its own.
    void read_components(std::vector<Rgbe>& line) {
        std::size_t n = static_cast<std::size_t>(bytes_[at_ + 2]) << 8 | bytes_[at_ + 3];
        at_ += 4;
        if (n != line.size()) damaged("a line has the wrong length");
        for (int c = 0; c < 4; ++c)
            for (std::size_t i = 0; i < n;) {
                std::size_t count = next();
                bool run = count > 128;
                if (run) count -= 128;
                if (count == 0 || count > n - i) damaged("a run is longer than its line");
                std::uint8_t v = run ? next() : std::uint8_t{0};
                for (std::size_t k = 0; k < count; ++k) line[i++].v[c] = run ? v : next();
            }
    }

    // Whole pixels; (1, 1, 1, n) repeats the previous one, and several in a row are the digits of a count.
    void read_pixels(std::vector<Rgbe>& line) {
        int shift = 0;
        for (std::size_t i = 0; i < line.size();) {
            Rgbe p{};
            for (std::uint8_t& v : p.v) v = next();
            if (p.v[0] != 1 || p.v[1] != 1 || p.v[2] != 1) {
                line[i++] = p;
                shift = 0;
                continue;
            }
            std::size_t count = static_cast<std::size_t>(p.v[3]) << shift;
            if (i == 0) damaged("a line begins with a repetition");
            if (count > line.size() - i) damaged("a run is longer than its line");
            for (std::size_t k = 0; k < count; ++k, ++i) line[i] = line[i - 1];
            shift += 8;
            if (shift > 24) damaged("a run is longer than its line");
        }
    }

    std::span<const std::uint8_t> bytes_;
    const std::string& name_;
    std::size_t at_ = 0;
};

// Linear sRGB of CIE XYZ with an equal-energy white, which is Radiance's (Radiance's color.h; ra_xyze -r does
// the same): Bradford's chromatic adaptation (CIE 159:2004) from the white x = y = 1/3 to sRGB's, (0.3127,
// 0.3290), then the inverse of the matrix that the primaries of ITU-R BT.709 and that white give. So (1, 1,
// 1) stays (1, 1, 1).
constexpr double rgb_from_xyz[3][3] = {{3.146657654, -1.666463755, -0.480193900},
                                       {-0.995521606, 1.955756734, 0.039764872},
                                       {0.063594803, -0.214563222, 1.150968419}};

} // namespace

// Ward, "Real Pixels", Graphics Gems II, and the Radiance file format notes. A pixel is
// mantissa * 2^(exponent - 136). EXPOSURE and GAMMA lines are kept as attributes "hdr.EXPOSURE" and so on
// and not applied.
Image decode_hdr(const EncodedImage& file) {
    auto damaged = [&](const std::string& what) {
        return Error(file.name, "the HDR file is damaged: " + what);
    };
    TextCursor cursor(file.bytes);
    Attributes attributes;
    bool xyz = false;
    constexpr int max_header_lines = 1000;
    for (int i = 0;; ++i) {
        auto line = cursor.line(4096);
        if (!line || i == max_header_lines) throw damaged("its header has no end");
        if (line->empty()) break;
        auto equals = line->find('=');
        if ((*line)[0] == '#' || equals == std::string::npos) continue;
        std::string key = line->substr(0, equals), value = line->substr(equals + 1);
        std::transform(key.begin(), key.end(), key.begin(),
                       [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
        if (key == "FORMAT") {
            xyz = value.find("xyze") != std::string::npos;
            if (!xyz && value.find("rgbe") == std::string::npos)
                throw Error(file.name, "the format '" + printable(value) + "' of this HDR file is not known");
        }
        attributes["hdr." + key] = value;
    }
    auto line = cursor.line(256);
    auto scan = line ? parse_resolution(*line) : std::nullopt;
    if (!scan) throw damaged("its resolution is '" + printable(line.value_or("")) + "'");
    check_image_size(file, scan->width(), scan->height(), 3, 4);
    if (cursor.remaining() < scan->lines * 4) throw damaged("it ends too early");

    Image image(static_cast<int>(scan->width()), static_cast<int>(scan->height()), {"R", "G", "B"});
    image.attributes() = std::move(attributes);
    LineReader reader(cursor.rest(), file.name);
    std::vector<Rgbe> pixels(scan->line_length);
    for (std::uint64_t l = 0; l < scan->lines; ++l) {
        reader.read(pixels);
        for (std::uint64_t i = 0; i < scan->line_length; ++i) {
            const Rgbe& p = pixels[i];
            float* out = image.f32().data() + 3 * scan->pixel(l, i);
            float scale = p.v[3] ? std::ldexp(1.0f, p.v[3] - 136) : 0.0f;
            for (int c = 0; c < 3; ++c) {
                double v = p.v[c];
                if (xyz)
                    v = rgb_from_xyz[c][0] * p.v[0] + rgb_from_xyz[c][1] * p.v[1] +
                        rgb_from_xyz[c][2] * p.v[2];
                out[c] = static_cast<float>(v) * scale;
            }
        }
    }
    return image;
}

} // namespace montelux
