// Layers of a film beyond its pixels: means, parts by replicates, mattes of the largest coverages.
#include <bit>
#include <gtest/gtest.h>
#include <map>

#include "montelux/film/film.h"
#include "montelux/film/film_layers.h"
#include "montelux/image/cryptomatte.h"

namespace montelux {
namespace {

LayerSet all_layers() {
    LayerSet set;
    for (std::size_t i = 0; i < layer_names().size(); ++i) set.add(static_cast<Layer>(i));
    return set;
}

Film film_of(const LayerSet& set, std::vector<std::string> groups = {}) {
    const FilmSettings settings{.width = 1, .height = 1, .crop = {0, 0, 1, 1}};
    return Film(settings, FilmLayers(set, std::move(groups)));
}

TEST(FilmLayers, TheStandardSetCostsNothing) {
    const FilmLayers standard;
    EXPECT_EQ(standard.values(), 0u);
    EXPECT_EQ(standard.sums(), 0u);
    EXPECT_EQ(standard.channels().size(), 20u);
    EXPECT_EQ(FilmLayers(LayerSet()).channels(), (std::vector<std::string>{"R", "G", "B"}));
    EXPECT_EQ(FilmLayers(LayerSet{Layer::variance, Layer::relative_variance}).sums(), 0u);
}

TEST(FilmLayers, ChannelsAndValuesAgree) {
    for (const LayerSet set : {all_layers(), LayerSet{Layer::uv}, LayerSet{Layer::error, Layer::material},
                               LayerSet{Layer::light_groups}, LayerSet::gbuffer()}) {
        const std::vector<std::string> groups = set.has(Layer::light_groups)
                                                    ? std::vector<std::string>{"key", "fill"}
                                                    : std::vector<std::string>();
        const Image image = film_of(set, groups).develop();
        EXPECT_EQ(image.channel_names(), FilmLayers(set, groups).channels());
    }
}

// Means over the samples that see a surface, or over all; parts as the mean of the pixel is formed.
TEST(FilmLayers, AveragesFeaturesAndParts) {
    Film film = film_of({Layer::position, Layer::alpha, Layer::direct});
    const FilmLayers& layers = film.layers();
    double* const sums = film.layer_sums().data();
    Pixel& pixel = film.pixel(0, 0);
    const auto sample = [&](float seen, float x, float alpha, float direct) {
        std::vector<float> values(layers.values());
        values[FilmLayers::seen] = seen;
        values[FilmLayers::weight] = 1;
        values[layers.feature(Layer::position)] = x;
        values[layers.feature(Layer::alpha)] = alpha;
        values[layers.first_part() + 1] = direct;
        layers.add(sums, values.data());
        FilmSample s;
        s.radiance = {0, direct, 0};
        pixel.add_sample(s);
    };
    const auto close = [&] {
        layers.end_replicate(sums, pixel.open_samples());
        pixel.end_replicate();
    };
    for (int i = 0; i < 4; ++i) sample(1, 5, 1, 8);
    close();
    for (int i = 0; i < 2; ++i) sample(0, 0, 0, 2);
    sample(1, 8, 1, 2);
    close();
    sample(0, 0, 0, 100); // dropped: fewer than half of 4 points
    Film dropped = film, kept = film;
    dropped.end_replicates(4);
    kept.end_replicates(2);
    const auto value = [](const Film& f, const char* channel) {
        const Image image = f.develop();
        return image.value(0, 0, *image.find_channel(channel));
    };
    EXPECT_FLOAT_EQ(value(dropped, "P.X"), (4 * 5 + 8) / 5.0f);
    EXPECT_FLOAT_EQ(value(dropped, "A"), 5 / 8.0f);
    EXPECT_FLOAT_EQ(value(dropped, "direct.G"), 5);
    EXPECT_FLOAT_EQ(value(dropped, "G"), 5);
    EXPECT_FLOAT_EQ(value(kept, "direct.G"), 110 / 3.0f);
    EXPECT_FLOAT_EQ(value(kept, "G"), 110 / 3.0f);
}

// That of single samples, also where replicates are means of several; and over the mean, as in pbrt.
TEST(FilmLayers, VarianceIsThatOfSamples) {
    Film film = film_of({Layer::variance, Layer::relative_variance});
    Pixel& pixel = film.pixel(0, 0);
    for (const float value : {1.0f, 3.0f, 8.0f, 4.0f, 2.0f, 6.0f}) { // replicates 2, 6, 4
        FilmSample s;
        s.radiance = {value, 0, 2 * value};
        pixel.add_sample(s);
        if (pixel.open_samples() == 2) pixel.end_replicate();
    }
    const Image image = film.develop();
    const auto value = [&](const char* channel) { return image.value(0, 0, *image.find_channel(channel)); };
    EXPECT_FLOAT_EQ(value("variance.R"), 8); // 4 of a replicate of two samples
    EXPECT_FLOAT_EQ(value("relativeVariance.R"), 2);
    EXPECT_FLOAT_EQ(value("variance.B"), 32);
    EXPECT_FLOAT_EQ(value("relativeVariance.B"), 4);
    EXPECT_EQ(value("relativeVariance.G"), 0);
}

// Coverage by id, the largest first; more ids than a pixel remembers lose the smallest coverages only.
TEST(FilmLayers, MattesHoldTheLargestCoverages) {
    Film film = film_of({Layer::shape});
    const FilmLayers& layers = film.layers();
    Pixel& pixel = film.pixel(0, 0);
    std::map<std::uint32_t, int> counts;
    // Ten ids of 10, 20, ... samples, in turns, and twenty of one sample at the end.
    for (int round = 0; round < 100; ++round)
        for (std::uint32_t id = 1; id <= 10; ++id)
            if (round < static_cast<int>(10 * id)) ++counts[0x3f800000 + id];
    const auto add = [&](std::uint32_t id, float weight) {
        std::vector<float> values(layers.values());
        values[FilmLayers::weight] = weight;
        values[FilmLayers::shape_id] = std::bit_cast<float>(id);
        layers.add(film.layer_sums().data(), values.data());
        pixel.add_sample({});
    };
    for (const auto& [id, count] : counts)
        for (int i = 0; i < count; ++i) add(id, 2);
    for (std::uint32_t i = 0; i < 20; ++i) add(0x40000000 + i, 2);
    for (int i = 0; i < 30; ++i) add(0, 2); // no surface
    film.end_replicates();
    const Image image = film.develop();
    const std::vector<std::string> channels = cryptomatte_channels(shape_matte);
    for (std::size_t rank = 0; rank < cryptomatte_ranks; ++rank) {
        const float id = image.value(0, 0, *image.find_channel(channels[2 * rank]));
        EXPECT_EQ(std::bit_cast<std::uint32_t>(id), 0x3f800000u + 10 - rank);
        EXPECT_FLOAT_EQ(image.value(0, 0, *image.find_channel(channels[2 * rank + 1])),
                        static_cast<float>(10 * (10 - rank)) / 600);
    }
}

TEST(FilmLayers, HalfChannelsAreThoseWithoutCountsAndPlaces) {
    const std::vector<std::string> halves =
        half_channels_of({"R", "stderr.G", "samples", "replicates", "warning", "N.X", "P.X", "depth.Z",
                          "uv.U", "A", "motion.X", "dzdx", "CryptoShape00.R", "light.key.B", "direct.R"});
    EXPECT_EQ(halves, (std::vector<std::string>{"R", "stderr.G", "N.X", "A", "light.key.B", "direct.R"}));
}

} // namespace
} // namespace montelux
