#include "montelux/film/merge_slices.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <utility>

#include "montelux/film/film.h"
#include "montelux/film/film_error.h"
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

// The layers of one picture, by what they are.
struct Layers {
    std::array<int, 3> mean{}, error{}, skewness{}, albedo{}, normal{};
    int samples = 0, units = 0, outlier = 0, depth = 0;

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
        units = find("units");
        outlier = find("outlier");
        depth = find("depth.Z");
    }
};

// Moments of the units of a pixel, from what its layers say of their mean.
SkewMoments<3> moments_of(const Image& image, const Layers& at, int x, int y) {
    const double n = std::clamp(std::round(static_cast<double>(image.value(x, y, at.units))), 0.0, 1e15);
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
double weighted_squares(const SkewMoments<3>& m) {
    double sum = 0;
    if (m.count() >= 2)
        for (int c = 0; c < 3; ++c)
            sum += luminance_weight[c] * luminance_weight[c] * m.variance(c) *
                   static_cast<double>(m.count() - 1);
    return sum;
}

} // namespace

MergedSlices merge_slices(std::span<const Image> slices, std::span<const std::string> names) {
    if (slices.empty()) throw Error("merge", "at least one picture is expected");
    const std::string hash = text_attribute(slices[0], "renderHash", names[0]);
    const int count = slice_of(slices[0], names[0]).count;
    std::map<int, std::size_t> present;
    std::vector<Layers> layers;
    for (std::size_t i = 0; i < slices.size(); ++i) {
        const SliceNumber s = slice_of(slices[i], names[i]);
        if (text_attribute(slices[i], "renderHash", names[i]) != hash)
            throw Error(names[i], "it is of another render than " + names[0] +
                                      ": scene, film, sampler, seed or integrator differ");
        if (s.count != count)
            throw Error(names[i], "it is one of " + std::to_string(s.count) + " slices, but " + names[0] +
                                      " is one of " + std::to_string(count));
        if (slices[i].width() != slices[0].width() || slices[i].height() != slices[0].height())
            throw Error(names[i], "it has another size than " + names[0]);
        if (const auto [at, fresh] = present.emplace(s.index, i); !fresh)
            throw Error(names[i],
                        "it is slice " + std::to_string(s.index) + ", as " + names[at->second] + " is");
        layers.emplace_back(slices[i], names[i]);
    }
    MergedSlices result;
    for (int k = 1; k <= count; ++k)
        if (!present.contains(k)) result.missing.push_back(k);

    const Image& first = slices[present.begin()->second];
    result.image = Image(first.width(), first.height(), film_layers());
    Image& out = result.image;
    out.attributes() = first.attributes();
    // Of one slice alone.
    for (const char* key : {"stoppedBy", "clampedLuminance", "denoiser", "denoiserGuides"})
        out.attributes().erase(key);
    const Layers to(out, "the joined picture");
    double squares = 0, luminance = 0, all_samples = 0;
    for (int y = 0; y < out.height(); ++y)
        for (int x = 0; x < out.width(); ++x) {
            SkewMoments<3> total;
            double samples = 0, largest = 0, depth = 0;
            std::array<double, 3> albedo{}, normal{};
            // In the order of the slices, whatever that of the files.
            for (const auto& [number, i] : present) {
                const Image& from = slices[i];
                const Layers& at = layers[i];
                const SkewMoments<3> part = moments_of(from, at, x, y);
                total.merge(part);
                auto value = [&](int channel) { return static_cast<double>(from.value(x, y, channel)); };
                const double n = value(at.samples);
                samples += n;
                largest = std::max(largest, value(at.outlier) * weighted_squares(part));
                depth += n * value(at.depth);
                for (std::size_t c = 0; c < 3; ++c) {
                    albedo[c] += n * value(at.albedo[c]);
                    normal[c] += n * value(at.normal[c]);
                }
            }
            auto put = [&](int channel, double v) { out.set(x, y, channel, static_cast<float>(v)); };
            const double inverse = samples > 0 ? 1 / samples : 0, spread = weighted_squares(total);
            double error = 0;
            for (int c = 0; c < 3; ++c) {
                const auto k = static_cast<std::size_t>(c);
                put(to.mean[k], total.mean(c));
                put(to.error[k], total.standard_error(c));
                put(to.skewness[k], total.skewness_of_mean(c));
                put(to.albedo[k], albedo[k] * inverse);
                put(to.normal[k], normal[k] * inverse);
                error += luminance_weight[c] * total.standard_error(c);
                luminance += luminance_weight[c] * total.mean(c);
            }
            put(to.samples, samples);
            put(to.units, static_cast<double>(total.count()));
            put(to.outlier, spread > 0 ? std::min(1.0, largest / spread) : 0);
            put(to.depth, depth * inverse);
            squares += error * error;
            all_samples += samples;
        }
    const double pixels = static_cast<double>(out.pixel_count());
    result.mean_samples = all_samples / pixels;
    result.relative_error = luminance > 0 ? std::sqrt(squares * pixels) / luminance : 0;

    Attributes& a = out.attributes();
    a["slice"] =
        result.missing.empty() ? std::string("1/1") : std::string("some of ") + std::to_string(count);
    a["samplesTaken"] = static_cast<float>(result.mean_samples);
    a["relativeError"] = static_cast<float>(result.relative_error);
    double bad = 0, seconds = 0, interrupted = 0;
    auto number = [](const Image& image, const char* key) {
        const auto at = image.attributes().find(key);
        if (at == image.attributes().end()) return 0.0;
        if (const int* v = std::get_if<int>(&at->second)) return static_cast<double>(*v);
        if (const float* v = std::get_if<float>(&at->second)) return static_cast<double>(*v);
        return 0.0;
    };
    for (const Image& slice : slices) {
        bad += number(slice, "badSamples");
        seconds += number(slice, "renderSeconds");
        interrupted = std::max(interrupted, number(slice, "interrupted"));
    }
    a["interrupted"] = static_cast<int>(interrupted);
    a["badSamples"] = static_cast<int>(std::min(bad, 1e9));
    a["renderSeconds"] = static_cast<float>(seconds);
    return result;
}

} // namespace montelux
