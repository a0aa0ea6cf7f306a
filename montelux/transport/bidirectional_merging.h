// BidirectionalMerging: vertices of the camera's path that merge with those of the light paths of a map.
#pragma once

#include <cmath>

#include "montelux/transport/bidirectional_strategies.h"

namespace montelux {

// Weights are those of strategy_weight.h: of a vertex of the map the densities of its own path are known up to it
// (LightMapVertex::at), of the camera's path those up to the vertex that it merges with. Two are left, of what lies on
// both sides of the merged vertex given the direction from the other side. Georgiev et al. keep sums over these
// densities (d_VCM, d_VC and d_VM) in place of the densities.
template <RandomStream Stream>
class BidirectionalMerging : protected BidirectionalStrategies<Stream> {
  protected:
    using BidirectionalStrategies<Stream>::BidirectionalStrategies;

    // Appends the light's path to those of a map.
    void store_light_path(LightPaths& paths) const {
        const auto first = paths.vertices.size();
        for (std::size_t j = 1; j <= memory_.light.size(); ++j) {
            const SubpathVertex& y = memory_.light[j - 1];
            LightMapVertex& v = paths.vertices.emplace_back();
            v.throughput = y.throughput;
            v.p = y.s.p;
            v.w = y.w;
            v.ng = y.s.ng;
            v.forward = y.forward;
            const bool can_be_reached = j > 1 || !end_.invisible;
            v.backward = can_be_reached ? y.backward : 0;
            v.to_previous = can_be_reached
                                ? this->density_of_previous(memory_.light, j, TransportMode::importance, 1)
                                : 0;
            v.emission = end_.emission;
            v.next_event = end_next_event_;
            v.number = static_cast<std::uint32_t>(j);
            v.events = y.events;
            v.delta = y.delta;
            v.in_medium = y.phase != nullptr;
            v.terminated = y.lambda.secondary_terminated();
            // A path that is not a number makes its own sample bad, and must not spoil others.
            v.mergeable = j >= 2 && y.connectible && !v.in_medium && all_finite(y.throughput) &&
                          !is_black(y.throughput);
            if (volumes_) paths.edges.push_back(y.edge);
        }
        // What comes after the last vertex that can merge is of no use.
        while (paths.vertices.size() > first && !paths.vertices.back().mergeable) {
            paths.vertices.pop_back();
            if (volumes_) paths.edges.pop_back();
        }
    }

    // Vertex k of the camera's path.
    void merge(std::size_t k, SampledSpectrum& narrower) {
        const SubpathVertex& z = memory_.camera[k - 1];
        if (!z.connectible || z.phase != nullptr || z.events > settings_.max_depth) return;
        const auto radius = static_cast<float>(integrator_.map_->radius());
        integrator_.map_->visit(z.s.p,
                                [&](const LightMapVertex& y, const LightPaths& paths, float distance2) {
                                    // The disc lies in the surface: what is near but on another one is left out.
                                    const float height = std::abs(dot(y.p - z.s.p, z.s.ng));
                                    if (y.events + z.events - 1 > settings_.max_depth ||
                                        height > 0.5f * radius || std::abs(dot(y.ng, z.s.ng)) < 0.5f)
                                        return;
                                    const SampledSpectrum added = merge(k, z, y, paths);
                                    radiance_ += added;
                                    narrower += 2 * distance2 < radius * radius ? added : -added;
                                });
    }

  private:
    using Strategies = BidirectionalStrategies<Stream>;

    // The weighted contribution, all of whose light comes from vertex y of the map.
    SampledSpectrum merge(std::size_t k, const SubpathVertex& z, const LightMapVertex& y,
                          const LightPaths& paths) {
        const Vec3f wi = z.surface.frame.to_local(-y.w);
        // Of the light's own facet: another one of a smooth mesh may be lit at an angle that is far from it, or from behind.
        const float facing = dot(y.ng, y.w), cosine = std::abs(facing);
        if (!(facing * dot(z.s.ng, y.w) * dot(y.ng, z.s.ng) > 0)) return {};
        const BsdfEvaluation e = z.evaluate(z.wo, wi, TransportMode::radiance, stream_);
        if (is_black(e.f)) return {};
        // Flux per area over the cosine is what radiance times solid angle is.
        SampledSpectrum value =
            z.throughput * e.f * y.throughput / (cosine * static_cast<float>(area_paths_));
        SampledWavelengths lambda = z.lambda;
        if (y.terminated) lambda.terminate_secondary();

        const std::size_t j = y.number, n = j + 1 + k;
        PathDensities& d = memory_.densities;
        this->reset_densities(n);
        d.from_light[0] = double(y.emission);
        d.next_event = double(y.next_event);
        for (std::size_t i = 1; i <= j; ++i) {
            const LightMapVertex& v = y.at(i);
            d.from_light[i] = double(v.forward);
            d.from_camera[i - 1] = double(v.backward);
            d.delta[i] = v.delta ? 1 : 0;
            d.merging[i] = this->area_paths_at(i, v.in_medium);
            if (volumes_) memory_.edges[i - 1] = paths.edge(v);
        }
        d.from_camera[j - 1] = double(y.to_previous) * double(e.pdf);
        this->fill_camera_side(n, j);
        d.delta[j] = 0;
        if (k > 1) {
            const float back = z.evaluate(wi, z.wo, TransportMode::importance, stream_).pdf;
            d.from_light[j + 1] =
                double(this->density_of_previous(memory_.camera, k, TransportMode::radiance, back));
        }
        if (volumes_) {
            media_factors(memory_.edges, lambda.secondary_terminated(), d.media, memory_.scratch);
            value /= static_cast<float>(d.media[0]); // all edges were walked
        }
        const double weight = strategy_weight(d, n + j, settings_.heuristic, memory_.scratch);
        if (lambda.secondary_terminated()) value = SampledSpectrum(4 * value[0], 0, 0, 0);
        if (observer_ != nullptr) [[unlikely]]
            observer_->found(observer_->self, {j,
                                               k + 1,
                                               end_,
                                               {},
                                               std::span(memory_.camera).first(k),
                                               camera_.ray.o,
                                               d,
                                               weight,
                                               value,
                                               &y});
        return value * static_cast<float>(weight);
    }

  protected:
    using Strategies::area_paths_;
    using Strategies::camera_;
    using Strategies::end_;
    using Strategies::end_next_event_;
    using Strategies::integrator_;
    using Strategies::memory_;
    using Strategies::observer_;
    using Strategies::radiance_;
    using Strategies::settings_;
    using Strategies::stream_;
    using Strategies::volumes_;
};

} // namespace montelux
