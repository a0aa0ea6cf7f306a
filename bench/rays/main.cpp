// montelux_bench_rays: the rays of renders, traced by Embree alone.
#include "bench/rays/options.h"
#include "bench/rays/report.h"
#include <algorithm>
#include <cstdio>
#include <exception>

#include "montelux/formats/load_scene.h"
#include "montelux/mc/math/error.h"

namespace {

using namespace montelux;
using namespace montelux::bench;

void narrow(FilmSettings& film, int width) {
    film.height = std::max(1, film.height * width / film.width);
    film.width = width;
    film.crop = {0, 0, film.width, film.height};
}

void measure(const std::filesystem::path& file, const RayOptions& options, std::vector<RayRun>& runs) {
    Warnings warnings;
    SceneDescription description = load_scene(file, warnings);
    narrow(description.film, options.width);
    description.sampler = {SamplerKind::independent, 0, options.spp};
    const Renderer renderer(description);
    const RecordedRays recorded(renderer, options.spp, options.rays);
    const EmbreeScene robust(renderer.scene()), fast(renderer.scene(), false);
    const std::string name =
        file.filename() == "scene.pbrt" ? file.parent_path().filename().string() : file.stem().string();
    for (const RayKind kind : ray_kinds) {
        if (recorded.count(kind) == 0) continue;
        for (const EmbreeScene* scene : {&robust, &fast})
            for (const RayOrder order : ray_orders) {
                const std::vector<Ray> rays = recorded.in_order(kind, order);
                for (const Tracing& tracing : all_tracings())
                    runs.push_back({name, kind, order, scene == &robust, tracing, rays.size(),
                                    trace(*scene, kind, rays, tracing, options.repetitions)});
            }
    }
}

} // namespace

int main(int argc, char** argv) {
    try {
        const RayOptions options = parse_ray_options({argv + 1, argv + argc});
        if (options.help) {
            std::fputs(ray_options_help().data(), stdout);
            return 0;
        }
        std::vector<RayRun> runs;
        for (const std::filesystem::path& scene : options.scenes) measure(scene, options, runs);
        print_table(runs);
        if (!options.json.empty()) write_json(options.json, runs);
        return 0;
    } catch (const std::exception& e) {
        std::fprintf(stderr, "montelux_bench_rays: %s\n", e.what());
        return 1;
    }
}
