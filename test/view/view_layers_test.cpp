// The layers that a page offers, from the channels of the picture.
#include <gtest/gtest.h>

#include "montelux/view/view_layers.h"

namespace montelux::testing {
namespace {

std::vector<std::string> names_and_kinds(std::vector<std::string> channels, bool with_reference = false) {
    std::vector<std::string> list;
    for (const ViewLayer& layer : view_layers(channels, with_reference))
        list.push_back(layer.name + ": " + layer.kind);
    return list;
}

using Names = std::vector<std::string>;

TEST(ViewLayers, MeanAndErrorComeFirst) {
    const Names always{"mean: color", "error: error", "relative error: ratio", "samples: count"};
    EXPECT_EQ(names_and_kinds({"R", "G", "B", "stderr.R", "stderr.G", "stderr.B", "samples"}), always);
    Names with_reference = always;
    with_reference.insert(with_reference.end(), {"reference: color", "z: z"});
    EXPECT_EQ(names_and_kinds({"R", "G", "B"}, true), with_reference);
}

TEST(ViewLayers, AreNamedAsTheOptionNamesThem) {
    const Names all = names_and_kinds(
        {"R",          "G",          "B",       "A",           "N.X",         "N.Y",         "N.Z",
         "Ng.X",       "Ng.Y",       "Ng.Z",    "P.X",         "P.Y",         "P.Z",         "albedo.R",
         "albedo.G",   "albedo.B",   "depth.Z", "light.key.R", "light.key.G", "light.key.B", "skewness.R",
         "skewness.G", "skewness.B", "uv.U",    "uv.V"});
    const Names more(all.begin() + 4, all.end());
    EXPECT_EQ(more, (Names{"alpha: scalar", "normal: vector", "geometric-normal: vector", "position: vector",
                           "albedo: color", "depth: scalar", "light key: color", "skewness: vector",
                           "uv.U: scalar", "uv.V: scalar"}));
}

TEST(ViewLayers, ACryptomatteIsShownByItsFirstIds) {
    const Names all =
        names_and_kinds({"CryptoShape00.R", "CryptoShape00.G", "CryptoShape00.B", "CryptoShape00.A",
                         "CryptoShape01.R", "CryptoShape01.G", "CryptoShape01.B", "CryptoShape01.A"});
    EXPECT_EQ(Names(all.begin() + 4, all.end()), Names{"CryptoShape00: id"});
}

TEST(ViewLayers, AreAtMostAsManyAsTheProtocolCounts) {
    std::vector<std::string> channels;
    channels.reserve(400);
    for (int i = 0; i < 400; ++i) channels.push_back("layer" + std::to_string(i) + ".R");
    EXPECT_EQ(view_layers(channels, false).size(), most_view_layers);
}

} // namespace
} // namespace montelux::testing
