// Whole scenes of pbrt-v4 users.
#include "test/formats/nanovdb_writing.h"
#include "test/temporary_folder.h"
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <gtest/gtest.h>
#include <nanovdb/util/GridValidator.h>

#include "montelux/formats/pbrt/load_pbrt.h"
#include "montelux/mc/math/error.h"
#include "montelux/scene/scene_digest.h"

namespace montelux {
namespace {

std::filesystem::path folder() { return std::filesystem::path(MONTELUX_SHARED_DIR) / "scenes/pbrt"; }

struct Counts {
    const char* name;
    std::size_t triangles, quadrics, shapes, lights, images, environments;
    int width, height, max_depth;
    std::uint32_t samples;
};

TEST(PbrtScenes, Counts) {
    if (!std::filesystem::exists(folder())) GTEST_SKIP() << "no shared files";
    // killeroo: 8,316 triangles, refined once and three times. The others by their PLY headers and index
    // lists.
    const Counts all[] = {
        {"cornell-box", 36, 0, 8, 1, 0, 0, 400, 400, 65, 1},
        {"veach-mis", 52, 3, 9, 3, 0, 0, 400, 225, 3, 1},
        {"killeroo-simple", 2 * 8316 * 4 + 4, 1, 5, 1, 0, 0, 400, 400, 5, 256},
        {"killeroo-gold", 8316 * 64 + 6, 1, 5, 2, 1, 0, 400, 300, 5, 512},
        {"coffee", 235271, 0, 23, 3, 0, 0, 400, 500, 17, 64},
        {"material-testball", 67456, 0, 2, 1, 0, 1, 400, 225, 65, 8},
    };
    for (const Counts& c : all) {
        SCOPED_TRACE(c.name);
        Warnings warnings;
        SceneDescription d = load_pbrt(folder() / c.name / "scene.pbrt", warnings);
        std::size_t triangles = 0;
        for (const TriangleMesh& m : d.scene.meshes) {
            triangles += m.triangle_count();
            EXPECT_TRUE(m.normals.empty() || m.normals.size() == m.positions.size());
            EXPECT_TRUE(m.uvs.empty() || m.uvs.size() == m.positions.size());
        }
        EXPECT_EQ(triangles, c.triangles);
        EXPECT_EQ(d.scene.quadrics.size(), c.quadrics);
        EXPECT_EQ(d.scene.shapes.size(), c.shapes);
        EXPECT_EQ(d.scene.world_shapes.size(), c.shapes);
        EXPECT_EQ(d.scene.lights.size(), c.lights);
        EXPECT_EQ(d.scene.images.size(), c.images);
        EXPECT_EQ(d.scene.environments.size(), c.environments);
        EXPECT_EQ(d.film.width, c.width);
        EXPECT_EQ(d.film.height, c.height);
        EXPECT_EQ(d.integrator.max_depth, c.max_depth);
        EXPECT_EQ(d.sampler.spp, c.samples);
        for (const Shape& s : d.scene.shapes) EXPECT_LT(s.material, d.scene.materials.size());
        std::size_t expected_warnings = std::string(c.name) == "cornell-box" ? 1 : 0; // its Accelerator
        EXPECT_EQ(warnings.messages().size(), expected_warnings);
    }
}

// The file that a script wrote is a NanoVDB file in every sense.
TEST(PbrtScenes, TheCloudIsRead) {
    const std::filesystem::path cloud = std::filesystem::path(MONTELUX_SOURCE_DIR) / "scenes/cloud";
    Warnings warnings;
    const Scene read = load_pbrt(cloud / "cloud.pbrt", warnings).scene;
    EXPECT_TRUE(warnings.messages().empty());
    ASSERT_EQ(read.sparse_grids.size(), 1u);
    const auto handle = nanovdb::io::readGrid((cloud / "cloud.nvdb").string());
    ASSERT_NE(handle.grid<float>(), nullptr);
    EXPECT_TRUE(nanovdb::isValid(*handle.grid<float>(), true, false));
    const nanovdb::NanoGrid<float>& grid = *handle.grid<float>();
    const auto accessor = grid.getAccessor();
    const auto& medium = std::get<SparseGridMedium>(read.media.at(0));
    std::uint64_t voxels = 0;
    for (auto it = grid.indexBBox().begin(); it; ++it) {
        const nanovdb::Vec3d at = grid.indexToWorld(nanovdb::Vec3d((*it)[0], (*it)[1], (*it)[2]));
        const Vec3d p = medium.box.world_from_medium.inverse().point(Vec3d(at[0], at[1], at[2]));
        const auto i = [](double x) { return static_cast<int>(std::lround(x)); };
        const float value = accessor.getValue(*it);
        ASSERT_EQ(read.sparse_grids[0].value(i(p.x), i(p.y), i(p.z)), value);
        voxels += value > 0;
    }
    EXPECT_EQ(voxels, grid.activeVoxelCount());
}

TEST(PbrtScenes, HairIsRead) {
    if (!std::filesystem::exists(folder())) GTEST_SKIP() << "no shared files";
    Warnings warnings;
    const Scene read = load_pbrt(folder() / "hair-curl" / "scene.pbrt", warnings).scene;
    ASSERT_EQ(read.curves.size(), 1u);
    EXPECT_EQ(read.curves[0].kind, Curves::Kind::cylinder);
    EXPECT_GT(read.curves[0].segment_count(), 60u);
    EXPECT_TRUE(warnings.messages().empty());
}

TEST(PbrtScenes, MotionIsRead) {
    if (!std::filesystem::exists(folder())) GTEST_SKIP() << "no shared files";
    Warnings warnings;
    const Scene read = load_pbrt(folder() / "killeroo-moving" / "scene.pbrt", warnings).scene;
    EXPECT_EQ(read.motions.size(), 2u);
    EXPECT_FALSE(read.camera.motion.has_value());
}

TEST(PbrtScenes, MediaAreRead) {
    if (!std::filesystem::exists(folder())) GTEST_SKIP() << "no shared files";
    const auto load = [](const char* name) {
        Warnings warnings;
        return load_pbrt(folder() / name / "scene.pbrt", warnings).scene;
    };
    const auto transitions = [](const Scene& read) {
        return std::count_if(read.shapes.begin(), read.shapes.end(),
                             [](const Shape& s) { return s.media.is_transition(); });
    };
    const Scene stairs = load("staircase2"), caustic = load("volumetric-caustic");
    EXPECT_EQ(stairs.media.size(), 1u);
    EXPECT_EQ(transitions(stairs), 1);
    EXPECT_EQ(caustic.media.size(), 1u);
    EXPECT_EQ(transitions(caustic), 3); // the wall in front, the ball, the lamp
    EXPECT_EQ(caustic.camera.medium, no_index);
}

// Of values, not of where the files lie.
TEST(PbrtScenes, CopiesHaveTheSameDigest) {
    if (!std::filesystem::exists(folder())) GTEST_SKIP() << "no shared files";
    const TemporaryFolder temporary;
    const std::filesystem::path copy = temporary / "killeroo-gold";
    std::filesystem::copy(folder() / "killeroo-gold", copy, std::filesystem::copy_options::recursive);
    auto hash = [](const std::filesystem::path& path) {
        Warnings warnings;
        return digest_of(load_pbrt(path / "scene.pbrt", warnings).scene);
    };
    EXPECT_EQ(hash(copy), hash(folder() / "killeroo-gold"));
    for (const auto& entry : std::filesystem::recursive_directory_iterator(copy))
        std::filesystem::permissions(entry, std::filesystem::perms::owner_all,
                                     std::filesystem::perm_options::add);
}

} // namespace
} // namespace montelux
