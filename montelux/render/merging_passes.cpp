#include "montelux/render/merging_passes.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <utility>

#include "montelux/mc/math/error.h"
#include "montelux/mc/parallel/cpu_time.h"
#include "montelux/mc/parallel/parallel_for.h"
#include "montelux/render/splat_pass.h"

namespace montelux {

namespace {

// Of the first pass, in sides of the pixel that is seen.
constexpr double radius_in_pixels = 1.5;
// (alpha - 1) / 2
constexpr double radius_exponent = -0.125;

constexpr std::uint64_t pilot_paths = 4096, paths_per_part = 1024;

std::size_t map_bytes(const LightPaths& part) {
    const auto entries = static_cast<std::size_t>(
        std::ranges::count_if(part.vertices, [](const LightMapVertex& v) { return v.mergeable; }));
    return part.bytes() + entries * LightMap::bytes_per_entry;
}

} // namespace

MergingPasses::MergingPasses(SampleContext& context, const Accelerator& accelerator,
                             const MergingSettings& settings, const PixelBounds& crop)
    : context_(context), accelerator_(accelerator), settings_(settings), crop_(crop),
      pixels_(static_cast<std::uint64_t>(crop.width()) * static_cast<std::uint64_t>(crop.height())) {
    plan();
}

double MergingPasses::radius(std::uint64_t index) const {
    return first_radius_ * std::pow(static_cast<double>(index) + 1, radius_exponent);
}

// Light merges across the whole scene, at a cost that is quadratic in the number of pixels; or never, as positions in
// single precision lie further apart.
void MergingPasses::check_radius() const {
    constexpr double least_share = 1e-6;
    const double scene = accelerator_.bounds().radius();
    const bool small = first_radius_ < least_share * scene;
    if (!small && !(first_radius_ > scene)) return;
    char text[200];
    std::snprintf(
        text, sizeof text,
        "the radius %.3g is too %s for this scene, whose own is %.3g; 'auto' chooses one by the size of "
        "a pixel",
        first_radius_, small ? "small" : "large", scene);
    throw Error("merging", text);
}

// From a part of the first pass: how large pixels are on the surfaces that are seen, and how much memory a path takes.
void MergingPasses::plan() {
    RenderReport ignored;
    std::mutex mutex;
    // In small films, of as many samples as it takes.
    const std::uint64_t paths = std::min(pixels_, pilot_paths);
    double parts = 0, sum = 0, squares = 0;
    std::uint64_t traced = 0;
    for (std::uint64_t index = 0; traced < pilot_paths; ++index) {
        for (const LightPaths& part : trace(index, paths, ignored, mutex, nullptr)) {
            const auto bytes = static_cast<double>(map_bytes(part));
            sum += bytes;
            squares += bytes * bytes;
            parts += 1;
        }
        traced += paths;
    }
    // With four standard errors of the mean of the parts.
    const double mean = sum / parts,
                 error =
                     parts > 1 ? std::sqrt(std::max(0.0, squares / parts - mean * mean) / (parts - 1)) : 0,
                 per_path = (mean + 4 * error) * parts / static_cast<double>(traced);
    const double most = static_cast<double>(settings_.memory) * 0x1p20 / per_path;
    paths_ = most < double(pixels_) ? std::max<std::uint64_t>(static_cast<std::uint64_t>(most), 1) : pixels_;

    first_radius_ = double(settings_.radius);
    if (first_radius_ > 0) return check_radius();
    constexpr int across = 64;
    std::vector<SampleContext::Key> keys;
    for (int j = 0; j < across; ++j)
        for (int i = 0; i < across; ++i)
            keys.push_back({crop_.x0 + static_cast<int>((i + 0.5) / across * crop_.width()),
                            crop_.y0 + static_cast<int>((j + 0.5) / across * crop_.height()), 0});
    first_radius_ = merging_radius(context_, accelerator_, keys);
}

std::vector<LightPaths> MergingPasses::trace(std::uint64_t index, std::uint64_t paths, RenderReport& report,
                                             std::mutex& mutex, const CancelFlag* cancel) const {
    std::vector<LightPaths> parts((paths + paths_per_part - 1) / paths_per_part);
    parallel_for(
        static_cast<std::int64_t>(parts.size()),
        [&](std::int64_t p) {
            const double begin = thread_cpu_seconds();
            const auto part = static_cast<std::uint64_t>(p);
            const std::uint64_t last = std::min((part + 1) * paths_per_part, paths);
            RayTracer tracer(accelerator_);
            std::vector<SampleContext::Key> keys;
            // Spread over the film.
            for (std::uint64_t i = part * paths_per_part; i < last; ++i) {
                const std::uint64_t pixel = i * pixels_ / paths;
                const auto width = static_cast<std::uint64_t>(crop_.width());
                keys.push_back({crop_.x0 + static_cast<int>(pixel % width),
                                crop_.y0 + static_cast<int>(pixel / width), index});
            }
            LightPaths& to = parts[part];
            context_.trace_light(tracer, keys, to);
            to.vertices.shrink_to_fit();
            to.edges.shrink_to_fit();
            const std::lock_guard lock(mutex);
            report.rays.merge(tracer.statistics);
            report.cpu_seconds += thread_cpu_seconds() - begin;
        },
        cancel);
    return parts;
}

void MergingPasses::prepare(std::uint64_t index, RenderReport& report, std::mutex& mutex,
                            const CancelFlag* cancel) {
    if (prepared_ == index) return;
    context_.set_light_map(nullptr); // frees the last one
    prepared_ = ~std::uint64_t{0};
    std::vector<LightPaths> parts = trace(index, paths_, report, mutex, cancel);
    if (cancel != nullptr && cancel->requested()) return;
    const double begin = thread_cpu_seconds();
    auto map = std::make_shared<const LightMap>(std::move(parts), paths_, radius(index));
    const std::lock_guard lock(mutex);
    report.cpu_seconds += thread_cpu_seconds() - begin;
    MergingSummary& summary = report.merging;
    summary.first_radius = first_radius_;
    summary.last_radius = map->radius();
    summary.light_paths = paths_;
    summary.of_paths = pixels_;
    if (!map->empty()) summary.bytes = std::max<std::uint64_t>(summary.bytes, map->bytes());
    context_.set_light_map(std::move(map));
    prepared_ = index;
}

double merging_radius(const SampleContext& context, const Accelerator& accelerator,
                      std::span<const SampleContext::Key> keys) {
    RayTracer tracer(accelerator);
    std::vector<double> sizes;
    for (const SampleContext::Key& key : keys) // 0 of surfaces seen edge-on
        if (const auto size = context.visible_pixel(tracer, key); size && *size > 0) sizes.push_back(*size);
    if (sizes.empty())
        return 1e-3 * std::max(accelerator.bounds().radius(), 1e-30); // nothing merges that is seen
    const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
    std::nth_element(sizes.begin(), middle, sizes.end());
    return radius_in_pixels * *middle;
}

void close_bias(RenderState& state, std::uint64_t samples) {
    check_sums(state.bias->open());
    state.bias->close_pass(static_cast<double>(samples) / static_cast<double>(state.film.pixels().size()));
    const MergingBias::Estimate bias = state.bias->estimate();
    MergingSummary& merging = state.report.merging;
    merging.bias = bias.mean;
    merging.bias_error = bias.error;
    merging.bias_rms = bias.rms;
    merging.passes = state.bias->passes();
}

} // namespace montelux
