// DirectiveText: a directive of a pbrt file with its parameters, as text that the reader reads back bit for bit.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "montelux/mc/math/transform.h"
#include "montelux/spectrum/rgb_colorspace.h"

namespace montelux::pbrt {

// The shortest digits that are read as the same number. Finite numbers only.
std::string digits_of(float v);
std::string digits_of(double v);
// In quotes, with escapes. Throws Error for text that pbrt's syntax cannot hold.
std::string quoted_text(std::string_view text);

// The directives that bring the identity to `t`. The matrix is kept bit for bit; the inverse too, where Translate, Scale,
// LookAt or the inversion of the matrix give it, else to rounding.
std::string transform_text(const Transform& t);
// Of a transformation that changes from time 0 to 1.
std::string motion_text(const Transform& start, const Transform& end);

class DirectiveText {
  public:
    // `head`: the directive with its names, without a line's end.
    explicit DirectiveText(std::string head) : text_(std::move(head)) {}

    void number(std::string_view name, float v) { numbers("float", name, {&v, 1}); }
    void integer(std::string_view name, int v);
    void integers(std::string_view name, std::span<const std::int32_t> values);
    void boolean(std::string_view name, bool v);
    void string(std::string_view name, std::string_view v) { strings("string", name, {&v, 1}); }
    void texture(std::string_view name, std::string_view v) { strings("texture", name, {&v, 1}); }
    void strings(std::string_view type, std::string_view name, std::span<const std::string_view> values);
    // `type`: "float", "point3", "rgb" ...
    void numbers(std::string_view type, std::string_view name, std::span<const float> values);
    void vector(std::string_view type, std::string_view name, Vec3f v);
    // Colours of a directive are in one space; false if they are in another.
    bool use_color_space(const RgbColorSpace& space);

    // With the directive ColorSpace before it where that is needed; it then belongs into a block of attributes.
    std::string text() const;

  private:
    void begin(std::string_view type, std::string_view name);

    std::string text_;
    const RgbColorSpace* space_ = nullptr;
};

} // namespace montelux::pbrt
