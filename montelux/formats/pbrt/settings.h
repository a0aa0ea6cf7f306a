// Film, filter, camera, sampler and integrator of a pbrt scene file as Montelux's settings.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "montelux/formats/pbrt/files.h"
#include "montelux/formats/pbrt/parameter.h"
#include "montelux/scene/render_settings.h"

namespace montelux::pbrt {

// One directive that names a plugin, with unparsed parameters.
struct Plugin {
    std::string name;
    ParameterList parameters;
    Location at;
};

// Each throws Error for unknown plugins and invalid values, and warns about what it ignores.
void read_film(const Plugin& plugin, Diagnostics& diagnostics, FilmSettings& film, std::string& output_file);
PixelFilter read_filter(const Plugin& plugin, Diagnostics& diagnostics);
// The shutter's times set the film's exposure time.
void read_camera(const Plugin& plugin, Files& files, Diagnostics& diagnostics, FilmSettings& film,
                 CameraSettings& settings);
// `seed` applies unless the sampler has its own.
SamplerSettings read_sampler(const Plugin& plugin, Diagnostics& diagnostics, std::uint64_t seed);
// `samples`: per pixel, in place of the sampler's, of an integrator that has a number of its own.
IntegratorSettings read_integrator(const Plugin& plugin, Diagnostics& diagnostics,
                                   std::optional<std::uint32_t>& samples);

} // namespace montelux::pbrt
