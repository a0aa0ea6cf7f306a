// ParameterReader: typed access to the parameters of one plugin; reports those that no getter read.
#pragma once

#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "montelux/formats/pbrt/parameter.h"
#include "montelux/mc/math/vec.h"

namespace montelux::pbrt {

// Every getter names a parameter and returns its value, or nothing. A parameter of the directive with another
// type is an error ("parameter 'fov' has type integer; expected float"), and so is a wrong number of values.
// A default of another type is skipped where another default fits: it may be meant for another plugin.
class ParameterReader {
  public:
    // `plugin` names it in messages, such as "camera 'perspective'"; `at` is the place of its directive.
    ParameterReader(const ParameterList& list, std::string plugin, Location at, Diagnostics& diagnostics);

    std::optional<float> number(std::string_view name);
    // The number in a parameter that `any` returned.
    float number_of(const Parameter& p) const;
    std::optional<int> integer(std::string_view name);
    std::optional<bool> boolean(std::string_view name);
    std::optional<std::string> string(std::string_view name);
    std::optional<Vec3f> point3(std::string_view name) { return triple(name, ParameterType::point3); }
    std::optional<Vec3f> vector3(std::string_view name) { return triple(name, ParameterType::vector3); }

    // All values of a parameter; empty when it is not there. The count is a multiple of `group`.
    std::span<const float> numbers(std::string_view name, ParameterType type, std::size_t group = 1);
    std::vector<Vec3f> triples(std::string_view name, ParameterType type);
    std::span<const std::int32_t> integers(std::string_view name);

    // The parameter, if present with one of these types. Warns if it is given with several of them.
    const Parameter* any(std::string_view name, std::initializer_list<ParameterType> types);
    // For parameters without effect here: marks them as known; returns whether one was given.
    const Parameter* ignored(std::string_view name);

    float number(std::string_view name, float otherwise) { return number(name).value_or(otherwise); }
    int integer(std::string_view name, int otherwise) { return integer(name).value_or(otherwise); }
    bool boolean(std::string_view name, bool otherwise) { return boolean(name).value_or(otherwise); }
    std::string string(std::string_view name, std::string_view otherwise) {
        return string(name).value_or(std::string(otherwise));
    }
    // A string of a closed set; an error names the nearest valid one.
    std::string_view choice(std::string_view name, std::initializer_list<std::string_view> choices,
                            std::string_view otherwise);

    // Warns about parameters that no getter has read, once for each plugin and name.
    void finish();

    Location at() const { return at_; }
    // The place of the parameter; of the directive if it is absent.
    Location at(std::string_view name) const;
    const std::string& plugin() const { return plugin_; }
    Diagnostics& diagnostics() { return diagnostics_; }
    [[noreturn]] void error(std::string_view sentence) const { diagnostics_.error(at_, sentence); }
    [[noreturn]] void error(std::string_view name, std::string_view sentence) const {
        diagnostics_.error(at(name), sentence);
    }

  private:
    std::optional<Vec3f> triple(std::string_view name, ParameterType type);
    const Parameter* one(std::string_view name, ParameterType type, std::size_t count = 1);
    void check_count(const Parameter& p, std::size_t count) const;
    [[noreturn]] void wrong_type(const Parameter& p, std::span<const ParameterType> types) const;
    void know(std::string_view name);

    const ParameterList& list_;
    std::string plugin_;
    Location at_;
    Diagnostics& diagnostics_;
    std::vector<std::string_view> known_;
};

} // namespace montelux::pbrt
