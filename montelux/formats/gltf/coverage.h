// What is read of glTF 2.0: the table behind `montelux formats gltf`, and which required extensions are refused.
#pragma once

#include <span>
#include <string_view>

#include "montelux/formats/support.h"

namespace montelux::gltf {

struct FeatureCoverage {
    std::string_view area;    // "mesh"
    std::string_view feature; // as in glTF, or the name of an extension
    Support support = Support::full;
    std::string_view note{}; // what is missing or happens instead
};

// By area.
std::span<const FeatureCoverage> feature_coverage();
// Null for a name that the table does not have.
const FeatureCoverage* find_feature(std::string_view name);
// Whether a scene that requires the extension can be shown.
bool is_supported_extension(std::string_view name);

} // namespace montelux::gltf
