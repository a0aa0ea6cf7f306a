// The names of all parameters of pbrt-v4's plugins, by kind of plugin: those that an Attribute may set.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

namespace montelux::pbrt {

// The kinds of plugins that an Attribute directive addresses.
enum class PluginKind : std::uint8_t { shape, light, material, medium, texture };
inline constexpr std::array<std::string_view, 5> plugin_kind_names = {"shape", "light", "material", "medium",
                                                                      "texture"};

// Names that fit at least one plugin of the kind, including plugins that are not supported yet; area lights
// count as lights. In alphabetical order, capitals first. Source: the Create functions of pbrt-v4's
// shapes.cpp, lights.cpp, materials.cpp, media.cpp, textures.cpp.
std::span<const std::string_view> parameter_names(PluginKind kind);
bool has_parameter(PluginKind kind, std::string_view name);

} // namespace montelux::pbrt
