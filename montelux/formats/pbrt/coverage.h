// Which plugins of pbrt-v4 are read, directive by directive: the table behind `montelux formats pbrt`.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "montelux/formats/support.h"

namespace montelux::pbrt {

struct PluginCoverage {
    std::string_view directive; // of the scene file
    std::string plugin;
    Support support = Support::full;
    std::string_view note{}; // what is missing or happens instead
};

// All plugins of pbrt-v4's file format, and those that Montelux adds, by directive.
std::span<const PluginCoverage> plugin_coverage();
// The plugins of a directive, whether they are supported or not.
std::span<const std::string_view> plugin_names(std::string_view directive);
bool is_plugin(std::string_view directive, std::string_view name);

// What an error about an unknown plugin of the directive adds: how to convert a file for pbrt-v3, or the nearest name.
std::string plugin_suggestion(std::string_view directive, std::string_view name);
inline constexpr std::string_view how_to_upgrade =
    ": the file is for pbrt-v3; 'pbrt --upgrade old.pbrt > new.pbrt' of pbrt-v4 converts it";

// "coateddiffuse" for the material CoatedDiffuse.
std::string material_type(std::string_view name);

} // namespace montelux::pbrt
