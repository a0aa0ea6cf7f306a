#include "montelux/render/metropolis/chain_renderer.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>

#include "montelux/mc/parallel/cpu_time.h"
#include "montelux/mc/parallel/parallel_for.h"
#include "montelux/render/metropolis/chain_bundle.h"
#include "montelux/render/tile_renderer.h"

namespace montelux {
namespace {

constexpr int threads_per_group = 8;

// Paths of at most one scattering event; features of the first surface are known from it on.
IntegratorSettings direct_integrator(IntegratorSettings settings) {
    settings.max_depth = std::min(settings.max_depth, 1);
    return settings;
}
// Of as many rays as a group has samples; a group is a replicate.
SamplerSettings direct_sampler(const SamplerSettings& settings, std::uint32_t group_samples) {
    SamplerSettings s = settings;
    s.seed = hash_key(settings.seed, 0x646972656374);
    s.replicate_points = group_samples;
    return s;
}

} // namespace

ChainRenderer::ChainRenderer(const SceneDescription& description, const SamplerSettings& sampler,
                             const SceneView& scene, const Camera& camera, const Accelerator& accelerator,
                             SampleOrder order)
    : description_(description), accelerator_(accelerator), order_(order),
      separates_direct_light_(!std::isfinite(description.film.max_component_value)),
      sampler_(description, scene, camera, separates_direct_light_), keys_(sampler.seed),
      direct_sampler_(direct_sampler(sampler, order.replicate_size())),
      direct_context_(description, direct_sampler_, scene, camera,
                      direct_integrator(description.integrator)) {}

template <typename Task>
bool ChainRenderer::run_tasks(std::size_t count, const GroupWatch& watch, std::uint64_t paths,
                              const Task& task) {
    std::atomic<bool> abandoned{false};
    parallel_for(static_cast<std::int64_t>(count), [&](std::int64_t i) {
        if (abandoned || watch.abandon()) {
            abandoned = true;
            return;
        }
        const double begin = thread_cpu_seconds();
        RayTracer tracer(accelerator_);
        task(static_cast<std::size_t>(i), tracer);
        const double seconds = thread_cpu_seconds() - begin;
        std::uint64_t taken;
        {
            std::lock_guard lock(mutex_);
            costs_.rays.merge(tracer.statistics);
            costs_.cpu_seconds += seconds;
            taken = paths_ += paths;
        }
        watch.tell(taken);
        if (watch.abandon()) abandoned = true; // the task may have returned early
    });
    return !abandoned;
}

void ChainRenderer::take_direct_light(std::uint64_t group, int row,
                                      std::span<ChainReplicate::PixelValue> into, RayTracer& tracer,
                                      BadSampleReport& bad) const {
    const PixelBounds& crop = description_.film.crop;
    const std::uint32_t rays = direct_sampler_.replicate_points;
    constexpr int columns = 64; // pixels whose rays are traced together
    std::vector<SampleContext::Key> keys;
    std::vector<SampleContext::Result> results;
    SampleContext::Batch batch;
    for (int begin = crop.x0; begin < crop.x1; begin += columns) {
        const int end = std::min(begin + columns, crop.x1);
        for (std::uint32_t ray = 0; ray < rays; ++ray) {
            keys.clear();
            for (int x = begin; x < end; ++x) keys.push_back({x, crop.y0 + row, group * rays + ray});
            results.resize(keys.size());
            direct_context_.take(tracer, keys, batch, results);
            for (std::size_t i = 0; i < keys.size(); ++i) {
                const SampleContext::Result& r = results[i];
                ChainReplicate::PixelValue& d = into[static_cast<std::size_t>(begin - crop.x0) + i];
                if (r.bad) {
                    bad.add({*r.bad, keys[i].x, keys[i].y, keys[i].index});
                    continue;
                }
                d.mean += Vec3d(r.film.radiance);
                d.albedo += r.film.albedo;
                d.normal += r.film.normal;
                d.depth += r.film.depth;
            }
        }
    }
    for (ChainReplicate::PixelValue& d : into) {
        const float scale = 1 / static_cast<float>(rays);
        d.mean = separates_direct_light_ ? d.mean / static_cast<double>(rays) : Vec3d();
        d.albedo *= scale;
        d.normal *= scale;
        d.depth *= scale;
    }
}

std::size_t ChainRenderer::groups_at_once(int threads) {
    return static_cast<std::size_t>(1 + (threads - 1) / threads_per_group);
}

bool ChainRenderer::make_plan(const GroupWatch& watch) {
    if (plan_) return true;
    const double begin = thread_cpu_seconds();
    plan_ = make_chain_plan(sampler_, accelerator_, description_, order_.replicate_size(), watch.abandon);
    costs_.cpu_seconds += thread_cpu_seconds() - begin;
    return plan_.has_value();
}

std::vector<ChainReplicate> ChainRenderer::take(std::uint64_t first, std::size_t count,
                                                const GroupWatch& watch) {
    paths_ = 0;
    if (!make_plan(watch)) return {};
    const PixelBounds& crop = description_.film.crop;
    while (groups_.size() < count)
        groups_.push_back(std::make_unique<ChainGroup>(sampler_, *plan_, keys_, crop));
    std::vector<ChainReplicate> replicates(count);
    for (std::size_t g = 0; g < count; ++g) {
        groups_[g]->begin(group_of(first + g));
        replicates[g].number = first + g;
        replicates[g].pixels.resize(pixel_count(crop));
    }
    const std::size_t starting = groups_[0]->starting_tasks(), walking = groups_[0]->walking_tasks();
    const std::uint64_t of_start = plan_->size.starting_points / starting;
    const std::uint64_t of_walk = plan_->size.chains * plan_->size.states;
    if (!run_tasks(count * starting, watch, of_start, [&](std::size_t i, RayTracer& tracer) {
            groups_[i / starting]->take_starting_points(i % starting, tracer);
        }))
        return {};
    for (std::size_t g = 0; g < count; ++g) groups_[g]->choose_starts();
    if (!run_tasks(count * walking, watch, of_walk, [&](std::size_t i, RayTracer& tracer) {
            groups_[i / walking]->walk(i % walking, tracer, watch.abandon);
        }))
        return {};
    for (std::size_t g = 0; g < count; ++g) {
        ChainGroup::Tally& tally = replicates[g].tally = groups_[g]->tally();
        ChainStatistics& s = tally.statistics;
        s.longest_step = static_cast<float>(plan_->small_step.longest());
        s.large_step_probability = static_cast<float>(plan_->large_step_probability);
        s.chains = plan_->size.all_chains();
        s.states = plan_->size.states;
        s.starting_points = plan_->size.starting_points;
    }
    const auto rows = static_cast<std::size_t>(crop.height());
    const auto width = static_cast<std::size_t>(crop.width());
    if (!run_tasks(count * rows, watch, 0, [&](std::size_t i, RayTracer& tracer) {
            const std::size_t g = i / rows, row = i % rows;
            const std::span pixels = std::span(replicates[g].pixels).subspan(row * width, width);
            BadSampleReport bad;
            take_direct_light(group_of(first + g), static_cast<int>(row), pixels, tracer, bad);
            const int y = crop.y0 + static_cast<int>(row);
            for (int x = crop.x0; x < crop.x1; ++x) {
                Vec3d& mean = pixels[static_cast<std::size_t>(x - crop.x0)].mean;
                mean = groups_[g]->mean(x, y) + mean;
            }
            if (bad.count() == 0) return;
            std::lock_guard lock(mutex_);
            replicates[g].tally.bad.merge(bad);
        }))
        return {};
    return replicates;
}

std::vector<ChainWalk> ChainRenderer::trace(std::uint64_t replicate, std::size_t chains,
                                            const GroupWatch& watch) {
    paths_ = 0;
    if (!make_plan(watch)) return {};
    ChainGroup group(sampler_, *plan_, keys_, description_.film.crop);
    group.begin(group_of(replicate));
    const GroupSize& size = plan_->size;
    if (!run_tasks(group.starting_tasks(), watch, size.starting_points / group.starting_tasks(),
                   [&](std::size_t i, RayTracer& tracer) { group.take_starting_points(i, tracer); }))
        return {};
    group.choose_starts();
    std::vector<ChainWalk> traces(std::min<std::uint64_t>(chains, size.all_chains()));
    const std::size_t bundles = std::min<std::uint64_t>(size.bundles, traces.size());
    const auto walk = [&](std::size_t task, RayTracer& tracer) {
        group.walk(task, tracer, watch.abandon, [&](std::size_t c, const Mutation& m) {
            const std::size_t chain = c * size.bundles + task; // ChainGroup::walk
            if (m.current == nullptr || chain >= traces.size()) return;
            ChainWalk& trace = traces[chain];
            if (trace.steps.empty()) {
                trace.start = m.current->film;
                trace.start_size = m.current->size;
                trace.steps.reserve(size.states);
            }
            trace.steps.push_back({m.proposed->film, m.proposed->size, m.acceptance, m.large, m.accepted});
        });
    };
    if (!run_tasks(bundles, watch, size.chains * size.states, walk)) return {};
    std::erase_if(traces, [](const ChainWalk& trace) { return trace.steps.empty(); });
    return traces;
}

ChainCosts ChainRenderer::take_costs() { return std::exchange(costs_, {}); }

void ChainRenderer::add(RenderState& state, const ChainReplicate& replicate) const {
    const PixelBounds& crop = description_.film.crop;
    const std::uint32_t m = order_.replicate_size();
    const ChainGroup::Tally& tally = replicate.tally;
    const std::span<Pixel> pixels = state.film.pixels();
    parallel_for(crop.height(), [&](std::int64_t row) {
        const auto width = static_cast<std::size_t>(crop.width());
        const std::size_t first = static_cast<std::size_t>(row) * width;
        for (std::size_t i = first; i < first + width; ++i) {
            const ChainReplicate::PixelValue& value = replicate.pixels[i];
            pixels[i].add_features(value.albedo, value.normal, value.depth, m);
            pixels[i].add_replicate(value.mean, m);
            if (tally.clamped > 0) pixels[i].add_clamped(static_cast<float>(tally.clamped * m));
        }
    });
    state.report.chains.merge(tally.statistics);
    state.report.bad.merge(tally.bad);
    state.report.clamped_samples += tally.clamped_samples;
    state.report.samples += std::uint64_t{m} * pixel_count(crop);
}

void ChainRenderer::run(RenderState& state, std::uint32_t target_samples, const ChainWatch& watch) {
    const std::uint64_t target = target_samples / order_.replicate_size();
    const std::size_t most = groups_at_once(thread_count());
    for (;;) {
        const std::uint64_t done = state.film.pixels().front().replicates().count();
        if (done >= target) return;
        const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(most, target - done));
        const std::vector<ChainReplicate> taken = take(done, count, watch.groups);
        watch.add([&] {
            for (const ChainReplicate& replicate : taken) add(state, replicate);
            take_costs().add_to(state.report);
        });
        if (taken.empty() || watch.pause()) return;
    }
}

} // namespace montelux
