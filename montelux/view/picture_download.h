// Pictures of a running render as the bytes of files.
#pragma once

#include <string>

#include "montelux/image/tone_curve.h"
#include "montelux/render/render_session.h"

namespace montelux {

// All layers. Throws Error where no temporary file can be written.
std::string exr_bytes(const RenderSnapshot& snapshot);
// Its colours under the curve, 8 bits.
std::string png_bytes(const RenderSnapshot& snapshot, const ToneCurve& curve);

} // namespace montelux
