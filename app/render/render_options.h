// RenderOptions: the options of the render command, and how they override a scene file.
#pragma once

#include "app/tone_options.h"
#include "app/usage_error.h"
#include "app/view/view_options.h"
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "montelux/formats/file_source.h"
#include "montelux/formats/studio.h"
#include "montelux/formats/warnings.h"
#include "montelux/render/render_target.h"
#include "montelux/scene/render_settings.h"

namespace CLI {
class App;
}

namespace montelux::app {

// A sample of a pixel, as in messages about samples that were left out.
struct SampleAddress {
    int x = 0, y = 0;
    std::uint64_t index = 0;
};

struct RenderOptions {
    std::string scene;
    std::vector<std::string> outputs;
    std::optional<std::uint64_t> spp, max_spp, seed, max_depth;
    std::optional<double> target_error, target_quantile, clamp;
    std::optional<double> time; // seconds
    std::optional<bool> adaptive;
    Slice slice;
    std::string checkpoint;
    double checkpoint_every = 60; // seconds
    bool resume = false;
    std::optional<std::pair<int, int>> resolution;
    std::optional<std::array<double, 4>> crop; // x0, x1, y0, y1 as fractions of the film
    std::optional<SamplerKind> sampler;
    std::optional<IntegratorKind> integrator;
    std::optional<double> large_steps;
    std::optional<Strategy> strategy;
    std::optional<Heuristic> heuristic;
    std::optional<LightSampling> light_sampling;
    std::optional<bool> manifold_sampling;
    std::optional<Guiding> guiding;
    std::optional<std::uint64_t> guiding_memory; // MiB
    std::optional<std::optional<float>> merging; // empty inside: off; 0: chosen automatically
    std::optional<std::uint64_t> merging_memory; // MiB
    std::optional<bool> equiangular;
    std::optional<MicrofacetScattering> microfacet_scattering;
    std::optional<ShadingTerminator> shading_terminator;
    std::optional<EnvironmentSampling> environment_sampling;
    std::optional<bool> environment_compensation;
    std::optional<EnvironmentLookup> environment_lookup;
    std::optional<LayerSet> layers;
    std::optional<LightGrouping> light_grouping;
    std::optional<bool> layers_in_camera_space, half;
    ToneOptions tone{};
    StudioSettings studio;
    ViewOptions view{};
    std::optional<SampleAddress> debug_sample; // traced alone, instead of a render
    std::optional<std::size_t> texture_memory; // bytes
    // Of glTF scenes: LoadOptions.
    std::optional<std::string> camera, variant;
    std::optional<double> scene_time;               // seconds
    std::map<std::string, std::string> definitions; // of Mitsuba scenes: LoadOptions
    // From the time of the picture on: seconds, or an angle in degrees of which 360 are the time of a frame.
    struct Shutter {
        double value = 0;
        bool is_angle = false;
    };
    Shutter shutter{};
    // Of sequences (sequence.h): the frames to render, of which n is at the time (n - 1) / frame_rate; or of one turn of
    // the camera in so many frames.
    std::optional<std::vector<std::uint32_t>> frames;
    double frame_rate = 24;                 // 1/s
    std::optional<std::uint64_t> turntable; // frames
    int threads = 0;
    double rank_timeout = 60; // seconds
    bool denoise = false, stats = false, memory = false, quiet = false;
};

// An invalid value ends the parse with a CLI::ValidationError.
void declare(CLI::App& command, RenderOptions& options);

// The scene to be rendered: what the file contains, with the options that override it, and with a studio (add_studio).
struct RequestedScene {
    SceneDescription description;
    StudioParts added;
    TurnAxis axis{}; // with --turntable
};
// `source`: of all files; null: the disk. `files_read` receives their names. Throws the errors of load_scene and
// add_studio, and UsageError if a crop contains no pixel of the film.
RequestedScene load_requested(const RenderOptions& options, Warnings& warnings, FileSource* source,
                              std::vector<std::filesystem::path>* files_read = nullptr);
// How long the shutter stays open.
double shutter_seconds(const RenderOptions& options);
// Throws UsageError for incompatible options.
// Without --adaptive only samples of paths that belong to one pixel are allocated.
RenderTarget target_of(const RenderOptions& options, IntegratorKind integrator);

} // namespace montelux::app
