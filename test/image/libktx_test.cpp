#include "test/image/image_testing.h"
#include "test/image/ktx2_reading.h"
#include <cstdlib>
#include <cstring>
#include <dlfcn.h>
#include <gtest/gtest.h>

#include "montelux/image/ktx1_write.h"
#include "montelux/image/ktx2_write.h"

// The files as Khronos' own library reads them. It is not in Debian 12: the variable MONTELUX_LIBKTX names
// the shared library, else it is looked for as libktx.so.4 and libktx.so.0, and without it the tests are
// skipped.

namespace montelux {
namespace {

// The beginning of struct ktxTexture, the same for versions 1 and 2 (libktx 4, ktx.h).
struct KtxTexture {
    int class_id;
    void *vtable, *vvtable, *protected_part;
    bool is_array, is_cubemap, is_compressed, generate_mipmaps;
    std::uint32_t width, height, depth, dimensions, levels, layers, faces;
    struct {
        int x, y, z;
    } orientation;
    void* key_values;
    std::uint32_t key_value_length;
    std::uint8_t* key_value_data;
    std::size_t size;
    std::uint8_t* data;
};

class LibKtx : public ::testing::Test {
  protected:
    void SetUp() override {
        if (const char* path = std::getenv("MONTELUX_LIBKTX")) {
            library_ = dlopen(path, RTLD_NOW);
            ASSERT_TRUE(library_) << dlerror();
        }
        for (const char* name : {"libktx.so.4", "libktx.so.0"})
            if (!library_) library_ = dlopen(name, RTLD_NOW);
        if (!library_) GTEST_SKIP() << "libktx is not there";
    }
    template <typename F>
    F function(const char* name) {
        void* address = dlsym(library_, name);
        EXPECT_TRUE(address) << name;
        return reinterpret_cast<F>(address);
    }

    void* library_ = nullptr;
};

TEST_F(LibKtx, ReadsTheFilesAsTheyAreMeant) {
    auto load = function<int (*)(const char*, std::uint32_t, KtxTexture**)>("ktxTexture_CreateFromNamedFile");
    auto image_offset =
        function<int (*)(KtxTexture*, std::uint32_t, std::uint32_t, std::uint32_t, std::size_t*)>(
            "ktxTexture2_GetImageOffset");
    auto format_of = function<std::uint32_t (*)(KtxTexture*)>("ktxTexture2_GetVkFormat");
    auto destroy = function<void (*)(KtxTexture*)>("ktxTexture2_Destroy");
    auto describe = function<std::uint32_t* (*)(std::uint32_t)>("vk2dfd");
    TemporaryFolder folder;
    for (TexelFormat format :
         {TexelFormat::rgba16f, TexelFormat::rgba32f, TexelFormat::rg16f, TexelFormat::rg32f,
          TexelFormat::rgb9e5, TexelFormat::r11g11b10f, TexelFormat::rgbm8})
        for (const auto& [size, levels] : {std::pair{16, 5}, {7, 2}, {1, 1}}) {
            SCOPED_TRACE(name_of(format));
            const auto path = folder / "a.ktx2";
            write_ktx2(path, chain_of_noise(size, levels),
                       {.format = format, .notes = {{"montelux.x", "y"}}});
            const Ktx2Contents file = read_ktx2(read_bytes(path));

            // The descriptor that libktx makes of the format, but for the primaries of tables.
            std::uint32_t* descriptor = describe(file.format);
            ASSERT_TRUE(descriptor);
            ASSERT_EQ(descriptor[0], 4 * file.descriptor.size());
            for (std::size_t i = 0; i < file.descriptor.size(); ++i) {
                const std::uint32_t difference = descriptor[i] ^ file.descriptor[i];
                EXPECT_EQ(difference, i == 3 && file.color_primaries == 0 ? 0x100u : 0u) << i;
            }
            std::free(descriptor);

            KtxTexture* texture = nullptr;
            ASSERT_EQ(load(path.c_str(), 1 /* with its images */, &texture), 0);
            EXPECT_EQ(texture->class_id, 2);
            EXPECT_EQ(format_of(texture), file.format);
            EXPECT_TRUE(texture->is_cubemap);
            EXPECT_FALSE(texture->is_array || texture->is_compressed || texture->generate_mipmaps);
            EXPECT_EQ(texture->width, static_cast<unsigned>(size));
            EXPECT_EQ(texture->levels, static_cast<unsigned>(levels));
            EXPECT_EQ(texture->faces, 6u);
            EXPECT_EQ(texture->orientation.x, 'r');
            EXPECT_EQ(texture->orientation.y, 'd');
            for (int level = 0; level < levels; ++level)
                for (int face = 0; face < cube_faces; ++face) {
                    std::size_t offset = 0;
                    ASSERT_EQ(image_offset(texture, level, 0, face, &offset), 0);
                    const std::size_t bytes = file.levels[level].size() / cube_faces;
                    EXPECT_EQ(
                        std::memcmp(texture->data + offset, file.levels[level].data() + face * bytes, bytes),
                        0);
                }
            destroy(texture);
        }

    write_ktx2(folder / "b.ktx2", Image(5, 3, {"R", "G"}), {.format = TexelFormat::rg16f});
    KtxTexture* texture = nullptr;
    ASSERT_EQ(load((folder / "b.ktx2").c_str(), 1, &texture), 0);
    EXPECT_FALSE(texture->is_cubemap);
    EXPECT_EQ(texture->dimensions, 2u);
    EXPECT_EQ(texture->height, 3u);
    destroy(texture);
}

TEST_F(LibKtx, ReadsVersionOne) {
    auto load = function<int (*)(const char*, std::uint32_t, KtxTexture**)>("ktxTexture_CreateFromNamedFile");
    auto destroy = function<void (*)(KtxTexture*)>("ktxTexture1_Destroy");
    TemporaryFolder folder;
    for (TexelFormat format : {TexelFormat::rgba16f, TexelFormat::rgba32f}) {
        const CubeMapChain chain = chain_of_noise(8, 3);
        write_ktx1(folder / "a.ktx", chain, {.format = format, .notes = {{"sh", "1 2 3\n"}}});
        write_ktx2(folder / "a.ktx2", chain, {.format = format});
        KtxTexture* texture = nullptr;
        ASSERT_EQ(load((folder / "a.ktx").c_str(), 1, &texture), 0);
        EXPECT_EQ(texture->class_id, 1);
        EXPECT_TRUE(texture->is_cubemap);
        EXPECT_EQ(texture->levels, 3u);
        EXPECT_EQ(texture->orientation.y, 'd');
        // In memory the levels follow each other as in the file, without their lengths.
        std::string texels;
        for (const std::string& level : read_ktx2(read_bytes(folder / "a.ktx2")).levels) texels += level;
        ASSERT_GE(texture->size, texels.size());
        EXPECT_EQ(std::memcmp(texture->data, texels.data(), texels.size()), 0);
        destroy(texture);
    }
}

} // namespace
} // namespace montelux
