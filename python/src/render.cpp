#include "python/src/bindings.h"
#include "python/src/guide.h"
#include "python/src/images.h"
#include "python/src/interruptible.h"
#include "python/src/render_job.h"
#include "python/src/scene_object.h"
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "montelux/image/cryptomatte.h"
#include "montelux/image/exposure.h"
#include "montelux/image/image_write.h"
#include "montelux/image/visible_error.h"
#include "montelux/mc/io/generation_file.h"
#include "montelux/mc/math/nearest_name.h"
#include "montelux/mc/parallel/parallel_for.h"
#include "montelux/render/render_warnings.h"
#include "montelux/scene/build/check_references.h"

namespace montelux::python {
std::shared_ptr<const SceneDescription> description_of(const SceneObject& scene,
                                                       std::optional<std::uint32_t> spp,
                                                       std::optional<std::uint64_t> seed) {
    if (!scene.holder->has_camera)
        throw Error("render",
                    "the scene has no camera; set scene.camera, for example to PerspectiveCamera(fov=40)");
    std::shared_ptr<const SceneDescription> description = scene.holder->description;
    check_materials(description->scene);
    const SamplerSettings& sampler = description->sampler;
    if ((spp && *spp != sampler.spp) || (seed && *seed != sampler.seed)) {
        auto own = std::make_shared<SceneDescription>(*description);
        if (spp) own->sampler.spp = *spp;
        if (seed) own->sampler.seed = *seed;
        description = std::move(own);
    }
    return description;
}

namespace {

std::unique_ptr<RenderJob> start(const SceneObject& scene, std::optional<std::uint32_t> spp,
                                 std::optional<std::uint64_t> seed, double target_error, double quantile,
                                 double time, std::optional<bool> adaptive, int threads,
                                 const std::filesystem::path& checkpoint, double checkpoint_every,
                                 bool resume, std::pair<std::uint32_t, std::uint32_t> slice, bool denoise,
                                 bool view) {
    std::shared_ptr<const SceneDescription> description = description_of(scene, spp, seed);
    if (!checkpoint.empty() && !resume && generation_exists(checkpoint))
        throw Error(checkpoint.string(), "the file exists; pass resume=True to resume from it, or remove it");
    RenderSessionSettings settings;
    settings.target.error = target_error;
    settings.target.quantile = quantile;
    settings.target.time = time;
    const auto adapts = [=](IntegratorKind kind) {
        return adaptive.value_or(target_error > 0 && kind == IntegratorKind::path);
    };
    settings.target.adaptive = adapts(description->integrator.method);
    settings.target.slice = {slice.first - 1, slice.second};
    settings.scene_name = scene.holder->name;
    settings.checkpoint = checkpoint;
    settings.checkpoint_every = checkpoint_every;
    settings.resume = resume;
    nb::gil_scoped_release unlocked;
    if (description->integrator.method == IntegratorKind::automatic) {
        auto own = std::make_shared<SceneDescription>(*description);
        const RenderTarget target = settings.target;
        const auto target_of = [&](IntegratorKind kind) {
            RenderTarget t = target;
            t.adaptive = adapts(kind);
            return t;
        };
        run_interruptibly([&](const CancelFlag& cancel) {
            with_threads(threads, [&] {
                decide_integrator(*own, settings, {.target = target_of, .cancel = &cancel});
            });
        });
        description = std::move(own);
    }
    return std::make_unique<RenderJob>(std::move(description), std::move(settings), threads, denoise, view);
}

// Warnings about the finished render.
std::vector<std::string> warnings_of(const RenderJob& job) {
    const RenderSnapshot result = job.result();
    const RenderSession& session = job.session();
    std::vector<std::string> texts{
        bad_sample_warning(result.report.bad, session.sampler().seed),
        missing_error_warning(result, session.renderer()),
        merging_notice(result, session.renderer().target()),
        merging_warning(result.report.merging),
        missing_light_warning(result, session.renderer().target(), session.description()),
        manifold_warning(session.renderer()),
        session.checkpoint_failure(),
        result.denoise_failure};
    std::erase(texts, "");
    return texts;
}

// Of a spectral film, shape (h, w, buckets). The channels of its means are consecutive, then come their errors
// (append_spectral_layers).
void add_spectral_layers(nb::dict& layers, const RenderSnapshot& snapshot) {
    const std::vector<std::string>& channels = snapshot.image->channel_names();
    for (const auto& [name, prefix] :
         {std::pair{"spectral", "S0."}, {"spectral_standard_error", "stderr.S0."}}) {
        const auto of_layer = [prefix = prefix](const std::string& channel) {
            return channel.starts_with(prefix);
        };
        const auto first = std::ranges::find_if(channels, of_layer);
        const auto count = static_cast<int>(std::ranges::count_if(channels, of_layer));
        if (count == 0) continue;
        const nb::object array =
            channels_of(snapshot.image, static_cast<int>(first - channels.begin()), count);
        layers[name] = array.attr("reshape")(snapshot.image->height(), snapshot.image->width(), count);
    }
}

// Layers by their names in Python, as arrays on the picture's own memory.
nb::dict layers_of(const RenderSnapshot& snapshot) {
    static constexpr std::pair<const char*, const char*> colors[] = {
        {"mean", "R"},
        {"standard_error", "stderr.R"},
        {"skewness", "skewness.R"},
        {"denoised", "denoised.R"},
        {"albedo", "albedo.R"},
        {"normal", "N.X"},
        {"variance", "variance.R"},
        {"relative_variance", "relativeVariance.R"},
        {"geometric_normal", "Ng.X"},
        {"position", "P.X"},
        {"direct", "direct.R"},
        {"indirect", "indirect.R"}};
    static constexpr std::pair<const char*, const char*> pairs[] = {
        {"uv", "uv.U"}, {"depth_slopes", "dzdx"}, {"motion", "motion.X"}};
    static constexpr std::pair<const char*, const char*> mattes[] = {{"shape", "CryptoShape00.R"},
                                                                     {"material", "CryptoMaterial00.R"}};
    static constexpr std::pair<const char*, const char*> numbers[] = {
        {"samples", "samples"}, {"replicates", "replicates"}, {"outlier", "outlier"},
        {"warning", "warning"}, {"depth", "depth.Z"},         {"alpha", "A"}};
    nb::dict d;
    for (const auto& [name, first] : colors)
        if (const std::optional<int> c = snapshot.image->find_channel(first))
            d[name] = channels_of(snapshot.image, *c, 3);
    for (const auto& [name, channel] : numbers)
        if (const std::optional<int> c = snapshot.image->find_channel(channel))
            d[name] = channels_of(snapshot.image, *c, 1);
    for (const auto& [name, channel] : pairs)
        if (const std::optional<int> c = snapshot.image->find_channel(channel))
            d[name] = channels_of(snapshot.image, *c, 2);
    for (const auto& [name, channel] : mattes)
        if (const std::optional<int> c = snapshot.image->find_channel(channel))
            d[name] = channels_of(snapshot.image, *c, static_cast<int>(2 * cryptomatte_ranks));
    const std::vector<std::string>& channels = snapshot.image->channel_names();
    for (std::size_t c = 0; c < channels.size(); ++c)
        if (channels[c].starts_with("light.") && channels[c].ends_with(".R"))
            d[channels[c].substr(0, channels[c].size() - 2).c_str()] =
                channels_of(snapshot.image, static_cast<int>(c), 3);
    add_spectral_layers(d, snapshot);
    return d;
}

// For screens and formats without layers: the denoised picture, if there is one.
Image shown(const RenderSnapshot& snapshot) {
    if (snapshot.image->find_channel("denoised.R")) return denoised_picture(*snapshot.image);
    return snapshot.image->select(std::vector<std::string>{"R", "G", "B"});
}

// Throws Error for a curve that is not known.
ToneCurve curve_of(double exposure, const std::string& tone) {
    const std::optional<ToneKind> kind = tone_named(tone);
    if (!kind) {
        std::string known;
        for (const std::string_view name : tone_names())
            known += (known.empty() ? "'" : ", '") + std::string(name) + "'";
        throw Error("tone", "there is no tone curve '" + tone + "'" + did_you_mean(tone, tone_names()) +
                                "; expected one of " + known);
    }
    return {static_cast<float>(exposure), *kind};
}

nb::tuple screen(const RenderSnapshot& snapshot, double exposure, const std::string& tone) {
    auto tones = std::make_shared<Image>(apply_tone_curve(shown(snapshot), curve_of(exposure, tone), 8));
    nb::object bytes = nb::bytes(reinterpret_cast<const char*>(tones->u8().data()), tones->u8().size());
    return nb::make_tuple(bytes, tones->height(), tones->width(), tones->channels());
}

} // namespace

void bind_render(nb::module_& m) {
    nb::class_<RenderSnapshot>(m, "RenderSnapshot", "A render at some moment.")
        .def_prop_ro("layers", &layers_of)
        .def_prop_ro("relative_error", [](const RenderSnapshot& l) { return l.error.relative; })
        .def_prop_ro("mean_samples", [](const RenderSnapshot& l) { return l.error.mean_samples; })
        .def_prop_ro("samples", [](const RenderSnapshot& l) { return l.report.samples; })
        .def_prop_ro("seconds", [](const RenderSnapshot& l) { return l.report.seconds; })
        .def_prop_ro("cpu_seconds", [](const RenderSnapshot& l) { return l.report.cpu_seconds; })
        .def_prop_ro("bad_samples", [](const RenderSnapshot& l) { return l.report.bad.count(); })
        .def_prop_ro("clamped_samples", [](const RenderSnapshot& l) { return l.report.clamped_samples; })
        .def_prop_ro("stop", [](const RenderSnapshot& l) { return std::string(to_string(l.report.stop)); })
        .def("screen", &screen, "exposure"_a, "tone"_a, "8-bit sRGB: (bytes, height, width, channels).")
        .def(
            "visible_error",
            [](const RenderSnapshot& l, double exposure, const std::string& tone) {
                return visible_error_share(*l.image, curve_of(exposure, tone));
            },
            "exposure"_a, "tone"_a)
        .def("automatic_exposure", [](const RenderSnapshot& l) { return automatic_exposure(shown(l)); })
        .def(
            "save",
            [](const RenderSnapshot& l, const std::filesystem::path& path, double exposure,
               const std::string& tone, int quality) {
                nb::gil_scoped_release unlocked;
                WriteOptions writing{.jpeg_quality = quality, .tone = curve_of(exposure, tone)};
                if (l.half) writing.exr_half = half_channels_of(l.image->channel_names());
                const std::string extension = path.extension().string();
                if (extension == ".exr" || extension == ".EXR")
                    write_picture(path, *l.image, writing);
                else
                    write_image(path, shown(l), writing);
            },
            "path"_a, "exposure"_a, "tone"_a, "quality"_a);
    nb::class_<RenderJob>(m, "RenderJob", "A render in the background.")
        .def("cancel", &RenderJob::cancel)
        .def("wait", &RenderJob::wait, "seconds"_a, nb::call_guard<nb::gil_scoped_release>())
        .def("snapshot", &RenderJob::snapshot, "seconds"_a, nb::call_guard<nb::gil_scoped_release>())
        .def("result", &RenderJob::result)
        .def("progress",
             [](const RenderJob& j) {
                 const RenderProgress p = j.progress();
                 return nb::make_tuple(p.samples_done, p.samples_total, p.seconds,
                                       p.error ? nb::object(nb::float_(p.error->relative)) : nb::none(),
                                       p.forecast.share, p.forecast.seconds_left);
             })
        .def("warnings", &warnings_of)
        .def_prop_ro("view_url", &RenderJob::view_url)
        .def_prop_ro("guide",
                     [](const RenderJob& j) -> std::optional<Guide> {
                         if (!j.session().guide()) return std::nullopt;
                         return Guide{j.session().guide()};
                     })
        .def_prop_ro("refused_checkpoint",
                     [](const RenderJob& j) { return j.session().refused_checkpoint(); });
    m.def("start_render", &start, "scene"_a, "spp"_a.none(), "seed"_a.none(), "target_error"_a,
          "target_quantile"_a, "time"_a, "adaptive"_a, "threads"_a, "checkpoint"_a, "checkpoint_every"_a,
          "resume"_a, "slice"_a, "denoise"_a, "view"_a, "montelux.Scene.render, with everything decided.");
    m.def("check_writable", &check_writable, "path"_a);
}

} // namespace montelux::python
