// GuidingTrace: what a guide learns from one path.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "montelux/mc/warp/equal_area_square.h"
#include "montelux/spectrum/sampled_spectrum.h"
#include "montelux/transport/guiding/guiding_field.h"

namespace montelux {

// One vertex of a path that is not specular.
struct GuidingRecord {
    Point3f p;
    Facing facing = Facing::medium;
    Vec2f direction; // on equal_area_square
    // Of the radiance that the vertex scatters, mean of the wavelengths: all of it; that of the direction; and the part
    // of what the direction hit that next-event estimation is left to find.
    float radiance = 0, estimate = 0, left_to_light_samples = 0;
    bool aimed = false, visible = false; // it has a light sample; the light could be seen
    // Of the direction, per solid angle; pdf is that of its mixture, 0 where a delta lobe or nothing was drawn.
    float pdf = 0, bsdf_pdf = 0, guide_pdf = 0;
};

// Written while a path is traced; nothing in it influences the path.
class GuidingTrace {
  public:
    void clear() { size_ = 0; }

    // The path goes on from the last vertex; the radiance is without what it meets there.
    void arrive(SampledSpectrum radiance) {
        if (size_ == 0 || seen_) return;
        vertices_[size_ - 1].after_light_sample = radiance;
        seen_ = true;
    }
    // The ray that left the last vertex has found a light, of which the path does not count this part.
    void left_to_light_samples(SampledSpectrum radiance) {
        if (size_ > 0) vertices_[size_ - 1].left_to_light_samples = radiance;
    }
    // A vertex that is not specular; its emission is in the radiance.
    void begin(Point3f p, Facing facing, SampledSpectrum throughput, SampledSpectrum radiance) {
        open_ = size_ < vertices_.size();
        if (!open_) return;
        seen_ = false;
        Vertex& v = vertices_[size_++];
        v = {};
        v.p = p;
        v.facing = facing;
        v.throughput = throughput;
        v.before = radiance;
    }
    // The last vertex has survived Russian roulette, with this probability.
    void survive(float probability) {
        if (open_) vertices_[size_ - 1].survival = probability;
    }
    void aim() {
        if (open_) vertices_[size_ - 1].aimed = true;
    }
    // Densities as those of GuidingRecord.
    void scatter(Vec3f wi, float pdf, float bsdf_pdf, float guide_pdf) {
        if (!open_) return;
        Vertex& v = vertices_[size_ - 1];
        v.direction = equal_area_sphere_to_square(wi);
        v.pdf = pdf;
        v.bsdf_pdf = bsdf_pdf;
        v.guide_pdf = guide_pdf;
        if (bsdf_pdf > 0) v.more_likely = pdf / bsdf_pdf;
        open_ = false;
    }
    // A delta lobe was drawn, so many times as often as without a guide.
    void scatter_smoothly(float more_likely) {
        if (open_) vertices_[size_ - 1].more_likely = more_likely;
    }
    // The path has ended with this radiance. What a direction brings from the next vertex is what the vertices around
    // that one scatter on average, by the guide: much less noisy than the rest of the path (temporal differences;
    // Dahm and Keller 2017, "Learning Light Transport the Reinforced Way"). Null: the rest of the path.
    void finish(SampledSpectrum radiance, const GuidingField* guide,
                std::vector<GuidingRecord>& records) const {
        for (std::size_t i = 0; i < size_; ++i) {
            const Vertex& v = vertices_[i];
            const Vertex* const next = i + 1 < size_ ? &vertices_[i + 1] : nullptr;
            const SampledSpectrum after = next != nullptr || seen_ ? v.after_light_sample : radiance;
            const auto share = [&](SampledSpectrum found) {
                const float mean = average(safe_div(clamp_zero(found), v.throughput));
                return std::isfinite(mean) ? mean : 0.0f;
            };
            const GuidingRegion* const around =
                next != nullptr && guide != nullptr ? guide->find(next->p, next->facing) : nullptr;
            const float estimate =
                around == nullptr
                    ? share(radiance - after)
                    : share(next->before - after) + v.survival * share(next->throughput) * around->radiance;
            records.push_back({v.p, v.facing, v.direction, share(radiance - v.before), estimate,
                               share(v.left_to_light_samples), v.aimed, !is_black(after - v.before), v.pdf,
                               v.bsdf_pdf, v.guide_pdf});
        }
    }

    // An unbiased estimate of what the square of a path's radiance (mean of the wavelengths) would be without the guide
    // that this path has followed, but for MIS weights: paths that it finds more often count more.
    double square_without_guide(SampledSpectrum radiance) const {
        const auto total = double(average(radiance));
        double sum = 0, counted = 0;
        // Of what is found there, and with all that is found later: it was as likely as the path so far.
        const auto find = [&](double until, double more_likely) {
            const double found = until - counted;
            sum += more_likely * found * (found + 2 * (total - until));
            counted = until;
        };
        double more_likely = 1;
        find(size_ > 0 ? double(average(vertices_[0].before)) : total, 1);
        for (std::size_t i = 0; i < size_; ++i) {
            const Vertex& v = vertices_[i];
            const bool last = i + 1 == size_;
            const double carried =
                more_likely * double(average(v.throughput)); // by directions of BSDFs alone
            more_likely *= double(v.survival);
            // Without a guide the throughput decides on Russian roulette.
            const double roulette = carried > 0 ? std::min(1.0, carried) : 1;
            find(last && !seen_ ? total : double(average(v.after_light_sample)), more_likely / roulette);
            more_likely *= double(v.more_likely);
            find(last ? total : double(average(vertices_[i + 1].before)), more_likely / roulette);
        }
        return sum;
    }

  private:
    struct Vertex {
        Point3f p;
        Facing facing = Facing::medium;
        Vec2f direction;
        float pdf = 0, bsdf_pdf = 0, guide_pdf = 0, survival = 1;
        float more_likely = 1; // the direction, than without a guide
        bool aimed = false;
        SampledSpectrum throughput{}; // of the path to it
        // Radiance of the path before its light sample, and after it.
        SampledSpectrum before{}, after_light_sample{};
        SampledSpectrum left_to_light_samples{};
    };

    std::array<Vertex, 32> vertices_; // later ones teach nothing
    std::size_t size_ = 0;
    bool open_ = false; // the last vertex has no direction yet
    bool seen_ = false; // the path has gone on from it
};

} // namespace montelux
