// Cameras of a file by name or number: glTF and Mitsuba files may have several.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

namespace montelux {

// The camera with that name, or else with that number from 0; empty if there is none. Names may be empty.
std::optional<std::size_t> find_camera(std::span<const std::string> names, const std::string& asked);

// "there is no camera 'plam' (did you mean 'plan'?); expected 0 'front', 1 'plan'"
std::string no_such_camera(std::span<const std::string> names, const std::string& asked);

// "0 'front', 1 'plan'"
std::string numbered_names(std::span<const std::string> names);

} // namespace montelux
