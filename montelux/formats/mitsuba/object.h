// Object: an element of a Mitsuba scene with its properties, before a reader gives it a meaning.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "montelux/mc/math/transform.h"
#include "montelux/mc/math/vec.h"
#include "montelux/scene/build/build_messages.h"

namespace montelux::mitsuba {

struct RgbValue {
    Vec3d rgb; // as written: linear sRGB
};

struct SpectrumValue {
    std::vector<double> wavelengths; // nm, ascending; empty: the same value everywhere
    std::vector<double> values;
};

// An object within, by its index into SceneGraph::objects.
struct ObjectIndex {
    std::size_t value = 0;
};

using PropertyValue = std::variant<bool, std::int64_t, double, std::string, Vec3d, RgbValue, SpectrumValue,
                                   Matrix4, ObjectIndex>;

struct Property {
    std::string name{}; // empty: an object without a name
    PropertyValue value{};
    SourceLocation at{};
};

struct Object {
    std::string kind{}; // the element: "shape", "bsdf"; <spectrum type="..."> is a "texture"
    std::string type{}; // the plugin: "sphere"; "scene" for the root
    std::string id{};   // may be empty
    SourceLocation at{};
    std::vector<Property> properties{}; // in the order of the file
};

} // namespace montelux::mitsuba
