#include "montelux/render/pilot_variance.h"

#include <algorithm>
#include <cmath>

namespace montelux {
namespace {

constexpr double significant = 3; // errors of a difference
// Of the mean over all tiles: relMSE of pictures of mean 0.2 with its usual epsilon of 0.01.
constexpr double darkest_share = 0.5;

// One picture in one tile.
struct TileMoments {
    double mean = 0;
    double variance = 0;     // of a sample, mean over pixels
    double square_error = 0; // of the mean
    double samples = 1;      // per pixel, of the mean; of its noisiest part
};

double square(double x) { return x * x; }

// How many times as large as with independent pixels the squared errors of means over tiles are: splats and chains reach
// neighbouring pixels together. From all tiles, as a single difference says little.
double error_growth(const PilotPart& part, std::span<const std::size_t> tile_ends) {
    double of_means = 0, of_pixels = 0;
    std::size_t i = 0;
    for (const std::size_t end : tile_ends) {
        const auto pixels = static_cast<double>(end - i);
        double difference = 0, squares = 0;
        for (; i < end; ++i) {
            const double d = double(part.first[i]) - double(part.second[i]);
            difference += d;
            squares += d * d;
        }
        of_means += square(difference / pixels);
        of_pixels += squares / square(pixels);
    }
    return of_pixels > 0 ? std::max(1.0, of_means / of_pixels) : 1;
}

std::vector<TileMoments> tile_moments(const PilotPicture& picture, std::span<const std::size_t> tile_ends) {
    std::vector<TileMoments> tiles(tile_ends.size());
    for (std::size_t k = 0; k < picture.parts.size(); ++k) {
        const PilotPart& part = picture.parts[k];
        const double growth = error_growth(part, tile_ends);
        std::size_t i = 0;
        for (std::size_t t = 0; t < tiles.size(); ++t) {
            const auto pixels = static_cast<double>(tile_ends[t] - i);
            double sum = 0, squares = 0;
            for (; i < tile_ends[t]; ++i) {
                sum += 0.5 * (double(part.first[i]) + double(part.second[i]));
                squares += square(double(part.first[i]) - double(part.second[i]));
            }
            TileMoments& tile = tiles[t];
            tile.mean += sum / pixels;
            tile.variance += part.samples * 0.5 * squares / pixels;
            tile.square_error += growth * 0.25 * squares / square(pixels);
            tile.samples = k == 0 ? 2 * part.samples : std::min(tile.samples, 2 * part.samples);
        }
    }
    return tiles;
}

// Variance of a sample that would explain why `seen` has less light than `other`.
double variance_of_missed(const TileMoments& seen, const TileMoments& other, double pixels) {
    const double missed =
        other.mean - seen.mean - significant * std::sqrt(seen.square_error + other.square_error);
    return missed > 0 ? seen.samples * pixels * square(missed) : 0;
}

// All pictures in the same tiles.
class Comparison {
  public:
    Comparison(std::span<const PilotPicture> pictures, std::span<const std::size_t> tile_ends)
        : pictures_(pictures), ends_(tile_ends), all_(static_cast<double>(tile_ends.back())) {
        for (const PilotPicture& picture : pictures) moments_.push_back(tile_moments(picture, tile_ends));
        for (const auto& tiles : moments_) wholes_.push_back(whole(tiles));
    }

    double mean(std::size_t k) const { return wholes_[k].mean; }
    // Of a sample, each tile's divided by the square of scale(tile).
    template <typename Scale>
    double variance(std::size_t k, const Scale& scale) const {
        double own = 0, missed_in_tiles = 0, weight = 0;
        for (std::size_t t = 0; t < ends_.size(); ++t) {
            const double share = pixels_of(t) / all_ / square(scale(t));
            own += share * moments_[k][t].variance;
            missed_in_tiles += share * missed(k, pixels_of(t), [&](std::size_t i) { return moments_[i][t]; });
            weight += share;
        }
        // Light may be missed everywhere, a little.
        const double missed_in_all = missed(k, all_, [&](std::size_t i) { return wholes_[i]; });
        return own + std::max(missed_in_tiles, weight * missed_in_all);
    }
    double tile_mean(std::size_t k, std::size_t t) const { return moments_[k][t].mean; }

  private:
    double pixels_of(std::size_t t) const {
        return static_cast<double>(ends_[t] - (t > 0 ? ends_[t - 1] : 0));
    }
    TileMoments whole(const std::vector<TileMoments>& tiles) const {
        TileMoments sum;
        for (std::size_t t = 0; t < tiles.size(); ++t) {
            const double share = pixels_of(t) / all_;
            sum.mean += share * tiles[t].mean;
            sum.square_error += square(share) * tiles[t].square_error;
            sum.samples = tiles[t].samples;
        }
        return sum;
    }
    template <typename Of>
    double missed(std::size_t k, double pixels, const Of& of) const {
        double most = 0;
        for (std::size_t other = 0; other < pictures_.size(); ++other)
            if (other != k && pictures_[other].is_evidence)
                most = std::max(most, variance_of_missed(of(k), of(other), pixels));
        return most;
    }

    std::span<const PilotPicture> pictures_;
    std::span<const std::size_t> ends_;
    double all_;
    std::vector<std::vector<TileMoments>> moments_;
    std::vector<TileMoments> wholes_;
};

} // namespace

std::vector<double> relative_variances(std::span<const PilotPicture> pictures,
                                       std::span<const std::size_t> tile_ends, PilotMeasure measure) {
    const Comparison comparison(pictures, tile_ends);
    std::vector<double> result(pictures.size());
    std::size_t best = pictures.size();
    double least = 0;
    for (std::size_t k = 0; k < pictures.size(); ++k) {
        if (!(comparison.mean(k) > 0)) continue;
        const double v = comparison.variance(k, [&](std::size_t) { return comparison.mean(k); });
        if (best == pictures.size() || v < least) {
            best = k;
            least = v;
        }
    }
    if (best == pictures.size()) return result;
    const double mean = comparison.mean(best);
    for (std::size_t k = 0; k < pictures.size(); ++k)
        result[k] = comparison.variance(k, [&](std::size_t t) {
            return measure == PilotMeasure::picture
                       ? mean
                       : std::max(comparison.tile_mean(best, t), darkest_share * mean);
        });
    return result;
}

} // namespace montelux
