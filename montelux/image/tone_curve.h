// Tone curve for previews: exposure, then the sRGB curve, clipped to [0, 1].
#pragma once

#include "montelux/image/image.h"

namespace montelux {

struct ToneCurve {
    // In stops: light is multiplied by 2^exposure, and 1 becomes white.
    float exposure = 0;

    // Linear light to an encoded value in [0, 1]; NaN and negative light give 0.
    float operator()(float light) const;
};

// The exposure that brings the log-average luminance of the finite positive pixels to `key`
// (Reinhard et al. 2002, "Photographic Tone Reproduction for Digital Images", Eq. 1-2, without its curve).
// 0 for an image without light. Luminance is 0.2126 R + 0.7152 G + 0.0722 B, or Y.
float automatic_exposure(const Image& image, float key = 0.18f);

// The colour channels (and A, which is not curved) as an 8-bit or 16-bit sRGB image.
// Throws Error when `bits` is neither 8 nor 16 or there are no colour channels.
Image apply_tone_curve(const Image& image, const ToneCurve& curve, int bits = 8);

} // namespace montelux
