// The header attributes of a rendered picture.
#pragma once

#include <string>

#include "montelux/film/film_error.h"
#include "montelux/image/image.h"
#include "montelux/render/renderer.h"

namespace montelux {

// Writes the attributes that `montelux info` prints; `scene_name` is the name of the scene's file.
// SliceMerger matches slices of one render by them.
void add_render_header(Image& image, const std::string& scene_name, const Renderer& renderer,
                       const RenderReport& report, const FilmError& error, double clamped_luminance);

} // namespace montelux
