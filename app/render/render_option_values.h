// Values of the render command's options, read from their texts; UsageError says what is expected.
#pragma once

#include "app/render/render_options.h"
#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace montelux::app {

// Healthy ranks may be silent for a second.
double parse_rank_timeout(const std::string& option, const std::string& s);
bool parse_on_off(const std::string& option, const std::string& s);
LayerSet parse_layer_list(const std::string& option, const std::string& s);
bool parse_space(const std::string& option, const std::string& s);
LightGrouping parse_light_grouping(const std::string& option, const std::string& s);
Slice parse_slice(const std::string& option, const std::string& s);
std::pair<int, int> parse_resolution(const std::string& option, const std::string& s);
std::array<double, 4> parse_crop(const std::string& option, const std::string& s);
// Of --merging: empty: off; 0: auto.
std::optional<float> parse_merging(const std::string& option, const std::string& s);
SampleAddress parse_sample(const std::string& option, const std::string& s);
RenderOptions::Shutter parse_shutter(const std::string& option, const std::string& s);
std::vector<std::uint32_t> read_frames(const std::string& option, const std::string& s);
Orbit read_orbit(const std::string& option, const std::string& s);
StudioSettings::Background read_background(const std::string& option, const std::string& s);

} // namespace montelux::app
