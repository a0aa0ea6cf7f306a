// Delta tracking: a ray through a medium, from one tentative collision to the next.
#pragma once

#include <algorithm>
#include <limits>
#include <optional>

#include "montelux/mc/random/philox_stream.h"
#include "montelux/mc/random/stream.h"
#include "montelux/mc/warp/exponential.h"
#include "montelux/scene/medium/medium_model.h"

namespace montelux {

// The numbers of a walk whose length is not known beforehand. The first collision takes those of the path's
// stream, which may be stratified.
class CollisionNumbers {
  public:
    template <RandomStream Stream>
    explicit CollisionNumbers(Stream& stream) {
        const Vec2f u = stream.next_2d();
        first_depth_ = stream.refined(u.x);
        first_event_ = u.y;
        rest_.emplace(PhiloxStream::split(stream));
    }

    // Optical depth of the next collision.
    double depth() { return sample_exponential(depths_++ == 0 ? first_depth_ : rest_->next_double(), 1.0); }
    // Uniform, for what happens there.
    float event() { return events_++ == 0 ? first_event_ : rest_->next_1d(); }
    float other() { return rest_->next_1d(); }

  private:
    double first_depth_ = 0;
    float first_event_ = 0;
    int depths_ = 0, events_ = 0;
    std::optional<PhiloxStream> rest_;
};

// Woodcock et al. 1965: collisions at the rate of the majorant of the first wavelength along `ray`, whose
// direction has unit length. collision(t, relative, majorant) returns whether to go on; `relative` is the
// transmittance of the majorant since the last collision (or the start), divided by that of the first
// wavelength, whose value is the probability of getting there.
//
// The relative transmittance from the last collision to the end of the ray; empty if a collision ended the walk.
template <SampledMedium M, typename Collision>
std::optional<SampledSpectrum> track(const M& medium, const Ray& ray, CollisionNumbers& numbers,
                                     const Collision& collision) {
    MajorantWalk walk = medium.majorants(ray);
    MajorantSegment segment;
    SampledSpectrum relative(1);
    double depth = numbers.depth(); // still to go
    while (walk.next(segment)) {
        const double hero = static_cast<double>(segment.majorant[0]), end = static_cast<double>(segment.t1);
        const SampledSpectrum excess = segment.majorant - segment.majorant[0];
        const auto pass = [&](double distance) {
            // An infinite distance must not make a NaN where there is no excess.
            constexpr double most = std::numeric_limits<float>::max();
            relative *= exp(excess * -static_cast<float>(std::min(distance, most)));
        };
        double t = static_cast<double>(segment.t0);
        while (hero > 0 && depth < hero * (end - t)) {
            const double step = depth / hero;
            t += step;
            pass(step);
            if (!collision(static_cast<float>(t), relative, segment.majorant)) return std::nullopt;
            relative = SampledSpectrum(1);
            depth = numbers.depth();
        }
        if (hero > 0) depth -= hero * (end - t);
        pass(end - t);
    }
    return relative;
}

} // namespace montelux
