#include "python/src/bindings.h"
#include "python/src/interruptible.h"
#include "python/src/numpy_bridge.h"
#include "python/src/scene_object.h"
#include <utility>
#include <vector>

#include "montelux/mc/parallel/parallel_for.h"
#include "montelux/render/metropolis/chain_renderer.h"
#include "montelux/render/strategy_pictures.h"

namespace montelux::python {
namespace {

DoubleArray strategy_array(const std::vector<Vec3f>& pixels, const PixelBounds& crop) {
    const std::size_t shape[] = {static_cast<std::size_t>(crop.height()),
                                 static_cast<std::size_t>(crop.width()), 3};
    NewArray array = new_array(shape);
    double* to = array.data;
    for (const Vec3f& pixel : pixels)
        for (int c = 0; c < 3; ++c) *to++ = static_cast<double>(pixel[c]);
    return array.array;
}

std::vector<nb::tuple> strategies_of(const SceneObject& scene, std::optional<std::uint32_t> spp,
                                     std::optional<std::uint64_t> seed, int threads) {
    const std::shared_ptr<const SceneDescription> description = description_of(scene, spp, seed);
    std::vector<StrategyPicture> pictures;
    {
        nb::gil_scoped_release unlocked;
        run_interruptibly([&](const CancelFlag& cancel) {
            with_threads(threads, [&] {
                const Renderer renderer(*description);
                pictures = strategy_pictures(renderer, [&] { return cancel.requested(); });
            });
        });
    }
    std::vector<nb::tuple> list;
    const PixelBounds& crop = description->film.crop;
    for (const StrategyPicture& p : pictures)
        list.push_back(
            nb::make_tuple(p.s, p.t, strategy_array(p.weighted, crop), strategy_array(p.unweighted, crop)));
    return list;
}

// Of chains of one length.
nb::dict dict_of(const std::vector<ChainWalk>& traces) {
    const std::size_t chains = traces.size(), steps = traces.empty() ? 0 : traces[0].steps.size();
    const std::size_t points[] = {chains, steps, 2}, one[] = {chains, 2}, each[] = {chains},
                      numbers[] = {chains, steps};
    NewArray start = new_array(one), start_size = new_array(each), proposed = new_array(points),
             size = new_array(numbers), acceptance = new_array(numbers);
    NewIndexArray large = new_index_array(numbers), accepted = new_index_array(numbers);
    for (std::size_t c = 0; c < chains; ++c) {
        start.data[2 * c] = static_cast<double>(traces[c].start.x);
        start.data[2 * c + 1] = static_cast<double>(traces[c].start.y);
        start_size.data[c] = traces[c].start_size;
        for (std::size_t t = 0; t < steps; ++t) {
            const ChainWalk::Step& step = traces[c].steps[t];
            const std::size_t i = c * steps + t;
            proposed.data[2 * i] = static_cast<double>(step.proposed.x);
            proposed.data[2 * i + 1] = static_cast<double>(step.proposed.y);
            size.data[i] = step.size;
            acceptance.data[i] = step.acceptance;
            large.data[i] = step.large;
            accepted.data[i] = step.accepted;
        }
    }
    nb::dict d;
    d["start"] = start.array;
    d["start_size"] = start_size.array;
    d["proposed"] = proposed.array;
    d["size"] = size.array;
    d["acceptance"] = acceptance.array;
    d["large"] = large.array;
    d["accepted"] = accepted.array;
    return d;
}

nb::dict chains_of(const SceneObject& scene, std::size_t chains, std::uint64_t group,
                   std::optional<std::uint32_t> spp, std::optional<std::uint64_t> seed, int threads) {
    const std::shared_ptr<const SceneDescription> description = description_of(scene, spp, seed);
    if (description->integrator.method != IntegratorKind::metropolis)
        throw Error("path_chains",
                    "only the integrator 'metropolis' has chains; set scene.integrator.method");
    std::vector<ChainWalk> traces;
    {
        nb::gil_scoped_release unlocked;
        run_interruptibly([&](const CancelFlag& cancel) {
            with_threads(threads, [&] {
                const Renderer renderer(*description);
                renderer.serve([&](const SampleTakers& takers) {
                    traces = takers.chains->trace(group, chains,
                                                  {[&] { return cancel.requested(); }, [](std::uint64_t) {}});
                });
            });
        });
    }
    return dict_of(traces);
}

} // namespace

void bind_paths(nb::module_& m) {
    m.def("strategy_pictures", &strategies_of, "scene"_a, "spp"_a.none(), "seed"_a.none(), "threads"_a,
          "montelux.Scene.strategy_pictures, with everything decided: (s, t, weighted, unweighted) of each.");
    m.def("path_chains", &chains_of, "scene"_a, "chains"_a, "group"_a, "spp"_a.none(), "seed"_a.none(),
          "threads"_a, "montelux.Scene.path_chains, with everything decided.");
}

} // namespace montelux::python
