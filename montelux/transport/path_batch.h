// PathBatch: many paths on their way, one step at a time.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <type_traits>
#include <vector>

#include "montelux/transport/path_state.h"

namespace montelux {

// The memory of PathIntegrator::estimate for many samples; allocated once and used again.
struct PathBatch {
    std::vector<PathState> states;
    std::vector<Index> alive; // of `states`, in order

    std::vector<const Ray*> rays; // to be traced next
    std::vector<Hit> hits;
    std::vector<std::optional<ShadowRay>> shadows;
    std::vector<Index> shadow_owners; // of `states`
    std::unique_ptr<bool[]> occluded;
    std::size_t capacity = 0;

    // Without paths, and memory for so many.
    void reset(std::size_t paths) {
        states.clear();
        alive.clear();
        if (paths <= capacity) return;
        capacity = paths;
        states.reserve(paths);
        alive.reserve(paths);
        rays.reserve(paths);
        hits.resize(paths);
        shadows.reserve(paths);
        shadow_owners.reserve(paths);
        occluded = std::make_unique<bool[]>(paths);
    }
};

// Converts to the result of f: an element that is built in place by emplace_back. Structs that were just
// written are slow to copy.
template <typename F>
struct InPlace {
    const F& f;
    explicit InPlace(const F& function) : f(function) {}
    operator std::invoke_result_t<const F&>() const { return f(); }
};

} // namespace montelux
