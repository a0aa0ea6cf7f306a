// Media of Mitsuba scenes, and volume files.
#include "test/formats/mitsuba/looks.h"
#include <cstring>
#include <gtest/gtest.h>

#include "montelux/formats/mitsuba/grid_volume.h"

namespace montelux::mitsuba_media_test {
namespace {

using test::expect_says;
using test::look_error;
using test::Looks;

using VolumeBytes = std::vector<std::uint8_t>;

template <typename T>
void append(VolumeBytes& bytes, T value) {
    std::uint8_t raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    bytes.insert(bytes.end(), raw, raw + sizeof(T));
}

// A volume file with the box from (0, 0, 0) to (2, 4, 8).
VolumeBytes volume_file(std::array<std::int32_t, 3> size, std::int32_t channels,
                        const std::vector<float>& values) {
    VolumeBytes bytes{'V', 'O', 'L', 3};
    append(bytes, std::int32_t{1});
    for (const std::int32_t n : size) append(bytes, n);
    append(bytes, channels);
    for (const float x : {0.0f, 0.0f, 0.0f, 2.0f, 4.0f, 8.0f}) append(bytes, x);
    for (const float v : values) append(bytes, v);
    return bytes;
}

std::string volume_error(const VolumeBytes& bytes) {
    try {
        mitsuba::read_grid_volume(bytes, "a.vol");
    } catch (const Error& e) {
        return e.what();
    }
    return {};
}

TEST(MitsubaVolumeFile, IsRead) {
    const VolumeBytes bytes = volume_file({2, 1, 3}, 1, {1, 2, 3, 4, 5, 6});
    const mitsuba::GridVolume v = mitsuba::read_grid_volume(bytes, "a.vol");
    EXPECT_EQ(v.size, (std::array{2, 1, 3}));
    EXPECT_EQ(v.channels, 1);
    EXPECT_EQ(v.upper, (Point3f{2, 4, 8}));
    EXPECT_EQ(v.values, (std::vector<float>{1, 2, 3, 4, 5, 6}));
}

TEST(MitsubaVolumeFile, SaysWhatIsWrong) {
    EXPECT_EQ(volume_error({}), "a.vol: is no volume file (.vol)");
    VolumeBytes bytes = volume_file({1, 1, 1}, 1, {1});
    EXPECT_EQ(volume_error(bytes), "");
    bytes[3] = 2;
    EXPECT_EQ(volume_error(bytes), "a.vol: has version 2 of the format; expected 3");
    bytes[3] = 3;
    bytes[4] = 4;
    EXPECT_EQ(volume_error(bytes), "a.vol: has samples of encoding 4; expected 1, 32-bit floats");
    expect_says(volume_error(volume_file({1, 0, 1}, 1, {1})), "has 0 samples along y");
    expect_says(volume_error(volume_file({1, -4, -1}, 1, {1, 2, 3, 4})), "has -4 samples along y");
    expect_says(volume_error(volume_file({1, 1, 1}, 2, {1, 2})), "has 2 channels; expected 1, 3 or 6");
    expect_says(volume_error(volume_file({2, 1, 1}, 1, {1})), "ends before its last sample");
    expect_says(volume_error(volume_file({1 << 30, 1 << 30, 1 << 30}, 6, {1})),
                "ends before its last sample");
    expect_says(volume_error(volume_file({1, 1, 1}, 1, {std::numeric_limits<float>::infinity()})),
                "not finite");
}

// Each byte in turn, and each length: values or an Error.
TEST(MitsubaVolumeFile, DamagedOnesAreReadOrRefused) {
    const VolumeBytes bytes = volume_file({2, 1, 1}, 3, {1, 2, 3, 4, 5, 6});
    for (std::size_t i = 0; i < bytes.size(); ++i)
        for (const std::uint8_t value : {0, 1, 127, 128, 255}) {
            VolumeBytes damaged = bytes;
            damaged[i] = value;
            try {
                EXPECT_LE(mitsuba::read_grid_volume(damaged, "a.vol").values.size(), 6u);
            } catch (const Error& e) {
                EXPECT_TRUE(std::string(e.what()).starts_with("a.vol: ")) << e.what();
            }
        }
    for (std::size_t n = 0; n < bytes.size(); ++n)
        EXPECT_NE(volume_error(VolumeBytes(bytes.begin(), bytes.begin() + std::ptrdiff_t(n))), "") << n;
}

std::string medium(const std::string& properties, const std::string& type = "homogeneous") {
    return "<medium type=\"" + type + "\">" + properties + "</medium>";
}
const std::map<std::string, VolumeBytes> volumes{
    {"grey.vol", volume_file({1, 1, 2}, 1, {1, 3})},
    {"color.vol", volume_file({1, 1, 2}, 3, {0.9f, 0.5f, 0.1f, 0.2f, 0.3f, 0.4f})},
    {"flakes.vol", volume_file({1, 1, 1}, 6, {1, 1, 1, 0, 0, 0})},
    {"negative.vol", volume_file({1, 1, 1}, 1, {-1})}};
std::string medium_error(const std::string& content) {
    return look_error(
        content, [](Looks& looks) { looks.media.of(looks.plugin("medium")); }, volumes);
}
template <typename M>
M read(Looks& looks) {
    const Index index = looks.media.of(looks.plugin("medium"));
    EXPECT_EQ(looks.media.of(looks.plugin("medium")), index);
    EXPECT_TRUE(looks.warnings.messages().empty());
    return std::get<M>(looks.scene.media.at(index));
}
template <typename M>
M read(const std::string& content) {
    Looks looks(content, volumes);
    return read<M>(looks);
}

TEST(MitsubaHomogeneousMedium, HasExtinctionAndAlbedo) {
    const auto standard = read<HomogeneousMedium>(medium(""));
    EXPECT_FLOAT_EQ(standard.sigma_s.constant, 0.75f);
    EXPECT_FLOAT_EQ(standard.sigma_a.constant, 0.25f);
    EXPECT_EQ(std::get<HenyeyGreenstein>(standard.phase).g, 0);
    const auto m = read<HomogeneousMedium>(medium(
        "<float name=\"sigma_t\" value=\"4\"/><float name=\"albedo\" value=\"0.5\"/><float name=\"scale\" "
        "value=\"3\"/><boolean name=\"sample_emitters\" value=\"false\"/>"));
    EXPECT_FLOAT_EQ(m.sigma_s.constant, 2);
    EXPECT_FLOAT_EQ(m.sigma_a.constant, 2);
    EXPECT_FLOAT_EQ(m.scale, 3);
}

TEST(MitsubaHomogeneousMedium, ColorsAreMultipliedByWavelength) {
    Looks looks(
        medium("<rgb name=\"sigma_t\" value=\"0.5 0.4 0.3\"/><rgb name=\"albedo\" value=\"0.9 0.5 0.1\"/>"));
    const auto m = read<HomogeneousMedium>(looks);
    const RgbAlbedoSpectrum t(RgbColorSpace::srgb(), {0.5f, 0.4f, 0.3f}),
        a(RgbColorSpace::srgb(), {0.9f, 0.5f, 0.1f});
    for (const float lambda : {400.0f, 500.0f, 600.0f, 700.0f}) {
        EXPECT_NEAR(spectrum_of(m.sigma_s, looks.scene.spectra)(lambda), t(lambda) * a(lambda), 1e-5);
        EXPECT_NEAR(spectrum_of(m.sigma_a, looks.scene.spectra)(lambda), t(lambda) * (1 - a(lambda)), 1e-5);
    }
}

TEST(MitsubaHomogeneousMedium, MayHaveAGridOfAlbedo) {
    Looks looks(
        medium("<volume type=\"gridvolume\" name=\"albedo\"><string name=\"filename\" value=\"color.vol\"/>"
               "</volume><float name=\"sigma_t\" value=\"2\"/>"),
        volumes);
    const auto m = read<FieldMedium>(looks);
    EXPECT_FALSE(m.bounded);
    EXPECT_FLOAT_EQ(m.extinction.value.constant, 2);
    EXPECT_EQ(looks.scene.color_grids.at(m.albedo.colors).values.size(), 2u);
    EXPECT_EQ(m.albedo.wrap, GridWrap::clamp);
    for (const auto& [name, wrap] :
         {std::pair{"clamp", GridWrap::clamp}, std::pair{"repeat", GridWrap::repeat},
          std::pair{"mirror", GridWrap::mirror}})
        EXPECT_EQ(
            read<FieldMedium>(medium("<volume type=\"gridvolume\" name=\"albedo\"><string name=\"filename\" "
                                     "value=\"color.vol\"/><string name=\"wrap_mode\" value=\"" +
                                     std::string(name) + "\"/></volume>"))
                .albedo.wrap,
            wrap);
}

TEST(MitsubaHeterogeneousMedium, HasAGridInAPlace) {
    const std::string grid =
        "<volume type=\"gridvolume\" name=\"sigma_t\"><string name=\"filename\" value=\"grey.vol\"/><string "
        "name=\"filter_type\" value=\"nearest\"/><transform name=\"to_world\"><scale value=\"2\"/><translate "
        "x=\"1\"/></transform>";
    Looks looks(
        medium(grid + "</volume><float name=\"albedo\" value=\"0.9\"/><float name=\"scale\" value=\"5\"/>"
                      "<phase type=\"hg\"><float name=\"g\" value=\"0.3\"/></phase>",
               "heterogeneous"),
        volumes);
    const auto m = read<FieldMedium>(looks);
    EXPECT_TRUE(m.bounded);
    EXPECT_EQ(m.box.p0, (Point3f{1, 0, 0}));
    EXPECT_EQ(m.box.p1, (Point3f{3, 2, 2}));
    EXPECT_EQ(m.extinction.unit_from_world.point({1, 1, 2}), (Point3f{0, 0.5f, 1}));
    EXPECT_TRUE(m.extinction.nearest);
    EXPECT_EQ(looks.scene.scalar_grids.at(m.extinction.scalars).values, (std::vector<float>{1, 3}));
    EXPECT_FLOAT_EQ(m.albedo.value.constant, 0.9f);
    EXPECT_FLOAT_EQ(m.scale, 5);
    EXPECT_FLOAT_EQ(std::get<HenyeyGreenstein>(m.phase).g, 0.3f);
    looks.builder.finish({}, false);

    const auto boxed = read<FieldMedium>(
        medium(grid + "<boolean name=\"use_grid_bbox\" value=\"true\"/></volume>", "heterogeneous"));
    EXPECT_EQ(boxed.box.p1, (Point3f{5, 8, 16}));
    EXPECT_EQ(boxed.extinction.unit_from_world.point({5, 4, 16}), (Point3f{1, 0.5f, 1}));
}

TEST(MitsubaHeterogeneousMedium, ConstantColorsAreThoseOfReflectancesWhereTheyCanBe) {
    Looks looks(
        medium("<volume type=\"constvolume\" name=\"sigma_t\"><rgb name=\"value\" value=\"0.5 0.4 0.3\"/>"
               "</volume>",
               "heterogeneous"));
    looks.expect_albedo({read<FieldMedium>(looks).extinction.value}, {}, {0.5f, 0.4f, 0.3f});
    EXPECT_EQ(medium_error(
                  medium("<volume type=\"constvolume\" name=\"sigma_t\"><rgb name=\"value\" value=\"5 4 3\"/>"
                         "</volume>",
                         "heterogeneous")),
              "");
}

// The unit cube bounds it as well where it is the same everywhere.
TEST(MitsubaHeterogeneousMedium, MayBeConstant) {
    const auto m = read<FieldMedium>(
        medium("<volume type=\"constvolume\" name=\"sigma_t\"><float name=\"value\" value=\"3\"/><transform "
               "name=\"to_world\"><translate x=\"-0.5\"/></transform></volume>",
               "heterogeneous"));
    EXPECT_TRUE(m.bounded);
    EXPECT_EQ(m.box.p0, (Point3f{-0.5f, 0, 0}));
    EXPECT_FLOAT_EQ(m.extinction.value.constant, 3);
}

TEST(MitsubaMedia, PhaseFunctions) {
    const auto phase = [](const std::string& type, const std::string& properties = "") {
        return read<HomogeneousMedium>(medium("<phase type=\"" + type + "\">" + properties + "</phase>"))
            .phase;
    };
    EXPECT_EQ(std::get<HenyeyGreenstein>(phase("isotropic")).g, 0);
    EXPECT_FLOAT_EQ(std::get<HenyeyGreenstein>(phase("hg")).g, 0.8f);
    EXPECT_EQ(std::get<Draine>(phase("rayleigh")).alpha, 1);
    EXPECT_EQ(std::get<Draine>(phase("rayleigh")).g, 0);
    expect_says(medium_error(medium("<phase type=\"sggx\"/>")), "the phase 'sggx' is not supported");
    expect_says(medium_error(medium("<phase type=\"hg\"><float name=\"g\" value=\"1\"/></phase>")),
                "'g' is 1;");
    expect_says(medium_error(medium("<phase type=\"hg\"/><phase type=\"hg\"/>")),
                "several objects of the kind 'phase'");
}

TEST(MitsubaMedia, SayWhatIsWrong) {
    const auto grid = [](const std::string& file, const std::string& type = "heterogeneous") {
        return medium("<volume type=\"gridvolume\" name=\"sigma_t\"><string name=\"filename\" value=\"" +
                          file + "\"/></volume>",
                      type);
    };
    expect_says(medium_error(medium("<float name=\"sigma_s\" value=\"1\"/>")),
                "'sigma_s' is not supported; expected 'sigma_t' and 'albedo'");
    expect_says(medium_error(medium("<float name=\"albedo\" value=\"1.1\"/>")),
                "'albedo' is 1.1; expected a number from 0 to 1");
    expect_says(medium_error(medium("<float name=\"sigma_t\" value=\"-1\"/>")), "'sigma_t' lies below 0");
    expect_says(medium_error(medium("", "heterogenous")), "did you mean 'heterogeneous'?");
    expect_says(medium_error(grid("none.vol")), "there is no file 'none.vol'");
    expect_says(medium_error(grid("flakes.vol")), "flakes.vol: has 6 channels; expected 1 or 3");
    expect_says(medium_error(grid("negative.vol")), "negative.vol: has a negative sample");
    expect_says(medium_error(grid("grey.vol", "homogeneous")), "expected a medium 'heterogeneous'");
    expect_says(medium_error(medium("<volume type=\"gridvolume\" name=\"sigma_t\"/>", "heterogeneous")),
                "needs the property 'filename'");
}

} // namespace
} // namespace montelux::mitsuba_media_test
