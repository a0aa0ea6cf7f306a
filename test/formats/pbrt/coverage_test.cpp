// The table of plugins against the reader: each is read, in part, with a warning, or refused, as the table says.
#include "test/formats/pbrt/parse.h"
#include "test/scene/measured_brdf_testing.h"
#include "test/temporary_folder.h"
#include <fstream>
#include <gtest/gtest.h>
#include <map>
#include <set>

#include "montelux/formats/pbrt/coverage.h"
#include "montelux/image/image_write.h"

namespace montelux {
namespace {

using pbrt::PluginCoverage;

// A scene of a plugin with what it cannot do without.
std::string scene_with(const PluginCoverage& p) {
    const std::string_view d = p.directive;
    const std::map<std::string, std::string> needed = {
        {"Shape trianglemesh", "\"point3 P\" [ 0 0 0 1 0 0 0 1 0 ]"},
        {"Shape bilinearmesh", "\"point3 P\" [ 0 0 0 1 0 0 0 1 0 1 1 0 ]"},
        {"Shape loopsubdiv", "\"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] \"integer indices\" [ 0 1 2 ]"},
        {"Shape plymesh", "\"string filename\" \"a.ply\""},
        {"Shape curve", "\"point3 P\" [ 0 0 0 1 0 0 1 1 0 1 1 1 ]"},
        {"Material mix", "\"string materials\" [ \"m\" \"m\" ]"},
        {"Material measured", "\"string filename\" \"a.bsdf\""},
        {"Texture imagemap", "\"string filename\" \"a.png\""},
        {"Texture ptex", "\"string filename\" \"a.ptx\""},
        {"LightSource goniometric", "\"string filename\" \"a.png\""},
        {"LightSource projection", "\"string filename\" \"a.png\""},
        {"MakeNamedMedium uniformgrid", "\"float density\" 1"},
        {"MakeNamedMedium rgbgrid", "\"rgb sigma_s\" [ 1 1 1 ]"},
        {"MakeNamedMedium nanovdb", "\"string filename\" \"a.nvdb\""},
        {"Camera realistic", "\"string lensfile\" \"a.dat\""},
    };
    std::string parameters;
    if (const auto found = needed.find(std::string(d) + ' ' + p.plugin); found != needed.end())
        parameters = ' ' + found->second;
    const std::string quoted = '"' + p.plugin + '"', plain = std::string(d) + ' ' + quoted + parameters;
    const std::string rest = "\nMakeNamedMaterial \"m\" \"string type\" \"diffuse\" Shape \"disk\" "
                             "LightSource \"point\"\n";
    if (d == "Shape" || d == "Material" || d == "LightSource" || d == "ColorSpace")
        return "WorldBegin" + rest + plain + " Shape \"sphere\"";
    if (d == "AreaLightSource") return "WorldBegin" + rest + plain + " Shape \"sphere\"";
    if (d == "Texture") {
        const bool of_numbers =
            p.plugin == "fbm" || p.plugin == "windy" || p.plugin == "wrinkled" || p.plugin == "step";
        return "WorldBegin" + rest + "Texture \"t\" \"" + (of_numbers ? "float" : "spectrum") + "\" " +
               quoted + parameters + " Material \"diffuse\" \"texture " +
               (of_numbers ? "displacement" : "reflectance") + "\" \"t\" Shape \"sphere\"";
    }
    if (d == "MakeNamedMedium")
        return "WorldBegin" + rest + "MakeNamedMedium \"a\" \"string type\" " + quoted + parameters;
    return plain + "\nWorldBegin" + rest;
}

class EveryPbrtPlugin : public ::testing::Test {
  protected:
    EveryPbrtPlugin() {
        std::ofstream(folder / "a.ply")
            << "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
               "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
               "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
        std::ofstream(folder / "a.dat") << "1\n2\n3\n";
        Image white(4, 4, {"R", "G", "B"}, PixelFormat::u8, ColorEncoding::srgb());
        for (auto& v : white.u8()) v = 255;
        write_image(folder / "a.png", white);
        const std::vector<std::uint8_t> brdf =
            testing::measured_brdf_file(testing::measured_ggx({{0.5f, 0.5f}}, 8)).bytes();
        std::ofstream(folder / "a.bsdf", std::ios::binary)
            .write(reinterpret_cast<const char*>(brdf.data()), static_cast<std::streamsize>(brdf.size()));
    }

    TemporaryFolder folder;
};

TEST_F(EveryPbrtPlugin, IsReadAsTheTableSays) {
    // Their files are tested elsewhere; here they are broken.
    const std::set<std::string> files_are_broken = {"realistic", "nanovdb"};
    for (const PluginCoverage& p : pbrt::plugin_coverage()) {
        const std::string name = std::string(p.directive) + ' ' + p.plugin;
        Warnings warnings;
        std::string error;
        try {
            parse_pbrt(scene_with(p), "scene", folder.path(), warnings);
        } catch (const Error& e) {
            error = e.what();
        }
        EXPECT_EQ(error.find("unknown"), std::string::npos) << name << ": " << error;
        if (files_are_broken.contains(p.plugin)) {
            EXPECT_EQ(error.find("supported"), std::string::npos) << name << ": " << error;
            continue;
        }
        if (p.support == Support::none) {
            EXPECT_NE(error.find("is not supported yet"), std::string::npos) << name << ": " << error;
            continue;
        }
        EXPECT_EQ(error, "") << name;
        EXPECT_EQ(!warnings.messages().empty(), p.support == Support::otherwise)
            << name << ": " << (warnings.messages().empty() ? "" : warnings.messages()[0]);
        // Only what is read as it is meant needs no note.
        if (p.support != Support::full) {
            EXPECT_FALSE(p.note.empty()) << name;
        }
    }
}

TEST_F(EveryPbrtPlugin, StandsInTheDocumentation) {
    std::ifstream file(std::string(MONTELUX_SOURCE_DIR) + "/docs/pbrt.md");
    const std::string text((std::istreambuf_iterator<char>(file)), {});
    for (const PluginCoverage& p : pbrt::plugin_coverage()) {
        if (p.directive == "Accelerator" || (p.directive == "Integrator" && p.support == Support::otherwise))
            continue;
        EXPECT_NE(text.find('`' + p.plugin + '`'), std::string::npos) << p.plugin;
    }
}

TEST(PbrtCoverage, HasEachPluginOnce) {
    std::set<std::pair<std::string_view, std::string>> seen;
    for (const PluginCoverage& p : pbrt::plugin_coverage())
        EXPECT_TRUE(seen.emplace(p.directive, p.plugin).second) << p.directive << ' ' << p.plugin;
    EXPECT_GT(seen.size(), 70u);
    EXPECT_TRUE(pbrt::is_plugin("Film", "rgb"));
    EXPECT_FALSE(pbrt::is_plugin("Film", "sphere"));
}

} // namespace
} // namespace montelux
