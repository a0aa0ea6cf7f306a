#include "montelux/render/metropolis/chain_group.h"

#include <algorithm>
#include <cmath>

#include "montelux/render/metropolis/chain_bundle.h"

namespace montelux {
namespace {

constexpr std::uint64_t points_per_task = 2048;
constexpr std::size_t together = 64; // paths of starting points that are traced at once
constexpr std::uint64_t steps_between_stops = 64;

} // namespace

ChainGroup::ChainGroup(const PrimarySampler& sampler, const ChainPlan& plan, const ChainKeys& keys,
                       const PixelBounds& bounds)
    : sampler_(&sampler), plan_(&plan), keys_(&keys), weights_(plan.weights()), splats_(bounds),
      splat_scale_(plan.splat_scale()), picture_scale_(1 / splat_scale_),
      pixels_(static_cast<double>(bounds.width()) * static_cast<double>(bounds.height())),
      sizes_(plan.size.starting_points),
      starting_sums_((plan.size.starting_points + points_per_task - 1) / points_per_task),
      parts_(starting_sums_.size() + plan.size.bundles) {}

void ChainGroup::begin(std::uint64_t number) {
    number_ = number;
    splats_.clear();
    std::ranges::fill(parts_, Part{});
    starts_.clear();
    correction_ = 0;
}

void ChainGroup::splat(const PrimarySample& sample, double weight, Part& part) {
    if (!(weight > 0) || !(sample.size > 0)) return;
    sampler_->splat(splats_, sample, weight * splat_scale_);
    if (sample.clamped != 0) part.clamped += weight * double(sample.clamped);
}

void ChainGroup::count(const PrimarySample& sample, std::uint64_t path, Part& part) const {
    if (sample.clamped != 0) ++part.clamped_samples;
    if (!sample.bad) return;
    const Vec2<int> pixel = sampler_->pixel_of(sample.film);
    const std::uint64_t paths = plan_->size.starting_points + plan_->size.all_states();
    part.bad.add({*sample.bad, pixel.x, pixel.y, number_ * paths + path});
}

void ChainGroup::take_starting_points(std::size_t task, RayTracer& tracer) {
    Part& part = parts_[task];
    PrimarySampler::Memory memory;
    std::vector<PrimarySamples> samples(together, PrimarySamples(PhiloxStream(0)));
    std::vector<PrimarySamples*> states;
    states.reserve(samples.size());
    for (PrimarySamples& s : samples) states.push_back(&s);
    std::vector<PrimarySample> results(together);
    const std::uint64_t begin = task * points_per_task;
    const std::uint64_t end = std::min<std::uint64_t>(begin + points_per_task, sizes_.size());
    double sum = 0;
    for (std::uint64_t i = begin; i < end; i += together) {
        const auto count_here = static_cast<std::size_t>(std::min<std::uint64_t>(together, end - i));
        for (std::size_t k = 0; k < count_here; ++k) {
            samples[k].restart(keys_->stream(ChainKeys::starting_point, number_, i + k));
            samples[k].propose_large();
        }
        sampler_->evaluate(tracer, std::span(states).first(count_here), plan_->importance, memory, results);
        for (std::size_t k = 0; k < count_here; ++k) {
            const PrimarySample& r = results[k];
            count(r, i + k, part);
            sizes_[i + k] = r.size;
            sum += r.size;
            splat(r, weights_(r.size), part);
        }
    }
    starting_sums_[task] = sum;
}

void ChainGroup::choose_starts() {
    double sum = 0;
    for (const double s : starting_sums_) sum += s;
    // Without a scale chains have no weight.
    if (!(sum > 0) || !(plan_->scale > 0)) return;
    correction_ = sum / static_cast<double>(sizes_.size()) / plan_->scale;
    // In proportion to size, by systematic sampling.
    const double offset = keys_->stream(ChainKeys::choice, number_, 0).next_double();
    const auto chains = static_cast<double>(plan_->size.all_chains());
    std::size_t i = 0;
    double up_to = sizes_[0];
    std::uint64_t last = 0; // with a size, where rounding leaves nothing at the end
    for (double c = 0; c < chains; ++c) {
        const double wanted = sum * (offset + c) / chains;
        while (i + 1 < sizes_.size() && (up_to < wanted || !(sizes_[i] > 0))) up_to += sizes_[++i];
        if (sizes_[i] > 0) last = i;
        starts_.push_back(last);
    }
}

std::array<double, 3> ChainGroup::observables(const PrimarySample& sample) const {
    const Point2f begin = sampler_->film_begin();
    const Vec2f size = sampler_->film_size();
    return {double((sample.film.x - begin.x) / size.x), double((sample.film.y - begin.y) / size.y),
            std::log(sample.size)};
}

void ChainGroup::walk(std::size_t task, RayTracer& tracer, const std::function<bool()>& stop,
                      const StepObserver& observer) {
    Part& part = parts_[starting_sums_.size() + task];
    const std::size_t chains = plan_->size.chains;
    std::vector<PhiloxStream> starts, walks;
    for (std::size_t c = 0; c < chains; ++c) {
        const std::uint64_t chain = c * plan_->size.bundles + task; // so bundles are alike
        walks.push_back(keys_->stream(ChainKeys::walk, number_, chain));
        if (!starts_.empty())
            starts.push_back(keys_->stream(ChainKeys::starting_point, number_, starts_[chain]));
    }
    ChainBundle bundle(*sampler_, plan_->importance);
    const bool dark = starts_.empty();
    if (dark)
        bundle.begin_dark(walks);
    else
        bundle.begin(tracer, starts, walks);
    std::vector<double> pending(chains, 0); // weights of current states that are not splatted yet
    std::uint64_t path = plan_->size.starting_points + task * chains * plan_->size.states;
    for (std::uint64_t t = 0; t < plan_->size.states; ++t) {
        if (t % steps_between_stops == 0 && stop()) return;
        bundle.step(tracer, plan_->large_step_probability, plan_->small_step,
                    [&](std::size_t c, const Mutation& m) {
                        const PrimarySample& y = *m.proposed;
                        if (observer) [[unlikely]]
                            observer(c, m);
                        count(y, path++, part);
                        (m.large ? part.large_steps : part.small_steps) += 1;
                        (m.large ? part.large_accepted : part.small_accepted) += m.acceptance;
                        // Both states in proportion to their probabilities (Veach 1997, section 11.5), and large
                        // steps as independent paths, too.
                        const double of_y = (m.acceptance * correction_ + m.large) * weights_(y.size);
                        if (!dark) pending[c] += (1 - m.acceptance) * correction_ * weights_(m.current->size);
                        if (!m.accepted) return splat(y, of_y, part);
                        splat(*m.current, pending[c], part);
                        pending[c] = of_y;
                    });
        if (!dark)
            for (std::size_t c = 0; c < chains; ++c)
                part.halves[2 * t < plan_->size.states ? 0 : 1].add(observables(bundle.current(c)));
    }
    for (std::size_t c = 0; c < chains && !dark; ++c) splat(bundle.current(c), pending[c], part);
}

ChainGroup::Tally ChainGroup::tally() const {
    Tally tally;
    ChainStatistics& s = tally.statistics;
    ChannelMoments<3> halves[2];
    for (const Part& part : parts_) {
        tally.bad.merge(part.bad);
        tally.clamped += part.clamped / pixels_;
        tally.clamped_samples += part.clamped_samples;
        s.large_steps += part.large_steps;
        s.small_steps += part.small_steps;
        s.large_accepted += part.large_accepted;
        s.small_accepted += part.small_accepted;
        for (int h = 0; h < 2; ++h) halves[h].merge(part.halves[h]);
    }
    s.groups = 1;
    s.dark_groups = starts_.empty();
    for (const ChannelMoments<3>& half : halves) s.agreement.add(half);
    return tally;
}

} // namespace montelux
