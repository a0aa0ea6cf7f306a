#include "montelux/render/checkpoint.h"

#include <algorithm>
#include <array>
#include <bit>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "montelux/mc/io/byte_stream.h"
#include "montelux/mc/io/generation_file.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/random/hash.h"
#include "montelux/scene/light/light_groups.h"
#include "montelux/scene/scene_names.h"
#include "montelux/scene/setting_names.h"

namespace montelux {
namespace {

constexpr std::string_view kind = "render";
// Version of the layout below.
constexpr std::uint32_t layout_version = 9;
static_assert(std::is_trivially_copyable_v<Pixel> && std::endian::native == std::endian::little);

template <typename... T>
std::uint64_t hash_of(const T&... values) {
    std::uint64_t h = 0;
    auto add = [&](const auto& v) {
        using V = std::decay_t<decltype(v)>;
        if constexpr (std::is_same_v<V, float>)
            h = hash_key(h, std::bit_cast<std::uint32_t>(v));
        else
            h = hash_key(h, static_cast<std::uint64_t>(v));
    };
    (add(values), ...);
    return h;
}
std::uint64_t hash_of_filter(const PixelFilter& filter) {
    const std::uint64_t which = filter.index();
    return std::visit(
        [&](const auto& f) {
            using F = std::decay_t<decltype(f)>;
            const std::uint64_t h = hash_of(which, f.radius.x, f.radius.y);
            if constexpr (std::is_same_v<F, GaussianFilter>) return hash_of(h, f.sigma);
            if constexpr (std::is_same_v<F, MitchellFilter>) return hash_of(h, f.b, f.c);
            if constexpr (std::is_same_v<F, LanczosFilter>) return hash_of(h, f.tau);
            return h;
        },
        filter);
}

// What a resumed render must share with the saved one; `difference` is the message if it does not.
struct Fingerprint {
    const char* difference;
    std::uint64_t hash;
};
std::uint64_t hash_of_text(std::string_view text) {
    std::uint64_t h = text.size();
    for (const char c : text) h = hash_key(h, static_cast<std::uint8_t>(c));
    return h;
}
std::uint64_t hash_of_film(const FilmSettings& f) {
    const SpectralSettings spectral = f.spectral.value_or(SpectralSettings{});
    return hash_of(f.width, f.height, f.crop.x0, f.crop.y0, f.crop.x1, f.crop.y1, hash_of_filter(f.filter),
                   f.iso, f.exposure_time, f.white_balance, f.max_component_value, hash_of_text(f.sensor),
                   f.spectral.has_value(), spectral.lambda_min, spectral.lambda_max, spectral.buckets);
}
std::uint64_t hash_of_integrator(const IntegratorSettings& s) {
    const auto with_background = [&](std::uint64_t h) {
        if (s.method != IntegratorKind::path)
            h = hash_of(h, static_cast<int>(s.method), s.large_step_probability);
        return s.background ? hash_of(h, s.background->x, s.background->y, s.background->z) : h;
    };
    const auto with_guiding = [&](std::uint64_t h) {
        return s.guiding == Guiding::off ? h : hash_of(h, static_cast<int>(s.guiding), s.guiding_memory);
    };
    const auto with_merging = [&](std::uint64_t h) {
        return merges(s) ? hash_of(h, s.merging->radius, s.merging->memory) : h;
    };
    const auto with_manifolds = [&](std::uint64_t h) {
        return s.manifold_sampling ? hash_of(h, 0x6d616e69666f6c64ULL) : h; // "manifold"
    };
    if (s.occlusion) return with_background(hash_of(s.occlusion->cosine, s.occlusion->max_distance));
    return with_manifolds(with_merging(with_guiding(with_background(
        hash_of(s.max_depth, s.count_passages, static_cast<int>(s.strategy), static_cast<int>(s.heuristic),
                static_cast<int>(s.light_sampling), s.equiangular, s.regularize,
                static_cast<int>(s.environment_sampling), s.environment_compensation,
                static_cast<int>(s.environment_lookup), static_cast<int>(s.microfacet_scattering),
                static_cast<int>(s.shading_terminator))))));
}
// Another version of the program may take different samples.
std::uint64_t version() { return hash_of(layout_version, hash_of_text(MONTELUX_VERSION)); }

constexpr std::size_t fingerprint_count = 10;
std::array<Fingerprint, fingerprint_count> fingerprints(const SceneDigest& scene, const SceneDescription& d,
                                                        const RenderTarget& target) {
    auto of = [](const ContentDigest& part) { return hash_of(part.high, part.low); };
    return {{{"the scene's geometry differs", of(scene.geometry)},
             {"the scene's materials differ", of(scene.materials)},
             {"the scene's textures differ", of(scene.textures)},
             {"the scene's lights differ", of(scene.lights)},
             {"the scene's camera differs", of(scene.camera)},
             {"the film differs", hash_of_film(d.film)},
             {"the sampler or seed differs", hash_of(static_cast<int>(d.sampler.kind), d.sampler.seed)},
             {"the integrator differs", hash_of_integrator(d.integrator)},
             {"the allocation of samples (--adaptive) differs", hash_of(target.adaptive)},
             {"the slice differs", hash_of(target.slice.index, target.slice.count)}}};
}

// Of everything that the sums of the film's layers depend on and the mean does not; 0 for the standard layers.
std::uint64_t hash_of_layers(const SceneDescription& d, const FilmLayers& layers) {
    const LayerSettings& settings = d.film.layers;
    if (layers.sums() == 0 && !settings.in_camera_space) return 0;
    std::uint64_t h = hash_of(layers.sums(), settings.in_camera_space);
    for (const std::string& group : layers.light_groups()) h = hash_of(h, hash_of_text(group));
    for (const Layer layer :
         {Layer::geometric_normal, Layer::position, Layer::uv, Layer::depth_slopes, Layer::motion,
          Layer::alpha, Layer::direct, Layer::indirect, Layer::shape, Layer::material})
        h = hash_of(h, layers.set().has(layer));
    const auto add_names = [&](const std::vector<std::string>& names) {
        for (const std::string& name : names) h = hash_of(h, hash_of_text(name));
    };
    if (settings.set.has(Layer::light_groups))
        for (const Index group : light_groups(d.scene, settings.light_grouping).of_light)
            h = hash_of(h, group);
    if (settings.set.has(Layer::shape)) {
        add_names(d.scene.shape_names);
        add_names(instance_names(d.scene));
    }
    if (settings.set.has(Layer::material)) add_names(d.scene.material_names);
    return h == 0 ? 1 : h;
}

void put(ByteWriter& out, const SplatFilm& film) {
    out.put_all(film.sums());
    out.put(film.bad());
    out.put(film.overflows());
}
void get(ByteReader& in, SplatFilm& film) {
    in.get_all(film.sums());
    const auto bad = in.get<std::uint64_t>(), overflows = in.get<std::uint64_t>();
    film.set_counts(bad, overflows);
}

std::size_t splat_bytes(const RenderState& state) {
    const auto of = [](const SplatFilm& film) {
        return film.sums().size_bytes() + 2 * sizeof(std::uint64_t);
    };
    return (state.splats ? of(*state.splats) : 0) +
           (state.bias ? of(state.bias->open()) + state.bias->cells().size_bytes() + sizeof(std::uint64_t)
                       : 0);
}

// An upper bound of the size for this film, generous so that a checkpoint of a larger film is refused by the right
// message. Larger files are not read into memory.
std::size_t most_bytes(const RenderState& state) {
    const std::span<const Pixel> pixels = state.film.pixels();
    // With splats, whatever the integrator is.
    return 64 * (pixels.size_bytes() + pixels.size() * (sizeof(std::uint32_t) + 6 * sizeof(std::int64_t)) +
                 state.film.buckets().size_bytes() + state.film.layer_sums().size_bytes()) +
           1024;
}

void check_version(const std::filesystem::path& path, ByteReader& in) {
    if (in.get<std::uint64_t>() != version())
        throw Error(path.string(), "the checkpoint is of another version of Montelux, which this one cannot "
                                   "resume; resume it with that version, or render anew to another file");
}

} // namespace

void save_checkpoint(const std::filesystem::path& path, const Renderer& renderer, const RenderState& state) {
    ByteWriter out;
    const bool may_be_guided = renderer.description().integrator.guiding != Guiding::off;
    const std::span<const Pixel> pixels = state.film.pixels();
    out.reserve(pixels.size_bytes() + state.film.buckets().size_bytes() +
                state.film.layer_sums().size_bytes() + splat_bytes(state) +
                state.target_samples.size() * sizeof(std::uint32_t) + 1024);
    out.put(version());
    for (const Fingerprint& f :
         fingerprints(renderer.scene_digest(), renderer.description(), renderer.target()))
        out.put(f.hash);
    out.put(points_per_replicate(renderer.sampler()));
    out.put(state.report);
    out.put(static_cast<std::uint64_t>(pixels.size()));
    out.put(static_cast<std::uint64_t>(state.target_samples.size()));
    out.put_all(std::span<const std::uint32_t>(state.target_samples));
    out.put_all(pixels);
    out.put_all(state.film.buckets());
    if (const std::uint64_t layers = hash_of_layers(renderer.description(), state.film.layers());
        layers != 0 || may_be_guided) {
        out.put(layers);
        out.put_all(state.film.layer_sums());
    }
    if (may_be_guided) {
        out.put(static_cast<std::uint8_t>(state.guide != nullptr));
        if (state.guide) state.guide->save(out);
    }
    if (state.splats) put(out, *state.splats);
    if (state.bias) {
        put(out, state.bias->open());
        out.put_all(state.bias->cells());
        out.put(state.bias->passes());
    }
    write_generation(path, kind, out.take());
}

std::uint64_t render_fingerprint(const Renderer& renderer) {
    std::uint64_t hash = hash_of(version(), SampleOrder(renderer.sampler(), {}).replicate_size());
    for (const Fingerprint& f : fingerprints(renderer.scene_digest(), renderer.description(), {}))
        hash = hash_of(hash, f.hash);
    return hash;
}

std::uint64_t picture_fingerprint(const SceneDescription& d, const RenderTarget& target) {
    std::uint64_t hash = hash_of(
        version(), d.sampler.spp, std::bit_cast<std::uint64_t>(target.error),
        std::bit_cast<std::uint64_t>(target.quantile), std::bit_cast<std::uint64_t>(target.time),
        d.film.layers.half, hash_of_text(text_of(d.film.layers.set)), hash_of_layers(d, film_layers_of(d)));
    for (const Fingerprint& f : fingerprints(digest_of(d.scene), d, target)) hash = hash_of(hash, f.hash);
    return hash;
}

IntegratorKind integrator_of_checkpoint(const std::filesystem::path& path, const SceneDescription& d) {
    const Generation generation = read_generation(path, kind, most_bytes(RenderState(d)));
    ByteReader in(generation.payload, "checkpoint");
    check_version(path, in);
    std::array<std::uint64_t, fingerprint_count> saved{};
    in.get_all(std::span<std::uint64_t>(saved));
    IntegratorSettings settings = d.integrator;
    for (const auto& [name, method] : integrator_names) {
        settings.method = method;
        if (std::ranges::find(saved, hash_of_integrator(settings)) != saved.end()) return method;
    }
    throw Error(path.string(), "the checkpoint is of another render: the integrator's settings differ");
}

RestoredRender load_checkpoint(const std::filesystem::path& path, const SceneDescription& description,
                               const RenderTarget& target) {
    RestoredRender restored{RenderState(description), 0, {}};
    RenderState& state = restored.state;
    const std::span<Pixel> pixels = state.film.pixels();
    const bool may_be_guided = description.integrator.guiding != Guiding::off;
    const Generation generation = read_generation(path, kind, most_bytes(state));
    restored.newest_refused_because = generation.newest_refused_because;
    ByteReader in(generation.payload, "checkpoint");
    check_version(path, in);
    for (const Fingerprint& f : fingerprints(digest_of(description.scene), description, target))
        if (in.get<std::uint64_t>() != f.hash)
            throw Error(path.string(), std::string("the checkpoint is of another render: ") + f.difference);
    restored.replicate_points = in.get<std::uint32_t>();
    state.report = in.get<RenderReport>();
    const auto count = in.get<std::uint64_t>(), target_samples = in.get<std::uint64_t>();
    if (count != pixels.size() || (target_samples != 0 && target_samples != count))
        throw Error(path.string(), "the checkpoint has another number of pixels");
    state.target_samples.resize(target_samples);
    in.get_all(std::span<std::uint32_t>(state.target_samples));
    in.get_all(pixels);
    in.get_all(state.film.buckets());
    const std::uint64_t layers = hash_of_layers(description, state.film.layers());
    const bool has_layers = in.remaining() > splat_bytes(state);
    if ((has_layers ? in.get<std::uint64_t>() : 0) != layers)
        throw Error(path.string(),
                    "the checkpoint is of another render: the layers of the film (--layers) differ");
    if (layers != 0) in.get_all(state.film.layer_sums());
    if (may_be_guided) {
        if (in.get<std::uint8_t>() != 0)
            state.guide = std::make_shared<const GuidingField>(GuidingField::load(in));
    }
    if (state.splats) get(in, *state.splats);
    if (state.bias) {
        get(in, state.bias->open());
        std::vector<MergingBias::Cell> cells(state.bias->cells().size());
        in.get_all(std::span(cells));
        state.bias->restore(cells, in.get<std::uint64_t>());
    }
    if (!in.at_end() || restored.replicate_points == 0)
        throw Error(path.string(), "the checkpoint is not what its header says");
    return restored;
}

} // namespace montelux
