// UnguidedSquare: from guided paths, what the mean square of paths without a guide would be.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace montelux {

// Follows one path. Light that it finds is weighted by how much more likely the path so far was than the same path
// without a guide: then the mean of square() is that of the squared radiance of unguided paths. It knows rare light from
// the guide's samples, where as many unguided samples would mostly have missed it. Radiance is the mean over the
// wavelengths; densities count that of directions and the probability of surviving Russian roulette.
class UnguidedSquare {
  public:
    void clear() { *this = {}; }

    // The path has this radiance before it samples light at a vertex.
    void arrive(double radiance) {
        close(radiance);
        samples_light_ = false;
    }
    // It samples light there. Without the guide this light has `weight` times its MIS weight.
    void sample_light(double weight) {
        samples_light_ = true;
        of_light_ = {weight, likelihood()};
    }
    // Light was met that has so much more radiance by the MIS weight that it has without the guide.
    void meet_light(double more) { open_ += more; }
    // A direction has been drawn that is so many times as likely as without the guide.
    void scatter(double more_likely) { ratio_ *= more_likely; }
    // Russian roulette was survived.
    void survive(double probability) { ratio_ *= probability; }
    // The path goes on. `strength` is what Russian roulette without a guide goes by, and `plays` whether it does here.
    void go_on(double radiance, double strength, bool plays) {
        close(radiance);
        if (plays) survival_ = std::min(survival_, strength * ratio_);
    }

    // Of the whole path.
    double square(double radiance) {
        close(radiance);
        double sum = 0, later = 0;
        for (std::size_t i = size_; i-- > 0;) {
            const Found& f = found_[i];
            if (f.radiance != 0) sum += f.likelihood * f.radiance * (f.radiance + 2 * later);
            later += f.radiance;
        }
        return std::isfinite(sum) ? sum : radiance * radiance;
    }

  private:
    // What was found since the last call.
    void close(double radiance) {
        const double found = radiance - counted_;
        counted_ = radiance;
        if (samples_light_)
            add({found * of_light_.radiance, of_light_.likelihood});
        else
            add({found + std::exchange(open_, 0), likelihood()});
    }
    double likelihood() const { return survival_ > 0 ? ratio_ / survival_ : 0; }

    struct Found {
        double radiance = 0, likelihood = 0;
    };
    void add(Found f) {
        if (f.radiance == 0) return;
        if (size_ == found_.size())
            found_.back().radiance += f.radiance; // of a very long path
        else
            found_[size_++] = f;
    }

    std::array<Found, 64> found_;
    std::size_t size_ = 0;
    double counted_ = 0, open_ = 0;
    double ratio_ = 1;    // of the densities
    double survival_ = 1; // of Russian roulette without a guide
    bool samples_light_ = false;
    Found of_light_; // factor and likelihood of the light sample's
};

} // namespace montelux
