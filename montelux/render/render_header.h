// What a rendered picture says of how it came about.
#pragma once

#include <string>

#include "montelux/film/film_error.h"
#include "montelux/image/image.h"
#include "montelux/render/renderer.h"

namespace montelux {

// Writes the attributes that `montelux info` shows; `scene_name` is the name of the scene's file. Slices of
// one render know each other by them (SliceMerger).
void add_render_header(Image& image, const std::string& scene_name, const Renderer& renderer,
                       const RenderReport& report, const FilmError& error, double clamped_luminance);

} // namespace montelux
