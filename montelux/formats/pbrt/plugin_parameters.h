// The names of all parameters that pbrt-v4's plugins have, by kind of plugin: what an Attribute may give.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

namespace montelux::pbrt {

// What an Attribute directive can be for.
enum class PluginKind : std::uint8_t { shape, light, material, medium, texture };
inline constexpr std::array<std::string_view, 5> plugin_kind_names = {"shape", "light", "material", "medium",
                                                                      "texture"};

// Names that fit at least one plugin of the kind, those included that Montelux does not have yet; area
// lights count as lights. In alphabetical order, capitals first. After the plugins' sources (pbrt-v4,
// functions Create of shapes.cpp, lights.cpp, materials.cpp, media.cpp, textures.cpp).
std::span<const std::string_view> parameter_names(PluginKind kind);
bool has_parameter(PluginKind kind, std::string_view name);

} // namespace montelux::pbrt
