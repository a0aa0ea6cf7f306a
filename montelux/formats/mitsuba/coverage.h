// Which plugins of Mitsuba 3 are read: the table behind `montelux formats mitsuba`.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "montelux/formats/support.h"

namespace montelux::mitsuba {

struct PluginCoverage {
    std::string_view kind; // the element of the scene file
    std::string_view plugin;
    Support support = Support::full;
    std::string_view note{}; // what is missing or happens instead
};

// All plugins that Mitsuba 3.9 documents, by kind.
std::span<const PluginCoverage> plugin_coverage();
std::vector<std::string_view> plugin_names(std::string_view kind);
// Null for a plugin that Mitsuba does not document.
const PluginCoverage* find_plugin(std::string_view kind, std::string_view plugin);

} // namespace montelux::mitsuba
