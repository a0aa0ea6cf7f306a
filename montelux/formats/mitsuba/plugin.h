// Plugin: an object of a Mitsuba scene as its reader sees it: properties by name and type, each read or reported.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "montelux/formats/mitsuba/scene_graph.h"
#include "montelux/mc/math/transform.h"

namespace montelux::mitsuba {

// Refers to a graph that must outlive it. Readers throw Error "file:line:column: sentence" for properties of another
// type. Copies share nothing: what a copy has read counts for the copy alone.
class Plugin {
  public:
    Plugin(const SceneGraph& graph, std::size_t object)
        : graph_(&graph), index_(object), used_(graph.objects[object].properties.size()) {}

    const SceneGraph& graph() const { return *graph_; }
    // Equal for every reference to the same object: a key for what was made of it. Readers keep what they made, as a
    // file may refer to the same object any number of times.
    std::size_t index() const { return index_; }
    const std::string& kind() const { return object().kind; }
    const std::string& type() const { return object().type; }
    const std::string& id() const { return object().id; }
    SourceLocation at() const { return object().at; }

    // "the bsdf 'plastic'"
    std::string describe() const;
    [[noreturn]] void error(std::string_view sentence) const { graph_->diagnostics.error(at(), sentence); }
    void warn(std::string_view sentence) const { graph_->diagnostics.warn(at(), sentence); }
    // For a type that the reader does not read: not supported, and why, or no plugin of Mitsuba.
    [[noreturn]] void refuse() const;

    bool has(std::string_view name) const;
    // The property whatever its type is, marked as read; null without it.
    const Property* find(std::string_view name);
    // Values; `otherwise` without the property.
    bool flag(std::string_view name, bool otherwise);
    std::int64_t integer(std::string_view name, std::int64_t otherwise,
                         std::int64_t least = std::numeric_limits<std::int64_t>::min(),
                         std::int64_t most = std::numeric_limits<std::int64_t>::max());
    double number(std::string_view name, double otherwise, double least = -std::numeric_limits<double>::max(),
                  double most = std::numeric_limits<double>::max());
    std::string text(std::string_view name, std::string_view otherwise);
    // One of `names`.
    std::string choice(std::string_view name, std::string_view otherwise,
                       std::initializer_list<std::string_view> names);
    Vec3d vector(std::string_view name, Vec3d otherwise);
    // The identity without it. An Error for a matrix without an inverse.
    Transform transform(std::string_view name);
    // The path of the file that a property names; an Error without it or where the file is missing.
    std::filesystem::path file(std::string_view name);

    // Objects within of one kind, named or not, in the order of the file, marked as read.
    std::vector<Plugin> children(std::string_view kind);
    // The only one of them; empty without it, an Error for several.
    std::optional<Plugin> child(std::string_view kind);
    // The object under that name; empty where the property is missing or no object.
    std::optional<Plugin> object(std::string_view name);

    // A property that has no effect here: a warning with the reason if it is given.
    void ignore(std::string_view name, std::string_view why);
    // The same without a warning, where nothing is lost.
    void skip(std::string_view name) { find(name); }
    // Warns about each property that was not read, with the nearest name that was asked for.
    void finish();

  private:
    const Object& object() const { return graph_->objects[index_]; }
    const Property* look_up(std::string_view name) const;
    [[noreturn]] void wrong_type(const Property& property, std::string_view expected) const;

    const SceneGraph* graph_;
    std::size_t index_;
    std::vector<bool> used_;
    std::vector<std::string> asked_; // names of properties, for messages
};

// "a number", "an object": what a property holds.
std::string_view type_name(const PropertyValue& value);

} // namespace montelux::mitsuba
