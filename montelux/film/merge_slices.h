// Pictures of slices of one render, joined into the picture of the whole.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "montelux/film/film_error.h"
#include "montelux/image/image.h"
#include "montelux/mc/stats/skew_moments.h"

namespace montelux {

struct MergedSlices {
    Image image;
    std::vector<int> missing;  // slices, counted from 1, that no picture was of
    double relative_error = 0; // FilmError::relative
    double mean_samples = 0, mean_luminance = 0;
    // How many samples were clamped, and the mean luminance that this took away.
    double clamped_samples = 0, clamped_luminance = 0;
    OutlierReport outliers;
};

// Joins what Film::develop() wrote for slices k/n of one render, one picture after the other in any order, so
// that no two need be in memory. All layers are those of all replicates together, as far as 32-bit layers
// tell (relative differences of about 1e-7). The standard error is infinite where there are fewer than two
// replicates. Pictures say what they are of in the attributes `renderHash` and `slice`.
class SliceMerger {
  public:
    // Throws Error, naming the picture, where it is no slice, is of another render than those before, or of a
    // slice that one of these is of. `name` is for messages.
    void add(const Image& slice, const std::string& name);
    // The joined picture of all that were added; throws Error where there were none.
    MergedSlices finish() const;

  private:
    struct PixelSums {
        SkewMoments<3> replicates;
        Vec3d brightest; // replicate
        double samples = 0;
        double depth = 0; // these and the next are weighted by samples
        std::array<double, 3> albedo{}, normal{};
    };

    std::string first_name_, hash_;
    int width_ = 0, height_ = 0, count_ = 0;
    std::map<int, std::string> names_; // of the slices that were added
    std::vector<PixelSums> pixels_;
    Attributes attributes_; // of the picture of the lowest slice
    double bad_samples_ = 0, seconds_ = 0, interrupted_ = 0;
    double clamped_samples_ = 0, clamped_light_ = 0, samples_taken_ = 0; // the light weighted by samples
};

} // namespace montelux
