#include "app/render/render_option_values.h"

#include "app/option_values.h"
#include "app/render/frame_list.h"
#include <charconv>
#include <optional>

namespace montelux::app {

double parse_rank_timeout(const std::string& option, const std::string& s) {
    const double seconds = parse_duration(option, s);
    if (!(seconds >= 2)) refuse(option, s, "a time of at least 2s is expected, for example 10s or 2m");
    return seconds;
}

bool parse_on_off(const std::string& option, const std::string& s) {
    if (s != "on" && s != "off") refuse(option, s, "on or off is expected");
    return s == "on";
}

LayerSet parse_layer_list(const std::string& option, const std::string& s) {
    try {
        return parse_layers(s);
    } catch (const Error& e) {
        refuse(option, s, e.what());
    }
}

bool parse_space(const std::string& option, const std::string& s) {
    if (s != "world" && s != "camera") refuse(option, s, "world or camera is expected");
    return s == "camera";
}

LightGrouping parse_light_grouping(const std::string& option, const std::string& s) {
    if (s != "light" && s != "kind") refuse(option, s, "light or kind is expected");
    return s == "kind" ? LightGrouping::kind : LightGrouping::light;
}

Slice parse_slice(const std::string& option, const std::string& s) {
    std::uint32_t k = 0, n = 0;
    const char* end = s.data() + s.size();
    auto [p, e] = std::from_chars(s.data(), end, k);
    if (e == std::errc() && p != end && *p == '/') {
        auto [q, f] = std::from_chars(p + 1, end, n);
        if (f == std::errc() && q == end && k >= 1 && k <= n && n <= 1'000'000) return {k - 1, n};
    }
    refuse(option, s, "K/N is expected with K from 1 to N, for example 3/16");
}

std::pair<int, int> parse_resolution(const std::string& option, const std::string& s) {
    int w = 0, h = 0;
    const char* end = s.data() + s.size();
    auto [p, e] = std::from_chars(s.data(), end, w);
    if (e == std::errc() && p != end && (*p == 'x' || *p == 'X')) {
        auto [q, f] = std::from_chars(p + 1, end, h);
        if (f == std::errc() && q == end && w > 0 && h > 0 && w <= Image::max_dimension &&
            h <= Image::max_dimension)
            return {w, h};
    }
    refuse(option, s,
           "WIDTHxHEIGHT in pixels is expected, each from 1 to " + std::to_string(Image::max_dimension) +
               ", for example 640x480");
}

std::array<double, 4> parse_crop(const std::string& option, const std::string& s) {
    std::array<double, 4> crop{};
    const char *at = s.data(), *end = s.data() + s.size();
    bool good = true;
    for (std::size_t i = 0; i < 4 && good; ++i) {
        auto [stop, error] = std::from_chars(at, end, crop[i]);
        good = error == std::errc() && crop[i] >= 0 && crop[i] <= 1 &&
               (i == 3 ? stop == end : stop != end && *stop == ',');
        at = stop + 1;
    }
    if (!good || !(crop[0] < crop[1]) || !(crop[2] < crop[3]))
        refuse(option, s,
               "x0,x1,y0,y1 is expected: fractions of the film from 0 to 1 with x0 < x1 and y0 < y1, for "
               "example 0.25,0.75,0,0.5");
    return crop;
}

std::optional<float> parse_merging(const std::string& option, const std::string& s) {
    if (s == "off") return std::nullopt;
    if (s == "auto") return 0.0f;
    double radius = 0;
    const auto [end, error] = std::from_chars(s.data(), s.data() + s.size(), radius);
    if (error != std::errc() || end != s.data() + s.size() || !(radius > 1e-30 && radius < 1e30))
        refuse(option, s, "off, auto or a radius above 0, in units of the scene, is expected");
    return static_cast<float>(radius);
}

SampleAddress parse_sample(const std::string& option, const std::string& s) {
    SampleAddress a;
    const char* end = s.data() + s.size();
    auto comma = [end](std::from_chars_result r) {
        return r.ec == std::errc() && r.ptr != end && *r.ptr == ',';
    };
    if (auto x = std::from_chars(s.data(), end, a.x); comma(x))
        if (auto y = std::from_chars(x.ptr + 1, end, a.y); comma(y))
            if (auto [stop, error] = std::from_chars(y.ptr + 1, end, a.index);
                error == std::errc() && stop == end)
                return a;
    refuse(
        option, s,
        "x,y,index is expected: column and row of a pixel and the number of one of its samples, all from 0 "
        "on, for example 320,240,7");
}

RenderOptions::Shutter parse_shutter(const std::string& option, const std::string& s) {
    const bool is_angle = s.ends_with("deg");
    RenderOptions::Shutter shutter{is_angle ? parse_not_negative(option, s.substr(0, s.size() - 3))
                                            : parse_duration(option, s),
                                   is_angle};
    if (is_angle && shutter.value > 360) refuse(option, s, "an angle from 0deg to 360deg is expected");
    return shutter;
}

std::vector<std::uint32_t> read_frames(const std::string& option, const std::string& s) {
    if (std::optional<std::vector<std::uint32_t>> frames = parse_frames(s)) return *std::move(frames);
    refuse(option, s,
           "frames from 1 to " + std::to_string(most_frames) +
               " are expected, for example 1-48, 1-48x2 (every second one) or 1,5,9");
}

Orbit read_orbit(const std::string& option, const std::string& s) {
    if (const std::optional<Orbit> orbit = parse_orbit(s)) return *orbit;
    refuse(option, s, "expected " + std::string(orbit_syntax));
}

StudioSettings::Background read_background(const std::string& option, const std::string& s) {
    if (const std::optional<StudioSettings::Background> background = parse_background(s)) return *background;
    refuse(option, s, "expected " + std::string(background_syntax));
}

} // namespace montelux::app
