// Films, pixel filters and samplers of a Mitsuba scene as settings of a SceneDescription.
#pragma once

#include "montelux/formats/mitsuba/plugin.h"
#include "montelux/mc/random/sampler_settings.h"
#include "montelux/scene/film/film_settings.h"

namespace montelux::mitsuba {

// What a sensor without a film has: 768 x 576 pixels and a Gaussian filter.
FilmSettings standard_film();
FilmSettings read_film(Plugin film);

// What a sensor without a sampler has: 4 independent samples per pixel.
SamplerSettings standard_sampler();
SamplerSettings read_sampler(Plugin sampler);

} // namespace montelux::mitsuba
