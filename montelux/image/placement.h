// Where an image lies in a larger picture: the data window of an OpenEXR file in its display window.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "montelux/image/image.h"

namespace montelux {

// In pixels, x to the right and y down; ends are exclusive.
struct PixelWindow {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;

    int width() const { return x1 - x0; }
    int height() const { return y1 - y0; }
    bool operator==(const PixelWindow&) const = default;
};

// The image's own pixels (data) and the picture that they are a part of (display). An image keeps both in its
// attributes: "dataWindow.x" and ".y" where they are not 0, and "displayWindow.x", ".y", ".width" and
// ".height" where the two windows differ. Only EXR keeps them.
struct Placement {
    PixelWindow data, display;
};
Placement placement_of(const Image& image);
// Places the image's top left pixel at (x, y) of `display`.
void set_placement(Image& image, int x, int y, const PixelWindow& display);
// Attributes that placement_of reads.
bool is_of_placement(std::string_view attribute);

// A copy of the pixels of the data window that lie in `window`, placed there; throws Error when it is empty
// or reaches beyond the data window.
Image cut_out(const Image& image, const PixelWindow& window);

// "columns 4 to 7, rows 0 to 9".
std::string text_of(const PixelWindow& window);

// The intersection of two different parts of one picture; empty if they are the same part, or if their
// display windows differ. Throws Error when they have no pixel in common.
std::optional<PixelWindow> common_pixels(const std::string& a_name, const Image& a, const std::string& b_name,
                                         const Image& b);

} // namespace montelux
