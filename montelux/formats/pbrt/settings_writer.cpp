#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "montelux/formats/pbrt/scene_writer.h"
#include "montelux/image/image_write.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/math/float_near.h"
#include "montelux/mc/math/overloaded.h"
#include "montelux/scene/camera/camera.h"
#include "montelux/spectrum/camera_sensors.h"

namespace montelux::pbrt {
namespace {

// The number that the reader multiplies by `factor` to get `v`; the nearest one where none gives it exactly.
float divided(float v, float factor) {
    const double guess = static_cast<double>(v) / static_cast<double>(factor);
    return float_near(guess, [&](float x) { return x * factor == v; }).value_or(static_cast<float>(guess));
}

} // namespace

void SceneWriter::perspective(DirectiveText& d, float lens_radius, float focal_distance,
                              std::optional<float> aspect, const std::optional<ScreenWindow>& window) {
    if (lens_radius != 0) d.number("lensradius", lens_radius);
    d.number("focaldistance", focal_distance);
    if (aspect) d.number("frameaspectratio", *aspect);
    if (window) {
        const std::array<float, 4> values = {window->x_min, window->x_max, window->y_min, window->y_max};
        d.numbers("float", "screenwindow", values);
    }
}

void SceneWriter::realistic(DirectiveText& d, const RealisticCamera& camera) {
    d.number("focusdistance", camera.focus_distance);
    const std::string name = "lens.dat";
    std::string rows =
        "# radius of curvature, thickness, index of refraction, diameter of the aperture (mm)\n";
    float stop = 0;
    for (const LensSurface& s : camera.surfaces) {
        const float diameter = divided(s.aperture_radius, 0.0005f);
        rows += digits_of(divided(s.radius, 0.001f)) + " " + digits_of(divided(s.thickness, 0.001f)) + " " +
                digits_of(s.eta) + " " + digits_of(diameter) + "\n";
        if (s.radius == 0) stop = std::max(stop, diameter);
    }
    if (stop > 0) d.number("aperturediameter", stop);
    AtomicFile file(files_.add(name));
    file.write(rows.data(), rows.size());
    file.commit();
    d.string("lensfile", files_.reference(name));
    if (!camera.aperture) return;
    for (const std::string_view known : aperture_names()) {
        const AperturePicture shape = *find_aperture(known);
        if (shape.width == camera.aperture->width && shape.values == camera.aperture->values)
            return d.string("aperture", known);
    }
    Image picture(camera.aperture->width, camera.aperture->height, {"Y"});
    for (std::size_t i = 0; i < picture.sample_count(); ++i) picture.f32()[i] = camera.aperture->values[i];
    const std::string picture_name = "aperture.exr";
    write_image(files_.add(picture_name), picture);
    d.string("aperture", files_.reference(picture_name));
}

void SceneWriter::camera() {
    const CameraSettings& c = scene_.camera;
    std::string before;
    if (c.motion) {
        before = motion_text(c.motion->start().inverse(), c.motion->end().inverse());
    } else {
        before = transform_text(c.world_from_camera.inverse());
    }
    if (c.medium != no_index)
        before += "MediumInterface \"\" " + quoted_text("medium-" + std::to_string(c.medium)) + "\n";
    const auto directive = [&](const char* name) { return DirectiveText("Camera " + quoted_text(name)); };
    const auto finish = [&](DirectiveText& d) {
        const CameraSettings standard;
        if (c.shutter_open != standard.shutter_open || c.shutter_close != standard.shutter_close) {
            d.number("shutteropen", c.shutter_open);
            d.number("shutterclose", c.shutter_close);
        }
        put(before + d.text() + "Identity\n");
    };
    std::visit(
        Overloaded{
            [&](const PerspectiveCamera& p) {
                DirectiveText d = directive("perspective");
                d.number("fov", p.fov);
                perspective(d, p.lens_radius, p.focal_distance, p.frame_aspect_ratio, p.screen_window);
                finish(d);
            },
            [&](const OrthographicCamera& o) {
                DirectiveText d = directive("orthographic");
                std::optional<ScreenWindow> window = o.screen_window;
                if (o.scale != 1) {
                    const ScreenWindow w = window_of(o.screen_window, o.frame_aspect_ratio,
                                                     description_.film.width, description_.film.height);
                    window = {w.x_min * o.scale, w.x_max * o.scale, w.y_min * o.scale, w.y_max * o.scale};
                }
                perspective(d, o.lens_radius, o.focal_distance, o.frame_aspect_ratio, window);
                finish(d);
            },
            [&](const SphericalCamera& s) {
                DirectiveText d = directive("spherical");
                if (s.mapping == SphericalCamera::Mapping::equirectangular)
                    d.string("mapping", "equirectangular");
                finish(d);
            },
            [&](const RealisticCamera& r) {
                DirectiveText d = directive("realistic");
                realistic(d, r);
                finish(d);
            }},
        c.model);
}

void SceneWriter::film() {
    const FilmSettings& f = description_.film;
    const FilmSettings standard;
    const bool gbuffer = f.layers.set == LayerSet::gbuffer();
    DirectiveText d(std::string("Film ") + (f.spectral ? "\"spectral\""
                                            : gbuffer  ? "\"gbuffer\""
                                                       : "\"rgb\""));
    d.integer("xresolution", f.width);
    d.integer("yresolution", f.height);
    if (!description_.output_file.empty()) d.string("filename", description_.output_file);
    if (!(f.crop == PixelBounds{0, 0, f.width, f.height})) {
        const std::array<std::int32_t, 4> bounds = {f.crop.x0, f.crop.x1, f.crop.y0, f.crop.y1};
        d.integers("pixelbounds", bounds);
    }
    if (f.spectral) {
        d.integer("nbuckets", f.spectral->buckets);
        d.number("lambdamin", f.spectral->lambda_min);
        d.number("lambdamax", f.spectral->lambda_max);
    }
    const bool camera_space = f.layers.in_camera_space;
    if (!f.spectral && gbuffer)
        d.string("coordinatesystem", camera_space ? "camera" : "world");
    else if (f.layers.set != LayerSet::standard() || camera_space ||
             f.layers.light_grouping != LightGrouping::light)
        warn("film", "pbrt's films have no list of layers; add --layers " + text_of(f.layers.set) +
                         (camera_space ? " --layer-space camera" : "") + " where the scene is rendered");
    if (const auto* lens = std::get_if<RealisticCamera>(&scene_.camera.model))
        d.number("diagonal", divided(lens->film_diagonal, 0.001f));
    else if (f.diagonal != standard.diagonal)
        d.number("diagonal", divided(f.diagonal, 0.001f));
    if (f.iso != standard.iso) d.number("iso", f.iso);
    // The time that the shutter is open is a factor of its own.
    const CameraSettings& c = scene_.camera;
    const bool has_shutter = c.shutter_open != 0 || c.shutter_close != 1;
    const float exposure =
        has_shutter ? divided(f.exposure_time, c.shutter_close - c.shutter_open) : f.exposure_time;
    if (exposure != 1) d.number("exposuretime", exposure);
    if (f.white_balance != 0) d.number("whitebalance", f.white_balance);
    if (f.sensor != standard.sensor) d.string("sensor", f.sensor);
    if (std::isfinite(f.max_component_value)) d.number("maxcomponentvalue", f.max_component_value);
    if (f.layers.half) d.boolean("savefp16", true);
    put(d.text());
}

void SceneWriter::filter() {
    const auto write = [&](const char* name, Vec2f radius, const auto& parameters) {
        DirectiveText d("PixelFilter " + quoted_text(name));
        d.number("xradius", radius.x);
        d.number("yradius", radius.y);
        parameters(d);
        put(d.text());
    };
    const auto none = [](DirectiveText&) {};
    std::visit(Overloaded{[&](const BoxFilter& f) { write("box", f.radius, none); },
                          [&](const TriangleFilter& f) { write("triangle", f.radius, none); },
                          [&](const GaussianFilter& f) {
                              write("gaussian", f.radius,
                                    [&](DirectiveText& d) { d.number("sigma", f.sigma); });
                          },
                          [&](const MitchellFilter& f) {
                              write("mitchell", f.radius, [&](DirectiveText& d) {
                                  d.number("B", f.b);
                                  d.number("C", f.c);
                              });
                          },
                          [&](const LanczosFilter& f) {
                              write("sinc", f.radius, [&](DirectiveText& d) { d.number("tau", f.tau); });
                          }},
               description_.film.filter);
}

void SceneWriter::sampler() {
    const SamplerSettings& s = description_.sampler;
    const auto name = [&] {
        switch (s.kind) {
        case SamplerKind::independent:
            return "independent";
        case SamplerKind::stratified:
            return "stratified";
        case SamplerKind::halton:
            return "halton";
        case SamplerKind::hammersley:
            warn("sampler", "pbrt has no Hammersley points; 'halton' is written");
            return "halton";
        case SamplerKind::sobol:
            return "sobol";
        case SamplerKind::sobol_blue_noise:
            break;
        }
        return "zsobol";
    }();
    DirectiveText d("Sampler " + quoted_text(name));
    // Of a type that holds 31 bits.
    const int spp = static_cast<int>(std::min<std::uint32_t>(s.spp, INT32_MAX));
    if (s.kind == SamplerKind::stratified) {
        d.integer("xsamples", spp);
        d.integer("ysamples", 1);
    } else {
        d.integer("pixelsamples", spp);
    }
    if (s.seed > UINT32_MAX)
        warn("sampler", "the seed " + std::to_string(s.seed) + " has more than 32 bits; add --seed " +
                            std::to_string(s.seed) + " where the scene is rendered");
    else if (s.seed != 0)
        d.integer("seed", static_cast<int>(static_cast<std::uint32_t>(s.seed)));
    put(d.text());
}

void SceneWriter::integrator() {
    const IntegratorSettings& s = description_.integrator;
    const IntegratorSettings standard;
    if (s.occlusion) {
        DirectiveText d("Integrator \"ambientocclusion\"");
        d.boolean("cossample", s.occlusion->cosine);
        if (std::isfinite(s.occlusion->max_distance)) d.number("maxdistance", s.occlusion->max_distance);
        return put(d.text());
    }
    const bool traces = traces_light(s.method);
    const bool by_strategy = !traces && (s.strategy == Strategy::uniform || s.strategy == Strategy::bsdf ||
                                         s.strategy == Strategy::light);
    const bool by_chains = s.method == IntegratorKind::metropolis && !by_strategy;
    DirectiveText d(std::string("Integrator ") + (s.method == IntegratorKind::bidirectional ? "\"bdpt\""
                                                  : traces                                  ? "\"lightpath\""
                                                  : by_strategy && s.strategy == Strategy::uniform
                                                      ? "\"randomwalk\""
                                                  : by_strategy ? "\"simplepath\""
                                                  : by_chains   ? "\"mlt\""
                                                                : "\"volpath\""));
    d.integer("maxdepth", s.max_depth);
    if (by_chains) {
        d.integer("mutationsperpixel", static_cast<int>(description_.sampler.spp));
        if (s.large_step_probability > 0) d.number("largestepprobability", s.large_step_probability);
    }
    if (by_strategy && s.strategy != Strategy::uniform) {
        d.boolean("samplelights", s.strategy == Strategy::light);
        d.boolean("samplebsdf", true);
    }
    const auto option = [&](bool is_standard, const std::string& text) {
        if (!is_standard)
            warn("integrator", "pbrt has no setting for it; add " + text + " where the scene is rendered");
    };
    option(s.method != IntegratorKind::metropolis || by_chains, "--integrator metropolis");
    option(s.method != IntegratorKind::automatic, "--integrator auto");
    if (traces) {
        option(s.light_sampling == standard.light_sampling, "--light-sampling");
    } else if (by_chains) {
        if (s.regularize) d.boolean("regularize", true);
        option(s.light_sampling == standard.light_sampling, "--light-sampling");
        option(s.strategy == Strategy::mis, "--strategy");
    } else if (!by_strategy) {
        if (s.regularize) d.boolean("regularize", true);
        if (s.light_sampling == LightSampling::uniform) d.string("lightsampler", "uniform");
        if (s.light_sampling == LightSampling::power) d.string("lightsampler", "power");
        option(s.strategy == Strategy::mis,
               s.strategy == Strategy::mis_bsdf ? "--strategy mis-bsdf" : "--strategy mis-light");
    } else {
        option(!s.regularize, "\"bool regularize\" true to another integrator");
        option(s.light_sampling == standard.light_sampling, "--light-sampling");
    }
    option(s.heuristic == standard.heuristic, "--heuristic balance");
    option(s.manifold_sampling == standard.manifold_sampling, "--manifold-sampling on");
    option(s.equiangular == standard.equiangular, "--equiangular off");
    option(s.environment_sampling == standard.environment_sampling, "--environment-sampling");
    option(s.environment_compensation == standard.environment_compensation, "--environment-compensation off");
    if (by_strategy) {
        option(s.environment_lookup == standard.environment_lookup, "--environment-lookup bilinear");
        option(s.microfacet_scattering == standard.microfacet_scattering, "--microfacet-scattering multiple");
        option(s.shading_terminator == standard.shading_terminator, "--shading-terminator soft");
        option(!s.background, "--background");
        option(s.count_passages, "\"bool countpassages\" false to another integrator");
    } else {
        if (!s.count_passages) d.boolean("countpassages", false);
        if (s.environment_lookup == EnvironmentLookup::bilinear) d.string("environmentlookup", "bilinear");
        if (s.microfacet_scattering == MicrofacetScattering::multiple)
            d.string("microfacetscattering", "multiple");
        if (s.shading_terminator == ShadingTerminator::soft) d.string("shadingterminator", "soft");
        if (s.background) d.vector("rgb", "background", *s.background);
    }
    put(d.text());
}

} // namespace montelux::pbrt
