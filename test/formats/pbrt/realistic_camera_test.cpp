// Realistic cameras: lens files, units, and what is wrong with them.
#include "test/temporary_folder.h"
#include <fstream>
#include <gtest/gtest.h>
#include <string>

#include "montelux/formats/load_scene.h"
#include "montelux/image/image_write.h"
#include "montelux/mc/math/error.h"

namespace montelux::testing {
namespace {

class RealisticCameras : public ::testing::Test {
  protected:
    SceneDescription load(const std::string& lens, const std::string& parameters) {
        std::ofstream(folder_ / "lens.dat") << lens;
        std::ofstream(folder_ / "scene.pbrt")
            << "Film \"rgb\" \"float diagonal\" 20\nCamera \"realistic\" " << parameters << "\nWorldBegin\n"
            << "LightSource \"infinite\"\n";
        warnings_ = {};
        return load_scene(folder_ / "scene.pbrt", warnings_);
    }
    std::string error(const std::string& lens,
                      const std::string& parameters = "\"string lensfile\" \"lens.dat\"") {
        try {
            load(lens, parameters);
        } catch (const Error& e) {
            const std::string text = e.what();
            const std::size_t place = text.find(folder_.path().string());
            return place == 0 ? text.substr(folder_.path().string().size() + 1) : text;
        }
        return "";
    }

    TemporaryFolder folder_;
    Warnings warnings_;
};

constexpr const char* singlet =
    "# r, thickness, eta, diameter\n50 3 1.5 20\n-50 1 1 20 # glass ends\n0 50 0 12\n";

TEST_F(RealisticCameras, AreReadInMillimetres) {
    const SceneDescription d = load(
        singlet, "\"string lensfile\" \"lens.dat\" \"float aperturediameter\" 4 \"float focusdistance\" 2");
    const auto& camera = std::get<RealisticCamera>(d.scene.camera.model);
    ASSERT_EQ(camera.surfaces.size(), 3u);
    EXPECT_FLOAT_EQ(camera.surfaces[0].radius, 0.05f);
    EXPECT_FLOAT_EQ(camera.surfaces[0].thickness, 0.003f);
    EXPECT_EQ(camera.surfaces[0].eta, 1.5f);
    EXPECT_FLOAT_EQ(camera.surfaces[1].aperture_radius, 0.01f);
    EXPECT_FLOAT_EQ(camera.surfaces[2].aperture_radius, 0.002f);
    EXPECT_EQ(camera.focus_distance, 2);
    EXPECT_FLOAT_EQ(camera.film_diagonal, 0.02f);
    EXPECT_TRUE(warnings_.messages().empty());
}

TEST_F(RealisticCameras, CannotOpenWiderThanTheLens) {
    load(singlet, "\"string lensfile\" \"lens.dat\" \"float aperturediameter\" 13");
    ASSERT_EQ(warnings_.messages().size(), 1u);
    EXPECT_NE(warnings_.messages()[0].find("no wider aperture than 12"), std::string::npos);
}

TEST_F(RealisticCameras, AperturesByNameAndByFile) {
    for (const char* name : {"gaussian", "square", "pentagon", "star"}) {
        const SceneDescription d = load(singlet, "\"string lensfile\" \"lens.dat\" \"string aperture\" \"" +
                                                     std::string(name) + "\"");
        EXPECT_EQ(std::get<RealisticCamera>(d.scene.camera.model).aperture, find_aperture(name));
    }
    Image half(2, 2, {"Y"}, PixelFormat::f32, ColorEncoding::linear());
    half.f32()[0] = 4; // the upper left pixel alone
    write_image(folder_ / "half.pfm", half);
    const SceneDescription d =
        load(singlet, "\"string lensfile\" \"lens.dat\" \"string aperture\" \"half.pfm\"");
    const AperturePicture& picture = *std::get<RealisticCamera>(d.scene.camera.model).aperture;
    EXPECT_FLOAT_EQ(picture.at(-0.5, 0.5), 3.1415927f);
    EXPECT_EQ(picture.at(0.5, -0.5), 0);
    // Of colours their mean.
    Image colored(2, 2, {"R", "G", "B"}, PixelFormat::f32, ColorEncoding::linear());
    colored.f32()[0] = 6;
    colored.f32()[11] = 2; // blue, at the lower right
    write_image(folder_ / "colored.pfm", colored);
    const SceneDescription of_colors =
        load(singlet, "\"string lensfile\" \"lens.dat\" \"string aperture\" \"colored.pfm\"");
    const AperturePicture& mean = *std::get<RealisticCamera>(of_colors.scene.camera.model).aperture;
    EXPECT_FLOAT_EQ(mean.at(-0.5, 0.5), 3 * mean.at(0.5, -0.5));
    EXPECT_GT(mean.at(0.5, -0.5), 0);
}

TEST_F(RealisticCameras, MistakesAreNamed) {
    EXPECT_EQ(error("50 3 1.5\n").substr(0, 40),
              "scene.pbrt:2:20: '" + (folder_ / "lens.dat").string().substr(0, 22));
    EXPECT_NE(error("50 3 1.5\n").find("has 3 numbers; expected rows of 4"), std::string::npos);
    EXPECT_NE(error("").find("has 0 numbers"), std::string::npos);
    EXPECT_NE(error("50 3 glass 20\n").find("lens.dat:1:6: expected a number"), std::string::npos)
        << error("50 3 glass 20\n");
    EXPECT_NE(error("-50 3 1.5 20\n50 50 1 20\n").find("does not converge light"), std::string::npos);
    EXPECT_NE(error(singlet, "\"string lensfile\" \"lens.dat\" \"float focusdistance\" 0.1")
                  .find("cannot focus at"),
              std::string::npos);
    const auto aperture_error = [&](const std::string& name) {
        return error(singlet, "\"string lensfile\" \"lens.dat\" \"string aperture\" \"" + name + "\"");
    };
    EXPECT_NE(aperture_error("pentagn").find(
                  "parameter 'aperture' is 'pentagn'; expected one of gaussian, square, pentagon, star, or "
                  "the file of a picture (did you mean 'pentagon'?)"),
              std::string::npos)
        << aperture_error("pentagn");
    EXPECT_NE(aperture_error("hexagon.png").find("hexagon.png"), std::string::npos);
    Image black(2, 2, {"Y"}, PixelFormat::u8, ColorEncoding::srgb());
    write_image(folder_ / "black.png", black);
    EXPECT_NE(error(singlet, "\"string lensfile\" \"lens.dat\" \"string aperture\" \"black.png\"")
                  .find("lets no light through"),
              std::string::npos);
    EXPECT_NE(error(singlet, "\"string lensfile\" \"none.dat\"").find("none.dat"), std::string::npos);
    std::string many;
    for (int i = 0; i < 101; ++i) many += "1e5 1e-3 1 24\n";
    EXPECT_NE(error(many).find("lens.dat' has more than 100 surfaces"), std::string::npos) << error(many);
}

} // namespace
} // namespace montelux::testing
