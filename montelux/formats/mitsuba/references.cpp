#include "montelux/formats/mitsuba/references.h"

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <utility>

#include "montelux/mc/math/nearest_name.h"
#include "montelux/scene/build/quoted.h"

namespace montelux::mitsuba {
namespace {

constexpr std::size_t max_reference_depth = 100;

} // namespace

void References::define(const std::string& id, std::size_t object, const Place& place) {
    const auto [known, is_new] = objects_.emplace(id, object);
    if (!is_new)
        place.error("the id " + in_quotes(id) + " is already used at " +
                    graph_.diagnostics.describe(graph_.objects[known->second].at));
}

void References::define_alias(const std::string& id, const std::string& alias, const Place& place) {
    const auto source = objects_.find(id);
    if (source == objects_.end()) place.error("there is no object " + in_quotes(id) + " before this alias");
    define(alias, source->second, place);
}

void References::add(std::size_t object, std::size_t property, std::string id) {
    open_.push_back({object, property, std::move(id)});
}

void References::resolve() const {
    for (const Open& open : open_) {
        Property& property = graph_.objects[open.object].properties[open.property];
        const auto found = objects_.find(open.id);
        if (found == objects_.end()) {
            std::vector<std::string_view> names;
            for (const auto& [id, object] : objects_) names.emplace_back(id);
            Place(graph_.diagnostics, property.at)
                .error("there is no object " + in_quotes(open.id) + did_you_mean(open.id, names));
        }
        property.value = ObjectIndex{found->second};
    }
}

// Depth first, without recursion: a file may chain many objects by references.
void References::check_circles() const {
    enum class State : std::uint8_t { fresh, open, done };
    struct Visit {
        std::size_t object, next_property;
    };
    std::vector<State> states(graph_.objects.size(), State::fresh);
    std::vector<std::size_t> heights(graph_.objects.size(), 0);
    std::vector<Visit> path;
    for (std::size_t root = 0; root < graph_.objects.size(); ++root) {
        if (states[root] != State::fresh) continue;
        states[root] = State::open;
        path.push_back({root, 0});
        while (!path.empty()) {
            Visit& visit = path.back();
            const std::vector<Property>& properties = graph_.objects[visit.object].properties;
            if (visit.next_property == properties.size()) {
                states[visit.object] = State::done;
                const std::size_t height = heights[visit.object] + 1;
                path.pop_back();
                if (!path.empty())
                    heights[path.back().object] = std::max(heights[path.back().object], height);
                continue;
            }
            const Property& property = properties[visit.next_property++];
            const auto* child = std::get_if<ObjectIndex>(&property.value);
            if (child == nullptr) continue;
            if (states[child->value] == State::open)
                Place(graph_.diagnostics, property.at)
                    .error("references form a circle through " + in_quotes(graph_.objects[child->value].id));
            if (states[child->value] == State::done)
                heights[visit.object] = std::max(heights[visit.object], heights[child->value] + 1);
            if (heights[visit.object] > max_reference_depth || path.size() > max_reference_depth)
                Place(graph_.diagnostics, property.at)
                    .error("objects contain one another more than " + std::to_string(max_reference_depth) +
                           " levels deep");
            if (states[child->value] == State::fresh) {
                states[child->value] = State::open;
                path.push_back({child->value, 0});
            }
        }
    }
}

} // namespace montelux::mitsuba
