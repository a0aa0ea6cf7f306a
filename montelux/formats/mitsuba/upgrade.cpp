#include "montelux/formats/mitsuba/upgrade.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <optional>

#include "montelux/scene/build/quoted.h"

namespace montelux::mitsuba {
namespace {

bool is_lower(char c) { return std::islower(static_cast<unsigned char>(c)) != 0; }
bool is_upper(char c) { return std::isupper(static_cast<unsigned char>(c)) != 0; }
char lower(char c) { return static_cast<char>(std::tolower(static_cast<unsigned char>(c))); }

// Takes a number out of the object.
std::optional<double> take(Object& object, std::string_view name) {
    const auto found = std::ranges::find(object.properties, name, &Property::name);
    if (found == object.properties.end()) return std::nullopt;
    const auto* number = std::get_if<double>(&found->value);
    if (number == nullptr) return std::nullopt; // the reader says that there is no such property
    const double value = *number;
    object.properties.erase(found);
    return value;
}

} // namespace

FormatVersion version_of(std::string_view text, const Place& place) {
    int numbers[3] = {0, 0, 0};
    const char *at = text.data(), *end = text.data() + text.size();
    for (int i = 0; i < 3; ++i) {
        const auto [next, error] = std::from_chars(at, end, numbers[i]);
        if (error != std::errc() || numbers[i] < 0)
            place.error("the version is " + in_quotes(text) + "; expected one such as 3.0.0");
        at = next;
        if (at == end) break;
        if (*at != '.' || i == 2)
            place.error("the version is " + in_quotes(text) + "; expected one such as 3.0.0");
        ++at;
    }
    if (numbers[0] > 3)
        place.error("version " + in_quotes(text) + " of Mitsuba's format; versions up to 3 are read");
    return {numbers[0]};
}

std::string to_snake_case(std::string_view name) {
    std::string result;
    for (std::size_t i = 0; i < name.size(); ++i) {
        if (i > 0 && is_lower(name[i - 1]) && is_upper(name[i])) {
            result += '_';
            for (; i < name.size() && is_upper(name[i]); ++i) result += lower(name[i]);
            --i;
        } else {
            result += name[i];
        }
    }
    return result;
}

void upgrade(Object& object) {
    if (object.kind == "bsdf" && object.type == "diffuse")
        for (Property& p : object.properties)
            if (p.name == "diffuse_reflectance") p.name = "reflectance";
    if (object.kind != "texture") return;
    constexpr std::array<std::string_view, 4> names{"uoffset", "voffset", "uscale", "vscale"};
    std::array<std::optional<double>, 4> values;
    for (std::size_t i = 0; i < names.size(); ++i) values[i] = take(object, names[i]);
    if (std::ranges::none_of(values, [](const auto& v) { return v.has_value(); })) return;
    Matrix4 scale, move;
    scale.m[0][0] = values[2].value_or(1);
    scale.m[1][1] = values[3].value_or(1);
    move.m[0][3] = values[0].value_or(0);
    move.m[1][3] = values[1].value_or(0);
    object.properties.push_back({"to_uv", scale * move, object.at});
}

} // namespace montelux::mitsuba
