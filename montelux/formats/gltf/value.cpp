#include "montelux/formats/gltf/value.h"

#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "montelux/scene/build/quoted.h"

namespace montelux::gltf {
namespace {

constexpr double most_whole = 9007199254740992.0; // 2^53: beyond it, JSON's numbers have gaps

// RFC 6901.
std::string escaped(std::string_view key) {
    std::string result;
    for (const char c : shown(key)) {
        if (c == '~')
            result += "~0";
        else if (c == '/')
            result += "~1";
        else
            result += c;
    }
    return result;
}

} // namespace

std::string shown_number(double value) {
    char text[32];
    const auto [end, error] = std::to_chars(text, text + sizeof text, value, std::chars_format::general, 6);
    return {text, end};
}

void Value::wrong_type(std::string_view expected) const {
    std::string read;
    switch (json_->type()) {
    case nlohmann::json::value_t::null:
        read = "null";
        break;
    case nlohmann::json::value_t::object:
        read = "an object";
        break;
    case nlohmann::json::value_t::array:
        read = "an array";
        break;
    case nlohmann::json::value_t::string:
        read = "the text " + in_quotes(json_->get_ref<const std::string&>());
        break;
    case nlohmann::json::value_t::boolean:
        read = json_->get<bool>() ? "true" : "false";
        break;
    default:
        read = "the number " + shown_number(json_->get<double>());
        break;
    }
    error(read + "; expected " + std::string(expected));
}

double Value::number(double least, double most) const {
    if (!json_->is_number()) wrong_type("a number");
    const double value = json_->get<double>();
    if (!(std::abs(value) <= static_cast<double>(std::numeric_limits<float>::max())))
        error("the number " + shown_number(value) + " is beyond what single-precision numbers hold");
    if (value < least) error(shown_number(value) + " is below " + shown_number(least));
    if (value > most) error(shown_number(value) + " is above " + shown_number(most));
    return value;
}

std::uint64_t Value::whole() const {
    constexpr std::string_view expected = "an integer that is not negative";
    if (!json_->is_number()) wrong_type(expected);
    const double value = json_->get<double>();
    if (!(value >= 0 && value <= most_whole && std::floor(value) == value)) wrong_type(expected);
    return static_cast<std::uint64_t>(value);
}

const std::string& Value::text() const {
    if (!json_->is_string()) wrong_type("a text");
    return json_->get_ref<const std::string&>();
}

bool Value::boolean() const {
    if (!json_->is_boolean()) wrong_type("true or false");
    return json_->get<bool>();
}

std::size_t Value::size() const {
    if (!json_->is_array()) wrong_type("an array");
    return json_->size();
}

Value Value::operator[](std::size_t i) const {
    return {(*json_)[i], pointer_ + '/' + std::to_string(i), *diagnostics_};
}

std::vector<double> Value::numbers(std::size_t count) const {
    if (size() != count)
        error("an array of " + std::to_string(size()) + " values; expected " + std::to_string(count) +
              " numbers");
    std::vector<double> result(count);
    for (std::size_t i = 0; i < count; ++i) result[i] = (*this)[i].number();
    return result;
}

void Value::check_object() const {
    if (!json_->is_object()) wrong_type("an object");
}

std::optional<Value> Value::find(std::string_view key) const {
    check_object();
    const auto found = json_->find(key);
    if (found == json_->end()) return std::nullopt;
    return Value(*found, pointer_ + '/' + escaped(key), *diagnostics_);
}

Value Value::required(std::string_view key) const {
    std::optional<Value> found = find(key);
    if (!found) error("has no " + in_quotes(key) + ", which glTF demands");
    return *std::move(found);
}

std::vector<std::string> Value::keys() const {
    check_object();
    std::vector<std::string> result;
    for (const auto& [key, value] : json_->items()) result.push_back(key);
    return result;
}

double Value::number(std::string_view key, double otherwise, double least, double most) const {
    const std::optional<Value> found = find(key);
    return found ? found->number(least, most) : otherwise;
}

std::uint64_t Value::whole(std::string_view key, std::uint64_t otherwise) const {
    const std::optional<Value> found = find(key);
    return found ? found->whole() : otherwise;
}

std::string Value::text(std::string_view key, std::string_view otherwise) const {
    const std::optional<Value> found = find(key);
    return found ? found->text() : std::string(otherwise);
}

bool Value::boolean(std::string_view key, bool otherwise) const {
    const std::optional<Value> found = find(key);
    return found ? found->boolean() : otherwise;
}

Vec3f Value::vec3(std::string_view key, Vec3f otherwise) const {
    const std::optional<Value> found = find(key);
    if (!found) return otherwise;
    const std::vector<double> v = found->numbers(3);
    return Vec3f(Vec3d(v[0], v[1], v[2]));
}

Vec3f Value::color(std::string_view key, Vec3f otherwise) const {
    const Vec3f c = vec3(key, otherwise);
    if (!(c.x >= 0 && c.y >= 0 && c.z >= 0)) required(key).error("a colour with a negative component");
    return c;
}

std::vector<Value> Value::elements(std::string_view key) const {
    std::vector<Value> result;
    if (const std::optional<Value> found = find(key)) {
        const std::size_t count = found->size();
        result.reserve(count);
        for (std::size_t i = 0; i < count; ++i) result.push_back((*found)[i]);
    }
    return result;
}

std::optional<Value> Value::extension(std::string_view name) const {
    const std::optional<Value> all = find("extensions");
    return all ? all->find(name) : std::nullopt;
}

} // namespace montelux::gltf
