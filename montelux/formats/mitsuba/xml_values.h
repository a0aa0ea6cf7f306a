// Values in the attributes of Mitsuba's XML: numbers, lists of numbers, spectra, and the parts of transformations.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "montelux/formats/mitsuba/object.h"

namespace montelux::mitsuba {

// Attributes of an element, in the order of the file, after the substitution of parameters.
struct Attribute {
    std::string name, value;
};

// Where an error is, and how it is thrown.
class Place {
  public:
    Place(const BuildMessages& messages, SourceLocation at) : messages_(&messages), at_(at) {}
    SourceLocation at() const { return at_; }
    [[noreturn]] void error(std::string_view sentence) const { messages_->error(at_, sentence); }

  private:
    const BuildMessages* messages_;
    SourceLocation at_;
};

// One finite number; white space around it is ignored. `what` is its name in errors: "the attribute 'x'".
double number_of(std::string_view text, std::string_view what, const Place& place);
std::int64_t integer_of(std::string_view text, std::string_view what, const Place& place);
// Numbers that are separated by white space or commas.
std::vector<double> numbers_of(std::string_view text, std::string_view what, const Place& place);
// Three numbers, or one that stands for all.
Vec3d triple_of(std::string_view text, std::string_view what, const Place& place);
// "0.5", or pairs "400:0.1, 500:0.2" of ascending wavelengths (nm) and values.
SpectrumValue spectrum_of(std::string_view text, const Place& place);
// Three or one number, or "#rrggbb" in sRGB.
RgbValue rgb_of(std::string_view text, const Place& place);

// The matrix of an element <translate>, <scale>, <rotate>, <lookat> or <matrix>; empty for other elements.
std::optional<Matrix4> transformation_of(std::string_view element, const std::vector<Attribute>& attributes,
                                         const Place& place);
// x, y and z, or `value`; those that are not given are `otherwise`. Errors name other attributes, but for `also`.
Vec3d components_of(const std::vector<Attribute>& attributes, double otherwise, const Place& place,
                    std::string_view also = {});

} // namespace montelux::mitsuba
