// ViewLayer: what a viewer can show of a picture, one layer at a time.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace montelux {

struct ViewLayer {
    // In the words of docs/view-protocol.md: color, error, ratio, vector, scalar, id, count, z.
    std::string name, kind;
    int channels = 3;
    bool exact = false;            // sent as 32-bit floats, else as 16-bit ones
    std::vector<std::string> of{}; // channels of the picture; empty for the layers that LivePicture computes
};

// The layers that a LivePicture computes: they come first, in this order, the last two with a reference only.
enum class LiveLayer : std::size_t { mean, error, relative_error, samples, reference, z };

// Messages count layers in a byte.
inline constexpr std::size_t most_view_layers = 256;

// Those, and the layers of a picture with these channels (Film::develop), of which the last ones may be left out.
std::vector<ViewLayer> view_layers(std::span<const std::string> channels, bool with_reference);

// The layer of a light group.
std::string light_layer(std::string_view group);

} // namespace montelux
