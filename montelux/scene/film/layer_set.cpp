#include "montelux/scene/film/layer_set.h"

#include <algorithm>
#include <array>
#include <vector>

#include "montelux/mc/math/error.h"
#include "montelux/mc/math/nearest_name.h"

namespace montelux {
namespace {

constexpr std::array<std::string_view, 23> names_of_layers{"mean",
                                                           "error",
                                                           "skewness",
                                                           "samples",
                                                           "replicates",
                                                           "outlier",
                                                           "warning",
                                                           "albedo",
                                                           "normal",
                                                           "depth",
                                                           "variance",
                                                           "relative-variance",
                                                           "geometric-normal",
                                                           "position",
                                                           "uv",
                                                           "depth-slopes",
                                                           "motion",
                                                           "alpha",
                                                           "direct",
                                                           "indirect",
                                                           "light-groups",
                                                           "shape",
                                                           "material"};

} // namespace

std::span<const std::string_view> layer_names() { return names_of_layers; }

LayerSet parse_layers(std::string_view list) {
    LayerSet set;
    for (std::size_t begin = 0; begin <= list.size();) {
        const std::size_t end = std::min(list.find(',', begin), list.size());
        const std::string_view name = list.substr(begin, end - begin);
        begin = end + 1;
        if (name == "default") {
            set.add(LayerSet::standard());
            continue;
        }
        if (name == "gbuffer") {
            set.add(LayerSet::gbuffer());
            continue;
        }
        const auto* const found = std::ranges::find(names_of_layers, name);
        if (found == names_of_layers.end()) {
            std::vector<std::string_view> known{"default", "gbuffer"};
            known.insert(known.end(), names_of_layers.begin(), names_of_layers.end());
            std::string message = "there is no layer '" + std::string(name) + "'" +
                                  did_you_mean(name, known) + "; expected a list of";
            for (const std::string_view k : known)
                message += (k == known.front() ? " " : ", ") + std::string(k);
            throw Error(message);
        }
        set.add(static_cast<Layer>(found - names_of_layers.begin()));
    }
    return set;
}

std::string text_of(LayerSet layers) {
    std::string text;
    for (std::size_t i = 0; i < names_of_layers.size(); ++i)
        if (layers.has(static_cast<Layer>(i)))
            text += (text.empty() ? "" : ",") + std::string(names_of_layers[i]);
    return text;
}

} // namespace montelux
