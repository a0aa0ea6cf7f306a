// ChainRenderer: takes the replicates of a Metropolis picture, group of chains by group of chains.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "montelux/accel/accelerator.h"
#include "montelux/render/metropolis/chain_group.h"
#include "montelux/render/metropolis/chain_plan.h"
#include "montelux/render/render_state.h"
#include "montelux/render/sample_context.h"
#include "montelux/render/sample_order.h"
#include "montelux/scene/camera/camera.h"

namespace montelux {

// The render loop as a chain renderer sees it. Called from the rendering threads, several at once.
struct ChainWatch {
    // Whether to give up the groups that are being taken.
    std::function<bool()> abandon;
    // Whether to return after a group, asked between groups.
    std::function<bool()> pause;
    // Paths taken since the last group was added to the film.
    std::function<void(std::uint64_t paths)> tell;
    // Calls the function, which changes the film and the report.
    std::function<void(const std::function<void()>& change)> add;
};

// Groups are replicates: that of the film's n-th replicate has the number that `order` gives its samples. They are
// taken a few at a time, so that all threads have work, and added in order. Memory: a SplatFilm for every eight threads.
//
// Light after at most one scattering event comes from camera rays of each pixel, as many as it has samples, which
// are stratified as SampleContext's are; chains follow all other light. They are a part of the group, and give albedo,
// normal and depth. If the film limits samples, whose limit holds for the sum of both kinds of light, chains follow all
// light.
class ChainRenderer {
  public:
    // All arguments must outlive it.
    ChainRenderer(const SceneDescription& description, const SamplerSettings& sampler, const SceneView& scene,
                  const Camera& camera, const Accelerator& accelerator, SampleOrder order);

    // Takes groups until all pixels have so many samples, or the watch says otherwise.
    void run(RenderState& state, std::uint32_t target_samples, const ChainWatch& watch);

  private:
    // Means over the camera rays of a pixel.
    struct DirectLight {
        Vec3d radiance;
        Vec3f albedo, normal;
        float depth = 0;
    };
    struct Costs {
        RayStatistics rays;
        double cpu_seconds = 0;
    };
    // Returns false if it was abandoned.
    bool take(std::uint64_t first, std::size_t count, const ChainWatch& watch);
    // A row of a group's pixels.
    void take_direct_light(std::uint64_t group, int row, std::span<DirectLight> into, RayTracer& tracer,
                           BadSampleReport& bad) const;
    void add(RenderState& state, const ChainGroup& group, std::span<const DirectLight> direct) const;
    template <typename Task>
    bool run_tasks(std::size_t count, const ChainWatch& watch, std::uint64_t paths, const Task& task);

    const SceneDescription& description_;
    const Accelerator& accelerator_;
    SampleOrder order_;
    bool separates_direct_light_;
    PrimarySampler sampler_;
    ChainKeys keys_;
    SamplerSettings direct_sampler_;
    SampleContext direct_context_;
    std::optional<ChainPlan> plan_;
    std::vector<std::unique_ptr<ChainGroup>> groups_;
    std::vector<std::vector<DirectLight>> direct_; // of the groups
    std::vector<BadSampleReport> bad_;             // of their direct light
    std::mutex mutex_;                             // of bad_ and the members below, while tasks run
    Costs costs_;                                  // since the last group was added
    std::uint64_t paths_ = 0;
};

} // namespace montelux
