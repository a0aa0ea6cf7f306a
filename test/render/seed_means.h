// Renders of one scene with many seeds, and a scene for them.
#pragma once

#include "test/render/scene_testing.h"
#include <array>
#include <memory>
#include <utility>
#include <vector>

#include "montelux/mc/stats/moments.h"

namespace montelux::testing {

inline constexpr int bidirectional_seeds = 16;

// The means over the picture of renders with different seeds, by channel. Pixels of one render share light paths.
struct SeedMeans {
    std::array<RunningMoments, 3> channel;
    std::vector<Film> films;
};
inline SeedMeans render_of_seeds(SceneDescription d, IntegratorKind method, std::uint32_t spp,
                                 int count = bidirectional_seeds) {
    d.integrator.method = method;
    d.sampler.spp = spp;
    // With the same numbers the methods would agree too well.
    const std::uint64_t first = d.sampler.seed + (method == IntegratorKind::path ? 100 : 200);
    const auto prepared = std::make_shared<const PreparedScene>(d);
    SeedMeans result;
    for (int i = 0; i < count; ++i) {
        d.sampler.seed = first + static_cast<std::uint64_t>(i);
        RenderState state(d);
        Renderer(d, {}, 0, prepared).render(state);
        result.films.push_back(std::move(state.film));
        for (int c = 0; c < 3; ++c)
            result.channel[static_cast<std::size_t>(c)].add(picture_mean(result.films.back(), c).mean);
    }
    return result;
}

// A floor and a wall, lit by nothing yet.
inline SceneBuilder lit_corner(const Material& floor = DiffuseMaterial{gray(0.6f)}) {
    SceneBuilder b;
    b.add_mesh(square(Transform::scale({1.5, 1.5, 1})), b.add(floor));
    b.add_mesh(square(Transform::translate({0, 1.2, 0.6}) * Transform::rotate(90, {1, 0, 0})),
               b.add(DiffuseMaterial{gray(0.5f)}));
    b.look({0.2, -4, 2.2}, {0, 0, 0.3}, 40);
    return b;
}
inline void add_box_lamp(SceneBuilder& b, double size = 0.3) {
    b.add_mesh(square(Transform::translate({0.3, -0.2, 1.6}) * Transform::rotate(180, {1, 0, 0}) *
                      Transform::scale({size, size, 1})),
               b.add(DiffuseMaterial{gray(0)}), static_cast<float>(0.7 / (size * size)));
}

} // namespace montelux::testing
