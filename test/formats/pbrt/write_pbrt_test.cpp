#include "test/formats/pbrt/parse.h"
#include "test/formats/pbrt/round_trip.h"
#include "test/formats/pbrt/write_pbrt_testing.h"
#include "test/scene/measured_brdf_testing.h"
#include <algorithm>
#include <optional>

#include "montelux/formats/measured_brdf_file.h"
#include "montelux/formats/pbrt/write_pbrt.h"

namespace montelux {
namespace {

using test::expect_round_trip;

TEST_F(WritePbrt, Shapes) {
    EXPECT_EQ(world_round_trip(R"(
        Shape "sphere" "float radius" 0.3 "float zmin" -0.1 "float phimax" 123.4
        AttributeBegin Translate 1 2 3 Rotate 33 1 2 3 Scale 1 -2 0.7 Shape "sphere" AttributeEnd
        ReverseOrientation
        Shape "disk" "float height" 0.1 "float innerradius" 0.25 "float phimax" 77
        Scale -1 1 1
        Shape "cylinder" "float zmin" -3 "float zmax" 0.1 "string name" "a \"tube\""
        Shape "trianglemesh" "point3 P" [0 0 0 1 0 0 0 1 0 1 1 0.1] "integer indices" [0 1 2 2 1 3]
            "normal N" [0 0 1 0 0.1 1 0 0 1 -0 0 1] "point2 uv" [0 0 1 0 0 1 1 1] "float alpha" 0.5
        Shape "trianglemesh" "point3 P" [0 0 0 1 0 0 0 1 0] "vector3 S" [1 0 0 1 0 0 1 0 0]
        Shape "loopsubdiv" "integer levels" 2 "point3 P" [0 0 0 1 0 0 0 1 0 0 0 1]
            "integer indices" [0 2 1 0 1 3 1 2 3 0 3 2]
        Shape "bilinearmesh" "point3 P" [0 0 0 1 0 0 0 1 0 1 1 1] "normal N" [0 0 1 0 0 1 0 0 1 0 0 1]
        Shape "bilinearmesh" "point3 P" [0 0 0 1 0 0 0 1 0 1 1 0])"),
              Texts());
}

TEST_F(WritePbrt, LargeMeshesBecomeFiles) {
    const SceneDescription description = parse(R"(WorldBegin Shape "loopsubdiv" "integer levels" 4
        "point3 P" [0 0 0 1 0 0 0 1 0 0 0 1] "integer indices" [0 2 1 0 1 3 1 2 3 0 3 2])");
    ASSERT_GT(description.scene.meshes.at(0).positions.size(), 64u);
    EXPECT_EQ(expect_round_trip(description).messages(), Texts());
    Warnings warnings;
    const auto files = write_pbrt(description, folder_ / "a.pbrt", warnings);
    ASSERT_EQ(files.size(), 2u);
    EXPECT_EQ(files[0], folder_ / "a-files/shape-0.ply");
    EXPECT_EQ(files[1], folder_ / "a.pbrt");
    EXPECT_EQ(folder_.file_count(), 2); // no temporary folder
}

TEST_F(WritePbrt, Curves) {
    EXPECT_EQ(world_round_trip(R"(
        Shape "curve" "point3 P" [0 0 0 1 0 0 1 1 0 0 1 1] "float width0" 0.1 "float width1" 0.03
        Shape "curve" "point3 P" [0 0 0 1 0 0 1 1 0 0 1 1 2 2 2 3 3 3 1 2 3] "float width" 0.1
        Shape "curve" "string type" "cylinder" "string basis" "bspline" "point3 P" [0 0 0 1 0 0 1 1 0 0 1 1 3 2 1]
        AttributeBegin Scale 2 2 2
        Shape "curve" "string type" "ribbon" "point3 P" [0 0 0 1 0 0 1 1 0 0 1 1] "normal N" [0 0 1 0 1 0]
        AttributeEnd)"),
              Texts());
}

TEST_F(WritePbrt, ObjectsInstancesAndMotion) {
    EXPECT_EQ(world_round_trip(R"(
        ObjectBegin "tree" Shape "sphere" Translate 1 0 0 Shape "disk" ObjectEnd
        Shape "sphere"
        AttributeBegin Translate 0 0 1 ObjectInstance "tree" AttributeEnd
        AttributeBegin ActiveTransform EndTime Rotate 30 0 1 0 Translate 1 0 0 ActiveTransform All
            Shape "sphere" "float radius" 0.2
            AreaLightSource "diffuse" "rgb L" [1 2 3]
            Shape "trianglemesh" "point3 P" [0 0 0 1 0 0 0 1 0] AttributeEnd
        AttributeBegin Rotate 20 1 0 0 ActiveTransform EndTime Translate 0 3 0 ActiveTransform All
            ObjectInstance "tree" AttributeEnd)"),
              Texts());
}

TEST_F(WritePbrt, Materials) {
    make_pictures();
    {
        AtomicFile file(folder_ / "measured.bsdf");
        write_measured_brdf(file, testing::measured_case(0.5f, 0.5f));
        file.commit();
    }
    EXPECT_EQ(world_round_trip(R"(
        Texture "bumps" "float" "wrinkled" "integer octaves" 3
        Material "diffuse" "rgb reflectance" [0.2 0.31 0.7] "texture displacement" "bumps" Shape "sphere"
        Material "diffuse" Shape "sphere"
        Material "diffuse" "spectrum reflectance" [400 0.1 500 0.25 700 0.5] "string normalmap" "rgba.png" Shape "sphere"
        Material "conductor" Shape "sphere"
        Material "conductor" "spectrum eta" "metal-Ag-eta" "spectrum k" "metal-Ag-k" "float roughness" 0.1 Shape "sphere"
        Material "conductor" "rgb reflectance" [0.9 0.8 0.1] "float uroughness" 0.1 "bool remaproughness" false
            Shape "sphere"
        Material "dielectric" "spectrum eta" "glass-BK7" Shape "sphere"
        Material "dielectric" "float eta" 1.33 "float vroughness" 0.2 Shape "sphere"
        Material "thindielectric" "float eta" 1.7 Shape "sphere"
        Material "coateddiffuse" "rgb reflectance" [0.1 0.2 0.3] "float thickness" 0.3 "float g" 0.1
            "rgb albedo" [0.5 0.5 0.4] "integer maxdepth" 7 "integer nsamples" 2 "float roughness" 0.3 Shape "sphere"
        Material "coatedconductor" "rgb reflectance" [0.7 0.2 0.3] "float conductor.roughness" 0.1
            "float interface.roughness" 0.2 Shape "sphere"
        Material "coatedconductor" Shape "sphere"
        Material "diffusetransmission" "rgb reflectance" [0.1 0.2 0.3] "rgb transmittance" [0.3 0.2 0.1] Shape "sphere"
        Material "hair" "float eumelanin" 0.7 Shape "sphere"
        Material "hair" "rgb sigma_a" [0.1 0.2 3] "float beta_m" 0.2 Shape "sphere"
        Material "hair" "rgb reflectance" [0.1 0.2 0.3] Shape "sphere"
        Material "measured" "string filename" "measured.bsdf" Shape "sphere"
        Material "subsurface" "string name" "Skin1" Shape "sphere"
        Material "subsurface" "rgb reflectance" [0.3 0.5 0.5] "rgb mfp" [1 0.5 0.2] "float g" 0.2 Shape "sphere"
        Material "subsurface" "texture sigma_a" "marbled" "rgb sigma_s" [1 2 3] "float scale" 2 Shape "sphere"
        MakeNamedMaterial "red" "string type" "diffuse" "rgb reflectance" [0.9 0.1 0.1]
        MakeNamedMaterial "both" "string type" "mix" "string materials" ["red" "unused"] "float amount" 0.3
        MakeNamedMaterial "unused" "string type" "dielectric"
        NamedMaterial "both" Shape "sphere" Shape "disk"
        MakeNamedMaterial "sides" "string type" "sided" "string front" "both" "string back" "black"
        MakeNamedMaterial "black" "string type" "sided" "string back" "red"
        NamedMaterial "sides" Shape "sphere"
        Material "plastic" "float alpha" 0.1 "string distribution" "ggx-separable" "bool nonlinear" true Shape "sphere"
        Material "conductor" "string distribution" "beckmann" "rgb specularreflectance" [0.1 0.2 0.3] Shape "sphere"
        Material "disney" "float clearcoat" 0.3 "float sheen" 1.5 "float eta" 1.3 Shape "sphere"
        Material "disneythin" "float diffusetransmission" 0.3 Shape "sphere"
        Material "dielectric" "rgb speculartransmittance" [0.1 0.2 0.3] Shape "sphere"
        Texture "marbled" "spectrum" "marble"
        Material "interface" Shape "sphere"
        ColorSpace "rec2020" Material "diffuse" "rgb reflectance" [0.123456 0.2 0.7] Shape "sphere")"),
              Texts());
}

TEST_F(WritePbrt, Textures) {
    make_pictures();
    EXPECT_EQ(world_round_trip(R"(
        Texture "a" "float" "imagemap" "string filename" "rgba.png" "string encoding" "linear"
        Texture "b" "float" "imagemap" "string filename" "grey16.png" "string filter" "trilinear" "string wrap" "clamp"
            "float uscale" 2 "float vdelta" 0.1
        Texture "c" "spectrum" "imagemap" "string filename" "map.exr" "float scale" 0.5 "bool invert" true
        Texture "d" "spectrum" "imagemap" "string filename" "half.exr" "string filter" "ewa" "float maxanisotropy" 4
        Texture "e" "spectrum" "imagemap" "string filename" "rgba.png" "string encoding" "gamma 2.2"
            "string mapping" "spherical"
        Texture "f" "spectrum" "scale" "texture tex" "c" "texture scale" "a"
        Texture "g" "spectrum" "mix" "texture tex1" "d" "rgb tex2" [0.1 0.2 0.3] "texture amount" "b"
        Translate 1 2 3 Rotate 10 1 2 3
        Texture "h" "spectrum" "checkerboard" "texture tex1" "e" "spectrum tex2" [300 0.5 800 0.6]
            "string mapping" "planar" "vector3 v1" [1 2 3] "float udelta" 0.1
        Texture "i" "spectrum" "checkerboard" "integer dimension" 3
        Texture "j" "spectrum" "bilerp" "rgb v00" [0.1 0.1 0.2] "texture v11" "h" "string mapping" "cylindrical"
        Texture "k" "spectrum" "dots" "texture inside" "i" "texture outside" "j"
        Texture "l" "spectrum" "directionmix" "texture tex1" "k" "texture tex2" "f" "vector3 dir" [1 2 0.3]
        Texture "m" "spectrum" "marble" "float scale" 3 "float variation" 0.3
        Texture "n" "float" "fbm" "integer octaves" 4 "float roughness" 0.4
        Texture "o" "float" "windy"
        Texture "p" "float" "constant" "float value" 0.25
        Texture "q" "float" "mix" "texture tex1" "n" "texture tex2" "o" "texture amount" "p"
        Material "diffuse" "texture reflectance" "l" "texture displacement" "q" Shape "sphere" "texture alpha" "b"
        Material "diffuse" "texture reflectance" "g" Shape "sphere"
        Material "conductor" "texture eta" "m" "texture roughness" "a" Shape "sphere")"),
              Texts());
}

// What scenes of other formats have, in parameters that pbrt-v4 does not know.
TEST_F(WritePbrt, OwnTextures) {
    make_pictures();
    EXPECT_EQ(world_round_trip(R"(
        Texture "a" "float" "imagemap" "string filename" "rgba.png" "string channel" "green" "string wrap" "mirror"
        Texture "b" "float" "imagemap" "string filename" "rgba.png" "string channel" "color" "bool vertexcolors" true
        Texture "c" "spectrum" "imagemap" "string filename" "rgba.png" "rgb factor" [0.5 0.25 1]
            "string swrap" "clamp" "string twrap" "mirror" "bool vertexcolors" true
            "string mapping" "affine" "vector3 v1" [0.5 0.1 0] "vector3 v2" [-0.1 2 0] "float udelta" 0.3
        Texture "d" "spectrum" "vertexcolor" "rgb factor" [0.2 0.3 0.4]
        Texture "f" "float" "checkerboard" "float tex1" 0.25 "bool sharp" true
        Texture "e" "float" "step" "texture tex" "a" "float edge" 0.25
        Texture "n" "spectrum" "imagemap" "string filename" "map.exr" "rgb factor" [0.5 0.5 1] "float uscale" 2
            "bool seconduv" true
            "bool righthanded" true
        Material "diffuse" "texture reflectance" "c" "texture normalmap" "n" Shape "sphere" "texture alpha" "e"
        Material "diffuse" "texture reflectance" "d" "string normalmap" "map.exr"
        Shape "trianglemesh" "point3 P" [0 0 0 1 0 0 0 1 0] "rgb colors" [1 0 0 0 1 0 0 0.5 1]
            "float opacities" [1 0.5 0.25] "point2 uv2" [0 1 0.5 0.25 1 0]
        Material "conductor" "texture roughness" "b" "texture normalmap" "n" "bool shadowed" true Shape "sphere"
        Material "conductor" "texture roughness" "f" Shape "sphere")"),
              Texts());
}

// Large meshes with colours of vertices, opacities or both.
TEST_F(WritePbrt, ColoredMeshesBecomeFiles) {
    SceneDescription d = parse("WorldBegin LightSource \"point\" Texture \"c\" \"spectrum\" \"vertexcolor\" "
                               "Material \"diffuse\" \"texture reflectance\" \"c\" Shape \"loopsubdiv\" "
                               "\"integer levels\" 4 \"point3 P\" [0 0 0 1 0 0 0 1 0 0 0 1] "
                               "\"integer indices\" [0 2 1 0 1 3 1 2 3 0 3 2]");
    TriangleMesh& mesh = d.scene.meshes.at(0);
    std::vector<Vec3f> colors;
    std::vector<float> opacities;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        colors.push_back({0.25f, 0.5f, static_cast<float>(i)});
        opacities.push_back(0.125f * static_cast<float>(i % 8));
        mesh.second_uvs.push_back({0.5f, static_cast<float>(i)});
    }
    mesh.colors = colors;
    EXPECT_EQ(test::expect_round_trip(d).messages(), Texts());
    mesh.opacities = opacities;
    EXPECT_EQ(test::expect_round_trip(d).messages(), Texts());
    mesh.colors.clear();
    EXPECT_EQ(test::expect_round_trip(d).messages(), Texts());
}

TEST_F(WritePbrt, Lights) {
    make_pictures();
    const std::string lights = R"(
        LightSource "point" "rgb I" [3 2 1] "point3 from" [1 2 3] "float scale" 0.3 "string group" "lamps"
        LightSource "point" "float power" 60
        LightSource "point" "blackbody I" 3000 "float power" 12.5
        LightSource "spot" "spectrum I" [400 1 700 2] "point3 from" [1 0.3 2] "point3 to" [0.2 0.1 7]
            "float coneangle" 33 "float conedeltaangle" 7.5
        LightSource "distant" "rgb L" [1 1 0.9] "point3 from" [1 2 3] "float illuminance" 1000
        LightSource "infinite" "rgb L" [0.1 0.2 0.3] "float illuminance" 3
        LightSource "infinite" "rgb L" [0.1 0.2 0.3] "point3 portal" [0 0 0 0 1 0 1 1 0 1 0 0]
        LightSource "infinite" "string filename" "map.exr" "float scale" 1.7
        AttributeBegin Rotate 33 1 2 3 LightSource "infinite" "string filename" "map.exr" "float illuminance" 5
        LightSource "goniometric" "string filename" "map.exr" "rgb I" [1 2 3]
        LightSource "projection" "string filename" "rgba.png" "float fov" 37 AttributeEnd
        LightSource "sky" "float elevation" 20 "float azimuth" 33.5 "float turbidity" 3
        LightSource "sky" "vector3 sun" [0.3 -0.2 0.5] "bool sundisc" false "float illuminance" 10000
        AttributeBegin ActiveTransform EndTime Translate 1 2 0 ActiveTransform All
        LightSource "point" "point3 from" [0.1 0.2 0.3]
        LightSource "spot" "point3 from" [0.1 0.2 0.3] "point3 to" [0 0 1]
        AttributeEnd
        AttributeBegin AreaLightSource "diffuse" "rgb L" [3 2 1] "bool twosided" true "float scale" 0.7
        Shape "trianglemesh" "point3 P" [0 0 0 1 0 0 0 1 0] AttributeEnd
        LightSource "point"
        AttributeBegin AreaLightSource "diffuse" "float power" 100 "string group" "panel"
        Shape "trianglemesh" "point3 P" [0 0 0 1 0 0 0 1 0] Shape "sphere" "float radius" 0.3 AttributeEnd
        AttributeBegin AreaLightSource "diffuse" "string filename" "rgba.png"
        Shape "trianglemesh" "point3 P" [0 0 0 1 0 0 0 1 0] Scale 1 1 -1 Shape "disk" AttributeEnd
        ColorSpace "aces2065-1" LightSource "point" LightSource "distant" "rgb L" [0.3 0.4 0.5])";
    EXPECT_EQ(world_round_trip(lights), Texts());
    write_image(folder_ / "odd.exr", Image(5, 3, {"R", "G", "B"}));
    for (const char* map : {"odd.exr", "map.exr"}) {
        const Texts warnings =
            world_round_trip("LightSource \"infinite\" \"string filename\" \"" + std::string(map) +
                             "\" \"string layout\" \"equirectangular\"");
        ASSERT_EQ(warnings.size(), 1u) << map;
        EXPECT_NE(warnings[0].find("pbrt-v4 refuses"), std::string::npos) << warnings[0];
    }
}

TEST_F(WritePbrt, Media) {
    EXPECT_EQ(round_trip(R"(
        MediumInterface "" "fog" Camera "perspective" "float fov" 33
        WorldBegin
        MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_a" [0.1 0.2 0.3] "spectrum sigma_s" [400 1 700 2]
            "float scale" 0.3 "rgb Le" [1 2 3] "float Lescale" 0.3 "float g" 0.2
        MakeNamedMedium "milk" "string type" "homogeneous" "string preset" "Wholemilk" "float alpha" 2 "float g" 0.1
        Translate 1 2 3 Rotate 20 1 2 3
        MakeNamedMedium "grid" "string type" "uniformgrid" "integer nx" 2 "integer ny" 1 "integer nz" 2
            "float density" [0.1 0.2 0.3 4e-10] "float temperature" [1 2 3 4] "float temperaturescale" 1000
            "point3 p0" [-1 -1 -1]
        MakeNamedMedium "rgb" "string type" "rgbgrid" "integer nx" 2 "rgb sigma_a" [0.1 0.2 0.3 0.123456789 5 6]
            "rgb Le" [1 1 1 2 2 2]
        MakeNamedMedium "cloud" "string type" "cloud" "float density" 2 "float wispiness" 0.5
        AttributeBegin MediumInterface "milk" "fog" Shape "sphere" AttributeEnd
        MediumInterface "grid" "" Material "interface" Shape "sphere"
        MediumInterface "rgb" "cloud" Material "interface" Shape "sphere")"),
              Texts());
}

TEST_F(WritePbrt, SparseGridsBecomeUniformOnes) {
    SceneDescription d = parse("WorldBegin LightSource \"point\" Shape \"sphere\"");
    SparseGrid grid{.node_count = {1, 1, 1},
                    .nodes = {0},
                    .blocks = std::vector<std::uint32_t>(SparseGrid::node_size, SparseGrid::constant_entry),
                    .values = std::vector<float>(SparseGrid::block_size)};
    grid.blocks[0] = 0;
    for (int i = 0; i < 3; ++i)
        grid.values[static_cast<std::size_t>(64 * (2 + i) + 8 * 3 + 1)] = 0.1f + static_cast<float>(i);
    ASSERT_TRUE(grid.is_consistent());
    d.scene.sparse_grids = {grid};
    d.scene.media.push_back(SparseGridMedium{.box = {{1, 2, 0}, {5, 4, 2}, Transform::translate({1, 2, 3})},
                                             .density = 0,
                                             .scale = 3,
                                             .temperature_space_from_density = {}});
    Warnings warnings;
    write_pbrt(d, folder_ / "a.pbrt", warnings);
    ASSERT_EQ(warnings.messages().size(), 1u);
    EXPECT_NE(warnings.messages()[0].find("'uniformgrid'"), std::string::npos);
    Warnings ignored;
    const SceneDescription again = load_scene(folder_ / "a.pbrt", ignored);
    const auto& medium = std::get<GridMedium>(again.scene.media.at(0));
    EXPECT_EQ(medium.scale, 3);
    const ScalarGrid& uniform = again.scene.scalar_grids.at(medium.density);
    for (int i = 0; i < 500; ++i) {
        const auto random = [i](int k) {
            return static_cast<float>(noise(static_cast<std::uint64_t>(3 * i + k)));
        };
        const Point3f p(6 * random(0), 5 * random(1), 3 * random(2)); // in the space of the grid
        const Vec3f extent = medium.box.p1 - medium.box.p0, from = p - medium.box.p0;
        EXPECT_NEAR(uniform({from.x / extent.x, from.y / extent.y, from.z / extent.z}), grid(p), 1e-5f);
    }
}

void expect_all_round_trip(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> paths;
    std::error_code error;
    for (std::filesystem::recursive_directory_iterator i(folder, error), end; i != end; i.increment(error))
        if (i->path().extension() == ".pbrt") paths.push_back(i->path());
    ASSERT_FALSE(paths.empty());
    std::sort(paths.begin(), paths.end());
    std::size_t whole = 0;
    for (const std::filesystem::path& path : paths) {
        SCOPED_TRACE(path.string());
        Warnings ignored;
        std::optional<SceneDescription> loaded;
        try {
            loaded.emplace(load_scene(path, ignored));
        } catch (const Error&) {
            continue; // a part of a scene
        }
        ++whole;
        if (!loaded->scene.sparse_grids.empty()) continue; // SparseGridsBecomeUniformOnes
        try {
            Texts warnings = expect_round_trip(*loaded).messages();
            std::erase_if(warnings, [](const std::string& w) {
                return w.find("latitude-longitude") != std::string::npos;
            });
            EXPECT_EQ(warnings, Texts());
        } catch (const Error& e) {
            ADD_FAILURE() << e.what();
        }
    }
    EXPECT_GT(whole, 0u);
}

TEST(WritePbrtScenes, ScenesOfTheRepository) {
    expect_all_round_trip(std::filesystem::path(MONTELUX_SOURCE_DIR) / "scenes");
}

TEST(WritePbrtSlowTest, SharedScenes) {
    const std::filesystem::path folder = std::filesystem::path(MONTELUX_SHARED_DIR) / "scenes/pbrt";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not there";
    expect_all_round_trip(folder);
}

} // namespace
} // namespace montelux
