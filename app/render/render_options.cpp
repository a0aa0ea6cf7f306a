#include "app/render/render_options.h"

#include "app/definitions.h"
#include "app/option_values.h"
#include "app/render/frame_list.h"
#include "app/render/render_option_values.h"
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "montelux/formats/load_scene.h"
#include "montelux/image/texel_file.h"
#include "montelux/mc/parallel/parallel_for.h"
#include "montelux/scene/light_tracing_support.h"
#include "montelux/scene/setting_names.h"

namespace montelux::app {

namespace {

// Limit of the samples per pixel if only a target or a time is given.
constexpr std::uint32_t most_samples = 1u << 24;

template <typename Table>
std::string names(const Table& table) {
    std::string list;
    for (const auto& [name, value] : table) list += (list.empty() ? "" : ", ") + std::string(name);
    return list;
}

std::string layer_list() {
    std::string list = "default, gbuffer";
    for (const std::string_view name : layer_names()) list += ", " + std::string(name);
    return list;
}

// An option that takes one of the names of a table.
template <typename Table, typename Target>
void add_choice(CLI::App& c, const std::string& name, Target& target, const Table& table,
                const std::string& help) {
    auto read = [name, &target, &table](const std::string& text) {
        for (const auto& [known, value] : table)
            if (text == known) {
                target = value;
                return;
            }
        refuse(name, text, "one of " + names(table) + " is expected");
    };
    c.add_option_function<std::string>(name, read, help + names(table))->type_name("NAME")->take_last();
}

PixelBounds crop_of(const std::array<double, 4>& c, int width, int height) {
    auto pixel = [](double v, int n) { return static_cast<int>(std::ceil(v * n - 1e-9)); };
    PixelBounds b{pixel(c[0], width), pixel(c[2], height), pixel(c[1], width), pixel(c[3], height)};
    if (b.width() < 1 || b.height() < 1)
        throw UsageError("--crop", "no pixel of the " + std::to_string(width) + "x" + std::to_string(height) +
                                       " film lies within");
    return b;
}

} // namespace

void declare(CLI::App& c, RenderOptions& o) {
    c.add_option("SCENE", o.scene,
                 "Scene (pbrt-v4, glTF 2.0, Mitsuba 3) or model (OBJ, PLY, STL); .gz is unpacked")
        ->required();
    c.add_option("-o,--output", o.outputs,
                 "Picture to write: .exr, .png, .jpg, .hdr or .pfm; may be given several times. Default: the "
                 "name that the scene asks for, in this folder, as .exr")
        ->type_name("FILE")
        ->allow_extra_args(false); // the scene may follow it
    add_whole_number(c, "--spp", o.spp, 1, 1u << 30, "Samples per pixel, in place of the scene's");
    add_whole_number(c, "--max-spp", o.max_spp, 1, 1u << 30,
                     "Limit of the samples per pixel with --target-error or --time");
    add_parsed(c, "--target-error", "ERROR", o.target_error, parse_share,
               "Stop when the picture's relative error is this, for example 0.01 or 1%");
    add_parsed(c, "--target-quantile", "SHARE", o.target_quantile, parse_share,
               "With --target-error: stop when this share of the pixels is within it");
    add_parsed(c, "--time", "TIME", o.time, parse_time_limit,
               "Stop after this time, for example 90, 90s, 10m or 1h30m");
    add_parsed(c, "--adaptive", "on|off", o.adaptive, parse_on_off,
               "More samples where the error is: on, off. Default: on with --target-error");
    add_parsed(c, "--clamp", "VALUE", o.clamp, parse_positive,
               "Largest RGB value of a sample; the light it removes is reported. Default: none but the "
               "scene's");
    CLI::Option* checkpoint =
        c.add_option("--checkpoint", o.checkpoint, "Keep the running state in this file")
            ->type_name("FILE")
            ->check(file_name());
    add_parsed(c, "--checkpoint-every", "TIME", o.checkpoint_every, parse_duration,
               "How often it is written. Default: 60s")
        ->needs(checkpoint);
    c.add_flag("--resume", o.resume, "Resume from the checkpoint, if it exists");
    add_parsed(c, "--slice", "K/N", o.slice, parse_slice,
               "Take a part of the samples, K/N with K from 1 to N; montelux merge joins the parts");
    add_whole_number(c, "--seed", o.seed, 0, UINT64_MAX,
                     "Seed of all random numbers, in place of the scene's");
    add_whole_number(
        c, "--threads", o.threads, 0, most_threads,
        "Threads, also more than processors; 0: one per processor. The picture does not depend on it");
    add_parsed(
        c, "--texture-memory", "SIZE", o.texture_memory,
        [](const std::string& option, const std::string& s) {
            return parse_size(option, s, TexelFile::least_limit);
        },
        "Image textures are kept in a temporary file (in TMPDIR), of which about this much is in memory, for "
        "example 500M or 2G. The picture does not depend on it. Default: all are in memory");
    add_parsed(c, "--rank-timeout", "TIME", o.rank_timeout, parse_rank_timeout,
               "Under mpirun: a rank that is silent for this long is given up, and the render ends with what "
               "the others did. Default: 60s");
    c.add_option(
         "--camera", o.camera,
         "Of a glTF or Mitsuba scene: the camera, by its name or its number from 0. Default: the first")
        ->type_name("NAME")
        ->take_last();
    c.add_option("--variant", o.variant, "Of a glTF scene: the variant of its materials, by its name")
        ->type_name("NAME")
        ->take_last();
    add_parsed(c, "--time-of-scene", "TIME", o.scene_time, parse_duration,
               "Of a glTF scene: the time at which its animations are shown, for example 1.5s. Default: all "
               "at rest");
    add_parsed(c, "--shutter", "TIME|ANGLE", o.shutter, parse_shutter,
               "Of a glTF scene: how long the shutter is open from the time of the picture on, for example "
               "0.02s, or "
               "180deg of the 360deg that a frame takes (--frame-rate): what moves meanwhile is blurred. "
               "Default: 0");
    add_parsed(
        c, "--frames", "LIST", o.frames, read_frames,
        "Render these frames of a glTF scene's animations to numbered files, out.png to out.0001.png and so "
        "on: 1-48, 1-48x2 (every second one), 1,5,9. Frames that are finished are skipped");
    add_parsed(c, "--frame-rate", "RATE", o.frame_rate, parse_positive,
               "Frames per second: frame n is at the time (n - 1) / RATE. Default: 24");
    add_whole_number(
        c, "--turntable", o.turntable, 1, most_frames,
        "Render a turn of the camera around the scene in N frames, to numbered files; --frames chooses "
        "among them");
    declare_definitions(c, o.definitions);
    add_parsed(c, "--resolution", "WxH", o.resolution, parse_resolution,
               "Size of the film in pixels; the scene's crop keeps its place");
    add_parsed(c, "--crop", "x0,x1,y0,y1", o.crop, parse_crop,
               "Render a part of the film alone, as fractions from the top left");
    add_parsed(
        c, "--environment", "studio|none|FILE", o.studio.environment,
        [](const std::string& option, const std::string& s) {
            if (s.empty()) refuse(option, s, "the file of an environment map, studio or none is expected");
            return s;
        },
        "What lights the scene all around, in place of its infinite lights: the studio's light, nothing, or "
        "a "
        "map, latitude-longitude or square equal-area. Default: the scene's own; studio for models and glTF");
    add_parsed(c, "--orbit", "AZ,EL[,DIST]", o.studio.orbit, read_orbit,
               "A camera that frames the scene, in place of its own, from this azimuth and elevation "
               "(degrees) and, in "
               "multiples of the distance that fills the picture, DIST. Default for models: 35,18,1");
    add_parsed(
        c, "--ground", "on|off", o.studio.ground, parse_on_off,
        "A large light grey disc below the scene, which catches its shadow: on, off. Default: on for models "
        "without lights");
    add_parsed(c, "--background", "COLOUR", o.studio.background, read_background,
               "What the camera sees where it meets nothing, whatever lights the scene: transparent (PNG and "
               "EXR get "
               "alpha), black, grey, white, #rrggbb, or linear r,g,b");
    add_parsed(c, "--layers", "LIST", o.layers, parse_layer_list,
               "Layers of the EXR file, in place of the scene's, for example default,position,uv: " +
                   layer_list());
    add_parsed(
        c, "--layer-space", "world|camera", o.layers_in_camera_space, parse_space,
        "Space of the layers normal, geometric-normal and position: world, camera. Default: the scene's, or "
        "world");
    add_parsed(
        c, "--light-groups", "light|kind", o.light_grouping, parse_light_grouping,
        "With the layer light-groups: lights that the scene puts into no group form one each (light), or one "
        "of each kind (kind). Default: light");
    c.add_flag_callback(
        "--half", [&o] { o.half = true; }, "EXR files hold 16-bit floats where those suffice");
    c.add_flag_callback(
        "--no-half", [&o] { o.half = false; }, "They hold 32-bit floats, whatever the scene's savefp16 says");
    declare(c, o.tone);
    add_choice(c, "--sampler", o.sampler, sampler_names, "Where samples are taken: ");
    add_choice(
        c, "--integrator", o.integrator, integrator_names,
        "How paths are found: from the camera, the default; from the camera and from lights, joined in all "
        "ways, for caustics and lamps in shades; from lights alone, which misses what mirrors and smooth "
        "glass show the camera; from the camera by Markov chains that stay near bright paths, for light "
        "that path tracing rarely finds; or as a short pilot chooses (auto): ");
    add_parsed(c, "--large-steps", "SHARE", o.large_steps, parse_share,
               "Of metropolis: share of the steps that start a path anew. Default: chosen by a pilot");
    add_choice(c, "--strategy", o.strategy, strategy_names, "How light is found: ");
    add_choice(c, "--heuristic", o.heuristic, heuristic_names,
               "Weights of the strategy mis and its two terms: ");
    add_choice(
        c, "--light-sampling", o.light_sampling, light_sampling_names,
        "How one light is chosen among many: by its importance for the point that is lit, the default; in "
        "proportion to its power; or all alike: ");
    add_parsed(
        c, "--manifold-sampling", "on|off", o.manifold_sampling, parse_on_off,
        "Of path: caustics of one smooth mirror or one smooth surface of glass or water are found by "
        "walking on it to where it sends a lamp's light (specular manifold sampling). Pays where lamps are "
        "small. Default: off");
    add_choice(
        c, "--guiding", o.guiding, guiding_names,
        "Whether paths learn where light comes from, and follow it: where that pays, by a trial; always; or "
        "never, the default: ");
    add_whole_number(c, "--guiding-memory", o.guiding_memory, 16, 1u << 20,
                     "MiB that learning may take. Default: 256");
    add_parsed(
        c, "--merging", "off|auto|RADIUS", o.merging, parse_merging,
        "Of bidirectional: camera paths also end at the light paths that pass within RADIUS (units of the "
        "scene), which finds caustics in mirrors and under water. Discs shrink from pass to pass: the "
        "picture "
        "is consistent, not unbiased, and its errors cover noise alone; its last line estimates the bias. "
        "auto: by the size of a pixel. Default: off");
    add_whole_number(
        c, "--merging-memory", o.merging_memory, 1, 1u << 20,
        "MiB that the light paths of a pass may take; where it is too little, fewer of them merge. "
        "Default: 192");
    add_parsed(c, "--equiangular", "on|off", o.equiangular, parse_on_off,
               "In media lamps are also looked for from points of the ray close to them: on, off. "
               "Default: on");
    add_choice(c, "--environment-sampling", o.environment_sampling, environment_sampling_names,
               "How directions to environment maps are sampled; auto, the default, is tabulated: ");
    add_parsed(
        c, "--environment-compensation", "on|off", o.environment_compensation, parse_on_off,
        "For the strategy mis and its terms: maps are not sampled where BSDFs find them as well: on, off. "
        "Default: on");
    add_choice(
        c, "--environment-lookup", o.environment_lookup, environment_lookup_names,
        "What environment maps are between the centres of their texels; nearest, the default, is pbrt's: ");
    add_choice(c, "--microfacet-scattering", o.microfacet_scattering, microfacet_scattering_names,
               "Light that the microfacets of rough surfaces throw at one another is lost, as in pbrt and by "
               "default, "
               "or followed until it leaves: ");
    add_choice(c, "--shading-terminator", o.shading_terminator, shading_terminator_names,
               "Coarse meshes with smooth normals are shadowed by their facets, as in pbrt and by default, "
               "or as the "
               "smooth surface that they stand for: ");
    add_whole_number(c, "--max-depth", o.max_depth, 0, 1'000'000, "Scattering events of a path at most");
    add_parsed(c, "--debug-sample", "x,y,index", o.debug_sample, parse_sample,
               "Render no picture: trace this one sample of the render and print its path, vertex by vertex");
    c.add_flag("--denoise", o.denoise,
               "Also denoise the picture by Open Image Denoise ('montelux denoise --help'): .exr keeps the "
               "picture and gets the layers denoised.R, G, B; other formats show those");
    declare_view(c, o.view, !o.view.stays);
    c.add_flag("--stats", o.stats, "Print times, rays per second, memory");
    c.add_flag("--memory", o.memory, "Print what the parts of the scene take in memory");
    c.add_flag("--quiet", o.quiet, "Print nothing but errors");
    c.footer(
        "Examples:\n"
        "  montelux render scene.pbrt --spp 64 -o out.exr -o out.png\n"
        "  montelux render scene.pbrt --resolution 320x240 --crop 0.5,1,0,0.5 -o corner.exr\n"
        "  montelux render scene.pbrt --spp 64 --debug-sample 320,240,7\n"
        "  montelux render model.obj --orbit 60,20 -o model.png\n"
        "  montelux render model.glb --frames 1-48 -o out.png\n"
        "\n"
        "'mpirun -n 8 montelux render ...' shares the render among machines; the picture is the same.\n"
        "An EXR file holds every layer: mean, standard error, samples, albedo, normal, depth and those of "
        "--layers.\n"
        "SIGINT (Ctrl-C) or SIGTERM ends the render early and saves the picture; another one, a "
        "second later or more, ends it at once: the picture is not saved.");
}

namespace {

void apply(const RenderOptions& o, SceneDescription& d) {
    if (o.resolution) {
        auto [w, h] = *o.resolution;
        // The crop of the file keeps its place on the film.
        auto scaled = [](int v, int from, int to) {
            return static_cast<int>(static_cast<long long>(v) * to / from);
        };
        PixelBounds& b = d.film.crop;
        b = {scaled(b.x0, d.film.width, w), scaled(b.y0, d.film.height, h), scaled(b.x1, d.film.width, w),
             scaled(b.y1, d.film.height, h)};
        b.x1 = std::max(b.x1, b.x0 + 1);
        b.y1 = std::max(b.y1, b.y0 + 1);
        d.film.width = w;
        d.film.height = h;
    }
    if (o.crop) d.film.crop = crop_of(*o.crop, d.film.width, d.film.height);
    const bool open_ended = (o.target_error || o.time) && !o.spp && !o.max_spp;
    if (open_ended) d.sampler.spp = most_samples;
    if (o.max_spp)
        d.sampler.spp = o.target_error || o.time
                            ? static_cast<std::uint32_t>(*o.max_spp)
                            : std::min(d.sampler.spp, static_cast<std::uint32_t>(*o.max_spp));
    if (o.spp) d.sampler.spp = static_cast<std::uint32_t>(std::min(*o.spp, o.max_spp.value_or(*o.spp)));
    if (o.seed) d.sampler.seed = *o.seed;
    if (o.sampler) d.sampler.kind = *o.sampler;
    if (o.integrator) d.integrator.method = *o.integrator;
    if (o.large_steps) d.integrator.large_step_probability = static_cast<float>(*o.large_steps);
    if (o.strategy)
        d.integrator.strategy = *o.strategy;
    else if (o.integrator && (traces_light(*o.integrator) || o.integrator == IntegratorKind::automatic))
        d.integrator.strategy = Strategy::mis; // whatever the scene's integrator was
    if (o.heuristic) d.integrator.heuristic = *o.heuristic;
    if (o.light_sampling) d.integrator.light_sampling = *o.light_sampling;
    if (o.manifold_sampling) d.integrator.manifold_sampling = *o.manifold_sampling;
    if (o.guiding) d.integrator.guiding = *o.guiding;
    if (o.guiding_memory) d.integrator.guiding_memory = *o.guiding_memory;
    if (o.merging) {
        d.integrator.merging.reset();
        if (*o.merging) d.integrator.merging = MergingSettings{.radius = **o.merging};
    }
    if (o.merging_memory) {
        if (!d.integrator.merging)
            throw UsageError("--merging-memory", "expected --merging auto or a radius: paths do not merge");
        d.integrator.merging->memory = *o.merging_memory;
    }
    if (o.equiangular) d.integrator.equiangular = *o.equiangular;
    if (o.environment_sampling) d.integrator.environment_sampling = *o.environment_sampling;
    if (o.environment_compensation) d.integrator.environment_compensation = *o.environment_compensation;
    if (o.environment_lookup) d.integrator.environment_lookup = *o.environment_lookup;
    if (o.microfacet_scattering) d.integrator.microfacet_scattering = *o.microfacet_scattering;
    if (o.shading_terminator) d.integrator.shading_terminator = *o.shading_terminator;
    if (o.max_depth) d.integrator.max_depth = static_cast<int>(*o.max_depth);
    if (o.layers) d.film.layers.set = *o.layers;
    if (o.light_grouping) d.film.layers.light_grouping = *o.light_grouping;
    if (o.layers_in_camera_space) d.film.layers.in_camera_space = *o.layers_in_camera_space;
    if (o.half) d.film.layers.half = *o.half;
    if (o.clamp) d.film.max_component_value = static_cast<float>(*o.clamp);
}

} // namespace

double shutter_seconds(const RenderOptions& o) {
    return o.shutter.is_angle ? o.shutter.value / 360 / o.frame_rate : o.shutter.value;
}

RequestedScene load_requested(const RenderOptions& o, Warnings& warnings, FileSource* source,
                              std::vector<std::filesystem::path>* files_read) {
    if (o.shutter.value > 0 && !o.scene_time)
        throw UsageError("--shutter", "expected --time-of-scene TIME, when it opens, or --frames");
    RequestedScene r;
    r.description =
        load_scene(o.scene, warnings,
                   {.files_read = files_read,
                    .source = source,
                    .texel_file = o.texture_memory ? TexelFile::create(*o.texture_memory) : nullptr,
                    .camera = o.camera,
                    .variant = o.variant,
                    .time = o.scene_time,
                    .definitions = o.definitions,
                    .shutter = shutter_seconds(o)});
    apply(o, r.description);
    if (o.integrator == IntegratorKind::light_tracing) warnings.add("--integrator", light_tracing_warning);
    if (o.turntable) r.axis = turn_axis_of(r.description);
    DiskFiles disk;
    r.added = add_studio(r.description, o.studio, source != nullptr ? *source : disk, warnings, files_read);
    return r;
}

RenderTarget target_of(const RenderOptions& o, IntegratorKind integrator) {
    if (o.target_quantile && !o.target_error)
        throw UsageError("--target-quantile", "expected --target-error ERROR, the error of that share");
    if (o.resume && o.checkpoint.empty())
        throw UsageError("--resume", "expected --checkpoint FILE, the file to resume from");
    RenderTarget target;
    target.error = o.target_error.value_or(0);
    target.quantile = o.target_quantile.value_or(0);
    target.time = o.time.value_or(0);
    // Light paths reach all pixels at once, and chains choose themselves where they take samples.
    const bool may_adapt = integrator == IntegratorKind::path || integrator == IntegratorKind::automatic;
    target.adaptive = o.adaptive.value_or(o.target_error.has_value() && may_adapt);
    target.slice = o.slice;
    if (target.slice.count > 1 && (target.error > 0 || target.adaptive))
        throw UsageError("--slice",
                         "slices share a number of samples per pixel; give --spp, without --target-error "
                         "and --adaptive");
    return target;
}

} // namespace montelux::app
