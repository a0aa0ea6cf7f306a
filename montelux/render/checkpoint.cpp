#include "montelux/render/checkpoint.h"

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

namespace montelux {
namespace {

constexpr std::string_view kind = "render";
// Version of the layout below.
constexpr std::uint32_t layout_version = 3;
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
// Another version of the program may take different samples.
std::uint64_t version() { return hash_of(layout_version, hash_of_text(MONTELUX_VERSION)); }

// Without options of surfaces the hash is that of versions that did not have them: their checkpoints stay valid.
std::uint64_t with_surfaces(SurfaceSettings s, std::uint64_t hash) {
    if (s == SurfaceSettings{}) return hash;
    return hash_of(hash, static_cast<int>(s.microfacets), static_cast<int>(s.terminator));
}

std::array<Fingerprint, 10> fingerprints(const SceneDigest& scene, const SceneDescription& d,
                                         const RenderTarget& target) {
    const FilmSettings& f = d.film;
    auto of = [](const ContentDigest& part) { return hash_of(part.high, part.low); };
    return {{{"the scene's geometry differs", of(scene.geometry)},
             {"the scene's materials differ", of(scene.materials)},
             {"the scene's textures differ", of(scene.textures)},
             {"the scene's lights differ", of(scene.lights)},
             {"the scene's camera differs", of(scene.camera)},
             {"the film differs",
              hash_of(f.width, f.height, f.crop.x0, f.crop.y0, f.crop.x1, f.crop.y1, hash_of_filter(f.filter),
                      f.iso, f.exposure_time, f.white_balance, f.max_component_value)},
             {"the sampler or seed differs", hash_of(static_cast<int>(d.sampler.kind), d.sampler.seed)},
             {"the integrator differs",
              with_surfaces(d.integrator.surfaces(),
                            hash_of(d.integrator.max_depth, static_cast<int>(d.integrator.strategy),
                                    static_cast<int>(d.integrator.heuristic),
                                    static_cast<int>(d.integrator.light_sampling),
                                    static_cast<int>(d.integrator.environment_sampling),
                                    d.integrator.environment_compensation,
                                    static_cast<int>(d.integrator.environment_lookup)))},
             {"the allocation of samples (--adaptive) differs", hash_of(target.adaptive)},
             {"the slice differs", hash_of(target.slice.index, target.slice.count)}}};
}

} // namespace

void save_checkpoint(const std::filesystem::path& path, const Renderer& renderer, const RenderState& state) {
    ByteWriter out;
    const std::span<const Pixel> pixels = state.film.pixels();
    out.reserve(pixels.size_bytes() + state.target_samples.size() * sizeof(std::uint32_t) + 1024);
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
    write_generation(path, kind, out.take());
}

std::uint64_t render_fingerprint(const Renderer& renderer) {
    std::uint64_t hash = hash_of(version(), SampleOrder(renderer.sampler(), {}).replicate_size());
    for (const Fingerprint& f : fingerprints(renderer.scene_digest(), renderer.description(), {}))
        hash = hash_of(hash, f.hash);
    return hash;
}

RestoredRender load_checkpoint(const std::filesystem::path& path, const SceneDescription& description,
                               const RenderTarget& target) {
    RestoredRender restored{RenderState(description.film), 0, {}};
    RenderState& state = restored.state;
    const std::span<Pixel> pixels = state.film.pixels();
    // An upper bound of the size for this film, generous so that a checkpoint of a larger film is refused by
    // the right message. Larger files are not read into memory.
    const std::size_t most = 64 * (pixels.size_bytes() + pixels.size() * sizeof(std::uint32_t)) + 1024;
    const Generation generation = read_generation(path, kind, most);
    restored.newest_refused_because = generation.newest_refused_because;
    ByteReader in(generation.payload, "checkpoint");
    if (in.get<std::uint64_t>() != version())
        throw Error(path.string(), "the checkpoint is of another version of Montelux, which this one cannot "
                                   "resume; resume it with that version, or render anew to another file");
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
    if (!in.at_end() || restored.replicate_points == 0)
        throw Error(path.string(), "the checkpoint is not what its header says");
    return restored;
}

} // namespace montelux
