// GuidingTrace: the records of one path that a guide learns from, and its UnguidedSquare.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "montelux/mc/warp/equal_area_square.h"
#include "montelux/spectrum/sampled_spectrum.h"
#include "montelux/transport/guiding/guiding_field.h"
#include "montelux/transport/guiding/unguided_square.h"

namespace montelux {

// One vertex of a path that is not specular.
struct GuidingRecord {
    Point3f p;
    Facing facing = Facing::medium;
    Vec2f direction;    // on equal_area_square
    float distance = 0; // straight to the next record's vertex; 0: there is none
    // Of the radiance that the vertex scatters, mean of the wavelengths: all of it; that of the direction; and the part
    // of what the direction hit that next-event estimation is left to find.
    float radiance = 0, estimate = 0, left_to_light_samples = 0;
    bool glossy = false; // what it scatters depends much on the direction: is_glossy of the BSDF
    bool aimed = false, visible = false; // it has a light sample; the light could be seen
    // Of the direction, per solid angle; pdf is that of its mixture, 0 where a delta lobe or nothing was drawn.
    float pdf = 0, bsdf_pdf = 0, guide_pdf = 0;
};

// Written while a path is traced; nothing in it influences the path.
class GuidingTrace {
  public:
    void clear() {
        size_ = 0;
        full_ = false;
        more_likely_ = 1;
        unguided_.clear();
    }

    // The path goes on from the last vertex; the radiance is without what it meets there.
    void arrive(SampledSpectrum radiance) {
        unguided_.arrive(double(average(radiance)));
        if (size_ == 0 || seen_) return;
        vertices_[size_ - 1].after_light_sample = radiance;
        seen_ = true;
    }
    // The ray that left the last vertex has found a light, which the path counts with this MIS weight, and without the
    // guide would count with the other one.
    void meet_light(SampledSpectrum radiance, float weight, float unguided_weight) {
        unguided_.meet_light((double(unguided_weight) - double(weight)) * double(average(radiance)));
        if (size_ > 0 && !full_) vertices_[size_ - 1].left_to_light_samples = radiance * (1 - weight);
    }
    // Density of the last direction without the guide, where `pdf` is the one with it.
    float unguided_pdf(float pdf) const {
        return more_likely_ > 0 ? static_cast<float>(double(pdf) / more_likely_) : 0;
    }
    // A vertex that is not specular; its emission is in the radiance. `glossy`: what it scatters depends much on the
    // direction, so that the mean of those around it says little.
    void begin(Point3f p, Facing facing, bool glossy, SampledSpectrum throughput, SampledSpectrum radiance) {
        unguided_.arrive(double(average(radiance)));
        open_ = size_ < vertices_.size();
        full_ = !open_;
        if (full_) return;
        seen_ = false;
        Vertex& v = vertices_[size_++];
        v = {};
        v.p = p;
        v.facing = facing;
        v.glossy = glossy;
        v.throughput = throughput;
        v.before = radiance;
    }
    // The last vertex has survived Russian roulette, with this probability.
    void survive(float probability) {
        unguided_.survive(double(probability));
        if (open_) vertices_[size_ - 1].survival = probability;
    }
    // ... any vertex has survived the one without a guide.
    void survive_on_throughput(float probability) { unguided_.survive(double(probability)); }
    // It samples light. Without the guide this has `unguided_weight` in place of its MIS weight.
    void aim(float weight, float unguided_weight) {
        unguided_.sample_light(weight > 0 ? double(unguided_weight) / double(weight) : 1);
        if (open_) vertices_[size_ - 1].aimed = true;
    }
    // Densities as those of GuidingRecord.
    void scatter(Vec3f wi, float pdf, float bsdf_pdf, float guide_pdf) {
        more_likely_ = bsdf_pdf > 0 ? double(pdf) / double(bsdf_pdf) : 0;
        unguided_.scatter(more_likely_);
        if (!open_) return;
        Vertex& v = vertices_[size_ - 1];
        v.direction = equal_area_sphere_to_square(wi);
        v.pdf = pdf;
        v.bsdf_pdf = bsdf_pdf;
        v.guide_pdf = guide_pdf;
        open_ = false;
    }
    // A delta lobe was drawn, so many times as often as without a guide.
    void scatter_in_delta_lobe(float more_likely) { unguided_.scatter(double(more_likely)); }
    // The path goes on from any vertex, after `depth` scattering events, unless Russian roulette without a guide ends it,
    // which goes by `strength`.
    void go_on(SampledSpectrum radiance, float strength, int depth) {
        unguided_.go_on(double(average(radiance)), double(strength), depth > 1);
    }
    // The path has ended with this radiance. What a direction brings from the next vertex is what the vertices around
    // that one scatter on average, by the guide: much less noisy than the rest of the path (temporal differences;
    // Dahm and Keller 2017, "Learning Light Transport the Reinforced Way"). From a glossy vertex it is what the path found
    // there: light that comes by reflection is not averaged away. Null: the rest of the path.
    void finish(SampledSpectrum radiance, const GuidingField* guide,
                std::vector<GuidingRecord>& records) const {
        SampledSpectrum scattered{}; // by the next vertex
        for (std::size_t i = size_; i-- > 0;) {
            const Vertex& v = vertices_[i];
            const Vertex* const next = i + 1 < size_ ? &vertices_[i + 1] : nullptr;
            const SampledSpectrum after = next != nullptr || seen_ ? v.after_light_sample : radiance;
            const auto share = [&](SampledSpectrum found) {
                const float mean = average(safe_div(clamp_zero(found), v.throughput));
                return std::isfinite(mean) ? mean : 0.0f;
            };
            const GuidingRegion* const around =
                next != nullptr && guide != nullptr ? guide->find(next->p, next->facing) : nullptr;
            SampledSpectrum brought = radiance - after;
            if (around != nullptr && (next->glossy || around->knows_radiance()))
                brought =
                    next->before - after + (next->glossy ? scattered : next->throughput * around->radiance);
            scattered = after - v.before + brought;
            const float distance = next != nullptr ? length(next->p - v.p) : 0;
            records.push_back({v.p, v.facing, v.direction, distance, share(radiance - v.before),
                               v.survival * share(brought), v.survival * share(v.left_to_light_samples),
                               v.glossy, v.aimed, !is_black(after - v.before), v.pdf, v.bsdf_pdf,
                               v.guide_pdf});
        }
    }

    // What the square of an unguided path's radiance (mean over the wavelengths) is on average.
    double unguided_square(SampledSpectrum radiance) const {
        UnguidedSquare unguided = unguided_;
        return unguided.square(double(average(radiance)));
    }

  private:
    struct Vertex {
        Point3f p;
        Facing facing = Facing::medium;
        Vec2f direction;
        float pdf = 0, bsdf_pdf = 0, guide_pdf = 0, survival = 1;
        bool glossy = false, aimed = false;
        SampledSpectrum throughput{}; // of the path to it
        // Radiance of the path before its light sample, and after it.
        SampledSpectrum before{}, after_light_sample{};
        SampledSpectrum left_to_light_samples{};
    };

    std::array<Vertex, 32> vertices_; // later ones teach nothing
    std::size_t size_ = 0;
    bool open_ = false;      // the last vertex has no direction yet
    bool seen_ = false;      // the path has gone on from it
    bool full_ = false;      // the path has later vertices
    double more_likely_ = 1; // the last direction, than without a guide
    UnguidedSquare unguided_;
};

} // namespace montelux
