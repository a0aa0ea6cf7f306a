// Differences of two pictures: RMSE, relative MSE, means, and z-scores where standard errors are known.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "montelux/image/image.h"

namespace montelux {

// A picture and, where it is known, the standard error of each of its colour samples. Refers to images that
// must outlive it.
struct MeasuredPicture {
    std::string name; // for messages
    const Image* image = nullptr;
    std::vector<int> channels; // R, G, B or Y in *image
    const Image* error = nullptr;
    std::vector<int> error_channels; // in *error, in the same order

    // Skewness of each sample's mean, in *image; empty when it is not known.
    std::vector<int> skewness_channels;

    bool has_error() const { return error != nullptr; }
    double value(int x, int y, int c) const { return static_cast<double>(image->linear(x, y, channels[c])); }
    double standard_error(int x, int y, int c) const {
        return static_cast<double>(error->linear(x, y, error_channels[c]));
    }
    // Third cumulant of the sample's error: skewness times the cube of the standard error; 0 when not known.
    double third_cumulant(int x, int y, int c) const {
        if (skewness_channels.empty() || !has_error()) return 0;
        double s = standard_error(x, y, c);
        return static_cast<double>(image->linear(x, y, skewness_channels[c])) * s * s * s;
    }
};

// Takes the colour channels, and the layer "stderr.R", "stderr.G", "stderr.B" (or "stderr.Y") if there is
// one, and the layer "skewness.". Throws Error for an image without colour; `name` begins the message.
MeasuredPicture measured_picture(const std::string& name, const Image& image);
// The same with the errors in an image of their own: its "stderr." layer, or else its colour channels.
// Throws Error when the sizes or channels differ.
MeasuredPicture measured_picture(const std::string& name, const Image& image, const std::string& error_name,
                                 const Image& error);

struct ComparisonOptions {
    // e in relMSE = mean of (a-b)^2 / (b^2 + e), in squared units of the picture. 0.01 is the value of
    // Rousselle et al. 2011, "Adaptive Sampling and Reconstruction using Greedy Error Minimization", 6.
    double relative_epsilon = 0.01;
    // Per cent of the pixels, those with the noisiest reference, left out of every figure: their own standard
    // errors are the least certain. The noise of a pixel is the sum over channels of the reference's standard
    // error divided by (the sum of its |values| + 1/1000 of the picture's mean sum). Rounded down to whole
    // pixels; of equals, the later pixels go first. When only the first picture has errors, its noise is
    // taken. Throws Error when neither has, or when it is outside [0, 100).
    double set_aside_percent = 0;
};

// Figures of one channel.
struct ChannelComparison {
    std::string name;
    double mean_a = 0, mean_b = 0;
    double relative_mean_difference = 0; // mean_a / mean_b - 1; NaN when mean_b is 0
    // Standard error of mean_a - mean_b from the known errors, pixels taken as independent; NaN without any.
    double mean_difference_error = 0;
    double rmse = 0;
    double rel_mse = 0;
};

// z = (a - b) / sqrt(sa^2 + sb^2) over pixels and channels, with the errors that are known.
struct ZScores {
    std::uint64_t count = 0;
    double mean = 0, standard_deviation = 0; // NaN below two scores
    std::array<double, 3> within{};          // share of |z| <= 1, 2, 3; NaN without scores
    double largest = 0;                      // of |z|
    std::uint64_t equal_without_error = 0;   // samples with a == b and no error: no score, nothing wrong
    std::uint64_t unexplained = 0;           // samples with a != b although both errors are 0
    std::uint64_t invalid_errors = 0;        // samples whose error is negative, NaN or infinite: no score

    // `within` for right, Gaussian errors.
    static constexpr std::array<double, 3> expected_within{0.682689492137086, 0.954499736103642,
                                                           0.997300203936740};
};

struct Comparison {
    std::vector<ChannelComparison> channels;
    double rmse = 0;    // sqrt of the mean over pixels and channels of (a-b)^2
    double rel_mse = 0; // mean over pixels and channels of (a-b)^2 / (b^2 + e)
    std::uint64_t pixels = 0, set_aside = 0;
    std::uint64_t not_finite = 0; // pixels with NaN or infinity in either picture, left out of every figure
    bool a_has_error = false, b_has_error = false;
    ZScores z; // empty when neither picture has errors
    // The same scores corrected for the skewness of the pictures' samples (skew_corrected_z), where a picture
    // has the layer "skewness." (`skew_known`).
    ZScores skew_corrected;
    bool skew_known = false;
    // The same scores with each pixel's variance pooled from the 3 x 3 pixels around it (pool_variances): for
    // unbiased pictures their mean is near 0 however skewed the samples are. Pixels set aside have no score,
    // but count as neighbours. A sample that differs although its own errors are 0 has a score where its
    // surroundings have errors. Empty when neither picture has errors.
    ZScores pooled;
};

// `b` is the reference. Throws Error when sizes or channels differ, or when no pixel is left.
Comparison compare_pictures(const MeasuredPicture& a, const MeasuredPicture& b,
                            const ComparisonOptions& options = {});

// Figures of one channel on its own.
struct ChannelSummary {
    double minimum = 0, mean = 0, maximum = 0; // of the finite samples; NaN when there are none
    std::uint64_t finite = 0, nan = 0, infinite = 0, negative = 0;
};
// Of the stored values: an encoding is not undone.
ChannelSummary summarize_channel(const Image& image, int channel);

} // namespace montelux
