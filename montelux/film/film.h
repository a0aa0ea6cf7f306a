// Film: running moments of every pixel, and the image made of them.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "montelux/film/film_error.h"
#include "montelux/film/film_layers.h"
#include "montelux/film/spectral_buckets.h"
#include "montelux/image/image.h"
#include "montelux/mc/stats/skew_moments.h"
#include "montelux/scene/film/film_settings.h"

namespace montelux {

// The contribution of one sample to its pixel. All but the radiance belong to the first surface; 0 without
// one.
struct FilmSample {
    Vec3f radiance; // linear sRGB, filter weight applied
    Vec3f albedo;   // linear sRGB
    Vec3f normal;   // world space
    float depth = 0;
};

// A radiance that is NaN, infinite, or negative although the filter weight is not.
struct BadSample {
    enum class Kind : std::uint8_t { nan, infinite, negative };
    Kind kind = Kind::nan;
    int x = 0, y = 0;
    std::uint64_t sample = 0;
    auto operator<=>(const BadSample&) const = default;
};

// The largest share of the replicates' squared deviations from their mean that a single replicate
// contributes, by luminance weights; 0 without any.
double share_of_replicate(const SkewMoments<3>& replicates, Vec3d replicate);

// A pixel's value is the mean of independent, identically distributed replicates: single samples for the
// independent sampler, means over one randomisation of a point set for the others. The standard error is
// computed from the spread of the replicates alone, so it holds for both.
class Pixel {
  public:
    void add_sample(const FilmSample& s) {
        replicate_sum_ += Vec3d(s.radiance);
        ++replicate_samples_;
        albedo_ += s.albedo;
        normal_ += s.normal;
        depth_ += s.depth;
        ++samples_;
    }
    // Luminance that clamping removed from a sample.
    void add_clamped(float luminance) { clamped_ += static_cast<double>(luminance); }
    void count_bad() {
        ++replicate_samples_;
        ++samples_;
        ++bad_;
    }
    // Adds to the open replicate's mean what light paths bring to the pixel in its pass over the film (SplatFilm).
    void add_splats(Vec3d mean) { replicate_sum_ += mean * static_cast<double>(replicate_samples_); }
    // Adds features of the first surface that stand for so many samples.
    void add_features(Vec3f albedo, Vec3f normal, float depth, std::uint32_t samples) {
        const auto n = static_cast<float>(samples);
        albedo_ += albedo * n;
        normal_ += normal * n;
        depth_ += depth * n;
    }
    // Adds a whole replicate of that mean, which stands for so many samples; none may be open.
    void add_replicate(Vec3d mean, std::uint32_t samples) {
        replicate_sum_ = mean * static_cast<double>(samples);
        replicate_samples_ = samples;
        samples_ += samples;
        end_replicate();
    }
    // Forgets the open replicate's sum; its samples stay counted.
    void drop_replicate() {
        replicate_sum_ = {};
        replicate_samples_ = 0;
    }
    // Closes the replicate of the samples since the last call.
    void end_replicate() {
        if (replicate_samples_ == 0) return;
        const Vec3d replicate = replicate_sum_ / static_cast<double>(replicate_samples_);
        if (replicates_.count() == 0 || dot(replicate, luminance_weight) > dot(brightest_, luminance_weight))
            brightest_ = replicate;
        replicates_.add(replicate);
        replicate_sum_ = {};
        replicate_samples_ = 0;
    }

    // Whether end_last_replicate() drops the open replicate: one of fewer than half of `points` where there are
    // others would weigh as much as a whole one and be as noisy as single samples. The rule depends on counts
    // only, so it adds no bias.
    bool drops_last_replicate(std::uint32_t points) const {
        return 2 * replicate_samples_ < points && replicates_.count() >= 2;
    }
    // end_replicate(), or forgets the open one.
    void end_last_replicate(std::uint32_t points) {
        if (drops_last_replicate(points)) drop_replicate();
        end_replicate();
    }

    std::uint32_t open_samples() const { return replicate_samples_; }

    // All replicates must be closed.
    const SkewMoments<3>& replicates() const { return replicates_; }
    // The replicate of greatest luminance; 0 without any.
    Vec3d brightest() const { return brightest_; }
    std::uint32_t samples() const { return samples_; }
    std::uint32_t bad() const { return bad_; }
    // Mean luminance that clamping removed.
    double clamped() const { return samples_ > 0 ? clamped_ / samples_ : 0; }
    double largest_share() const { return share_of_replicate(replicates_, brightest_); }
    Vec3f albedo() const { return samples_ > 0 ? albedo_ / static_cast<float>(samples_) : Vec3f{}; }
    Vec3f normal() const { return samples_ > 0 ? normal_ / static_cast<float>(samples_) : Vec3f{}; }
    float depth() const { return samples_ > 0 ? depth_ / static_cast<float>(samples_) : 0; }

  private:
    SkewMoments<3> replicates_;
    Vec3d replicate_sum_;
    double clamped_ = 0;
    Vec3d brightest_;
    Vec3f albedo_, normal_;
    float depth_ = 0;
    std::uint32_t replicate_samples_ = 0, samples_ = 0, bad_ = 0;
};

// The channels that Film::develop() makes of the standard layers, in order.
std::vector<std::string> film_layers(bool of_slice = false);

class Film {
  public:
    // With the layers of the settings, but for light groups, whose names belong to a scene.
    explicit Film(const FilmSettings& settings) : Film(settings, FilmLayers(settings.layers.set)) {}
    Film(const FilmSettings& settings, FilmLayers layers);

    const FilmSettings& settings() const { return settings_; }
    const FilmLayers& layers() const { return layers_; }
    // FilmLayers::sums() numbers for each pixel, in the order of the pixels.
    std::span<double> layer_sums() { return layer_sums_; }
    std::span<const double> layer_sums() const { return layer_sums_; }
    const PixelBounds& bounds() const { return settings_.crop; }
    Pixel& pixel(int x, int y) { return pixels_[index(x, y)]; }
    const Pixel& pixel(int x, int y) const { return pixels_[index(x, y)]; }
    // Row by row.
    std::span<Pixel> pixels() { return pixels_; }
    std::span<const Pixel> pixels() const { return pixels_; }
    // Of a spectral film, those of a pixel side by side; otherwise empty.
    std::span<BucketMoments> buckets() { return buckets_; }
    std::span<const BucketMoments> buckets() const { return buckets_; }
    std::size_t buckets_per_pixel() const { return buckets_.size() / pixels_.size(); }
    // Copies pixels of a row from a film of the same settings.
    void copy_row(const Film& from, int x, int y, int width);

    // Ends the open replicate of every pixel; whole replicates have this many points.
    void end_replicates(std::uint32_t points = 1);
    // Ends the open replicates of a part of the film, whatever their number of samples.
    void end_replicates(const PixelBounds& part);
    // Forgets the open replicate of every pixel.
    void drop_replicates();
    FilmError error() const { return error_of(*this); }
    // Of the layers of the film: R, G, B (mean); stderr.R, G, B; skewness.R, G, B (of the mean); samples;
    // replicates (from which the standard error is computed); outlier (Pixel::largest_share); warning
    // (PixelWarning); albedo.R, G, B; N.X, Y, Z; depth.Z; variance.R, G, B (of a sample); relativeVariance.R, G, B
    // (variance over mean); those of FilmLayers; of the cropped pixels. The standard error is infinite below two
    // replicates. A slice of a render also has brightest.R, G, B (Pixel::brightest): the outlier of the whole
    // picture cannot be computed from those of its slices. A spectral film has the layers of append_spectral_layers.
    Image develop(bool as_slice = false) const;

  private:
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y - settings_.crop.y0) *
                   static_cast<std::size_t>(settings_.crop.width()) +
               static_cast<std::size_t>(x - settings_.crop.x0);
    }

    void end_bucket_replicates(std::uint32_t points);

    FilmSettings settings_;
    FilmLayers layers_;
    std::vector<Pixel> pixels_;
    std::vector<BucketMoments> buckets_;
    std::vector<double> layer_sums_;
};

} // namespace montelux
