// visible_error_share: in how many pixels of a picture the noise shows.
#pragma once

#include <optional>

#include "montelux/image/image.h"
#include "montelux/image/tone_curve.h"

namespace montelux {

// Whether a standard error changes the 8-bit code of a luminance under `curve` by at least 1, as the mean of both
// directions. Errors that are not finite do.
bool error_is_visible(double luminance, double error, const ToneCurve& curve);

// Share of the pixels whose standard error of luminance changes their 8-bit code under `curve` by at least 1, as the
// mean of both directions; all pixels whose error is not finite count. Empty for a picture without colour or without
// the layer "stderr.".
std::optional<double> visible_error_share(const Image& image, const ToneCurve& curve);

} // namespace montelux
