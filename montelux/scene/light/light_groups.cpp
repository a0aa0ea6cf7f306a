#include "montelux/scene/light/light_groups.h"

#include <algorithm>
#include <map>

#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

constexpr std::size_t most_groups = 250, longest_name = 200;

std::string as_part_of_channel(std::string name) {
    name.resize(std::min(name.size(), longest_name));
    for (char& c : name)
        if (c == '.' || static_cast<unsigned char>(c) < 0x20) c = '_';
    return name;
}

} // namespace

LightGroups light_groups(const Scene& scene, LightGrouping grouping) {
    LightGroups groups;
    std::map<std::string, Index> known;
    const auto group = [&](const std::string& name) {
        const auto [at, fresh] = known.try_emplace(name, static_cast<Index>(groups.names.size()));
        if (!fresh) return at->second;
        if (groups.names.size() == most_groups)
            throw Error("light groups",
                        "more than " + std::to_string(most_groups) +
                            " groups of lights; group them by kind (--light-groups kind), or in the scene by "
                            "the parameter 'string group' of lights");
        groups.names.push_back(name);
        return at->second;
    };
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        std::string name;
        if (i < scene.light_groups.size()) name = as_part_of_channel(scene.light_groups[i]);
        if (name.empty()) {
            name = name_of(scene.lights[i]);
            std::ranges::replace(name, ' ', '-');
            if (grouping == LightGrouping::light) name += "-" + std::to_string(i);
        }
        groups.of_light.push_back(group(name));
    }
    if (!scene.media.empty()) groups.of_media = group("media");
    return groups;
}

} // namespace montelux
