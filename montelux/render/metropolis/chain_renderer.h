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

// What groups that are being taken report. Called from the rendering threads, several at once.
struct GroupWatch {
    // Whether to give up these groups.
    std::function<bool()> abandon;
    // Paths taken of them so far.
    std::function<void(std::uint64_t paths)> tell;
};

// The render loop as a chain renderer sees it.
struct ChainWatch {
    GroupWatch groups;
    // Whether to return after a group, asked between groups.
    std::function<bool()> pause;
    // Calls the function, which changes the film and the report.
    std::function<void(const std::function<void()>& change)> add;
};

struct ChainCosts {
    RayStatistics rays;
    double cpu_seconds = 0;

    void add_to(RenderReport& report) const {
        report.rays.merge(rays);
        report.cpu_seconds += cpu_seconds;
    }
};

// What a group brings to the film: one replicate of every pixel.
struct ChainReplicate {
    struct PixelValue {
        Vec3d mean;
        Vec3f albedo, normal;
        float depth = 0;
    };
    std::uint64_t number = 0;       // among the film's replicates, from 0
    std::vector<PixelValue> pixels; // row by row
    ChainGroup::Tally tally;        // with the statistics of the plan
};

// What a chain of a group did.
struct ChainWalk {
    struct Step {
        Point2f proposed; // the point of the film, in pixels
        double size = 0;  // of the proposed state
        double acceptance = 0;
        bool large = false, accepted = false;
    };
    Point2f start;
    double start_size = 0;
    std::vector<Step> steps;
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

    // The parts of run(), for groups that several processes take.
    const SampleOrder& order() const { return order_; }
    // Groups that keep so many threads busy.
    static std::size_t groups_at_once(int threads);
    // The film's replicates from `first` on, each a pure function of its number; none if they were abandoned.
    std::vector<ChainReplicate> take(std::uint64_t first, std::size_t count, const GroupWatch& watch);
    // The first chains of the film's replicate of this number, as take() walks them; fewer if the group has fewer or
    // found no light to start from, none if they were abandoned.
    std::vector<ChainWalk> trace(std::uint64_t replicate, std::size_t chains, const GroupWatch& watch);
    // Of everything since the last call.
    ChainCosts take_costs();
    // Call in the order of their numbers. May run at the same time as take().
    void add(RenderState& state, const ChainReplicate& replicate) const;

  private:
    // Light and features of a row of a group's pixels: means over their camera rays.
    void take_direct_light(std::uint64_t group, int row, std::span<ChainReplicate::PixelValue> into,
                           RayTracer& tracer, BadSampleReport& bad) const;
    // False if that was abandoned.
    bool make_plan(const GroupWatch& watch);
    std::uint64_t group_of(std::uint64_t replicate) const {
        // Groups are counted over all slices of a render.
        const std::uint32_t m = order_.replicate_size();
        return order_.index(replicate * m) / m;
    }
    template <typename Task>
    bool run_tasks(std::size_t count, const GroupWatch& watch, std::uint64_t paths, const Task& task);

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
    std::mutex mutex_; // of the members below, while tasks run
    ChainCosts costs_;
    std::uint64_t paths_ = 0; // of the groups that are being taken
};

} // namespace montelux
