// Renders that ranks of this process share.
#pragma once

#include "test/cluster/local_job.h"
#include "test/render/mixed_scene.h"
#include <cstdint>
#include <gtest/gtest.h>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "montelux/cluster/coordinator.h"
#include "montelux/cluster/serve.h"
#include "montelux/render/renderer.h"

namespace montelux::testing {

inline int differing(const Film& a, const Film& b) {
    int count = 0;
    for (std::size_t i = 0; i < a.pixels().size(); ++i) count += !same_pixel(a.pixels()[i], b.pixels()[i]);
    return count;
}

// The ranks beside the first one.
class Helpers {
  public:
    Helpers(LocalJob& job, const Renderer& renderer, int ranks, int tile_size,
            const CancelFlag* cancel = nullptr) {
        for (int r = 1; r < ranks; ++r)
            threads_.emplace_back([&job, &renderer, tile_size, r, cancel] {
                serve_render(renderer, job.mailbox(r),
                             {.tile_size = tile_size, .threads = 1 + r % 2, .cancel = cancel});
            });
    }
    ~Helpers() {
        for (std::thread& t : threads_) t.join();
    }

  private:
    std::vector<std::thread> threads_;
};

// Returns how many tiles changed hands.
inline std::uint64_t render_on(int ranks, const Renderer& renderer, RenderState& state,
                               RenderControl control = {}) {
    LocalJob job(ranks);
    const CoordinatorSettings settings{.tile_size = 4, .threads = 1};
    const Helpers helpers(job, renderer, ranks, settings.tile_size);
    Coordinator coordinator(job.mailbox(0), renderer.description().film.crop, settings);
    control.executor = &coordinator;
    renderer.render(state, control);
    EXPECT_FALSE(coordinator.failed());
    return coordinator.moved_tiles();
}

// A render led by one rank and taken by another, which falls silent: the state that was saved of it.
inline RenderState render_until_lost(const Renderer& renderer, protocol::Tag last, int n) {
    const SceneDescription& description = renderer.description();
    LocalJob job(2);
    FailingMailbox failing(job.mailbox(1), last, n);
    std::thread helper(
        [&] { serve_render(renderer, failing, {.tile_size = 4, .threads = 1, .patience_seconds = 60}); });
    RenderState state(description), saved(description);
    {
        Coordinator coordinator(job.mailbox(0), description.film.crop,
                                {.tile_size = 4, .threads = 0, .patience_seconds = 1.5});
        RenderControl control;
        control.executor = &coordinator;
        control.checkpoint = [&](const RenderState& s) { saved = s; };
        renderer.render(state, control);
        EXPECT_TRUE(coordinator.failed());
        EXPECT_TRUE(state.report.cancelled());
    }
    helper.join();
    EXPECT_TRUE(failing.failed());
    return saved;
}

} // namespace montelux::testing
