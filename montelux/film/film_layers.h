// FilmLayers: the layers of a film: their channels, and sums beyond the moments of its pixels.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "montelux/scene/film/layer_set.h"
#include "montelux/scene/render_settings.h"

namespace montelux {

class Pixel;

// The names of the layers of ids.
inline constexpr const char *shape_matte = "CryptoShape", *material_matte = "CryptoMaterial";

// The layers of Pixel (mean, error, albedo ...) cost nothing more. All others are made of numbers that each sample
// gives (`values`) and sums that each pixel keeps:
//   a sample: 1 if it sees a surface, weight of the pixel filter, ids of shape and material (their bits as floats,
//     0 for none), features, parts of the radiance in RGB;
//   a pixel: number of samples that see a surface, sum of the filter's weights, sums of features, for each part the
//     sum of the open replicate and that of the means of closed ones, and ids with their weights.
// Parts are split and averaged as the mean is, so that they sum to it. Coverages are weighted means: 1 inside of a
// shape, whatever the weights of the pixel's samples.
class FilmLayers {
  public:
    FilmLayers() : FilmLayers(LayerSet::standard()) {}
    // `light_groups`: names of the layers of Layer::light_groups.
    explicit FilmLayers(LayerSet set, std::vector<std::string> light_groups = {});

    LayerSet set() const { return set_; }
    const std::vector<std::string>& light_groups() const { return light_groups_; }
    // Numbers of a sample and of a pixel; 0 if Pixel has all layers.
    std::size_t values() const { return values_; }
    std::size_t sums() const { return sums_; }

    // Places in the numbers of a sample.
    static constexpr std::size_t seen = 0, weight = 1, shape_id = 2, material_id = 3;
    // Of a layer's first number; only for layers of features in the set.
    std::size_t feature(Layer layer) const;
    // Parts of the radiance: direct, indirect (where they are in the set), and the light groups.
    std::size_t parts() const { return parts_; }
    std::size_t first_part() const { return first_part_value_; } // three numbers each

    // Adds a sample.
    void add(double* sums, const float* values) const;
    // Closes the replicate of so many samples; as Pixel::end_replicate.
    void end_replicate(double* sums, std::uint32_t samples) const;
    // Forgets the open replicate.
    void drop_replicate(double* sums) const;

    // Of Film::develop, in order.
    std::vector<std::string> channels() const;
    // The values of the channels after those of Pixel, one after the other. All replicates must be closed.
    void develop(const Pixel& pixel, const double* sums, std::vector<float>& out) const;

  private:
    struct Matte {
        std::size_t id; // place in a sample's numbers
        std::size_t first_sum;
    };

    LayerSet set_;
    std::vector<std::string> light_groups_;
    std::size_t values_ = 0, sums_ = 0;
    std::size_t parts_ = 0, first_part_value_ = 0, first_part_sum_ = 0;
    std::size_t features_ = 0; // numbers of all features
    std::vector<Matte> mattes_;
};

// As the description's film asks.
FilmLayers film_layers_of(const SceneDescription& description);

// The channels that 16-bit floats suffice for: colours, errors, normals, alpha. Counts, ids, positions, texture
// coordinates, depths and motions keep 32 bits.
std::vector<std::string> half_channels_of(const std::vector<std::string>& channels);

} // namespace montelux
