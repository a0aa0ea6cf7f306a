// What the commands render and denoise print about a denoised picture.
#pragma once

#include <string>

#include "montelux/denoise/denoise_image.h"

namespace montelux::app {

// "denoised by ... (...)"; warns of pixels that were replaced unless `quiet`.
std::string describe(const Denoiser& denoiser, const DenoiseReport& report, bool quiet);

} // namespace montelux::app
