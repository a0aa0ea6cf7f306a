// Files of measured BRDFs: read back, and damaged in every way.
#include "test/scene/measured_brdf_testing.h"
#include <functional>
#include <gtest/gtest.h>

#include "montelux/formats/measured_brdf_file.h"
#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

MeasuredBrdfData small_brdf() { return testing::measured_ggx({{0.5f, 0.5f}}, 8); }

std::string message_of_brdf(const std::vector<std::uint8_t>& bytes) {
    try {
        read_measured_brdf(bytes, "a.bsdf");
    } catch (const Error& e) {
        return e.what();
    }
    return "";
}

TEST(MeasuredBrdfFile, IsReadBack) {
    const MeasuredBrdfData d = small_brdf();
    const MeasuredBrdf read = read_measured_brdf(testing::measured_brdf_file(d).bytes(), "a.bsdf");
    const auto expect_same = [](const BrdfTables& a, const BrdfTables& b) {
        EXPECT_EQ(a.columns, b.columns);
        EXPECT_EQ(a.rows, b.rows);
        EXPECT_EQ(a.values, b.values);
    };
    EXPECT_EQ(read.data().theta, d.theta);
    EXPECT_EQ(read.data().phi, d.phi);
    EXPECT_EQ(read.data().wavelengths, d.wavelengths);
    expect_same(read.data().ndf, d.ndf);
    expect_same(read.data().sigma, d.sigma);
    expect_same(read.data().visible_normals, d.visible_normals);
    expect_same(read.data().luminance, d.luminance);
    expect_same(read.data().spectra, d.spectra);
}

TEST(MeasuredBrdfFile, Errors) {
    EXPECT_EQ(message_of_brdf({}), "a.bsdf: is no file of a measured BRDF (.bsdf)");
    std::vector<std::uint8_t> bytes = testing::measured_brdf_file(small_brdf()).bytes();
    EXPECT_EQ(message_of_brdf(bytes), "");
    bytes[12] = 2;
    EXPECT_EQ(message_of_brdf(bytes), "a.bsdf: has version 2 of the format; expected 1");
    testing::TensorFileWriter empty;
    EXPECT_EQ(message_of_brdf(empty.bytes()), "a.bsdf: has no field 'jacobian'");
    testing::TensorFileWriter odd;
    odd.add_text("jacobian", "\1");
    odd.add("theta_i", {1, 1}, {0});
    EXPECT_EQ(message_of_brdf(odd.bytes()),
              "a.bsdf: field 'theta_i' has another type or number of dimensions than a measured BRDF");
    MeasuredBrdfData d = small_brdf();
    d.sigma.values[0] = -1;
    EXPECT_EQ(message_of_brdf(testing::measured_brdf_file(d).bytes()),
              "a.bsdf: measured BRDF: sigma: a value is negative or not finite");
}

// Each byte of the header in turn, and each length: a value or an Error, and no more memory than the file has.
TEST(MeasuredBrdfFile, DamagedFilesAreNoDanger) {
    const std::vector<std::uint8_t> good = testing::measured_brdf_file(small_brdf()).bytes();
    int refused = 0;
    for (std::size_t i = 0; i < 420; ++i)
        for (std::uint8_t value : {0, 1, 127, 255}) {
            std::vector<std::uint8_t> bytes = good;
            bytes[i] = value;
            refused += message_of_brdf(bytes).empty() ? 0 : 1;
        }
    EXPECT_GT(refused, 400);
    for (std::size_t length = 0; length < 1000; ++length)
        EXPECT_NE(message_of_brdf({good.begin(), good.begin() + static_cast<std::ptrdiff_t>(length)}), "");
}

} // namespace
} // namespace montelux
