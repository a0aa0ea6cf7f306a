// Animation: the values of a channel's target at a time.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "montelux/formats/gltf/document.h"

namespace montelux::gltf {

// A channel of an animation with a node for its target. Refers to its document.
struct Channel {
    Value source; // the channel
    Value sampler;
    std::size_t node = 0;
    std::string_view path; // "translation", "rotation", "scale" or "weights"
};

// Channels of all animations, the first one of each target; warns of others for the same.
std::vector<Channel> channels_of(const Document& document);

// The time of their last key, seconds; 0 without channels.
double end_of(Document& document, const std::vector<Channel>& channels);

// The target's numbers at a time (seconds): 3, 4 (a unit quaternion x y z w), 3, or `weight_count`. Before the first key
// and after the last one it rests. glTF 2.0 specification, appendix C.
std::vector<double> value_at(Document& document, const Channel& channel, double time,
                             std::size_t weight_count);

} // namespace montelux::gltf
