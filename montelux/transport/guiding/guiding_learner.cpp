#include "montelux/transport/guiding/guiding_learner.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "montelux/mc/parallel/parallel_for.h"

namespace montelux {
namespace {

// Regions with fewer directions that found light learn from those around them as well.
constexpr std::size_t least_directions = 200;
// One direction counts at most this many times as much as a region's mean: it may have been found by chance.
constexpr float most_of_mean = 50;
constexpr float first_share = 0.5f, least_share = 0.1f, most_share = 0.9f;

// Records stay where they are; pointers to them are sorted.
using Records = std::span<const GuidingRecord* const>;

// What a region learns from: records of its own, and of itself and its surroundings.
struct Part {
    Records own, around;
};

std::size_t directions_in(Records records) {
    return static_cast<std::size_t>(std::ranges::count_if(records, [](const GuidingRecord* r) {
        return r->pdf > 0 && (r->estimate > 0 || r->left_to_light_samples > 0);
    }));
}

// Halves space at the middle of its longest side, until no part has many records.
template <typename Node>
class RegionTree {
  public:
    RegionTree(std::span<const GuidingRecord*> records, std::size_t region_records)
        : region_records_(region_records) {
        if (records.empty()) return;
        Point3f low = records.front()->p, high = low;
        for (const GuidingRecord* r : records)
            for (int a = 0; a < 3; ++a) {
                low[a] = std::min(low[a], r->p[a]);
                high[a] = std::max(high[a], r->p[a]);
            }
        nodes.emplace_back();
        split(0, records, records, low, high, 0);
    }

    std::vector<Node> nodes; // those of axis 3 number `parts`
    std::vector<Part> parts;

  private:
    void split(std::size_t n, std::span<const GuidingRecord*> own, Records around, Point3f low, Point3f high,
               int depth) {
        const Vec3f size = high - low;
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        const float middle = low[axis] + 0.5f * size[axis];
        if (own.size() <= region_records_ || depth == max_depth ||
            !(middle > low[axis] && middle < high[axis])) {
            nodes[n] = {0, 3, static_cast<std::uint32_t>(parts.size()), 0};
            parts.push_back({own, around});
            return;
        }
        const auto second = std::stable_partition(
            own.begin(), own.end(), [&](const GuidingRecord* r) { return r->p[axis] < middle; });
        const std::array<std::span<const GuidingRecord*>, 2> halves{std::span(own.begin(), second),
                                                                    std::span(second, own.end())};
        for (std::size_t h = 0; h < 2; ++h) {
            const std::size_t child = nodes.size();
            nodes.emplace_back();
            if (h == 0)
                nodes[n] = {middle, static_cast<std::uint32_t>(axis), static_cast<std::uint32_t>(child), 0};
            else
                nodes[n].high = static_cast<std::uint32_t>(child);
            Point3f from = low, to = high;
            (h == 0 ? to : from)[axis] = middle;
            const bool alone = directions_in(halves[h]) >= least_directions;
            split(child, halves[h], alone ? Records(halves[h]) : around, from, to, depth + 1);
        }
    }

    static constexpr int max_depth = 48;
    std::size_t region_records_;
};

// A direction that has found light.
struct Found {
    Point3f p;
    Vec2f direction;
    float distance = 0;
    float estimate = 0, pdf = 0, bsdf_pdf = 0, guide_pdf = 0;
};

// The share of guided directions with the least second moment of the estimator. Its derivative by the share
// increases: the root is found by bisection.
float best_share(std::span<const Found> found) {
    const auto slope = [&](float share) {
        double sum = 0;
        for (const Found& f : found) {
            if (!(f.guide_pdf > 0)) continue;
            const double g = double(f.guide_pdf), b = double(f.bsdf_pdf), s = double(share);
            const double estimate = double(f.estimate) / (s * g + (1 - s) * b);
            sum += estimate * estimate * double(f.pdf) * (b - g);
        }
        return sum;
    };
    if (std::ranges::none_of(found, [](const Found& f) { return f.guide_pdf > 0; })) return first_share;
    float low = least_share, high = most_share;
    for (int i = 0; i < 8; ++i) {
        const float middle = 0.5f * (low + high);
        (slope(middle) < 0 ? low : high) = middle;
    }
    return 0.5f * (low + high);
}

// Of every `step`-th direction, from the centre of the sphere.
QuadtreeDensity density_of(std::span<const Found> found, const ParallaxSphere& sphere, std::size_t step,
                           const QuadtreeSettings& settings) {
    std::vector<SquareSample> samples;
    samples.reserve(found.size() / step + 1);
    for (std::size_t i = 0; i < found.size(); i += step) {
        const Found& f = found[i];
        const ParallaxSphere::Mapped m = sphere.from_centre(f.p, equal_area_square_to_sphere(f.direction));
        const float pdf = f.pdf / m.density;
        samples.push_back({equal_area_sphere_to_square(m.w), f.estimate * pdf, pdf});
    }
    return QuadtreeDensity(samples, settings);
}

Point3f centre_of(Records records) {
    Vec3d sum;
    for (const GuidingRecord* r : records) sum += Vec3d(r->p - Point3f{});
    return Point3f{} + Vec3f(sum / double(records.size()));
}

// The sphere from whose centre directions have the least noisy density, of those with the distances of the vertices
// from which the first fifth, half and four fifths of the light came, and of infinite ones.
ParallaxSphere best_sphere(std::span<const Found> found, Point3f centre, const QuadtreeSettings& settings) {
    constexpr std::size_t enough = 1000;
    constexpr double least_gain = 0.98;
    const std::size_t step = std::max<std::size_t>(1, found.size() / enough);
    std::vector<std::pair<float, double>> distances; // and light from there
    double all = 0;
    for (std::size_t i = 0; i < found.size(); i += step)
        if (found[i].distance > 0) {
            distances.emplace_back(found[i].distance, double(found[i].estimate));
            all += double(found[i].estimate);
        }
    std::ranges::sort(distances);
    ParallaxSphere best;
    double least = least_gain * density_of(found, best, step, settings).second_moment();
    double below = 0;
    std::array shares{0.2, 0.5, 0.8};
    std::size_t next = 0;
    for (const auto& [distance, light] : distances) {
        below += light;
        if (next == shares.size() || below < shares[next] * all) continue;
        while (next < shares.size() && below >= shares[next] * all) ++next;
        const ParallaxSphere sphere{centre, distance};
        const double moment = density_of(found, sphere, step, settings).second_moment();
        if (moment > 0 && moment < least) {
            least = moment;
            best = sphere;
        }
    }
    return best;
}

GuidingRegion learn_region(const Part& part, const QuadtreeSettings& settings) {
    GuidingRegion region;
    constexpr std::size_t least_vertices = 32;
    for (const Records records : {part.own, part.around}) {
        double radiance = 0;
        std::size_t counted = 0;
        for (const GuidingRecord* r : records)
            if (!r->glossy) {
                radiance += double(r->radiance);
                ++counted;
            }
        if (counted > 0) region.radiance = static_cast<float>(radiance / double(counted));
        if (counted >= least_vertices) break;
    }
    std::size_t aimed = 0, visible = 0;
    for (const GuidingRecord* r : part.around) {
        aimed += r->aimed ? 1 : 0;
        visible += r->aimed && r->visible ? 1 : 0;
    }
    // Light that can be seen is left to light samples; light that is mostly hidden from them is not.
    region.visible = (static_cast<float>(visible) + 1) / (static_cast<float>(aimed) + 1); // above 0
    const float hidden = aimed > 0 ? 1 - static_cast<float>(visible) / static_cast<float>(aimed) : 1.0f;
    std::vector<Found> found;
    double sum = 0;
    for (const GuidingRecord* at : part.around) {
        const GuidingRecord& r = *at;
        const float estimate = r.estimate + hidden * r.left_to_light_samples;
        if (!(r.pdf > 0 && estimate > 0)) continue;
        found.push_back({r.p, r.direction, r.distance, estimate, r.pdf, r.bsdf_pdf, r.guide_pdf});
        sum += double(estimate);
    }
    if (found.empty()) return region;
    const auto most = static_cast<float>(double(most_of_mean) * sum / double(found.size()));
    for (Found& f : found) f.estimate = std::min(f.estimate, most);
    region.sphere = best_sphere(found, centre_of(part.own.empty() ? part.around : part.own), settings);
    region.directions = density_of(found, region.sphere, 1, settings);
    region.share = best_share(found);
    return region;
}

} // namespace

GuidingField GuidingLearner::learn(std::span<const std::vector<GuidingRecord>> records,
                                   const GuidingLearnerSettings& settings, const PixelBounds& bounds,
                                   std::vector<float> expected) {
    GuidingField field;
    field.bounds_ = bounds;
    field.expected_ = std::move(expected);
    std::array<std::vector<const GuidingRecord*>, facings> sides;
    std::array<std::size_t, facings> counts{};
    std::size_t all = 0;
    for (const std::vector<GuidingRecord>& list : records) {
        for (const GuidingRecord& r : list) ++counts[static_cast<std::size_t>(r.facing)];
        all += list.size();
    }
    for (std::size_t f = 0; f < facings; ++f) sides[f].reserve(counts[f]);
    for (const std::vector<GuidingRecord>& list : records)
        for (const GuidingRecord& r : list) sides[static_cast<std::size_t>(r.facing)].push_back(&r);
    // A tree of directions has some hundred nodes.
    constexpr std::size_t bytes_of_region = 4096;
    const std::size_t region_records =
        std::max(settings.region_records, 2 * all * bytes_of_region / settings.most_bytes);
    std::array<std::optional<RegionTree<GuidingField::Node>>, facings> trees;
    parallel_for(static_cast<std::int64_t>(facings), [&](std::int64_t f) {
        const auto at = static_cast<std::size_t>(f);
        trees[at].emplace(sides[at], region_records);
    });
    std::vector<Part> parts;
    for (std::size_t f = 0; f < facings; ++f) {
        RegionTree<GuidingField::Node>& tree = *trees[f];
        for (GuidingField::Node& node : tree.nodes)
            if (node.axis == 3) node.low += static_cast<std::uint32_t>(parts.size());
        field.trees_[f] = std::move(tree.nodes);
        parts.insert(parts.end(), tree.parts.begin(), tree.parts.end());
    }
    field.regions_.resize(parts.size());
    parallel_for(static_cast<std::int64_t>(parts.size()), [&](std::int64_t i) {
        const auto at = static_cast<std::size_t>(i);
        field.regions_[at] = learn_region(parts[at], settings.directions);
    });
    return field;
}

} // namespace montelux
