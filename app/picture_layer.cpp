#include "app/picture_layer.h"

#include "app/joined.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <string_view>
#include <vector>

#include "montelux/mc/math/error.h"
#include "montelux/mc/math/nearest_name.h"

namespace montelux::app {
namespace {

struct LayerName {
    std::string_view name, channels; // what the names of its channels begin with
    LayerValues values = LayerValues::light;
};

// Layers whose channels have another name.
constexpr std::array<LayerName, 7> other_names = {{{"error", "stderr"},
                                                   {"normal", "N", LayerValues::directions},
                                                   {"geometric-normal", "Ng", LayerValues::directions},
                                                   {"position", "P"},
                                                   {"relative-variance", "relativeVariance"},
                                                   {"alpha", "A"},
                                                   {"depth", "depth.Z", LayerValues::depths}}};

// The channels of a layer in the order in which they are shown; empty if there are none.
std::vector<std::string> channels_of(const Image& image, const std::string& prefix) {
    if (prefix.empty()) {
        std::vector<std::string> names;
        for (const int c : image.color_channels())
            names.push_back(image.channel_names()[static_cast<std::size_t>(c)]);
        return names;
    }
    if (image.find_channel(prefix)) return {prefix};
    for (const std::string_view axes : {"RGB", "XYZ"}) {
        std::vector<std::string> names;
        for (const char axis : axes) names.push_back(prefix + "." + axis);
        if (std::ranges::all_of(names,
                                [&](const std::string& n) { return image.find_channel(n).has_value(); }))
            return names;
    }
    for (const char* axis : {".Y", ".Z"})
        if (image.find_channel(prefix + axis)) return {prefix + axis};
    return {};
}

std::string name_of_prefix(std::string_view prefix) {
    for (const LayerName& l : other_names)
        if (l.channels == prefix) return std::string(l.name);
    return std::string(prefix);
}

std::vector<std::string> layers_of(const Image& image) {
    std::vector<std::string> layers;
    if (!image.color_channels().empty()) layers.emplace_back("mean");
    for (const std::string& channel : image.channel_names()) {
        if (channel == "R" || channel == "G" || channel == "B" || channel == "Y") continue;
        const std::size_t dot = channel.rfind('.');
        const std::string prefix =
            dot == std::string::npos || channel == "depth.Z" ? channel : channel.substr(0, dot);
        if (channels_of(image, prefix).empty()) continue;
        const std::string name = name_of_prefix(prefix);
        if (std::ranges::find(layers, name) == layers.end()) layers.push_back(name);
    }
    return layers;
}

} // namespace

PictureLayer layer_of(const Image& image, const std::string& name, const std::string& file) {
    std::string prefix = name == "mean" ? "" : name;
    PictureLayer layer;
    for (const LayerName& l : other_names)
        if (l.name == name || l.channels == name) {
            prefix = l.channels;
            layer.values = l.values;
        }
    while (prefix.ends_with('.')) prefix.pop_back();
    const std::vector<std::string> channels = channels_of(image, prefix);
    if (channels.empty()) {
        const std::vector<std::string> known = layers_of(image);
        const std::vector<std::string_view> views(known.begin(), known.end());
        throw Error(file, "there is no layer '" + name + "'" + did_you_mean(name, views) + "; there are " +
                              joined(views));
    }
    const Image selected = image.select(channels).to_linear_f32();
    const std::vector<std::string> names =
        channels.size() == 3 ? std::vector<std::string>{"R", "G", "B"} : std::vector<std::string>{"Y"};
    layer.image = Image(image.width(), image.height(), names);
    std::ranges::copy(selected.f32(), layer.image.f32().begin());
    layer.image.attributes() = image.attributes();
    return layer;
}

void scale_for_screen(PictureLayer& layer) {
    const std::span<float> values = layer.image.f32();
    if (layer.values == LayerValues::directions)
        for (float& v : values) v = (v + 1) / 2;
    if (layer.values != LayerValues::depths) return;
    const auto is_surface = [](float depth) { return depth > 0 && std::isfinite(depth); };
    float nearest = std::numeric_limits<float>::infinity(), farthest = 0;
    for (const float depth : values)
        if (is_surface(depth)) {
            nearest = std::min(nearest, depth);
            farthest = std::max(farthest, depth);
        }
    const float range = farthest - nearest;
    for (float& v : values) v = !is_surface(v) ? 0 : range > 0 ? (farthest - v) / range : 1;
}

} // namespace montelux::app
