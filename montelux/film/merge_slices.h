// SliceMerger: joins the pictures of slices of one render.
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
    std::vector<int> missing;  // slices without a picture, counted from 1
    double relative_error = 0; // FilmError::relative
    double mean_samples = 0, mean_luminance = 0;
    // Number of clamped samples, and the mean luminance that clamping removed.
    double clamped_samples = 0, clamped_luminance = 0;
    OutlierReport outliers;
};

// Joins the images that Film::develop() makes for slices k/n of one render, one at a time in any order, so
// that no two need be in memory. Layers equal those of all replicates together, to the precision of 32-bit
// layers (relative differences of about 1e-7). The standard error is infinite below two replicates. The
// attributes `renderHash` and `slice` identify the render and the slice.
class SliceMerger {
  public:
    // Throws Error, naming the picture, if it is not a slice, belongs to another render than those before, or
    // repeats a slice. `name` is for messages.
    void add(const Image& slice, const std::string& name);
    // The joined picture; throws Error if none was added.
    MergedSlices finish() const;

  private:
    struct PixelSums {
        SkewMoments<3> replicates;
        Vec3d brightest; // replicate
        double samples = 0;
        double depth = 0; // this and the next are weighted by samples
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
