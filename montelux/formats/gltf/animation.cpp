#include "montelux/formats/gltf/animation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

#include "montelux/formats/gltf/accessor.h"
#include "montelux/mc/math/nearest_name.h"

namespace montelux::gltf {
namespace {

using Numbers = std::vector<double>;

constexpr auto paths = std::to_array<std::string_view>({"translation", "rotation", "scale", "weights"});
constexpr auto interpolations = std::to_array<std::string_view>({"LINEAR", "STEP", "CUBICSPLINE"});

void normalize_quaternion(Numbers& q) {
    double sum = 0;
    for (const double v : q) sum += v * v;
    if (sum > 0)
        for (double& v : q) v /= std::sqrt(sum);
}

// Along the shorter arc.
Numbers slerp(const Numbers& a, Numbers b, double t) {
    double cosine = 0;
    for (std::size_t i = 0; i < 4; ++i) cosine += a[i] * b[i];
    if (cosine < 0) {
        cosine = -cosine;
        for (double& v : b) v = -v;
    }
    const double angle = std::acos(std::min(cosine, 1.0));
    double wa = 1 - t, wb = t;
    if (std::sin(angle) > 1e-9) {
        wa = std::sin((1 - t) * angle) / std::sin(angle);
        wb = std::sin(t * angle) / std::sin(angle);
    }
    Numbers result(4);
    for (std::size_t i = 0; i < 4; ++i) result[i] = wa * a[i] + wb * b[i];
    return result;
}

// `count` numbers from the one with that number on, without decoding the others into memory of their own.
Numbers numbers_at(const std::vector<float>& all, std::size_t first, std::size_t count) {
    return {all.begin() + static_cast<std::ptrdiff_t>(first),
            all.begin() + static_cast<std::ptrdiff_t>(first + count)};
}

std::vector<float> output_of(Document& document, const Channel& channel) {
    const Value index = channel.sampler.required("output");
    if (channel.path == "weights") return read_scalars(document, open_accessor(document, index, {"SCALAR"}));
    std::vector<float> all;
    const auto add = [&](const auto& elements) {
        for (const auto& element : elements) all.insert(all.end(), element.begin(), element.end());
    };
    if (channel.path == "rotation")
        add(read_elements<4>(document, open_accessor(document, index, {"VEC4"}),
                             [](const std::array<float, 4>& v) { return v; }));
    else
        add(read_elements<3>(document, open_accessor(document, index, {"VEC3"}),
                             [](const std::array<float, 3>& v) { return v; }));
    return all;
}

// Of the keys, at least one, growing.
std::vector<float> times_of(Document& document, const Channel& channel) {
    const Value input = channel.sampler.required("input");
    std::vector<float> times = read_scalars(document, open_accessor(document, input, {"SCALAR"}));
    if (!std::ranges::is_sorted(times)) input.error("the times of keys do not grow");
    return times;
}

} // namespace

std::vector<Channel> channels_of(const Document& document) {
    std::vector<Channel> channels;
    std::set<std::pair<std::size_t, std::string_view>> targets;
    for (const Value& animation : document.all("animations")) {
        const std::vector<Value> samplers = animation.elements("samplers");
        for (const Value& source : animation.elements("channels")) {
            const Value target = source.required("target");
            const std::optional<Value> node = target.find("node");
            if (!node) continue; // for extensions
            const Value path = target.required("path");
            const auto* known = std::ranges::find(paths, std::string_view(path.text()));
            if (known == paths.end()) {
                path.warn("unknown path " + in_quotes(path.text()) + did_you_mean(path.text(), paths) +
                          "; the channel is ignored");
                continue;
            }
            document.refer(*node, "nodes", "node");
            const Value number = source.required("sampler");
            if (number.whole() >= samplers.size())
                number.error("sampler " + std::to_string(number.whole()) + " does not exist (there are " +
                             std::to_string(samplers.size()) + ")");
            if (!targets.emplace(node->whole(), *known).second) {
                source.warn("node " + std::to_string(node->whole()) + " has a channel for its " +
                            std::string(*known) + " already; this one is ignored");
                continue;
            }
            channels.push_back({source, samplers[number.whole()], node->whole(), *known});
        }
    }
    return channels;
}

double end_of(Document& document, const std::vector<Channel>& channels) {
    double end = 0;
    for (const Channel& channel : channels) end = std::max(end, double(times_of(document, channel).back()));
    return end;
}

std::vector<double> value_at(Document& document, const Channel& channel, double time,
                             std::size_t weight_count) {
    const std::size_t size = channel.path == "weights" ? weight_count : channel.path == "rotation" ? 4 : 3;
    const std::vector<float> times = times_of(document, channel);
    const std::string kind = channel.sampler.text("interpolation", "LINEAR");
    if (std::ranges::find(interpolations, std::string_view(kind)) == interpolations.end())
        channel.sampler.required("interpolation")
            .error("unknown interpolation " + in_quotes(kind) + did_you_mean(kind, interpolations));
    const bool cubic = kind == "CUBICSPLINE";
    const std::vector<float> output = output_of(document, channel);
    const std::size_t per_key = (cubic ? 3 : 1) * size;
    if (output.size() != times.size() * per_key)
        channel.sampler.required("output").error("has " + std::to_string(output.size()) + " numbers; " +
                                                 std::to_string(times.size()) + " keys need " +
                                                 std::to_string(times.size() * per_key));
    const auto value_of = [&](std::size_t key) {
        return numbers_at(output, key * per_key + (cubic ? size : 0), size);
    };
    const auto after =
        static_cast<std::size_t>(std::upper_bound(times.begin(), times.end(), time,
                                                  [](double t, float key) { return t < double(key); }) -
                                 times.begin());
    Numbers result;
    if (after == 0) {
        result = value_of(0);
    } else if (after == times.size() || kind == "STEP") {
        result = value_of(after - 1);
    } else {
        const double begin = double(times[after - 1]), length = double(times[after]) - begin;
        const double t = length > 0 ? (time - begin) / length : 0;
        const Numbers from = value_of(after - 1), to = value_of(after);
        if (cubic) { // Hermite, with tangents per second
            const Numbers out = numbers_at(output, (after - 1) * per_key + 2 * size, size),
                          in = numbers_at(output, after * per_key, size);
            const double t2 = t * t, t3 = t2 * t;
            result.resize(size);
            for (std::size_t i = 0; i < size; ++i)
                result[i] = (2 * t3 - 3 * t2 + 1) * from[i] + length * (t3 - 2 * t2 + t) * out[i] +
                            (3 * t2 - 2 * t3) * to[i] + length * (t3 - t2) * in[i];
        } else if (channel.path == "rotation") {
            result = slerp(from, to, t);
        } else {
            result.resize(size);
            for (std::size_t i = 0; i < size; ++i) result[i] = (1 - t) * from[i] + t * to[i];
        }
    }
    if (channel.path == "rotation") normalize_quaternion(result);
    return result;
}

} // namespace montelux::gltf
