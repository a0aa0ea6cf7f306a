// Mattes: the coverages of shapes and materials, by their names.
#include "test/render/layer_testing.h"
#include <bit>
#include <cstdint>
#include <gtest/gtest.h>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "montelux/image/cryptomatte.h"
#include "montelux/render/render_session.h"

namespace montelux::testing {
namespace {

// The coverages of a matte sum to alpha, and each is the area that its shape covers.
TEST(Layers, MattesDecodeToCoverage) {
    SceneBuilder b = square_below();
    b.description.sampler = {.kind = SamplerKind::sobol, .spp = 256};
    b.description.film.filter = BoxFilter{};
    // A card above the square's right half covers pixel columns from 8 + 1/3 on.
    b.add_mesh(square(Transform::translate({1 + 1.0 / 12, 0, 0.0}) * Transform::translate({0, 0, 1e-3})),
               b.add(DiffuseMaterial{gray(0.2f)}));
    // It is an instance, which has the name of its object.
    b.scene.world_shapes = {0};
    b.scene.objects.push_back({.shapes = {1}, .name = "card"});
    b.scene.instances.push_back({0, Transform()});
    b.scene.shape_names = {"floor", "shape of the card"};
    b.scene.material_names = {"", "paint"};
    const Transform camera_from_world = b.scene.camera.world_from_camera.inverse();
    const bool mirrored = camera_from_world.vector(Vec3d{1, 0, 0}).x < 0;
    RenderSession session(std::make_shared<const SceneDescription>(b.description), {});
    session.render();
    const Image image = *session.finish().image;
    const auto coverage = [&](const char* matte, std::string_view name, int x, int y) {
        double sum = 0;
        const std::vector<std::string> channels = cryptomatte_channels(matte);
        for (std::size_t c = 0; c < channels.size(); c += 2)
            if (std::bit_cast<std::uint32_t>(image.value(x, y, *image.find_channel(channels[c]))) ==
                cryptomatte_id(name))
                sum += image.value(x, y, *image.find_channel(channels[c + 1]));
        return sum;
    };
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x) {
            const double floor = coverage("CryptoShape", "floor", x, y),
                         card = coverage("CryptoShape", "card:0", x, y);
            EXPECT_NEAR(floor + card, value_of(image, x, y, "A"), 1e-6);
            EXPECT_NEAR(coverage("CryptoMaterial", "paint", x, y), card, 1e-6);
            EXPECT_NEAR(coverage("CryptoMaterial", "material-0", x, y), floor, 1e-6);
        }
    const int column = mirrored ? 7 : 8;
    EXPECT_NEAR(coverage("CryptoShape", "floor", column, 8), 1.0 / 3, 0.02);
    EXPECT_NEAR(coverage("CryptoShape", "card:0", column, 8), 2.0 / 3, 0.02);
    EXPECT_EQ(coverage("CryptoShape", "floor", mirrored ? 8 : 7, 8), 1);
    const std::string key = "cryptomatte/";
    int manifests = 0;
    for (const auto& [name, value] : image.attributes())
        if (name.starts_with(key) && name.ends_with("/manifest")) {
            ++manifests;
            const std::string& text = std::get<std::string>(value);
            EXPECT_TRUE(text.find("\"card:0\"") != text.npos || text.find("\"paint\"") != text.npos) << text;
        }
    EXPECT_EQ(manifests, 2);
}

} // namespace
} // namespace montelux::testing
