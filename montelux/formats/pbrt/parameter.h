// "type name" [ values ]: the parameters that follow a directive of a pbrt scene file.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "montelux/formats/pbrt/plugin_parameters.h"
#include "montelux/formats/pbrt/tokenizer.h"

namespace montelux {
class RgbColorSpace;
}

namespace montelux::pbrt {

enum class ParameterType : std::uint8_t {
    floating, // "float"
    integer,
    point2,
    vector2,
    point3,
    vector3,
    normal,
    boolean, // "bool"
    string,
    texture, // the name of a texture
    rgb,
    spectrum, // a name, a file, or wavelengths with values
    blackbody,
};
std::string_view name_of(ParameterType type);

// Values are in the vector that fits the type: `numbers` for all floating types and for spectra given by
// values, `strings` for names; booleans are 0 or 1 in `integers`.
struct Parameter {
    ParameterType type = ParameterType::floating;
    std::string name;
    Location at;
    std::vector<float> numbers;
    std::vector<std::int32_t> integers;
    std::vector<std::string> strings;
    const RgbColorSpace* color_space = nullptr; // of RGB values: the one in force at the directive

    std::size_t value_count() const { return numbers.size() + integers.size() + strings.size(); }
};

// The values of Attribute directives, in the file's order, one of each name and type. Shared by all
// directives that they apply to.
using Defaults = std::shared_ptr<const std::vector<std::shared_ptr<const Parameter>>>;

// The parameters of one directive in the file's order, then the defaults. Of several with one name the
// directive's own win, and the last of each.
class ParameterList {
  public:
    ParameterList() = default;
    explicit ParameterList(std::vector<Parameter> own) : own_(std::move(own)) {}
    // `defaults` may be null.
    ParameterList(std::vector<Parameter> own, Defaults defaults, PluginKind kind)
        : own_(std::move(own)), defaults_(std::move(defaults)), kind_(kind) {}

    const std::vector<Parameter>& own() const { return own_; }
    // For plugins that take defaults.
    std::optional<PluginKind> kind() const { return kind_; }
    // Null when there is none with that name.
    const Parameter* find(std::string_view name) const;
    // The last default with that name and one of these types, or null.
    const Parameter* find_default(std::string_view name, std::span<const ParameterType> types) const;

  private:
    std::vector<Parameter> own_;
    Defaults defaults_;
    std::optional<PluginKind> kind_;
};

// Reads parameters up to the next word. Errors: an unknown type, a missing name, values of the wrong kind, an
// open bracket. Warns about repeated parameters.
std::vector<Parameter> read_parameters(Tokenizer& tokens, const RgbColorSpace& color_space,
                                       Diagnostics& diagnostics);

} // namespace montelux::pbrt
