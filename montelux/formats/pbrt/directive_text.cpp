#include "montelux/formats/pbrt/directive_text.h"

#include <array>
#include <charconv>
#include <cmath>

#include "montelux/mc/math/error.h"

namespace montelux::pbrt {
namespace {

constexpr std::size_t numbers_per_line = 12;

template <typename T>
std::string shortest(T v) {
    if (!std::isfinite(v)) throw Error("a scene file holds finite numbers only");
    std::array<char, 64> text{};
    const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), v);
    return {text.data(), end};
}

std::string numbers_text(std::string_view directive, std::span<const double> values) {
    std::string text(directive);
    for (const double v : values) text += " " + digits_of(v);
    return text + "\n";
}

std::string matrix_text(const Matrix4& m) {
    std::string text = "Transform [";
    for (std::size_t column = 0; column < 4; ++column)
        for (std::size_t row = 0; row < 4; ++row) text += " " + digits_of(m.m[row][column]);
    return text + " ]\n";
}

// As LookAt of the camera that it is; empty where that is another transformation.
std::string look_at_text(const Transform& t) {
    const auto& c = t.inverse_matrix().m; // world from camera
    const Vec3d eye(c[0][3], c[1][3], c[2][3]), up(c[0][1], c[1][1], c[2][1]),
        direction(c[0][2], c[1][2], c[2][2]);
    for (const double distance : {1.0, 2.0, 8.0, 64.0, 0.5, 3.0, 5.0, 10.0, 100.0, 1000.0}) {
        const Vec3d target = eye + direction * distance;
        const std::optional<Transform> made = Transform::look_at(eye, target, up);
        if (made && Transform() * *made == t) {
            const std::array<double, 9> v = {eye.x,    eye.y, eye.z, target.x, target.y,
                                             target.z, up.x,  up.y,  up.z};
            return numbers_text("LookAt", v);
        }
    }
    return {};
}

} // namespace

std::string digits_of(float v) { return shortest(v); }
std::string digits_of(double v) { return shortest(v); }

std::string quoted_text(std::string_view text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '\0') throw Error("a name in a scene file contains no NUL byte");
        if (c == '"' || c == '\\') out += '\\';
        if (c == '\n')
            out += "\\n";
        else
            out += c;
    }
    return out + '"';
}

std::string transform_text(const Transform& t) {
    if (t == Transform()) return {};
    const auto& m = t.matrix().m;
    const auto makes = [&](const Transform& made) { return Transform() * made == t; };
    const std::array<double, 3> offset = {m[0][3], m[1][3], m[2][3]}, factors = {m[0][0], m[1][1], m[2][2]};
    if (makes(Transform::translate({offset[0], offset[1], offset[2]})))
        return numbers_text("Translate", offset);
    if (factors[0] != 0 && factors[1] != 0 && factors[2] != 0 &&
        makes(Transform::scale({factors[0], factors[1], factors[2]})))
        return numbers_text("Scale", factors);
    const std::optional<Transform> from_matrix = Transform::from_matrix(t.matrix());
    if (!from_matrix || !makes(*from_matrix))
        if (std::string look_at = look_at_text(t); !look_at.empty()) return look_at;
    return matrix_text(t.matrix());
}

std::string motion_text(const Transform& start, const Transform& end) {
    return "ActiveTransform StartTime\n" + transform_text(start) + "ActiveTransform EndTime\n" +
           transform_text(end) + "ActiveTransform All\n";
}

void DirectiveText::begin(std::string_view type, std::string_view name) {
    text_ += "\n    \"";
    text_ += type;
    text_ += ' ';
    text_ += name;
    text_ += "\" [";
}

void DirectiveText::integer(std::string_view name, int v) {
    const std::int32_t value = v;
    integers(name, {&value, 1});
}

void DirectiveText::integers(std::string_view name, std::span<const std::int32_t> values) {
    begin("integer", name);
    for (std::size_t i = 0; i < values.size(); ++i)
        text_ += (i > 0 && i % numbers_per_line == 0 ? "\n      " : " ") + std::to_string(values[i]);
    text_ += " ]";
}

void DirectiveText::boolean(std::string_view name, bool v) {
    begin("bool", name);
    text_ += v ? " true ]" : " false ]";
}

void DirectiveText::strings(std::string_view type, std::string_view name,
                            std::span<const std::string_view> values) {
    begin(type, name);
    for (const std::string_view v : values) text_ += " " + quoted_text(v);
    text_ += " ]";
}

void DirectiveText::numbers(std::string_view type, std::string_view name, std::span<const float> values) {
    begin(type, name);
    for (std::size_t i = 0; i < values.size(); ++i)
        text_ += (i > 0 && i % numbers_per_line == 0 ? "\n      " : " ") + digits_of(values[i]);
    text_ += " ]";
}

void DirectiveText::vector(std::string_view type, std::string_view name, Vec3f v) {
    const std::array<float, 3> values = {v.x, v.y, v.z};
    numbers(type, name, values);
}

bool DirectiveText::use_color_space(const RgbColorSpace& space) {
    if (space_ == nullptr) space_ = &space;
    return space_ == &space;
}

std::string DirectiveText::text() const {
    const bool other = space_ != nullptr && space_ != &RgbColorSpace::srgb();
    return (other ? "ColorSpace " + quoted_text(space_->name()) + "\n" : std::string()) + text_ + "\n";
}

} // namespace montelux::pbrt
