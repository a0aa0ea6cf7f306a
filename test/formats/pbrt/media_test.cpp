// Media, their places, and the material 'interface' of pbrt files.
#include "test/formats/nanovdb_writing.h"
#include "test/formats/pbrt/parse.h"
#include "test/temporary_folder.h"
#include <gtest/gtest.h>

#include "montelux/formats/nanovdb_file.h"
#include "montelux/scene/build/emission.h"
#include "montelux/scene/scene_tables.h"
#include "montelux/spectrum/rgb_colorspace.h"

namespace montelux {
namespace {

using test::parse;
using test::parse_world;

template <typename M>
M first_medium(const SceneDescription& d) {
    return std::get<M>(d.scene.media.at(0));
}
float value(const SceneDescription& d, SceneSpectrum s, float lambda) {
    return spectrum_of(s, d.scene.spectra)(lambda);
}
std::string medium(const std::string& type, const std::string& parameters = {}) {
    return "MakeNamedMedium \"m\" \"string type\" \"" + type + "\" " + parameters + "\n";
}

TEST(PbrtMedia, DefaultsAreThoseOfPbrt) {
    Warnings warnings;
    const auto fog = first_medium<HomogeneousMedium>(parse_world(medium("homogeneous"), &warnings));
    EXPECT_EQ(fog.sigma_a.constant, 1);
    EXPECT_EQ(fog.sigma_s.constant, 1);
    EXPECT_EQ(fog.scale, 1);
    EXPECT_TRUE(fog.le.is_constant() && fog.le.constant == 0);
    EXPECT_EQ(std::get<HenyeyGreenstein>(fog.phase).g, 0);

    const auto grid = first_medium<GridMedium>(parse_world(medium("uniformgrid", "\"float density\" 1")));
    EXPECT_EQ(grid.box.p0, Vec3f(0, 0, 0));
    EXPECT_EQ(grid.box.p1, Vec3f(1, 1, 1));
    EXPECT_EQ(grid.sigma_a.constant, 1);
    EXPECT_EQ(grid.sigma_s.constant, 1);
    EXPECT_EQ(grid.temperature, no_index);
    EXPECT_EQ(grid.le_grid, no_index);

    const auto cloud = first_medium<CloudMedium>(parse_world(medium("cloud")));
    EXPECT_EQ(cloud.density, 1);
    EXPECT_EQ(cloud.wispiness, 1);
    EXPECT_EQ(cloud.frequency, 5);
    EXPECT_EQ(cloud.sigma_a.constant, 1);

    const auto rgb = first_medium<RgbGridMedium>(parse_world(medium("rgbgrid", "\"rgb sigma_s\" [1 2 3]")));
    EXPECT_EQ(rgb.sigma_a, no_index);
    EXPECT_EQ(rgb.sigma_s, 0u);
    EXPECT_EQ(rgb.le, no_index);
    EXPECT_EQ(rgb.scale, 1);
}

TEST(PbrtMedia, HomogeneousWithEverything) {
    Warnings warnings;
    const SceneDescription d = parse_world(
        medium("homogeneous", "\"rgb sigma_a\" [1 2 3] \"spectrum sigma_s\" [300 1 900 4] \"float scale\" 7 "
                              "\"blackbody Le\" 3000 \"float Lescale\" 5 \"float g\" -0.3"),
        &warnings);
    EXPECT_EQ(warnings.messages().size(), 1u); // no light
    const auto m = first_medium<HomogeneousMedium>(d);
    EXPECT_FLOAT_EQ(value(d, m.sigma_a, 550), RgbUnboundedSpectrum(RgbColorSpace::srgb(), {1, 2, 3})(550));
    EXPECT_FLOAT_EQ(value(d, m.sigma_s, 500), 2);
    EXPECT_EQ(m.scale, 7);
    EXPECT_FLOAT_EQ(m.le_scale, 5 * photometric_scale(Spectrum(BlackbodySpectrum(3000))));
    EXPECT_FLOAT_EQ(value(d, m.le, 600), BlackbodySpectrum(3000)(600));
    EXPECT_EQ(std::get<HenyeyGreenstein>(m.phase).g, -0.3f);
    const auto draine = first_medium<HomogeneousMedium>(
        parse_world(medium("homogeneous", "\"float g\" 0.5 \"float alpha\" 2")));
    EXPECT_EQ(std::get<Draine>(draine.phase).g, 0.5f);
    EXPECT_EQ(std::get<Draine>(draine.phase).alpha, 2);
}

TEST(PbrtMedia, PresetsReplaceCoefficients) {
    const SceneDescription d = parse_world(
        medium("homogeneous", "\"string preset\" \"Skimmilk\" \"rgb sigma_s\" [9 9 9] \"float scale\" 10"));
    const auto m = first_medium<HomogeneousMedium>(d);
    EXPECT_FLOAT_EQ(value(d, m.sigma_s, 450),
                    RgbUnboundedSpectrum(RgbColorSpace::srgb(), {0.70f, 1.22f, 1.90f})(450));
    EXPECT_FLOAT_EQ(value(d, m.sigma_a, 450),
                    RgbUnboundedSpectrum(RgbColorSpace::srgb(), {0.0014f, 0.0025f, 0.0142f})(450));
    EXPECT_EQ(m.scale, 10);
}

TEST(PbrtMedia, GridsWithEverything) {
    const SceneDescription d = parse_world(
        "Translate 1 2 3\n" +
        medium("uniformgrid",
               "\"integer nx\" 2 \"integer ny\" 1 \"integer nz\" 3 \"float density\" [1 2 3 4 5 6] "
               "\"float temperature\" [6 5 4 3 2 1] \"float Lescale\" [1 1 1 1 1 2] \"point3 p0\" [4 0 0] "
               "\"point3 p1\" [-1 5 6] \"float temperaturecutoff\" 3 \"float temperaturescale\" 2 "
               "\"float scale\" 4 \"float g\" 0.1"));
    const auto m = first_medium<GridMedium>(d);
    EXPECT_EQ(m.box.p0, Vec3f(-1, 0, 0));
    EXPECT_EQ(m.box.p1, Vec3f(4, 5, 6));
    EXPECT_EQ(m.box.world_from_medium, Transform::translate({1, 2, 3}));
    const ScalarGrid& density = d.scene.scalar_grids.at(m.density);
    EXPECT_EQ(density.size, (std::array{2, 1, 3}));
    EXPECT_EQ(density.values, (std::vector<float>{1, 2, 3, 4, 5, 6}));
    EXPECT_EQ(d.scene.scalar_grids.at(m.temperature).values[0], 6);
    EXPECT_EQ(d.scene.scalar_grids.at(m.le_grid).values[5], 2);
    EXPECT_EQ(m.temperature_offset, 3);
    EXPECT_EQ(m.temperature_scale, 2);
    EXPECT_EQ(m.scale, 4);

    const SceneDescription rgb = parse_world(
        medium("rgbgrid", "\"integer nz\" 2 \"rgb sigma_a\" [1 2 3 4 5 6] \"rgb Le\" [1 1 1 0 0 0] "
                          "\"float Lescale\" 3 \"float scale\" 2"));
    const auto colors = first_medium<RgbGridMedium>(rgb);
    EXPECT_EQ(colors.sigma_s, no_index);
    EXPECT_EQ(rgb.scene.color_grids.at(colors.sigma_a).size, (std::array{1, 1, 2}));
    EXPECT_FLOAT_EQ(rgb.scene.color_grids.at(colors.sigma_a).values[1](600),
                    RgbUnboundedSpectrum(RgbColorSpace::srgb(), {4, 5, 6})(600));
    EXPECT_EQ(colors.le_scale, 3);
    EXPECT_FLOAT_EQ(value(rgb, colors.illuminant, 600), RgbColorSpace::srgb().illuminant()(600));
}

// A file of grids, and a scene with parameters that refers to it as FILE.
SceneDescription with_nanovdb(const std::vector<test::Handle>& grids, const std::string& parameters = {}) {
    const TemporaryFolder folder;
    const std::vector<std::uint8_t> bytes = test::nanovdb_bytes(grids, nanovdb::io::Codec::ZIP);
    const std::string path = folder.write("f.nvdb", {bytes.begin(), bytes.end()}).string();
    return parse_world("Translate 1 2 3\n" +
                       medium("nanovdb", "\"string filename\" \"" + path + "\" " + parameters));
}
test::Handle three_voxels(const std::string& name, float value = 1) {
    nanovdb::GridBuilder<float> builder(0.0f, nanovdb::GridClass::FogVolume);
    auto accessor = builder.getAccessor();
    accessor.setValue(nanovdb::Coord(-1, 0, 2), value);
    accessor.setValue(nanovdb::Coord(10, 0, 3), 5);
    accessor.setValue(nanovdb::Coord(0, 1, 9), 2);
    return builder.getHandle(0.5, nanovdb::Vec3d(4, 0, 0), name);
}

TEST(PbrtMedia, NanovdbDefaultsAreThoseOfPbrt) {
    std::vector<test::Handle> grids;
    grids.push_back(three_voxels("density"));
    const SceneDescription d = with_nanovdb(grids);
    const auto m = first_medium<SparseGridMedium>(d);
    EXPECT_EQ(m.sigma_a.constant, 1);
    EXPECT_EQ(m.sigma_s.constant, 1);
    EXPECT_EQ(m.scale, 1);
    EXPECT_EQ(m.temperature, no_index);
    EXPECT_EQ(std::get<HenyeyGreenstein>(m.phase).g, 0);
    // One voxel around those that are not 0, in the world: voxels (-1, 0, 2) to (10, 1, 9).
    const Transform& world = m.box.world_from_medium;
    const Vec3d low = world.point(Vec3d(m.box.p0)), high = world.point(Vec3d(m.box.p1));
    EXPECT_EQ(low, Vec3d(1 + 4 - 1, 2 - 0.5, 3 + 0.5));
    EXPECT_EQ(high, Vec3d(1 + 4 + 5.5, 2 + 1, 3 + 5));
    const SceneTables tables(d.scene);
    const auto local = m.at(tables.view(), 0, SampledWavelengths::sample_visible(0.5f));
    const Vec3d centre = Vec3d(1, 2, 3) + Vec3d(4 + 0.5 * 10, 0, 0.5 * 3);
    EXPECT_NEAR(local.coefficients(Point3f(centre)).sigma_s[0], 5, 1e-4f);
    EXPECT_NEAR(local.coefficients(Point3f(centre + Vec3d(0.25, 0, 0))).sigma_s[0], 2.5f, 1e-4f);
}

TEST(PbrtMedia, NanovdbWithEverything) {
    std::vector<test::Handle> grids;
    grids.push_back(three_voxels("heat", 3));
    grids.push_back(three_voxels("smoke"));
    grids.push_back(test::small_nanovdb("temperature"));
    const auto m = first_medium<SparseGridMedium>(
        with_nanovdb(grids, "\"string gridname\" \"smoke\" \"string temperaturename\" \"heat\" "
                            "\"float temperaturecutoff\" 3 \"float temperaturescale\" 2 \"float Lescale\" 7 "
                            "\"float scale\" 4 \"float g\" 0.1 \"float alpha\" 2 "
                            "\"spectrum sigma_a\" [300 1 900 4]"));
    EXPECT_EQ(m.density, 0u);
    EXPECT_EQ(m.temperature, 1u);
    EXPECT_EQ(m.temperature_offset, 3);
    EXPECT_EQ(m.temperature_scale, 2);
    EXPECT_EQ(m.le_scale, 7);
    EXPECT_EQ(m.scale, 4);
    EXPECT_EQ(std::get<Draine>(m.phase).alpha, 2);
    EXPECT_FALSE(m.sigma_a.is_constant());

    grids.clear();
    grids.push_back(test::small_nanovdb("temperature"));
    grids.push_back(three_voxels("density"));
    const SceneDescription d =
        with_nanovdb(grids, "\"string preset\" \"Skimmilk\" \"float temperatureoffset\" 5");
    const auto hot = first_medium<SparseGridMedium>(d);
    EXPECT_EQ(hot.temperature_offset, 5);
    EXPECT_FLOAT_EQ(value(d, hot.sigma_s, 450),
                    RgbUnboundedSpectrum(RgbColorSpace::srgb(), {0.70f, 1.22f, 1.90f})(450));
    // A point of the file in both grids.
    const PlacedSparseGrid file = NanovdbFile(test::nanovdb_bytes(grids), "f").read("temperature");
    const Vec3d in_density = hot.box.world_from_medium.inverse().point(Vec3d(1, 2, 3) + Vec3d(4, 0.5, 4.5));
    const Vec3d expected = file.file_from_grid.inverse().point(Vec3d(4, 0.5, 4.5));
    EXPECT_NEAR(length(hot.temperature_space_from_density.point(in_density) - expected), 0, 1e-9);
}

TEST(PbrtMedia, NanovdbRefusesWhatIsNoDensity) {
    const auto error = [](const std::vector<test::Handle>& grids, const std::string& parameters = {}) {
        try {
            with_nanovdb(grids, parameters);
        } catch (const Error& e) {
            const std::string what = e.what();
            return what.substr(what.find("f.nvdb"));
        }
        return std::string();
    };
    std::vector<test::Handle> grids;
    grids.push_back(three_voxels("density", -1));
    EXPECT_EQ(error(grids), "f.nvdb, grid 'density': has a negative value");
    EXPECT_EQ(error(grids, "\"string gridname\" \"x\""), "f.nvdb: has no grid 'x'; it has 'density'");
    grids.clear();
    grids.push_back(three_voxels("density"));
    EXPECT_EQ(error(grids), "");
    EXPECT_EQ(error(grids, "\"string temperaturename\" \"t\""), "f.nvdb: has no grid 't'; it has 'density'");
    nanovdb::GridBuilder<float> builder(0.25f, nanovdb::GridClass::FogVolume);
    builder.getAccessor().setValue(nanovdb::Coord(1, 1, 1), 1);
    grids.clear();
    grids.push_back(builder.getHandle(1.0, nanovdb::Vec3d(0), "density"));
    EXPECT_EQ(error(grids),
              "f.nvdb, grid 'density': has a density other than 0 outside its voxels (its background)");
}

// Media may be named before they are made; in blocks the state is that of attributes.
TEST(PbrtMedia, PlacesOfShapesAndCamera) {
    const SceneDescription d =
        parse("MediumInterface \"\" \"air\" Camera \"perspective\"\n" + medium("homogeneous") +
              "WorldBegin LightSource \"infinite\"\n"
              "Shape \"sphere\"\n"
              "AttributeBegin MediumInterface \"m\" \"air\" Material \"interface\" "
              "Shape \"sphere\" AttributeEnd\n"
              "MediumInterface \"m\" Shape \"disk\"\n"
              "MakeNamedMedium \"air\" \"string type\" \"cloud\"\n");
    ASSERT_EQ(d.scene.media.size(), 2u);
    EXPECT_EQ(d.scene.camera.medium, 1u);
    EXPECT_EQ(d.scene.shapes[0].media.inside, no_index);
    EXPECT_EQ(d.scene.shapes[0].media.outside, 1u);
    EXPECT_EQ(d.scene.shapes[1].media.inside, 0u);
    EXPECT_EQ(d.scene.shapes[1].media.outside, 1u);
    EXPECT_FALSE(d.scene.shapes[2].media.is_transition());
    EXPECT_TRUE(std::holds_alternative<InterfaceMaterial>(d.scene.materials[d.scene.shapes[1].material]));
}

TEST(PbrtMedia, TheOldNamesOfInterfaces) {
    for (const std::string name : {"", "none"}) {
        Warnings warnings;
        const SceneDescription d = parse_world(
            "LightSource \"infinite\" Material \"" + name + "\" Shape \"sphere\" Shape \"disk\"", &warnings);
        EXPECT_TRUE(std::holds_alternative<InterfaceMaterial>(d.scene.materials.at(0)));
        ASSERT_EQ(warnings.messages().size(), 1u);
        EXPECT_NE(warnings.messages()[0].find("deprecated; it is read as 'interface'"), std::string::npos);
    }
}

TEST(PbrtMedia, AttributesGiveDefaults) {
    const SceneDescription d =
        parse_world("Attribute \"medium\" \"float g\" 0.25 \"float density\" 2\n" + medium("cloud"));
    EXPECT_EQ(std::get<HenyeyGreenstein>(first_medium<CloudMedium>(d).phase).g, 0.25f);
    EXPECT_EQ(first_medium<CloudMedium>(d).density, 2);
}

} // namespace
} // namespace montelux
