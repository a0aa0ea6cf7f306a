// Layers are chosen by name; light groups are formed of names and kinds.
#include <gtest/gtest.h>
#include <string>

#include "montelux/mc/math/error.h"
#include "montelux/scene/film/layer_set.h"
#include "montelux/scene/light/light_groups.h"
#include "montelux/scene/scene_names.h"

namespace montelux {
namespace {

std::string error_of_list(std::string_view list) {
    try {
        parse_layers(list);
    } catch (const Error& e) {
        return e.what();
    }
    return {};
}

TEST(LayerSet, IsReadFromNames) {
    EXPECT_EQ(parse_layers("default"), LayerSet::standard());
    EXPECT_EQ(parse_layers("mean"), LayerSet());
    EXPECT_EQ(parse_layers("uv,motion"), (LayerSet{Layer::uv, Layer::motion}));
    LayerSet more = LayerSet::gbuffer();
    more.add(Layer::light_groups);
    EXPECT_EQ(parse_layers("gbuffer,light-groups"), more);
    for (const LayerSet set : {LayerSet::standard(), LayerSet::gbuffer(), LayerSet(), more})
        EXPECT_EQ(parse_layers(text_of(set)), set);
    ASSERT_EQ(layer_names().size(), static_cast<std::size_t>(Layer::material) + 1);
    for (std::size_t i = 0; i < layer_names().size(); ++i) {
        const LayerSet set = parse_layers(layer_names()[i]);
        EXPECT_TRUE(set.has(static_cast<Layer>(i)));
        EXPECT_EQ(set, LayerSet{static_cast<Layer>(i)});
    }
}

TEST(LayerSet, UnknownNamesAreRefusedWithTheNearestOne) {
    EXPECT_NE(error_of_list("albedo,positon")
                  .find("no layer 'positon' (did you mean 'position'?); expected a list of "
                        "default, gbuffer, mean, error"),
              std::string::npos)
        << error_of_list("albedo,positon");
    EXPECT_NE(error_of_list("").find("no layer ''"), std::string::npos);
    EXPECT_NE(error_of_list("uv,").find("no layer ''"), std::string::npos);
    EXPECT_NE(error_of_list("uv, depth").find("no layer ' depth'"), std::string::npos);
}

Scene scene_of_lights(std::size_t points) {
    Scene scene;
    scene.lights.emplace_back(DistantLight{});
    for (std::size_t i = 0; i < points; ++i) scene.lights.emplace_back(PointLight{});
    return scene;
}

TEST(LightGroups, AreOfOneLightAKindOrAName) {
    Scene scene = scene_of_lights(3);
    EXPECT_EQ(
        light_groups(scene, LightGrouping::light).names,
        (std::vector<std::string>{"distant-light-0", "point-light-1", "point-light-2", "point-light-3"}));
    const LightGroups kinds = light_groups(scene, LightGrouping::kind);
    EXPECT_EQ(kinds.names, (std::vector<std::string>{"distant-light", "point-light"}));
    EXPECT_EQ(kinds.of_light, (std::vector<Index>{0, 1, 1, 1}));
    scene.light_groups = {"key.1", "", "key.1"};
    scene.media.emplace_back(HomogeneousMedium{});
    const LightGroups named = light_groups(scene, LightGrouping::light);
    EXPECT_EQ(named.names, (std::vector<std::string>{"key_1", "point-light-1", "point-light-3", "media"}));
    EXPECT_EQ(named.of_light, (std::vector<Index>{0, 1, 0, 2}));
    EXPECT_EQ(named.of_media, 3u);
}

TEST(LightGroups, TooManyAreRefused) {
    const Scene scene = scene_of_lights(300);
    EXPECT_THROW(light_groups(scene, LightGrouping::light), Error);
    EXPECT_EQ(light_groups(scene, LightGrouping::kind).names.size(), 2u);
}

TEST(SceneNames, AreThoseOfTheFileOrNumbers) {
    Scene scene;
    scene.shape_names = {"", "teapot"};
    scene.material_names = {"gold"};
    EXPECT_EQ(shape_name(scene, 0), "shape-0");
    EXPECT_EQ(shape_name(scene, 1), "teapot");
    EXPECT_EQ(shape_name(scene, 7), "shape-7");
    EXPECT_EQ(material_name(scene, 0), "gold");
    EXPECT_EQ(material_name(scene, 1), "material-1");
    scene.objects = {{{0}, "tree"}, {{1}}, {{0}}};
    for (const Index object : {0u, 1u, 0u, 2u, 2u})
        scene.instances.push_back({object, Transform(), no_index});
    EXPECT_EQ(instance_names(scene),
              (std::vector<std::string>{"tree:0", "teapot", "tree:1", "shape-0:0", "shape-0:1"}));
}

} // namespace
} // namespace montelux
