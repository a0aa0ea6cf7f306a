#include "montelux/image/placement.h"

#include <algorithm>
#include <array>

#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

constexpr std::array<std::string_view, 6> names{"dataWindow.x",        "dataWindow.y",
                                                "displayWindow.x",     "displayWindow.y",
                                                "displayWindow.width", "displayWindow.height"};

int number(const Image& image, std::string_view name, int otherwise) {
    const auto found = image.attributes().find(name);
    if (found == image.attributes().end()) return otherwise;
    const int* v = std::get_if<int>(&found->second);
    return v != nullptr ? *v : otherwise;
}

template <typename T>
void copy_rows(std::span<const T> from, std::span<T> to, std::size_t first, std::size_t stride,
               std::size_t row) {
    for (std::size_t at = 0; at < to.size(); at += row, first += stride)
        std::copy_n(from.begin() + static_cast<std::ptrdiff_t>(first), row,
                    to.begin() + static_cast<std::ptrdiff_t>(at));
}

} // namespace

std::string text_of(const PixelWindow& w) {
    return "columns " + std::to_string(w.x0) + " to " + std::to_string(w.x1 - 1) + ", rows " +
           std::to_string(w.y0) + " to " + std::to_string(w.y1 - 1);
}

bool is_of_placement(std::string_view attribute) {
    return std::ranges::find(names, attribute) != names.end();
}

Placement placement_of(const Image& image) {
    Placement p;
    p.data.x0 = number(image, "dataWindow.x", 0);
    p.data.y0 = number(image, "dataWindow.y", 0);
    p.data.x1 = p.data.x0 + image.width();
    p.data.y1 = p.data.y0 + image.height();
    const int width = number(image, "displayWindow.width", 0),
              height = number(image, "displayWindow.height", 0);
    if (width < 1 || height < 1) {
        p.display = p.data;
        return p;
    }
    p.display.x0 = number(image, "displayWindow.x", 0);
    p.display.y0 = number(image, "displayWindow.y", 0);
    p.display.x1 = p.display.x0 + width;
    p.display.y1 = p.display.y0 + height;
    return p;
}

void set_placement(Image& image, int x, int y, const PixelWindow& display) {
    Attributes& a = image.attributes();
    for (const std::string_view name : names)
        if (const auto found = a.find(name); found != a.end()) a.erase(found);
    const PixelWindow data{x, y, x + image.width(), y + image.height()};
    if (x != 0) a["dataWindow.x"] = x;
    if (y != 0) a["dataWindow.y"] = y;
    if (display == data) return;
    if (display.x0 != 0) a["displayWindow.x"] = display.x0;
    if (display.y0 != 0) a["displayWindow.y"] = display.y0;
    a["displayWindow.width"] = display.width();
    a["displayWindow.height"] = display.height();
}

Image cut_out(const Image& image, const PixelWindow& window) {
    const Placement p = placement_of(image);
    const PixelWindow& data = p.data;
    if (window.width() < 1 || window.height() < 1 || window.x0 < data.x0 || window.y0 < data.y0 ||
        window.x1 > data.x1 || window.y1 > data.y1)
        throw Error("image", text_of(window) + " were asked for; there are " + text_of(data));
    Image part(window.width(), window.height(), image.channel_names(), image.format(), image.encoding());
    part.attributes() = image.attributes();
    const auto channels = static_cast<std::size_t>(image.channels());
    const std::size_t first = image.index(window.x0 - data.x0, window.y0 - data.y0),
                      stride = channels * static_cast<std::size_t>(image.width()),
                      row = channels * static_cast<std::size_t>(window.width());
    copy_rows(image.f32(), part.f32(), first, stride, row);
    copy_rows(image.u16(), part.u16(), first, stride, row);
    copy_rows(image.u8(), part.u8(), first, stride, row);
    set_placement(part, window.x0, window.y0, p.display);
    return part;
}

std::optional<PixelWindow> common_pixels(const std::string& a_name, const Image& a, const std::string& b_name,
                                         const Image& b) {
    const Placement pa = placement_of(a), pb = placement_of(b);
    if (pa.display != pb.display || pa.data == pb.data) return std::nullopt;
    const PixelWindow common{std::max(pa.data.x0, pb.data.x0), std::max(pa.data.y0, pb.data.y0),
                             std::min(pa.data.x1, pb.data.x1), std::min(pa.data.y1, pb.data.y1)};
    if (common.width() < 1 || common.height() < 1)
        throw Error(a_name, "it holds " + text_of(pa.data) + ", and " + b_name + " " + text_of(pb.data) +
                                ": they have no pixel in common");
    return common;
}

} // namespace montelux
