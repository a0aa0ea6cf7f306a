// References: the ids of a scene's objects, and what refers to them.
#pragma once

#include <cstddef>
#include <string>
#include <unordered_map>
#include <vector>

#include "montelux/formats/mitsuba/object.h"
#include "montelux/formats/mitsuba/scene_graph.h"
#include "montelux/formats/mitsuba/xml_values.h"

namespace montelux::mitsuba {

// References may come before their objects. Errors name the place of the reference.
class References {
  public:
    // The graph must outlive it.
    explicit References(SceneGraph& graph) : graph_(graph) {}

    // An Error if the id is taken, or for an alias of nothing.
    void define(const std::string& id, std::size_t object, const Place& place);
    void define_alias(const std::string& id, const std::string& alias, const Place& place);
    // The property of that number is, or will be, a reference to the id.
    void add(std::size_t object, std::size_t property, std::string id);

    // When all objects are known. An Error for an id without an object.
    void resolve() const;
    // An Error if resolved references form a circle, or chains of more than 100.
    void check_circles() const;

  private:
    struct Open {
        std::size_t object, property;
        std::string id;
    };

    SceneGraph& graph_;
    std::unordered_map<std::string, std::size_t> objects_;
    std::vector<Open> open_;
};

} // namespace montelux::mitsuba
