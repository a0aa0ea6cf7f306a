// VolumePathBranches: the branches of a path through media that a guide splits, followed one after another.
#pragma once

#include <algorithm>
#include <array>
#include <optional>

#include "montelux/mc/random/sample_stream.h"
#include "montelux/transport/guiding/guided_scattering.h"
#include "montelux/transport/volume_path_lights.h"

namespace montelux {

// The part of VolumePath (volume_path.h) that keeps the branches. A sample's are bounded, and so are those that wait:
// the splits on the way to the followed one have a product of at most most_branches_of_sample.
template <RandomStream Stream>
class VolumePathBranches : protected VolumePathLights<Stream> {
  protected:
    using VolumePathLights<Stream>::VolumePathLights;
    using VolumePathLights<Stream>::state_;
    using VolumePathLights<Stream>::stream_;
    using VolumePathLights<Stream>::recorder_;

    // Always false.
    bool end(PathEnd how) {
        state_.alive = false;
        if (recorder_) recorder_.ended(how);
        return false;
    }

    float survival_of(const GuidingRegion& region) const {
        return guided_survival(region, state_.carried(), state_.depth, state_.expected);
    }
    // A vertex that a guide learns from. Returns false if Russian roulette ends the path, which plays with the probability
    // chance() if there is a region.
    template <typename F>
    bool begin_guided(Point3f p, Facing facing, bool glossy, const GuidingRegion* region, const F& chance) {
        if (state_.trace != nullptr) [[unlikely]]
            state_.trace->begin(p, facing, glossy, state_.carried(), state_.radiance);
        if (region == nullptr) return true;
        const float survival = std::min(chance(), 1.0f);
        if (!lives(survival)) return false;
        if (state_.trace != nullptr) [[unlikely]]
            state_.trace->survive(survival);
        return true;
    }
    // Russian roulette. Returns false if the path ends.
    bool lives(float survival) {
        if (!(survival < 1)) return true;
        const float u = stream_.next_1d();
        if (recorder_) recorder_.played_roulette({.survival = survival, .u = u});
        if (!(u < survival)) return end(PathEnd::roulette);
        state_.throughput /= survival;
        return true;
    }

    // Continues by scatter() from a vertex, where a guide may split the path by what its region expects (null: it is not
    // known). The branches that begin here but for one are taken up when that has ended.
    template <typename F>
    void split(const GuidingRegion* judge, const F& scatter) {
        if constexpr (std::same_as<Stream, SampleStream>)
            if (judge != nullptr && state_.trace == nullptr) {
                const int count = guided_branches(*judge, state_.carried(), state_.branches, state_.expected);
                if (count > 1) {
                    state_.split(count);
                    const Branch here{state_, stream_, body_events_, passages_};
                    for (int i = 1; i < count; ++i) {
                        stream_ = here.stream.branch(static_cast<std::uint32_t>(i));
                        scatter();
                        if (state_.alive)
                            waiting_[waiting_count_++].emplace(
                                Branch{state_, stream_, body_events_, passages_});
                        take_up(here);
                    }
                }
            }
        scatter();
    }
    // False if none waits.
    bool takes_up_branch() {
        if (waiting_count_ == 0) return false;
        take_up(*waiting_[--waiting_count_]);
        return true;
    }

    int body_events_ = 0; // inside translucent bodies
    int passages_ = 0;    // straight ones, not counted, since the last event that was

  private:
    struct Branch {
        VolumeState state;
        Stream stream;
        int body_events = 0, passages = 0;
    };
    static constexpr std::size_t most_waiting = 3 * (most_branches_at_vertex - 1);
    static_assert(most_branches_at_vertex * most_branches_at_vertex * most_branches_at_vertex ==
                  most_branches_of_sample);

    // What the film gets is the sum over the branches.
    void take_up(const Branch& branch) {
        const SampledSpectrum radiance = state_.radiance;
        const float transparency = state_.transparency;
        state_ = branch.state;
        state_.radiance = radiance;
        state_.transparency = transparency;
        stream_ = branch.stream;
        body_events_ = branch.body_events;
        passages_ = branch.passages;
    }

    std::array<std::optional<Branch>, most_waiting> waiting_;
    std::size_t waiting_count_ = 0;
};

} // namespace montelux
