// Scenes in pbrt's syntax: settings, what is lost, and what failures leave.
#include "test/formats/pbrt/round_trip.h"
#include "test/formats/pbrt/write_pbrt_testing.h"
#include <functional>

#include "montelux/formats/pbrt/write_pbrt.h"

namespace montelux {
namespace {

using test::expect_round_trip;

TEST_F(WritePbrt, Settings) {
    const char* settings[] = {
        R"(LookAt 1 2 3 0.3 0.2 0.1 0 1 0.1 Camera "perspective" "float fov" 33.3 "float lensradius" 0.1
           "float screenwindow" [-1 1 -0.5 0.7] "float shutterclose" 0.5
           Film "rgb" "integer xresolution" 30 "integer yresolution" 20 "string filename" "a.exr" "float iso" 400
           "float exposuretime" 0.3 "integer pixelbounds" [1 20 2 19] "float maxcomponentvalue" 10
           "float whitebalance" 5000 "string sensor" "canon_eos_5d_mkiv" "bool savefp16" true
           PixelFilter "mitchell" "float xradius" 1.5 "float B" 0.2 Sampler "halton" "integer pixelsamples" 7 "integer seed" 5
           Integrator "volpath" "integer maxdepth" 9 "string lightsampler" "power" "bool regularize" true
           "string shadingterminator" "soft" "string microfacetscattering" "multiple"
           "string environmentlookup" "bilinear" "rgb background" [0.1 0.2 0.3] "bool countpassages" false)",
        R"(Scale -1 1 1 Camera "orthographic" "float frameaspectratio" 2 Film "spectral" "integer nbuckets" 5
           PixelFilter "sinc" "float tau" 2 Sampler "stratified" "integer xsamples" 3 "integer ysamples" 5
           Integrator "simplepath" "bool samplelights" false)",
        R"(Camera "spherical" "string mapping" "equirectangular" Film "gbuffer" "string coordinatesystem" "world"
           PixelFilter "box" Sampler "independent" Integrator "ambientocclusion" "float maxdistance" 3)",
        R"(ActiveTransform EndTime Translate 0 0 1 ActiveTransform All Camera "perspective"
           PixelFilter "triangle" Sampler "sobol" Integrator "randomwalk" "integer maxdepth" 3)"};
    for (const char* text : settings) {
        SCOPED_TRACE(text);
        EXPECT_EQ(round_trip(std::string(text) + " WorldBegin Shape \"sphere\""), Texts());
    }
}

TEST_F(WritePbrt, RealisticCamera) {
    write_bytes(folder_ / "lens.dat", "35.98738 1.21638 1.54 23.716\n11.69718 9.9957 1 17.996\n"
                                      "13.08714 5.12622 1.772 12.364\n-22.63294 1.76924 1.617 9.812\n"
                                      "71.05802 0.8184 1 9.152\n0 2.27766 0 8.756\n"
                                      "-9.58584 2.43254 1.617 8.184\n-11.28864 0.11506 1 9.152\n"
                                      "-166.7765 3.09606 1.713 10.648\n-7.5911 1.32682 1.805 11.44\n"
                                      "-16.7662 3.98068 1 12.276\n-7.70286 1.21638 1.617 13.42\n"
                                      "-11.97328 2 1 17.996\n");
    EXPECT_EQ(round_trip(R"(Camera "realistic" "string lensfile" "lens.dat" "float aperturediameter" 3
        "string aperture" "pentagon" Film "rgb" "float diagonal" 16 WorldBegin Shape "sphere")"),
              Texts());
}

// What the format cannot hold.
TEST_F(WritePbrt, SaysWhatIsLost) {
    const auto warnings_of = [&](const std::function<void(SceneDescription&)>& change) {
        SceneDescription d =
            parse("WorldBegin LightSource \"point\" Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0]");
        change(d);
        Warnings warnings;
        write_pbrt(d, folder_ / "a.pbrt", warnings);
        return warnings.messages().empty() ? std::string() : warnings.messages()[0];
    };
    EXPECT_EQ(warnings_of([](SceneDescription&) {}), "");
    EXPECT_NE(warnings_of([](SceneDescription& d) {
                  d.integrator.heuristic = Heuristic::balance;
              }).find("--heuristic balance"),
              std::string::npos);
    EXPECT_NE(
        warnings_of([](SceneDescription& d) { d.film.layers.set.add(Layer::position); }).find("--layers"),
        std::string::npos);
    EXPECT_NE(warnings_of([](SceneDescription& d) { d.sampler.seed = 1ull << 40; }).find("--seed"),
              std::string::npos);
    EXPECT_NE(warnings_of([](SceneDescription& d) {
                  TriangleMesh& m = d.scene.meshes[0];
                  m.end_positions = m.positions;
              }).find("deforms"),
              std::string::npos);
    EXPECT_NE(warnings_of([](SceneDescription& d) { d.scene.lights.push_back(SunLight{}); }).find("left out"),
              std::string::npos);
}

TEST_F(WritePbrt, NothingIsLeftOfAFailure) {
    SceneDescription d = parse("WorldBegin Shape \"loopsubdiv\" \"integer levels\" 4 \"point3 P\" "
                               "[0 0 0 1 0 0 0 1 0 0 0 1] \"integer indices\" [0 2 1 0 1 3 1 2 3 0 3 2]");
    Warnings warnings;
    expect_error([&] { write_pbrt(d, folder_ / "a.txt", warnings); }, {"a.txt", ".pbrt"});
    d.scene.sparse_grids.push_back(
        SparseGrid{.node_count = {100, 100, 100},
                   .nodes = std::vector<std::uint32_t>(1000000, SparseGrid::constant_entry | 1u),
                   .blocks = {},
                   .values = {},
                   .constants = {0, 1}});
    d.scene.media.push_back(SparseGridMedium{.box = {}, .density = 0, .temperature_space_from_density = {}});
    expect_error([&] { write_pbrt(d, folder_ / "a.pbrt", warnings); }, {"medium 0", "NanoVDB"});
    d.scene.media.clear();
    d.scene.materials.push_back(DiffuseMaterial{{.value = 0.0f / 0.0f}});
    EXPECT_THROW(write_pbrt(d, folder_ / "a.pbrt", warnings), Error);
    expect_error([&] { write_pbrt(d, folder_ / "none/a.pbrt", warnings); }, {"none/a.pbrt"});
    EXPECT_EQ(folder_.file_count(), 0);
}

} // namespace
} // namespace montelux
