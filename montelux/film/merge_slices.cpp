#include "montelux/film/merge_slices.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>

#include "montelux/film/film.h"
#include "montelux/film/film_error.h"
#include "montelux/film/pixel_warnings.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/stats/skew_moments.h"

namespace montelux {
namespace {

std::string text_attribute(const Image& image, const std::string& key, const std::string& name) {
    const auto at = image.attributes().find(key);
    if (at == image.attributes().end() || !std::holds_alternative<std::string>(at->second))
        throw Error(name, "it has no attribute " + key +
                              "; an EXR file that montelux render --slice wrote is expected");
    return std::get<std::string>(at->second);
}

struct SliceNumber {
    int index = 1, count = 1;
};
SliceNumber slice_of(const Image& image, const std::string& name) {
    const std::string text = text_attribute(image, "slice", name);
    SliceNumber s;
    const char* end = text.data() + text.size();
    const auto [p, e] = std::from_chars(text.data(), end, s.index);
    if (e == std::errc() && p != end && *p == '/') {
        const auto [q, f] = std::from_chars(p + 1, end, s.count);
        if (f == std::errc() && q == end && s.index >= 1 && s.index <= s.count && s.count <= 1'000'000)
            return s;
    }
    throw Error(name, "its attribute slice is '" + text + "'; K/N is expected");
}

// The layers of one picture, by meaning.
struct Layers {
    std::array<int, 3> mean{}, error{}, skewness{}, albedo{}, normal{};
    int samples = 0, replicates = 0, outlier = 0, depth = 0;
    std::optional<std::array<int, 3>> brightest; // only in slices

    Layers(const Image& image, const std::string& name) {
        auto find = [&](const std::string& channel) {
            const auto found = image.find_channel(channel);
            if (!found) throw Error(name, "it has no layer " + channel);
            return *found;
        };
        const char* rgb[] = {"R", "G", "B"};
        const char* xyz[] = {"X", "Y", "Z"};
        for (std::size_t c = 0; c < 3; ++c) {
            mean[c] = find(rgb[c]);
            error[c] = find(std::string("stderr.") + rgb[c]);
            skewness[c] = find(std::string("skewness.") + rgb[c]);
            albedo[c] = find(std::string("albedo.") + rgb[c]);
            normal[c] = find(std::string("N.") + xyz[c]);
        }
        samples = find("samples");
        replicates = find("replicates");
        outlier = find("outlier");
        depth = find("depth.Z");
        if (image.find_channel("brightest.R"))
            brightest = {find("brightest.R"), find("brightest.G"), find("brightest.B")};
    }
};

// Moments of a pixel's replicates, reconstructed from its layers.
SkewMoments<3> moments_of(const Image& image, const Layers& at, int x, int y) {
    const double n = std::clamp(std::round(static_cast<double>(image.value(x, y, at.replicates))), 0.0, 1e15);
    if (!(n >= 1)) return {};
    std::array<double, 3> mean{}, squares{}, cubes{};
    for (std::size_t c = 0; c < 3; ++c) {
        mean[c] = static_cast<double>(image.value(x, y, at.mean[c]));
        if (n < 2) continue;
        const double error = static_cast<double>(image.value(x, y, at.error[c]));
        const double m2 = error * error * (n - 1);
        squares[c] = n * m2;
        cubes[c] =
            static_cast<double>(image.value(x, y, at.skewness[c])) * std::sqrt(n) * m2 * std::sqrt(m2) * n;
    }
    return SkewMoments<3>(static_cast<std::uint64_t>(n), mean, squares, cubes);
}
// The brightest replicate of a pixel. For a picture without its layers, an outlier with the same share of the
// variance in each channel is assumed; exact if no other picture is merged with it.
Vec3d brightest_of(const Image& image, const Layers& at, int x, int y, const SkewMoments<3>& replicates) {
    Vec3d replicate;
    for (std::size_t c = 0; c < 3; ++c) {
        const int channel = static_cast<int>(c);
        if (at.brightest) {
            replicate[channel] = static_cast<double>(image.value(x, y, (*at.brightest)[c]));
            continue;
        }
        replicate[channel] = replicates.mean(channel);
        if (replicates.count() >= 2)
            replicate[channel] +=
                std::sqrt(static_cast<double>(image.value(x, y, at.outlier)) * replicates.variance(channel) *
                          static_cast<double>(replicates.count() - 1));
    }
    return replicate;
}

double number_attribute(const Image& image, const char* key) {
    const auto at = image.attributes().find(key);
    if (at == image.attributes().end()) return 0;
    if (const int* v = std::get_if<int>(&at->second)) return *v;
    if (const float* v = std::get_if<float>(&at->second)) return static_cast<double>(*v);
    return 0;
}

} // namespace

void SliceMerger::add(const Image& slice, const std::string& name) {
    const std::string hash = text_attribute(slice, "renderHash", name);
    const SliceNumber number = slice_of(slice, name);
    const Layers at(slice, name);
    if (names_.empty()) {
        first_name_ = name;
        hash_ = hash;
        count_ = number.count;
        width_ = slice.width();
        height_ = slice.height();
        pixels_.resize(slice.pixel_count());
    }
    if (hash != hash_)
        throw Error(name, "it is of another render than " + first_name_ +
                              ": scene, film, sampler, seed or integrator differ");
    if (number.count != count_)
        throw Error(name, "it is one of " + std::to_string(number.count) + " slices, but " + first_name_ +
                              " is one of " + std::to_string(count_));
    if (slice.width() != width_ || slice.height() != height_)
        throw Error(name, "it has another size than " + first_name_);
    if (const auto [other, fresh] = names_.emplace(number.index, name); !fresh)
        throw Error(name, other->second == name ? "it is given twice"
                                                : "it is slice " + std::to_string(number.index) + ", as " +
                                                      other->second + " is");
    if (names_.begin()->first == number.index) attributes_ = slice.attributes();
    bad_samples_ += number_attribute(slice, "badSamples");
    clamped_samples_ += number_attribute(slice, "clampedSamples");
    const double samples = number_attribute(slice, "samplesTaken");
    clamped_light_ += samples * number_attribute(slice, "clampedLuminance");
    samples_taken_ += samples;
    seconds_ += number_attribute(slice, "renderSeconds");
    interrupted_ = std::max(interrupted_, number_attribute(slice, "interrupted"));

    std::size_t i = 0;
    for (int y = 0; y < height_; ++y)
        for (int x = 0; x < width_; ++x, ++i) {
            PixelSums& sums = pixels_[i];
            const SkewMoments<3> part = moments_of(slice, at, x, y);
            const Vec3d brightest = brightest_of(slice, at, x, y, part);
            if (part.count() > 0 &&
                (sums.replicates.count() == 0 ||
                 dot(brightest, luminance_weight) > dot(sums.brightest, luminance_weight)))
                sums.brightest = brightest;
            sums.replicates.merge(part);
            auto value = [&](int channel) { return static_cast<double>(slice.value(x, y, channel)); };
            const double n = value(at.samples);
            sums.samples += n;
            sums.depth += n * value(at.depth);
            for (std::size_t c = 0; c < 3; ++c) {
                sums.albedo[c] += n * value(at.albedo[c]);
                sums.normal[c] += n * value(at.normal[c]);
            }
        }
}

MergedSlices SliceMerger::finish() const {
    if (names_.empty()) throw Error("merge", "at least one picture is expected");
    MergedSlices result;
    for (int k = 1; k <= count_; ++k)
        if (!names_.contains(k)) result.missing.push_back(k);
    result.image = Image(width_, height_, film_layers());
    Image& out = result.image;
    const Layers to(out, "the joined picture");
    std::vector<PixelSpread> spreads;
    std::vector<double> errors;
    spreads.reserve(pixels_.size());
    errors.reserve(pixels_.size());
    double squares = 0, luminance = 0, all_samples = 0;
    std::size_t i = 0;
    for (int y = 0; y < height_; ++y)
        for (int x = 0; x < width_; ++x, ++i) {
            const PixelSums& sums = pixels_[i];
            const SkewMoments<3>& replicates = sums.replicates;
            auto put = [&](int channel, double v) { out.set(x, y, channel, static_cast<float>(v)); };
            const double inverse = sums.samples > 0 ? 1 / sums.samples : 0;
            double error = 0;
            for (int c = 0; c < 3; ++c) {
                const auto k = static_cast<std::size_t>(c);
                put(to.mean[k], replicates.mean(c));
                put(to.error[k], replicates.standard_error(c));
                put(to.skewness[k], replicates.skewness_of_mean(c));
                put(to.albedo[k], sums.albedo[k] * inverse);
                put(to.normal[k], sums.normal[k] * inverse);
                error += luminance_weight[c] * replicates.standard_error(c);
                luminance += luminance_weight[c] * replicates.mean(c);
            }
            put(to.samples, sums.samples);
            put(to.replicates, static_cast<double>(replicates.count()));
            const double largest = std::min(1.0, share_of_replicate(replicates, sums.brightest));
            put(to.outlier, largest);
            spreads.push_back(
                pixel_spread(error, sums.samples, static_cast<double>(replicates.count()), largest));
            errors.push_back(error);
            put(to.depth, sums.depth * inverse);
            squares += error * error;
            all_samples += sums.samples;
        }
    const std::vector<PixelWarning> warnings = pixel_warnings(spreads, width_);
    result.outliers = outliers_of(errors, warnings);
    const int layer = *out.find_channel("warning");
    i = 0;
    for (int y = 0; y < height_; ++y)
        for (int x = 0; x < width_; ++x, ++i) out.set(x, y, layer, static_cast<float>(warnings[i]));
    const double pixels = static_cast<double>(out.pixel_count());
    result.mean_samples = all_samples / pixels;
    result.mean_luminance = luminance / pixels;
    result.clamped_samples = clamped_samples_;
    if (samples_taken_ > 0) result.clamped_luminance = clamped_light_ / samples_taken_;
    result.relative_error = luminance > 0 ? std::sqrt(squares * pixels) / luminance : 0;

    Attributes& a = out.attributes();
    a = attributes_;
    // Of one slice alone.
    for (const char* key : {"stoppedBy", "denoiser", "denoiserGuides", "mergingLastRadius", "mergingBias",
                            "mergingBiasError", "mergingBiasRms"})
        a.erase(key);
    a["slice"] =
        result.missing.empty() ? std::string("1/1") : std::string("some of ") + std::to_string(count_);
    a["samplesTaken"] = static_cast<float>(result.mean_samples);
    a["relativeError"] = static_cast<float>(result.relative_error);
    a["interrupted"] = static_cast<int>(interrupted_);
    a["badSamples"] = static_cast<int>(std::min(bad_samples_, 1e9));
    if (result.clamped_luminance > 0) {
        a["clampedLuminance"] = static_cast<float>(result.clamped_luminance);
        a["clampedSamples"] = static_cast<int>(std::min(clamped_samples_, 1e9));
    }
    a["renderSeconds"] = static_cast<float>(seconds_);
    return result;
}

} // namespace montelux
