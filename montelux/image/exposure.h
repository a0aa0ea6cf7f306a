// Exposure of pictures for screens: the one that suits a picture, and whether one would show anything.
#pragma once

#include "montelux/image/tone_curve.h"

namespace montelux {

// Bounds of an exposure, stops.
inline constexpr float least_exposure = -100, most_exposure = 100;

// The exposure that brings the log-average luminance of the finite positive pixels to `key`
// (Reinhard et al. 2002, "Photographic Tone Reproduction for Digital Images", Eq. 1-2, without its curve).
// 0 for an image without light. Luminance is 0.2126 R + 0.7152 G + 0.0722 B, or Y.
float automatic_exposure(const Image& image, float key = 0.18f);

// Shares of pixels, by the luma of their code values under a tone curve.
struct ToneShares {
    double black = 0, white = 0; // of all pixels: luma at most 1 %, and at least 99 %
    double dim = 0;              // black ones among those that have light
    bool any_light = false;
};
ToneShares tone_shares(const Image& image, const ToneCurve& curve);

// Above this share a picture shows nothing.
inline constexpr double blank_share = 0.99;

// For a picture whose scene does not choose an exposure: 0, unless more than blank_share of the pixels with light would
// be black, or of all pixels white; then automatic_exposure. Integer images are finished pictures: 0.
float suitable_exposure(const Image& image, ToneKind kind);

} // namespace montelux
