#include "montelux/formats/studio_settings.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>

#include "montelux/image/color_encoding.h"

namespace montelux {
namespace {

// As many numbers as there are between commas; false for others.
bool parse_list(std::string_view text, std::span<double> numbers) {
    const char *at = text.data(), *end = text.data() + text.size();
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        const auto [stop, error] = std::from_chars(at, end, numbers[i]);
        const bool last = i + 1 == numbers.size();
        if (error != std::errc() || !std::isfinite(numbers[i])) return false;
        if (last) return stop == end;
        if (stop == end || *stop != ',') return false;
        at = stop + 1;
    }
    return true;
}

StudioSettings::Background srgb_background(double r, double g, double b) {
    const auto linear = [](double v) { return ColorEncoding::srgb().to_linear(static_cast<float>(v)); };
    return {.transparent = false, .color = {linear(r), linear(g), linear(b)}};
}

} // namespace

std::optional<Orbit> parse_orbit(std::string_view text) {
    std::array<double, 3> v{0, 0, 1};
    if (!parse_list(text, std::span(v).first(2)) && !parse_list(text, v)) return std::nullopt;
    if (std::abs(v[1]) > 90 || !(v[2] > 0)) return std::nullopt;
    return Orbit{v[0], v[1], v[2]};
}

std::optional<StudioSettings::Background> parse_background(std::string_view text) {
    if (text == "transparent") return StudioSettings::Background{.transparent = true, .color = {}};
    constexpr std::array<std::pair<std::string_view, double>, 4> greys{
        {{"black", 0}, {"white", 1}, {"grey", 0.5}, {"gray", 0.5}}};
    for (const auto& [name, value] : greys)
        if (text == name) return srgb_background(value, value, value);
    if (text.size() == 7 && text[0] == '#') {
        std::uint32_t hex = 0;
        const auto [stop, error] = std::from_chars(text.data() + 1, text.data() + 7, hex, 16);
        if (error != std::errc() || stop != text.data() + 7) return std::nullopt;
        return srgb_background((hex >> 16) / 255.0, (hex >> 8 & 255) / 255.0, (hex & 255) / 255.0);
    }
    std::array<double, 3> v{};
    constexpr double brightest = 1e6;
    if (!parse_list(text, v) || std::ranges::any_of(v, [](double x) { return x < 0 || x > brightest; }))
        return std::nullopt;
    return StudioSettings::Background{.transparent = false, .color = Vec3f(Vec3d{v[0], v[1], v[2]})};
}

} // namespace montelux
