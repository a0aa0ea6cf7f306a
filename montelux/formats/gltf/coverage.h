// What is read of glTF 2.0: the table behind `montelux formats gltf`, and which required extensions are refused.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace montelux::gltf {

enum class Support : std::uint8_t {
    full,
    in_part, // the rest is ignored, with a warning where it is a loss
    none,    // ignored with a warning where it is optional, else an error
};

struct FeatureCoverage {
    std::string_view area;    // "mesh"
    std::string_view feature; // as in glTF, or the name of an extension
    Support support = Support::full;
    std::string_view note{}; // what is missing or happens instead
};

// By area.
std::span<const FeatureCoverage> feature_coverage();
// Whether a scene that requires the extension can be shown.
bool is_supported_extension(std::string_view name);

// "yes", "in part", "no"
std::string_view name_of(Support s);

} // namespace montelux::gltf
