#include "montelux/render/rounds.h"

#include <algorithm>
#include <bit>
#include <string>

#include "montelux/mc/math/error.h"
#include "montelux/render/allocation.h"

namespace montelux {
namespace {

constexpr std::uint64_t longest_round = 16;
constexpr std::uint32_t points_for_targets = 8;
constexpr std::uint32_t many_samples = 256; // so many are split into 16 replicates
// Of adaptive renders, for the first errors: samples, and units.
constexpr std::uint64_t pilot_samples = 16, pilot_units = 4;

} // namespace

std::uint64_t pilot_of(const SampleOrder& order) {
    const std::uint64_t samples = std::max(pilot_samples, pilot_units * order.unit());
    return (samples + order.unit() - 1) / order.unit() * order.unit();
}

SamplerSettings with_replicates(SamplerSettings settings, const RenderTarget& target) {
    if (settings.kind == SamplerKind::independent || settings.replicates >= 2 ||
        settings.replicate_points != 0)
        return settings;
    if (target.error > 0 || target.time > 0)
        settings.replicate_points = std::clamp(settings.spp / 8, 1u, points_for_targets);
    else if (target.adaptive) // pixels that get a third of the samples still have twenty units
        settings.replicate_points = std::clamp(std::bit_floor(settings.spp / 64), 1u, points_for_targets);
    else
        settings.replicates =
            std::min(std::max(settings.spp < many_samples ? 8u : 16u, target.slice.count), settings.spp);
    return settings;
}

void check_slice(const SceneDescription& description, const RenderTarget& target) {
    const Slice& slice = target.slice;
    if (slice.index >= slice.count)
        throw Error("slices are counted from 0, and there are " + std::to_string(slice.count));
    if (SampleOrder(with_replicates(description.sampler, target), slice).share() == 0)
        throw Error("there are fewer units of samples than slices; more samples a pixel are needed");
}

std::vector<std::uint32_t> next_goals(const RenderState& state, const SamplerSettings& sampler,
                                      const RenderTarget& target) {
    const SampleOrder order(sampler, target.slice);
    const std::uint64_t share = order.share();
    const std::size_t pixels = state.film.pixels().size();
    const std::uint64_t begin = state.goals.empty() ? 0 : state.goals.front();
    const std::uint64_t pilot = target.adaptive ? pilot_of(order) : 0;
    if (target.adaptive && begin >= pilot) return allocate(state.film, order, target);
    if (begin >= share) return {};
    std::uint64_t end = pilot;
    if (!target.adaptive || target.time > 0) { // 1, 2, 4, 8, 16, 32, 48, ... samples
        end = begin + std::clamp<std::uint64_t>(std::bit_floor(begin), 1, longest_round);
        if (order.unit() > 1) end = std::min(end, (begin / order.unit() + 1) * order.unit());
        if (target.adaptive) end = std::min(end, pilot);
    }
    return std::vector<std::uint32_t>(pixels, static_cast<std::uint32_t>(std::min(end, share)));
}

} // namespace montelux
