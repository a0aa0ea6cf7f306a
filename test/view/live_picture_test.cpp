// LivePicture: tiles as they are rendered, layers, changes; statistics of the picture; messages of tiles.
#include "test/view/view_testing.h"
#include <cmath>
#include <cstring>
#include <gtest/gtest.h>
#include <limits>
#include <map>
#include <mutex>

#include "montelux/image/half.h"
#include "montelux/image/visible_error.h"
#include "montelux/render/render_session.h"
#include "montelux/view/picture_statistics.h"
#include "montelux/view/tile_message.h"

namespace montelux::testing {
namespace {

constexpr int width = 40, height = 24; // no multiple of a tile's size

// A part of the film, with a layer for each light.
std::shared_ptr<SceneDescription> described(std::uint32_t spp = 32) {
    const std::shared_ptr<SceneDescription> d = viewed_scene(spp);
    d->film.crop = {3, 2, width, height};
    d->film.layers.set.add(Layer::light_groups);
    return d;
}

std::size_t number(std::string_view layer, const LivePicture& picture) {
    const std::optional<std::size_t> found = picture.find_layer(layer);
    EXPECT_TRUE(found) << layer;
    return found.value_or(0);
}

// A render whose tiles went into `picture`, finished.
RenderSnapshot rendered(RenderSession& session, std::unique_ptr<LivePicture>& picture) {
    session.prepare();
    picture = std::make_unique<LivePicture>(session.description().film.crop, session.replicate_size(),
                                            film_layers_of(session.description()).channels());
    session.render({.tile = [&](const FinishedTile& tile) { picture->update(tile); }});
    return session.finish();
}

TEST(LivePicture, TilesGiveThePixelsOfThePicture) {
    RenderSession session(described(), {});
    std::unique_ptr<LivePicture> picture;
    const RenderSnapshot finished = rendered(session, picture);
    const std::vector<int> mean = finished.image->color_channels(),
                           error = finished.image->color_channels("stderr.");
    for (int y = 0; y < height - 2; ++y)
        for (int x = 0; x < width - 3; ++x) {
            const LivePixel p = picture->pixel(x, y);
            for (std::size_t c = 0; c < 3; ++c) {
                EXPECT_EQ(p.mean[c], finished.image->value(x, y, mean[c]));
                EXPECT_EQ(p.error[c], finished.image->value(x, y, error[c]));
            }
            EXPECT_EQ(p.samples, 32);
        }
}

// The last replicate of a pixel is closed in a copy, by the rule of the finished picture.
TEST(LivePicture, OpenReplicatesCountAndStayOpen) {
    const auto d = described(12); // in eight replicates of two points, the last ones are never taken
    RenderSession plain(d, {}), watched(d, {});
    plain.render();
    const RenderSnapshot expected = plain.finish();
    std::unique_ptr<LivePicture> picture;
    const RenderSnapshot finished = rendered(watched, picture);
    EXPECT_TRUE(same_bits(*expected.image, *finished.image));
    EXPECT_GT(picture->pixel(20, 10).mean[1], 0);
}

TEST(LivePicture, OtherLayersComeWithWholePictures) {
    RenderSession session(described(), {});
    std::unique_ptr<LivePicture> picture;
    const RenderSnapshot finished = rendered(session, picture);
    const std::size_t depth = number("depth", *picture), albedo = number("albedo", *picture);
    EXPECT_TRUE(picture->values(depth, 1, 1).empty());
    std::uint64_t version = 0;
    EXPECT_TRUE(picture->changes_since(depth, version, 1000).empty());
    picture->update(finished.image);
    EXPECT_EQ(picture->values(depth, 5, 6),
              (std::vector<float>{finished.image->value(5, 6, *finished.image->find_channel("depth.Z"))}));
    EXPECT_EQ(picture->values(albedo, 5, 6).size(), 3u);
    // Whole, whatever the limit.
    EXPECT_EQ(picture->changes_since(depth, version, 1).size(), 6u);
    EXPECT_TRUE(picture->changes_since(depth, version, 1).empty());
}

TEST(LivePicture, LightsSumToTheMean) {
    RenderSession session(described(), {});
    std::unique_ptr<LivePicture> picture;
    picture = nullptr;
    const RenderSnapshot finished = rendered(session, picture);
    picture->update(finished.image);
    double most = 0;
    std::size_t lights = 0;
    std::vector<double> sum(3 * (width - 3) * (height - 2));
    for (std::size_t i = 0; i < picture->layers().size(); ++i) {
        if (!picture->layers()[i].name.starts_with("light ")) continue;
        EXPECT_EQ(picture->layers()[i].kind, "color");
        ++lights;
        std::size_t k = 0;
        for (int y = 0; y < height - 2; ++y)
            for (int x = 0; x < width - 3; ++x)
                for (const float v : picture->values(i, x, y)) sum[k++] += double(v);
    }
    EXPECT_GT(lights, 1u);
    std::size_t k = 0;
    for (int y = 0; y < height - 2; ++y)
        for (int x = 0; x < width - 3; ++x)
            for (const float v : picture->pixel(x, y).mean)
                most = std::max(most, std::abs(double(v) - sum[k++]));
    EXPECT_LT(most, 1e-4);
}

// A reader that asks again and again, with small limits, has the picture in the end, whatever happened meanwhile.
TEST(LivePicture, ChangesAddUpToThePicture) {
    RenderSession session(described(), {});
    session.prepare();
    LivePicture picture(session.description().film.crop, session.replicate_size(),
                        film_layers_of(session.description()).channels());
    const std::size_t mean = number("mean", picture);
    std::map<std::pair<int, int>, std::vector<float>> seen;
    std::uint64_t version = 0;
    int answers = 0;
    const auto read = [&] {
        const auto tiles = picture.changes_since(mean, version, 1000);
        for (const LiveTile& tile : tiles) seen[{tile.bounds.x0, tile.bounds.y0}] = tile.values;
        answers += !tiles.empty();
        return !tiles.empty();
    };
    int calls = 0;
    std::mutex mutex;
    session.render({.tile = [&](const FinishedTile& tile) {
        picture.update(tile);
        const std::lock_guard lock(mutex);
        if (++calls % 5 == 0) read();
    }});
    while (read()) continue;
    EXPECT_GT(answers, 6);
    ASSERT_EQ(seen.size(), 6u);
    for (const auto& [corner, values] : seen) {
        const int w = std::min(16, width - 3 - corner.first);
        for (std::size_t i = 0; i < values.size(); i += 3) {
            const int x = corner.first + static_cast<int>(i / 3) % w,
                      y = corner.second + static_cast<int>(i / 3) / w;
            for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(values[i + c], picture.pixel(x, y).mean[c]);
        }
    }
}

TEST(LivePicture, ReferenceGivesZScores) {
    RenderSession session(described(), {});
    std::unique_ptr<LivePicture> of_render;
    const RenderSnapshot finished = rendered(session, of_render);
    const auto channels = film_layers_of(session.description()).channels();
    LivePicture picture(session.description().film.crop, 4, channels, finished.image);
    picture.update(finished.image);
    EXPECT_EQ(picture.values(number("z", picture), 7, 7), (std::vector<float>{0}));
    // A reference that is brighter by the error of both.
    auto brighter = std::make_shared<Image>(*finished.image);
    const LivePixel p = picture.pixel(7, 7);
    for (int c = 0; c < 3; ++c)
        brighter->set(7, 7, c, p.mean[static_cast<std::size_t>(c)] + p.error[static_cast<std::size_t>(c)]);
    LivePicture other(session.description().film.crop, 4, channels, brighter);
    other.update(finished.image);
    EXPECT_NEAR(other.values(number("z", other), 7, 7).front(), -std::sqrt(0.5), 1e-3);
    EXPECT_EQ(other.values(number("reference", other), 7, 7).size(), 3u);
    EXPECT_FALSE(of_render->find_layer("z"));
}

TEST(PictureStatistics, AreThoseOfTheFilm) {
    RenderSession session(described(), {});
    std::unique_ptr<LivePicture> picture;
    const RenderSnapshot finished = rendered(session, picture);
    const ToneCurve curve{1.5f, ToneKind::agx};
    const std::vector<LivePixel> pixels = picture->pixels();
    const PictureStatistics s = statistics_of(pixels, curve);
    ASSERT_TRUE(s.error);
    EXPECT_NEAR(*s.error, finished.error.relative, 1e-5 * finished.error.relative);
    EXPECT_EQ(s.samples, 32);
    EXPECT_NEAR(s.visible, *visible_error_share(*finished.image, curve), 1e-9);
    std::uint64_t counted = s.histogram.infinite;
    for (const std::uint64_t n : s.histogram.counts) counted += n;
    EXPECT_EQ(counted, pixels.size());
}

TEST(PictureStatistics, OfAnEmptyPictureAreUnknown) {
    const std::vector<LivePixel> black(100);
    EXPECT_FALSE(statistics_of(black, {}).error);
    LivePixel unknown;
    unknown.mean = {1, 1, 1};
    unknown.error.fill(std::numeric_limits<float>::infinity());
    const PictureStatistics s = statistics_of(std::vector<LivePixel>(10, unknown), {});
    EXPECT_FALSE(s.error);
    EXPECT_EQ(s.histogram.infinite, 10u);
    EXPECT_EQ(s.visible, 1);
}

TEST(PictureStatistics, ErrorsBeyondTheHistogramCountInItsOuterBins) {
    std::vector<LivePixel> pixels;
    for (const float error : {0.0f, 1e-9f, 1e-5f, 11.0f, 1e3f, 1e9f, 1e30f}) {
        LivePixel& p = pixels.emplace_back();
        p.mean.fill(1);
        p.error.fill(error);
    }
    const ErrorHistogram histogram = statistics_of(pixels, {}).histogram;
    ASSERT_EQ(histogram.counts.size(), ErrorHistogram::bins);
    EXPECT_EQ(histogram.counts.front(), 3u);
    EXPECT_EQ(histogram.counts.back(), 4u);
    EXPECT_EQ(histogram.infinite, 0u);
}

TEST(TileMessage, HasTheBytesOfTheProtocol) {
    const LiveTile tile{{16, 32, 18, 33}, {1.0f, 2.0f}};
    const ViewLayer half{"error", "error", 1}, exact{"samples", "count", 1, true};
    const std::string h = tile_message(1, half, 0x01020304, std::vector{tile});
    ASSERT_EQ(h.size(), 8u + 8u + 4u);
    EXPECT_EQ(h.substr(0, 8), std::string("\x01\x01\x01\x02\x04\x03\x02\x01", 8));
    EXPECT_EQ(h.substr(8, 8), std::string("\x10\0\x20\0\x02\0\x01\0", 8));
    std::uint16_t bits = 0;
    std::memcpy(&bits, &h[18], 2);
    EXPECT_EQ(half_to_float(bits), 2.0f);
    const std::string e = tile_message(3, exact, 0, std::vector{tile, tile});
    ASSERT_EQ(e.size(), 8u + 2 * (8u + 8u));
    float value = 0;
    std::memcpy(&value, &e[8 + 8 + 4], 4);
    EXPECT_EQ(value, 2.0f);
}

} // namespace
} // namespace montelux::testing
