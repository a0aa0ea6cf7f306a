// A render that is interrupted again and again, saved, and resumed from its checkpoint.
#pragma once

#include <cstdint>
#include <filesystem>
#include <gtest/gtest.h>
#include <memory>
#include <utility>

#include "montelux/mc/parallel/parallel_for.h"
#include "montelux/mc/random/hash.h"
#include "montelux/render/checkpoint.h"
#include "montelux/render/render_session.h"
#include "montelux/render/splat_pass.h"

namespace montelux::testing {

struct Pieces {
    RenderState state; // at the end
    int count = 0, begun_within_a_pass = 0;
};

// Where it stops depends on samples alone: after up to a quarter of `samples`, those of the whole render. The checkpoint
// is at `path`.
inline Pieces render_in_pieces(const SceneDescription& whole, const std::filesystem::path& path,
                               std::uint64_t samples, std::shared_ptr<const PreparedScene> prepared) {
    Pieces pieces{RenderState(whole)};
    for (bool ended = false; !ended && pieces.count < 1000; ++pieces.count) {
        RenderState state(whole);
        SceneDescription description = whole;
        if (pieces.count > 0) {
            RestoredRender restored = load_checkpoint(path, description, {});
            description.sampler.replicate_points = restored.replicate_points;
            state = std::move(restored.state);
            pieces.begun_within_a_pass += open_samples(state.film) > 0;
        }
        const Renderer renderer(description, {}, 0, prepared);
        CancelFlag cancel;
        const std::uint64_t end = state.report.samples + 1 + hash_key(7, pieces.count) % (samples / 4);
        RenderControl control;
        control.cancel = &cancel;
        control.checkpoint_seconds = 0; // after every tile
        control.checkpoint = [&](const RenderState& s) {
            save_checkpoint(path, renderer, s);
            if (s.report.samples >= end) cancel.request();
        };
        with_threads(2, [&] { renderer.render(state, control); }); // more may end a pass at once
        ended = !state.report.cancelled();
        pieces.state = std::move(state);
    }
    EXPECT_FALSE(pieces.state.report.cancelled());
    return pieces;
}

} // namespace montelux::testing
