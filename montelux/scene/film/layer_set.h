// LayerSet: the layers of a picture, chosen by name.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>

namespace montelux {

enum class Layer : std::uint8_t {
    mean, // in every set
    error,
    skewness,
    samples,
    replicates,
    outlier,
    warning,
    albedo,
    normal, // shading normal
    depth,  // distance
    variance,
    relative_variance,
    geometric_normal,
    position,
    uv,
    depth_slopes, // of camera-space z, per pixel
    motion,
    alpha,
    direct,
    indirect,
    light_groups,
    shape,    // ids, as Cryptomatte
    material, // the same
};

class LayerSet {
  public:
    // The mean alone.
    constexpr LayerSet() = default;
    constexpr LayerSet(std::initializer_list<Layer> layers) {
        for (const Layer layer : layers) add(layer);
    }
    // What every render has unless layers are chosen.
    static constexpr LayerSet standard() {
        return {Layer::error,   Layer::skewness, Layer::samples, Layer::replicates, Layer::outlier,
                Layer::warning, Layer::albedo,   Layer::normal,  Layer::depth};
    }
    // The standard layers and those of pbrt's film "gbuffer".
    static constexpr LayerSet gbuffer() {
        LayerSet set = standard();
        for (const Layer layer : {Layer::position, Layer::depth_slopes, Layer::geometric_normal, Layer::uv,
                                  Layer::variance, Layer::relative_variance})
            set.add(layer);
        return set;
    }

    constexpr void add(Layer layer) { bits_ |= bit(layer); }
    constexpr void add(LayerSet other) { bits_ |= other.bits_; }
    constexpr bool has(Layer layer) const { return (bits_ & bit(layer)) != 0; }
    constexpr bool operator==(const LayerSet&) const = default;

  private:
    static constexpr std::uint32_t bit(Layer layer) { return 1u << static_cast<unsigned>(layer); }

    std::uint32_t bits_ = bit(Layer::mean);
};

// Of single layers, in the order of the enumeration.
std::span<const std::string_view> layer_names();
// A list with commas of names of layers, and of `default` and `gbuffer` for several. Throws Error with the name
// that is not known and the nearest one.
LayerSet parse_layers(std::string_view list);
// A list that parse_layers reads.
std::string text_of(LayerSet layers);

// How lights without a group of their own form the layers of Layer::light_groups.
enum class LightGrouping : std::uint8_t {
    light, // each alone
    kind,  // by kind: all area lights, all infinite ones ...
};

// What a film keeps, and the space of its layers.
struct LayerSettings {
    LayerSet set = LayerSet::standard();
    LightGrouping light_grouping = LightGrouping::light;
    bool in_camera_space = false; // positions and normals; else world space
    bool half = false;            // EXR files hold 16-bit floats where those suffice

    bool operator==(const LayerSettings&) const = default;
};

} // namespace montelux
