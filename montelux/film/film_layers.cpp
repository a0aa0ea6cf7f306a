#include "montelux/film/film_layers.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

#include "montelux/film/film.h"
#include "montelux/image/cryptomatte.h"
#include "montelux/mc/math/error.h"
#include "montelux/scene/light/light_groups.h"

namespace montelux {
namespace {

// Ids that a pixel remembers: more than are written, so that the ones written are the largest.
constexpr std::size_t matte_slots = 2 * cryptomatte_ranks;

// What a sample knows of its first surface, in the order of a sample's numbers.
struct Feature {
    Layer layer;
    std::size_t count;
    std::array<const char*, 3> channels;
    enum class Mean { surfaces, samples, weights } mean; // over samples that see a surface, all, or weighted
};
constexpr std::array<Feature, 6> features{
    {{Layer::geometric_normal, 3, {"Ng.X", "Ng.Y", "Ng.Z"}, Feature::Mean::samples},
     {Layer::position, 3, {"P.X", "P.Y", "P.Z"}, Feature::Mean::surfaces},
     {Layer::uv, 2, {"uv.U", "uv.V"}, Feature::Mean::surfaces},
     {Layer::depth_slopes, 2, {"dzdx", "dzdy"}, Feature::Mean::surfaces},
     {Layer::motion, 2, {"motion.X", "motion.Y"}, Feature::Mean::surfaces},
     {Layer::alpha, 1, {"A"}, Feature::Mean::weights}}};
// Places of the first sums of a pixel.
constexpr std::size_t seen_sum = 0, weight_sum = 1, first_feature_sum = 2;
constexpr std::array<const char*, 3> color_letters{"R", "G", "B"};

} // namespace

FilmLayers::FilmLayers(LayerSet set, std::vector<std::string> light_groups)
    : set_(set), light_groups_(std::move(light_groups)) {
    for (const Feature& f : features)
        if (set.has(f.layer)) features_ += f.count;
    const bool shapes = set.has(Layer::shape), materials = set.has(Layer::material);
    parts_ = (set.has(Layer::direct) ? 1u : 0u) + (set.has(Layer::indirect) ? 1u : 0u) + light_groups_.size();
    if (features_ == 0 && parts_ == 0 && !shapes && !materials) return;
    constexpr std::size_t before_features = 4;
    first_part_value_ = before_features + features_;
    values_ = first_part_value_ + 3 * parts_;
    first_part_sum_ = first_feature_sum + features_;
    sums_ = first_part_sum_ + 6 * parts_;
    const auto add_matte = [&](std::size_t id) {
        mattes_.push_back({id, sums_});
        sums_ += 2 * matte_slots;
    };
    if (shapes) add_matte(shape_id);
    if (materials) add_matte(material_id);
}

std::size_t FilmLayers::feature(Layer layer) const {
    std::size_t place = 4;
    for (const Feature& f : features) {
        if (f.layer == layer) break;
        if (set_.has(f.layer)) place += f.count;
    }
    return place;
}

void FilmLayers::add(double* sums, const float* values) const {
    sums[seen_sum] += static_cast<double>(values[seen]);
    sums[weight_sum] += static_cast<double>(values[weight]);
    for (std::size_t i = 0; i < features_; ++i)
        sums[first_feature_sum + i] += static_cast<double>(values[4 + i]);
    for (std::size_t p = 0; p < parts_; ++p)
        for (std::size_t c = 0; c < 3; ++c)
            sums[first_part_sum_ + 6 * p + c] += static_cast<double>(values[first_part_value_ + 3 * p + c]);
    for (const Matte& matte : mattes_) {
        const auto id = static_cast<double>(std::bit_cast<std::uint32_t>(values[matte.id]));
        if (id == 0) continue;
        double *slot = sums + matte.first_sum, *least = slot;
        std::size_t k = 0;
        // A slot is empty, with id 0, only if those behind it are.
        for (; k < matte_slots && slot[0] != 0 && slot[0] != id; ++k, slot += 2)
            if (slot[1] < least[1]) least = slot;
        if (k == matte_slots) {
            slot = least;
            slot[1] = 0;
        }
        slot[0] = id;
        slot[1] += static_cast<double>(values[weight]);
    }
}

void FilmLayers::end_replicate(double* sums, std::uint32_t samples) const {
    if (samples == 0) return;
    for (std::size_t p = 0; p < parts_; ++p) {
        double* const part = sums + first_part_sum_ + 6 * p;
        for (std::size_t c = 0; c < 3; ++c) {
            part[3 + c] += part[c] / static_cast<double>(samples);
            part[c] = 0;
        }
    }
}

void FilmLayers::drop_replicate(double* sums) const {
    for (std::size_t p = 0; p < parts_; ++p) std::fill_n(sums + first_part_sum_ + 6 * p, 3, 0.0);
}

std::vector<std::string> FilmLayers::channels() const {
    std::vector<std::string> names;
    const auto triple = [&](Layer layer, const std::string& name, const char* letters = "RGB") {
        if (!set_.has(layer)) return;
        for (int c = 0; c < 3; ++c) names.push_back(name + letters[c]);
    };
    const auto single = [&](Layer layer, const char* name) {
        if (set_.has(layer)) names.emplace_back(name);
    };
    triple(Layer::mean, "");
    triple(Layer::error, "stderr.");
    triple(Layer::skewness, "skewness.");
    single(Layer::samples, "samples");
    single(Layer::replicates, "replicates");
    single(Layer::outlier, "outlier");
    single(Layer::warning, "warning");
    triple(Layer::albedo, "albedo.");
    triple(Layer::normal, "N.", "XYZ");
    single(Layer::depth, "depth.Z");
    triple(Layer::variance, "variance.");
    triple(Layer::relative_variance, "relativeVariance.");
    for (const Feature& f : features)
        if (set_.has(f.layer)) names.insert(names.end(), f.channels.begin(), f.channels.begin() + f.count);
    triple(Layer::direct, "direct.");
    triple(Layer::indirect, "indirect.");
    for (const std::string& group : light_groups_)
        for (const char* c : color_letters) names.push_back("light." + group + "." + c);
    const auto matte = [&](Layer layer, const char* name) {
        if (!set_.has(layer)) return;
        const std::vector<std::string> of_matte = cryptomatte_channels(name);
        names.insert(names.end(), of_matte.begin(), of_matte.end());
    };
    matte(Layer::shape, shape_matte);
    matte(Layer::material, material_matte);
    return names;
}

void FilmLayers::develop(const Pixel& pixel, const double* sums, std::vector<float>& out) const {
    out.clear();
    if (sums_ == 0) return;
    const auto mean = [&](double sum, double count) {
        out.push_back(count > 0 ? static_cast<float>(sum / count) : 0.0f);
    };
    const auto count_of = [&](Feature::Mean m) {
        if (m == Feature::Mean::samples) return static_cast<double>(pixel.samples());
        return sums[m == Feature::Mean::surfaces ? seen_sum : weight_sum];
    };
    std::size_t i = first_feature_sum;
    for (const Feature& f : features)
        if (set_.has(f.layer))
            for (std::size_t c = 0; c < f.count; ++c) mean(sums[i++], count_of(f.mean));
    for (std::size_t p = 0; p < parts_; ++p)
        for (std::size_t c = 0; c < 3; ++c)
            mean(sums[first_part_sum_ + 6 * p + 3 + c], static_cast<double>(pixel.replicates().count()));
    for (const Matte& matte : mattes_) {
        std::array<std::pair<double, double>, matte_slots> ranks; // negative weight, id
        for (std::size_t k = 0; k < matte_slots; ++k)
            ranks[k] = {-sums[matte.first_sum + 2 * k + 1], sums[matte.first_sum + 2 * k]};
        std::ranges::sort(ranks);
        for (std::size_t k = 0; k < cryptomatte_ranks; ++k) {
            const auto [weight_of_id, id] = ranks[k];
            const bool counts = weight_of_id < 0;
            out.push_back(counts ? std::bit_cast<float>(static_cast<std::uint32_t>(id)) : 0.0f);
            mean(counts ? -weight_of_id : 0, sums[weight_sum]);
        }
    }
}

FilmLayers film_layers_of(const SceneDescription& description) {
    const LayerSettings& layers = description.film.layers;
    if (!layers.set.has(Layer::light_groups)) return FilmLayers(layers.set);
    return FilmLayers(layers.set, light_groups(description.scene, layers.light_grouping).names);
}

std::vector<std::string> half_channels_of(const std::vector<std::string>& channels) {
    std::vector<std::string> names;
    constexpr std::array<std::string_view, 9> exact{"Crypto", "samples", "replicates", "warning", "P.",
                                                    "uv.",    "depth.",  "dzd",        "motion."};
    for (const std::string& name : channels)
        if (std::ranges::none_of(exact, [&](std::string_view begin) { return name.starts_with(begin); }))
            names.push_back(name);
    return names;
}

} // namespace montelux
