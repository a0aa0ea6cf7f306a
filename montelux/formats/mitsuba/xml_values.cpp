#include "montelux/formats/mitsuba/xml_values.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

#include "montelux/formats/number.h"
#include "montelux/scene/build/quoted.h"

namespace montelux::mitsuba {
namespace {

constexpr std::string_view white = " \t\r\n";

std::string_view trimmed(std::string_view text) {
    const std::size_t begin = text.find_first_not_of(white);
    if (begin == std::string_view::npos) return {};
    return text.substr(begin, text.find_last_not_of(white) - begin + 1);
}

// Calls `visit` with each word between the separators.
template <typename Visit>
void for_each_word(std::string_view text, std::string_view separators, Visit&& visit) {
    for (;;) {
        const std::size_t begin = text.find_first_not_of(separators);
        if (begin == std::string_view::npos) return;
        text.remove_prefix(begin);
        const std::size_t length = std::min(text.find_first_of(separators), text.size());
        visit(text.substr(0, length));
        text.remove_prefix(length);
    }
}

void add_pair(SpectrumValue& to, double wavelength, double value, const Place& place) {
    if (!to.wavelengths.empty() && !(wavelength > to.wavelengths.back()))
        place.error("the wavelengths of a spectrum must ascend");
    to.wavelengths.push_back(wavelength);
    to.values.push_back(value);
}

float linear_of_srgb(unsigned code) {
    const float v = static_cast<float>(code) / 255;
    return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f);
}

Matrix4 matrix_of(const std::vector<Attribute>& attributes, const Place& place) {
    if (attributes.size() != 1 || attributes[0].name != "value")
        place.error("<matrix> has one attribute: value");
    const std::vector<double> values = numbers_of(attributes[0].value, "the matrix", place);
    if (values.size() != 16 && values.size() != 9)
        place.error("a matrix of " + std::to_string(values.size()) + " numbers; expected 9 or 16");
    const std::size_t n = values.size() == 16 ? 4 : 3;
    Matrix4 matrix;
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < n; ++j) matrix.m[i][j] = values[i * n + j];
    return matrix;
}

// Some direction at a right angle.
Vec3d across(Vec3d direction) {
    const Vec3d axis = std::abs(direction.z) < 0.9 * length(direction) ? Vec3d{0, 0, 1} : Vec3d{1, 0, 0};
    return cross(cross(direction, axis), direction);
}

// To the world from a space that looks along +z; +x to the left, +y up: right-handed.
Matrix4 look_at(const std::vector<Attribute>& attributes, const Place& place) {
    std::array<std::optional<Vec3d>, 3> read;
    constexpr std::array<std::string_view, 3> names{"origin", "target", "up"};
    for (const Attribute& a : attributes) {
        const auto found = std::ranges::find(names, a.name);
        if (found == names.end())
            place.error("<lookat> has no attribute " + in_quotes(a.name) +
                        "; expected origin, target and up");
        read[static_cast<std::size_t>(found - names.begin())] = triple_of(a.value, a.name, place);
    }
    if (!read[0] || !read[1]) place.error("<lookat> needs the attributes origin and target");
    const Vec3d forward = *read[1] - *read[0];
    const Vec3d up = read[2] && length_squared(*read[2]) > 0 ? *read[2] : across(forward);
    const Vec3d left = cross(up, forward);
    if (!(length_squared(left) > 0))
        place.error("<lookat> is undefined: origin and target are the same, or the line between them is "
                    "along 'up'");
    const Vec3d z = normalize(forward), x = normalize(left), y = cross(z, x);
    Matrix4 matrix;
    for (int i = 0; i < 3; ++i) {
        auto& row = matrix.m[static_cast<std::size_t>(i)];
        row = {x[i], y[i], z[i], (*read[0])[i]};
    }
    return matrix;
}

Matrix4 rotation(const std::vector<Attribute>& attributes, const Place& place) {
    const auto angle = std::ranges::find(attributes, "angle", &Attribute::name);
    if (angle == attributes.end()) place.error("<rotate> needs the attribute angle");
    const Vec3d axis = components_of(attributes, 0, place, "angle");
    if (!(length_squared(axis) > 0)) place.error("the axis of a rotation is zero");
    return Transform::rotate(number_of(angle->value, "the angle", place), axis).matrix();
}

} // namespace

double number_of(std::string_view text, std::string_view what, const Place& place) {
    const std::string_view word = trimmed(text);
    double value = 0;
    const NumberResult read = parse_number(word.data(), word.data() + word.size(), value);
    if (read.status == NumberStatus::out_of_range)
        place.error(std::string(what) + " is " + in_quotes(word) + ", which is too large");
    if (read.status != NumberStatus::ok || read.end != word.data() + word.size())
        place.error(std::string(what) + " is " + in_quotes(text) + "; expected a number");
    return value;
}

std::int64_t integer_of(std::string_view text, std::string_view what, const Place& place) {
    const double value = number_of(text, what, place);
    if (value != std::floor(value) || std::abs(value) > 9007199254740992.0)
        place.error(std::string(what) + " is " + in_quotes(text) + "; expected an integer");
    return static_cast<std::int64_t>(value);
}

std::vector<double> numbers_of(std::string_view text, std::string_view what, const Place& place) {
    std::vector<double> values;
    for_each_word(text, " \t\r\n,",
                  [&](std::string_view word) { values.push_back(number_of(word, what, place)); });
    return values;
}

Vec3d triple_of(std::string_view text, std::string_view what, const Place& place) {
    const std::vector<double> values = numbers_of(text, what, place);
    if (values.size() == 1) return {values[0], values[0], values[0]};
    if (values.size() != 3)
        place.error(std::string(what) + " has " + std::to_string(values.size()) +
                    " numbers; expected 3, or 1 for all");
    return {values[0], values[1], values[2]};
}

SpectrumValue spectrum_of(std::string_view text, const Place& place) {
    SpectrumValue spectrum;
    if (text.find(':') == std::string_view::npos) {
        spectrum.values = {number_of(text, "the spectrum", place)};
        return spectrum;
    }
    for_each_word(text, " \t\r\n,", [&](std::string_view word) {
        const std::size_t colon = word.find(':');
        if (colon == std::string_view::npos)
            place.error("a spectrum with " + in_quotes(word) + "; expected pairs such as 500:0.3");
        add_pair(spectrum, number_of(word.substr(0, colon), "a wavelength", place),
                 number_of(word.substr(colon + 1), "a value of the spectrum", place), place);
    });
    return spectrum;
}

RgbValue rgb_of(std::string_view text, const Place& place) {
    const std::string_view word = trimmed(text);
    if (!word.starts_with('#')) return {triple_of(text, "the colour", place)};
    if (word.size() != 7 ||
        !std::all_of(word.begin() + 1, word.end(), [](unsigned char c) { return std::isxdigit(c) != 0; }))
        place.error("the colour is " + in_quotes(word) + "; expected '#' and six hexadecimal digits");
    RgbValue color;
    for (int i = 0; i < 3; ++i) {
        const std::string digits(word.substr(1 + 2 * static_cast<std::size_t>(i), 2));
        color.rgb[i] =
            static_cast<double>(linear_of_srgb(static_cast<unsigned>(std::stoul(digits, nullptr, 16))));
    }
    return color;
}

Vec3d components_of(const std::vector<Attribute>& attributes, double otherwise, const Place& place,
                    std::string_view also) {
    Vec3d components{otherwise, otherwise, otherwise};
    bool whole = false, apart = false;
    for (const Attribute& a : attributes) {
        if (!also.empty() && a.name == also) continue;
        if (a.name == "value") {
            components = triple_of(a.value, "the attribute 'value'", place);
            whole = true;
        } else if (a.name == "x" || a.name == "y" || a.name == "z") {
            components[a.name[0] - 'x'] = number_of(a.value, "the attribute '" + a.name + "'", place);
            apart = true;
        } else {
            place.error("unexpected attribute " + in_quotes(a.name) + "; expected x, y and z, or value");
        }
    }
    if (whole && apart) place.error("'value' cannot stand beside x, y and z");
    return components;
}

std::optional<Matrix4> transformation_of(std::string_view element, const std::vector<Attribute>& attributes,
                                         const Place& place) {
    if (element == "translate") return Transform::translate(components_of(attributes, 0, place)).matrix();
    if (element == "scale") {
        const Vec3d s = components_of(attributes, 1, place);
        Matrix4 matrix;
        for (int i = 0; i < 3; ++i) matrix.m[static_cast<std::size_t>(i)][static_cast<std::size_t>(i)] = s[i];
        return matrix;
    }
    if (element == "rotate") return rotation(attributes, place);
    if (element == "lookat") return look_at(attributes, place);
    if (element == "matrix") return matrix_of(attributes, place);
    return std::nullopt;
}

} // namespace montelux::mitsuba
