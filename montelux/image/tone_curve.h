// Tone curve: linear light to the code values of 8- and 16-bit pictures, after an exposure.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "montelux/image/image.h"
#include "montelux/mc/math/vec.h"

namespace montelux {

// All but `linear` give values that a screen decodes by the sRGB curve.
enum class ToneKind : std::uint8_t {
    linear, // the light itself, clipped at 1
    srgb,   // clipped at 1, then the sRGB curve
    aces,   // S. Hill's fit of the ACES reference rendering and sRGB output transforms
    agx,    // B. Wrensch's approximation of AgX's base look
    filmic, // Hable 2010
};
// Of the enumeration, in its order.
const std::vector<std::string_view>& tone_names();
std::optional<ToneKind> tone_named(std::string_view name);

struct ToneCurve {
    // In stops: light is multiplied by 2^exposure before the curve. With linear and srgb 1 then becomes white.
    float exposure = 0;
    ToneKind kind = ToneKind::srgb;

    // Linear sRGB light to code values in [0, 1]; NaN and negative components count as 0. Black is 0, and grey stays
    // grey to 3e-4, a tenth of an 8-bit code.
    Vec3f operator()(Vec3f rgb) const;
    // Of grey light.
    float operator()(float light) const;

    // What a picture of its code values says of itself.
    ColorEncoding encoding() const {
        return kind == ToneKind::linear ? ColorEncoding::linear() : ColorEncoding::srgb();
    }
};

// The colour channels (and A, which is not curved) as an 8-bit or 16-bit image.
// Throws Error when `bits` is neither 8 nor 16 or there are no colour channels.
Image apply_tone_curve(const Image& image, const ToneCurve& curve, int bits = 8);

} // namespace montelux
