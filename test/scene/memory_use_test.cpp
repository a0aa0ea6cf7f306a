// The memory of a scene by kind: what the containers say is what the heap gave.
#include "test/sanitized.h"
#include <algorithm>
#include <gtest/gtest.h>
#include <malloc.h>
#include <memory>
#include <string_view>
#include <vector>

#include "montelux/scene/build/scene_builder.h"
#include "montelux/scene/memory_use.h"
#include "montelux/scene/scene_tables.h"

namespace montelux {
namespace {

std::size_t bytes_of(const std::vector<MemoryUse>& table, std::string_view kind) {
    for (const MemoryUse& use : table)
        if (use.kind == kind) return use.bytes;
    return 0;
}
std::size_t sum_of(const std::vector<MemoryUse>& table) {
    std::size_t sum = 0;
    for (const MemoryUse& use : table) sum += use.bytes;
    return sum;
}

TriangleMesh strip(std::size_t vertices) {
    TriangleMesh mesh;
    for (std::size_t i = 0; i < vertices; ++i) {
        const std::size_t row = i / 2;
        mesh.positions.emplace_back(static_cast<float>(row), static_cast<float>(i % 2), 0.0f);
        mesh.normals.emplace_back(0.0f, 0.0f, 1.0f);
        mesh.uvs.emplace_back(0.5f, 0.5f);
    }
    for (std::size_t i = 0; i + 2 < vertices; ++i)
        for (std::size_t k = 0; k < 3; ++k) mesh.indices.push_back(static_cast<Index>(i + k));
    return mesh;
}

// The sum of all vertex values and indices, 4 bytes each.
std::size_t raw_bytes(const TriangleMesh& m) {
    return m.positions.size() * 12 + m.normals.size() * 12 + m.uvs.size() * 8 + m.indices.size() * 4;
}

// Whatever room reading left over.
TEST(MemoryUse, MeshesTakeLittleMoreThanTheirData) {
    for (const std::size_t vertices :
         {std::size_t{100}, std::size_t{1030}, std::size_t{40000}, std::size_t{70000}}) {
        Scene scene;
        CallMessages messages("a test");
        TriangleMesh mesh = strip(vertices);
        const std::size_t raw = raw_bytes(mesh);
        mesh.indices.reserve(2 * mesh.indices.size());
        mesh.uvs.reserve(2 * mesh.uvs.size());
        SceneBuilder(scene, messages).add_shape(std::move(mesh), {});
        const auto taken = static_cast<double>(bytes_of(memory_use(scene), "triangle meshes"));
        EXPECT_GE(taken, static_cast<double>(raw + sizeof(TriangleMesh)));
        EXPECT_LE(taken, 1.13 * static_cast<double>(raw) + 200) << vertices;
    }
}

TEST(MemoryUse, MeshesThatDeformTakeTheirEndsAsWell) {
    Scene scene;
    CallMessages messages("a test");
    TriangleMesh mesh = strip(40000);
    mesh.end_positions = mesh.positions;
    mesh.end_normals = mesh.normals;
    const std::size_t raw = raw_bytes(mesh) + 40000 * 24;
    mesh.end_positions.reserve(80000);
    mesh.end_normals.reserve(80000);
    SceneBuilder(scene, messages).add_shape(std::move(mesh), {});
    const std::size_t taken = bytes_of(memory_use(scene), "triangle meshes");
    EXPECT_GE(taken, raw + sizeof(TriangleMesh));
    EXPECT_LE(taken, raw + raw / 8);
}

#if defined(__GLIBC__) && __GLIBC_PREREQ(2, 33)
std::size_t heap_bytes() {
    const struct mallinfo2 info = mallinfo2();
    return info.uordblks + info.hblkhd;
}

// Embree, which takes its memory from the system, is not asked here.
TEST(MemoryUse, TheSumIsWhatTheHeapGave) {
    if (under_sanitizers) GTEST_SKIP() << "the sanitizer has a heap of its own";
    { // what the first scene allocates once
        const Scene scene;
        const SceneTables tables(scene);
    }
    const std::size_t before = heap_bytes();
    auto scene = std::make_unique<Scene>();
    scene->meshes.push_back(strip(50000));
    scene->meshes.push_back(strip(4)); // has the instances
    scene->shapes.push_back({MeshIndex{0}});
    scene->shapes.push_back({MeshIndex{1}});
    scene->world_shapes.push_back(0);
    scene->materials.emplace_back(DiffuseMaterial{});
    for (Shape& shape : scene->shapes) shape.material = 0;
    scene->images.emplace_back(512, 300, std::vector<std::string>{"R", "G", "B"}, PixelFormat::u8,
                               ColorEncoding::srgb());
    scene->environments.emplace_back(512, 256, std::vector<std::string>{"R", "G", "B"});
    std::fill(scene->environments[0].f32().begin(), scene->environments[0].f32().end(), 1.0f);
    ImageInfiniteLight map;
    map.environment = 0;
    map.layout = EnvironmentLayout::equirectangular;
    scene->lights.emplace_back(map);
    scene->objects.push_back({{1}});
    scene->instances.assign(10000, Instance{0, Transform(), no_index});
    SparseGrid grid;
    grid.values.assign(100 * SparseGrid::block_size, 1.0f);
    scene->sparse_grids.push_back(std::move(grid));
    scene->media.emplace_back(HomogeneousMedium{});
    std::vector<MemoryUse> table;
    const auto tables = std::make_unique<SceneTables>(*scene);
    const std::size_t given = heap_bytes() - before;
    table = memory_use(*scene);
    for (const MemoryUse& use : tables->memory_use()) table.push_back(use);
    const auto sum = static_cast<double>(sum_of(table));
    EXPECT_NEAR(sum / static_cast<double>(given), 1, 0.02) << sum << " and " << given;
    EXPECT_GT(bytes_of(table, "pyramids of images"), 512u * 300 * 3 * 2 / 3);
    EXPECT_EQ(bytes_of(table, "images"), 512u * 300 * 3);
    EXPECT_EQ(bytes_of(table, "pictures of lights"), 512u * 256 * 12);
    EXPECT_GT(bytes_of(table, "tables of lights"), 512u * 256 * 4);
    EXPECT_GE(bytes_of(table, "media"), 100u * 512 * 4);
    EXPECT_EQ(bytes_of(table, "instances"), 10000 * sizeof(Instance));
}
#endif

} // namespace
} // namespace montelux
