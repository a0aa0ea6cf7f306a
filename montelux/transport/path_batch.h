// PathBatch: many paths on their way, one step at a time.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <type_traits>
#include <vector>

#include "montelux/mc/random/sample_stream.h"
#include "montelux/transport/path_state.h"

namespace montelux {

// A branch of a path, after the vertex where it was split off.
struct PathBranch {
    PathState state;
    SampleStream stream;
    std::optional<ShadowRay> shadow;
    Index sample = no_index; // whose path was split
};

// The memory of PathIntegrator::estimate for many samples; allocated once and used again.
struct PathBatch {
    std::vector<PathState> states; // of the samples, then of their branches
    std::vector<Index> alive;      // of `states`, in order

    std::vector<const Ray*> rays; // to be traced next
    std::vector<Hit> hits;
    std::vector<std::optional<ShadowRay>> shadows;
    std::vector<Index> shadow_owners; // of `states`
    std::unique_ptr<bool[]> occluded;
    std::size_t capacity = 0;

    // Of the states that are branches.
    struct Origin {
        Index sample;
        SampleStream stream;
    };
    std::vector<Origin> origins;
    std::vector<PathBranch> begun; // in this step

    // Without paths, and memory for so many.
    void reset(std::size_t paths) {
        states.clear();
        alive.clear();
        origins.clear();
        begun.clear();
        reserve(paths);
    }
    void reserve(std::size_t paths) {
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
    // The branches of this step become paths like the others.
    void take_branches() {
        if (alive.size() + begun.size() > capacity) reserve(2 * (alive.size() + begun.size()));
        for (PathBranch& b : begun) {
            const auto i = static_cast<Index>(states.size());
            if (b.shadow) {
                shadows.push_back(b.shadow);
                shadow_owners.push_back(i);
            }
            alive.push_back(i);
            states.push_back(b.state);
            origins.push_back({b.sample, b.stream});
        }
        begun.clear();
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
