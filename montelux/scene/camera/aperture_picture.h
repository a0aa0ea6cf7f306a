// AperturePicture: the transmittance of an aperture stop as a picture.
#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "montelux/image/image.h"
#include "montelux/mc/math/vec.h"

namespace montelux {

// The picture covers the square around the round stop; its mean is that of the disc, pi/4, so that a picture does not
// change the exposure: values may exceed 1. Row 0 is the top (+y of camera space), column 0 the left (-x).
struct AperturePicture {
    int width = 0, height = 0;
    std::vector<float> values;

    // Bilinear between the centres of pixels; x and y over the stop's radius. 0 outside the square.
    float at(double x, double y) const;

    bool operator==(const AperturePicture&) const = default;
};

// Those of pbrt-v4: gaussian (blurred edge), square (half as wide as the stop), pentagon, star. Empty for other names.
std::optional<AperturePicture> find_aperture(std::string_view name);
std::span<const std::string_view> aperture_names();
// The mean of the linear colours. Throws Error where the picture is black or has negative or non-finite values.
AperturePicture aperture_of(const Image& picture);

} // namespace montelux
