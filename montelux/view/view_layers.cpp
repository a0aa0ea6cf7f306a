#include "montelux/view/view_layers.h"

#include <algorithm>
#include <utility>

namespace montelux {

namespace {

constexpr std::string_view light_prefix = "light.";

// "light.key.R" is of the layer "light.key", "samples" of the layer "samples".
std::string_view layer_of(std::string_view channel) { return channel.substr(0, channel.rfind('.')); }
std::string_view component_of(std::string_view channel) {
    const std::size_t dot = channel.rfind('.');
    return dot == std::string_view::npos ? std::string_view() : channel.substr(dot + 1);
}

// Names of --layers for what EXR files abbreviate.
std::string_view full_name(std::string_view layer) {
    constexpr std::pair<std::string_view, std::string_view> names[]{
        {"N", "normal"}, {"Ng", "geometric-normal"}, {"P", "position"}, {"A", "alpha"}};
    for (const auto& [short_name, name] : names)
        if (layer == short_name) return name;
    return layer;
}

// A Cryptomatte is shown by the id that covers most of each pixel, the first channel of its first layer.
bool is_matte(std::string_view layer) { return layer.starts_with("Crypto"); }
bool is_first_matte(std::string_view layer) { return is_matte(layer) && layer.ends_with("00"); }

ViewLayer layer(std::string_view name, std::vector<std::string> channels) {
    ViewLayer made{std::string(full_name(name)), "scalar", static_cast<int>(channels.size()), true,
                   std::move(channels)};
    const std::string_view first = component_of(made.of.front());
    if (is_first_matte(name)) {
        made.of.resize(1);
        made.channels = 1;
        made.kind = "id";
    } else if (made.channels == 3 && first == "R") {
        const bool is_signed = name == "skewness";
        made.kind = is_signed ? "vector" : "color";
        made.exact = is_signed;
    } else if (made.channels == 3) {
        made.kind = "vector";
    }
    if (name.starts_with(light_prefix)) made.name = light_layer(name.substr(light_prefix.size()));
    return made;
}

} // namespace

std::string light_layer(std::string_view group) { return "light " + std::string(group); }

std::vector<ViewLayer> view_layers(std::span<const std::string> channels, bool with_reference) {
    std::vector<ViewLayer> layers{{"mean", "color"},
                                  {"error", "error", 1},
                                  {"relative error", "ratio", 1},
                                  {"samples", "count", 1, true}};
    if (with_reference) {
        layers.push_back({"reference", "color"});
        layers.push_back({"z", "z", 1});
    }
    for (std::size_t i = 0; i < channels.size();) {
        const std::string_view name = layer_of(channels[i]);
        std::size_t end = i + 1;
        while (end < channels.size() && !component_of(channels[i]).empty() && layer_of(channels[end]) == name)
            ++end;
        const bool is_live =
            component_of(channels[i]).empty() && channels[i].size() == 1 && name != "A"; // R, G, B
        const bool is_shown =
            !is_live && name != "stderr" && name != "samples" && (!is_matte(name) || is_first_matte(name));
        // Layers have one or three numbers; what has others (texture coordinates) shows each by itself.
        const std::vector<std::string> of(channels.begin() + static_cast<std::ptrdiff_t>(i),
                                          channels.begin() + static_cast<std::ptrdiff_t>(end));
        if (is_shown && (of.size() == 1 || of.size() == 3 || is_first_matte(name)))
            layers.push_back(layer(name, of));
        else if (is_shown)
            for (const std::string& channel : of) layers.push_back(layer(channel, {channel}));
        i = end;
    }
    if (layers.size() > most_view_layers) layers.resize(most_view_layers);
    return layers;
}

} // namespace montelux
