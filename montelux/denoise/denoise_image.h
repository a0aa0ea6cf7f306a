// Denoising a picture with layers: the result becomes further layers, and nothing is replaced.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "montelux/denoise/denoiser.h"
#include "montelux/image/image.h"
#include "montelux/image/image_write.h"

namespace montelux {

struct DenoiseReport {
    std::string guides;                         // "albedo and normal", "albedo", or empty
    std::uint64_t not_finite = 0, negative = 0; // as in DenoiserOutput
};

// Denoises R, G, B with the guides albedo.R, G, B and N.X, Y, Z where the picture has them, and adds the
// layers denoised.R, G, B (or overwrites those of an earlier time) and the attributes `denoiser` and
// `denoiserGuides`. The image becomes 32-bit linear. Throws Error on a picture without R, G, B and as
// Denoiser::denoise does; then the image is as it was.
DenoiseReport denoise_image(const Denoiser& denoiser, Image& image);

// The denoised layers as the R, G, B of a picture of its own, with all attributes: what formats without
// layers can hold. Throws Error where there are none.
Image denoised_picture(const Image& image);

// write_image: to EXR every layer, to other formats the denoised picture where there is one.
void write_picture(const std::filesystem::path& path, const Image& image, const WriteOptions& options = {});

} // namespace montelux
