#include "montelux/render/missing_light.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "montelux/film/film_error.h"
#include "montelux/mc/math/overloaded.h"
#include "montelux/mc/parallel/parallel_for.h"
#include "montelux/mc/random/hash.h"
#include "montelux/mc/stats/moments.h"
#include "montelux/render/merging_passes.h"
#include "montelux/render/sample_context.h"
#include "montelux/scene/light_tracing_support.h"
#include "montelux/scene/material/material.h"
#include "montelux/transport/bidirectional_integrator.h"
#include "montelux/transport/ray_tracer.h"

namespace montelux {
namespace {

constexpr std::uint64_t samples_of_pass = 2048, samples_of_part = 64;
// Numbers of bidirectional paths, of which one takes as long as some eight of path tracing.
constexpr double fewest_looks = 8192, most_looks = 65536, render_samples_per_look = 400;
constexpr std::uint32_t most_passes = 1 << 16; // of a film of one pixel
constexpr double rare = 8; // times the mean light of a sample: what a path must bring to be looked at

// A path that path tracing finds rarely or never.
struct Find {
    double in_a_sample; // luminance of a sample of path tracing that finds it; infinite if none does
    double light;       // luminance that it adds to the mean of its pass
    Index from;         // its light; no_index where that is not known
    int pass;
};

class MissingLightEstimate {
  public:
    MissingLightEstimate(const SceneDescription& description, const PreparedScene& prepared,
                         const IntegratorSettings& integrator)
        : crop_(description.film.crop),
          accelerator_(prepared.accelerator()), sampler_{.kind = SamplerKind::independent,
                                                         .seed = hash_key(description.sampler.seed,
                                                                          0x6d697373696e67), // "missing"
                                                         .spp = most_passes},
          camera_(description.scene.camera, description.film.width, description.film.height),
          context_(description, sampler_, prepared.view(), camera_, integrator),
          pixels_(static_cast<std::uint64_t>(crop_.width()) * static_cast<std::uint64_t>(crop_.height())),
          count_(std::min(pixels_, samples_of_pass)) {}

    void take_pass() {
        const int pass = static_cast<int>(means_.size());
        // Discs as wide as for a film of as many pixels as a pass has samples: blurred light is still there.
        if (pass == 0)
            radius_ = merging_radius(context_, accelerator_, keys_of(most_passes)) *
                      std::sqrt(static_cast<double>(pixels_) / static_cast<double>(count_));
        const std::vector<SampleContext::Key> keys = keys_of(static_cast<std::uint64_t>(pass));
        const std::size_t parts = (keys.size() + samples_of_part - 1) / samples_of_part;
        const auto part_of = [&](std::size_t i) {
            return std::span(keys).subspan(i * samples_of_part,
                                           std::min(samples_of_part, keys.size() - i * samples_of_part));
        };
        std::vector<LightPaths> light(parts);
        parallel_for(static_cast<std::int64_t>(parts), [&](std::int64_t i) {
            RayTracer tracer(accelerator_);
            context_.trace_light(tracer, part_of(static_cast<std::size_t>(i)),
                                 light[static_cast<std::size_t>(i)]);
        });
        context_.set_light_map(std::make_shared<const LightMap>(std::move(light), count_, radius_));

        std::vector<double> sums(parts, 0.0);
        std::vector<std::vector<Find>> found(parts);
        parallel_for(static_cast<std::int64_t>(parts), [&](std::int64_t p) {
            const auto part = static_cast<std::size_t>(p);
            RayTracer tracer(accelerator_);
            BidirectionalMemory memory;
            for (const SampleContext::Key& key : part_of(part))
                context_.find_paths(tracer, key, memory, [&](const SampleContext::FilmPath& path) {
                    // A light path brings its splats to the whole film.
                    const double value = dot(Vec3d(path.rgb), luminance_weight) /
                                         (path.film != nullptr ? static_cast<double>(pixels_) : 1),
                                 weighted = path.weight * value;
                    if (!(weighted > 0) || !std::isfinite(weighted)) return;
                    sums[part] += weighted;
                    const double of_sample = path.by_path_tracing > 0
                                                 ? value / path.by_path_tracing
                                                 : std::numeric_limits<double>::infinity();
                    if (of_sample > rare * mean_)
                        found[part].push_back(
                            {of_sample, weighted / static_cast<double>(count_), path.light, pass});
                });
        });
        double sum = 0;
        for (const double s : sums) sum += s;
        for (const std::vector<Find>& f : found) finds_.insert(finds_.end(), f.begin(), f.end());
        means_.push_back(sum / static_cast<double>(count_));
        mean_ += (means_.back() - mean_) / static_cast<double>(means_.size());
    }

    // With at least two passes.
    MissingLight missing(double samples) {
        MissingLight result;
        const auto passes = static_cast<double>(means_.size());
        if (!(mean_ > 0)) return result;
        std::ranges::sort(finds_, std::greater{}, &Find::in_a_sample);
        std::size_t end = 0;
        double light = 0; // of the paths so far that can be found, per sample
        for (std::size_t i = 0; i < finds_.size(); ++i) {
            if (std::isfinite(finds_[i].in_a_sample)) light += finds_[i].light / passes;
            // A sample that finds one of them brings at least as much as the last one: fewer than one is expected.
            if (samples * light < finds_[i].in_a_sample) end = i + 1;
        }
        std::vector<double> of_pass(means_.size(), 0.0);
        std::map<Index, double> of_light;
        for (std::size_t i = 0; i < end; ++i) {
            of_pass[static_cast<std::size_t>(finds_[i].pass)] += finds_[i].light;
            if (finds_[i].from != no_index) of_light[finds_[i].from] += finds_[i].light;
            if (std::isinf(finds_[i].in_a_sample)) result.never += finds_[i].light / passes / mean_;
        }
        RunningMoments missing, residuals; // of the ratio of two means (Cochran 1977, section 2.11)
        for (const double m : of_pass) missing.add(m);
        result.share = missing.mean() / mean_;
        for (std::size_t i = 0; i < of_pass.size(); ++i) residuals.add(of_pass[i] - result.share * means_[i]);
        result.error = residuals.standard_error() / mean_;
        if (!of_light.empty())
            result.light =
                std::ranges::max_element(of_light, {}, [](const auto& l) { return l.second; })->first;
        return result;
    }

    std::uint64_t samples() const { return means_.size() * count_; }

  private:
    // Pixels spread over the film, others in each pass.
    std::vector<SampleContext::Key> keys_of(std::uint64_t pass) const {
        std::vector<SampleContext::Key> keys;
        const std::uint64_t shift = hash_key(sampler_.seed, pass) % pixels_;
        for (std::uint64_t i = 0; i < count_; ++i) {
            const std::uint64_t pixel = (i * pixels_ / count_ + shift) % pixels_;
            const auto width = static_cast<std::uint64_t>(crop_.width());
            keys.push_back({crop_.x0 + static_cast<int>(pixel % width),
                            crop_.y0 + static_cast<int>(pixel / width), pass});
        }
        return keys;
    }

    PixelBounds crop_;
    const Accelerator& accelerator_;
    SamplerSettings sampler_;
    Camera camera_;
    SampleContext context_;
    std::uint64_t pixels_, count_;
    double radius_ = 0;
    std::vector<double> means_; // of the picture's luminance, one of each pass
    double mean_ = 0;           // of these
    std::vector<Find> finds_;
};

// Whether light may pass a surface of the material along one direction, or nearly so.
bool may_focus(const Material& material) {
    return std::visit(Overloaded{[](const DiffuseMaterial&) { return false; },
                                 [](const DiffuseTransmissionMaterial&) { return false; },
                                 [](const MeasuredMaterial&) { return false; },
                                 [](const InterfaceMaterial&) { return false; },
                                 [](const MixMaterial&) { return false; }, // its parts are materials, too
                                 [](const SidedMaterial&) { return false; },
                                 [](const auto&) { return true; }},
                      material);
}

} // namespace

std::optional<MissingLight> missing_light(const SceneDescription& description, const PreparedScene& prepared,
                                          double samples, bool guided) {
    IntegratorSettings integrator = description.integrator;
    if (integrator.method != IntegratorKind::path || integrator.strategy != Strategy::mis ||
        integrator.manifold_sampling || integrator.regularize ||
        std::ranges::none_of(description.scene.materials, may_focus))
        return std::nullopt;
    integrator.method = IntegratorKind::bidirectional;
    integrator.guiding = Guiding::off;
    integrator.shading_terminator = ShadingTerminator::hard;
    integrator.merging.emplace();
    if (description.scene.lights.empty() || light_tracing_obstacle(description.scene, integrator))
        return std::nullopt;
    MissingLightEstimate estimate(description, prepared, integrator);
    const double wanted = std::clamp(samples / render_samples_per_look, fewest_looks, most_looks);
    while (!(static_cast<double>(estimate.samples()) >= wanted)) estimate.take_pass();
    const bool looks_for_rare = !guided && !prepared.view().has_media();
    return estimate.missing(looks_for_rare ? samples : std::numeric_limits<double>::max());
}

} // namespace montelux
