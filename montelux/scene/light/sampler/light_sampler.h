// LightSampler: chooses one light among many: the concept, its models, and the variant.
#pragma once

#include <concepts>
#include <variant>

#include "montelux/scene/light/sampler/power_light_sampler.h"
#include "montelux/scene/light/sampler/tree_light_sampler.h"
#include "montelux/scene/light/sampler/uniform_light_sampler.h"

namespace montelux {

// Chooses a part of a light for a reference point. `probability` is that of `sample` for the same point; the
// probabilities of all parts sum to 1. `sample` must not be called without parts. It takes a number in [0,
// 1), as finely resolved as SampleStream::refined if there are many parts.
template <typename S>
concept LightSamplerModel = requires(const S& sampler, const ReferencePoint& from, double u, Index light,
                                     Index part) {
    { sampler.size() } -> std::same_as<Index>;        // parts of all lights
    { sampler.bytes() } -> std::same_as<std::size_t>; // memory
    { sampler.sample(from, u) } -> std::same_as<LightChoice>;
    { sampler.probability(from, light, part) } -> std::same_as<float>;
};
static_assert(LightSamplerModel<PowerLightSampler>);
static_assert(LightSamplerModel<TreeLightSampler>);
static_assert(LightSamplerModel<UniformLightSampler>);

class LightSampler {
  public:
    using Model = std::variant<UniformLightSampler, PowerLightSampler, TreeLightSampler>;

    LightSampler() = default;
    explicit LightSampler(Model model) : model_(std::move(model)) {}

    Index size() const {
        return std::visit([](const auto& m) { return m.size(); }, model_);
    }
    bool empty() const { return size() == 0; }
    std::size_t bytes() const {
        return std::visit([](const auto& m) { return m.bytes(); }, model_);
    }
    LightChoice sample(const ReferencePoint& from, double u) const {
        // Of a light or two; a comparison is cheaper than the jump of a visit.
        if (const auto* power = std::get_if<PowerLightSampler>(&model_)) return power->sample(from, u);
        return std::visit([&](const auto& m) { return m.sample(from, u); }, model_);
    }
    float probability(const ReferencePoint& from, Index light, Index part) const {
        return std::visit([&](const auto& m) { return m.probability(from, light, part); }, model_);
    }

  private:
    Model model_;
};
static_assert(LightSamplerModel<LightSampler>);

} // namespace montelux
