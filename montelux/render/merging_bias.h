// MergingBias: estimates the bias of a picture whose paths merge.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "montelux/film/splat_film.h"

namespace montelux {

// Merging by discs of radius r replaces the irradiance E at a point by its mean over the disc. Where E is smooth that is
// wrong by b r^2 + O(r^4) (Silverman 1986, "Density Estimation", section 4.3; Hachisuka, Jarosz, Jensen 2010, "A
// Progressive Error Estimation Framework for Photon Density Estimation"). A disc of half the area has half the bias, so
// twice the difference of the two estimates, from the same light paths with the same weights, estimates the bias
// (Richardson's extrapolation). At edges of shadows and of surfaces the bias falls more slowly, as r does at worst, and
// twice the difference is 0.6 of it.
//
// The differences are as noisy as the picture: they are averaged over cells of pixels, and their own noise, known from
// their spread over the passes, is subtracted from their squares.
class MergingBias {
  public:
    static constexpr int cell = 16; // pixels

    explicit MergingBias(const PixelBounds& crop);

    // A sample of a pixel: what it would gain by discs of half the area, linear sRGB. From any thread.
    void add(int x, int y, Vec3d narrower);
    // Ends a pass, of so many samples per pixel, which must be the same in all; 0 samples: forgets it.
    void close_pass(double samples);
    std::uint64_t passes() const { return passes_; }

    // In units of luminance, of the mean over the passes; 0 below two passes.
    struct Estimate {
        double mean = 0, error = 0, rms = 0;
    };
    Estimate estimate() const;

    // The state, for checkpoints.
    struct Cell {
        double sum = 0, squares = 0; // over passes, of the cell's bias
    };
    SplatFilm& open() { return open_; }
    const SplatFilm& open() const { return open_; }
    std::span<const Cell> cells() const { return cells_; }
    void restore(std::span<const Cell> cells, std::uint64_t passes);

  private:
    double pixels_in(std::size_t cell) const;

    PixelBounds crop_;
    int columns_;
    SplatFilm open_;          // a pixel for each cell
    std::vector<Cell> cells_; // and one for the whole picture
    std::uint64_t passes_ = 0;
};

} // namespace montelux
