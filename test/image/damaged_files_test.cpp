// Files that were made to break readers, and good ones broken here: each is read or refused with a sentence,
// within 1.5 GiB and 10 seconds.
#include "test/image/bounded_run.h"
#include "test/image/image_testing.h"
#include "test/image/sample_files.h"
#include <algorithm>
#include <cstring>
#include <filesystem>

#include "montelux/image/image_read.h"
#include "montelux/image/image_write.h"

namespace montelux {
namespace {

std::vector<std::filesystem::path> files_in(const std::string& folder) {
    std::vector<std::filesystem::path> files;
    auto path = std::filesystem::path(MONTELUX_SHARED_DIR) / folder;
    if (std::filesystem::is_directory(path))
        for (const auto& entry : std::filesystem::recursive_directory_iterator(path))
            if (entry.is_regular_file()) files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

class DamagedCollection : public testing::TestWithParam<const char*> {};

TEST_P(DamagedCollection, EndsWithASentenceOrAPicture) {
    auto files = files_in(GetParam());
    if (files.empty()) GTEST_SKIP() << "no test files beside the repository";
    for (const auto& file : files) {
        BoundedRun run = bounded_run([&] { read_image(file); });
        EXPECT_TRUE(run.ending == Ending::done || run.ending == Ending::refused)
            << file << ": " << run.message;
        if (run.ending != Ending::refused) continue;
        EXPECT_TRUE(run.message.starts_with(file.string() + ": ")) << run.message;
        EXPECT_GT(run.message.size(), file.string().size() + 10) << run.message;
        std::string what = run.message.substr(file.string().size());
        EXPECT_TRUE(std::all_of(what.begin(), what.end(), [](char c) { return c >= ' ' && c <= '~'; }))
            << what;
    }
}

INSTANTIATE_TEST_SUITE_P(Shared, DamagedCollection, testing::Values("bad/exr", "bad/images"));

TEST(GoodCollection, EveryPictureIsRead) {
    int count = 0;
    for (const char* folder : {"environments", "scenes"})
        for (const auto& file : files_in(folder)) {
            static const std::vector<std::string> known{".exr", ".png", ".jpg", ".hdr",
                                                        ".tga", ".pfm", ".bmp"};
            // One of each kind of reference is enough.
            bool repeated = file.string().find("/refs/") != std::string::npos &&
                            file.string().find("_rgb.exr") == std::string::npos;
            if (repeated || std::find(known.begin(), known.end(), file.extension()) == known.end()) continue;
            try {
                Image image = read_image(file);
                EXPECT_FALSE(image.color_channels().empty()) << file;
                ++count;
            } catch (const Error& e) {
                ADD_FAILURE() << e.what();
            }
        }
    if (count == 0) GTEST_SKIP() << "no test files beside the repository";
    EXPECT_GT(count, 50);
}

// A good file of each format and coding, to be broken.
std::vector<std::pair<std::string, std::string>> good_files() {
    TemporaryFolder folder;
    std::vector<std::pair<std::string, std::string>> files;
    Image image = make_picture(40, 35, {"R", "G", "B", "A"});
    for (float& v : image.f32()) v = std::abs(std::floor(v * 8) / 8); // repeats, so that runs occur
    auto add = [&](const std::string& name, const WriteOptions& options) {
        write_image(folder / name, image, options);
        files.emplace_back(name, read_bytes(folder / name));
    };
    image.attributes()["comments"] = std::string("a remark");
    for (ExrCompression c : {ExrCompression::uncompressed, ExrCompression::rle, ExrCompression::zips,
                             ExrCompression::zip, ExrCompression::piz})
        add(std::to_string(static_cast<int>(c)) + ".exr", {.exr_compression = c});
    add("a.png", {});
    add("b.png", {.png_bits = 16});
    add("a.hdr", {});
    add("a.pfm", {});
    for (int compression = 5; compression <= 9; ++compression)
        files.emplace_back("c" + std::to_string(compression) + ".exr",
                           make_exr({.compression = compression}));
    files.emplace_back("tiled.exr", make_exr({.tiled = true}));
    files.emplace_back("mipmap.exr", make_exr({.compression = 4, .tiled = true, .level_mode = 1}));
    files.emplace_back("ripmap.exr", make_exr({.compression = 1, .tiled = true, .level_mode = 2}));
    files.emplace_back("parts.exr", make_exr({.parts = 3}));
    files.emplace_back("baseline.jpg", make_jpeg(60, 50, 3, false));
    files.emplace_back("progressive.jpg", make_jpeg(60, 50, 3, true));
    // Run lengths, 24 bits, 32 x 32 pixels.
    std::string tga("\0\0\x0a\0\0\0\0\0\0\0\0\0\x20\0\x20\0\x18\0", 18);
    for (int i = 0; i < 256; ++i) tga += std::string("\x82\x01\x02\x03\x00\x07\x08\x09", 8);
    files.emplace_back("a.tga", tga);
    files.emplace_back(
        "a.ppm", "P3 8 8 255 " + [] {
            std::string s;
            for (int i = 0; i < 192; ++i) s += std::to_string(i) + " ";
            return s;
        }());
    return files;
}

// All the ways in which one file is broken, in one child.
BoundedRun read_broken(const std::string& name, const std::string& good, std::uint64_t first, int count) {
    return bounded_run(
        [&] {
            for (int k = 0; k < count; ++k) {
                std::uint64_t seed = (first + static_cast<std::uint64_t>(k)) * 1000;
                std::string bytes = good;
                if (k % 4 == 0)
                    bytes.resize(static_cast<std::size_t>(noise(seed) * static_cast<double>(bytes.size())));
                int changes = k % 4 == 0 ? 0 : 1 + k % 7;
                for (int c = 0; c < changes && !bytes.empty(); ++c) {
                    // Headers, being small, would seldom be met: half of the changes go into the first 400
                    // bytes.
                    double range = noise(seed + 10 + c) < 0.5
                                       ? std::min<double>(400, static_cast<double>(bytes.size()))
                                       : static_cast<double>(bytes.size());
                    auto at = static_cast<std::size_t>(noise(seed + 100 + c) * range);
                    double kind = noise(seed + 200 + c);
                    bytes[at] = kind < 0.3   ? '\0'
                                : kind < 0.6 ? '\xff'
                                             : static_cast<char>(noise(seed + 300 + c) * 256);
                }
                try {
                    read_image({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}, name);
                } catch (const Error&) {
                }
            }
        },
        60);
}

TEST(BrokenOnPurpose, NothingCrashes) {
    std::uint64_t seed = 0;
    for (const auto& [name, bytes] : good_files()) {
        ASSERT_NO_THROW(
            read_image({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}, name));
        BoundedRun run = read_broken(name, bytes, seed += 1000, 400);
        EXPECT_EQ(run.ending, Ending::done) << name << ": " << run.message;
    }
}

TEST(BrokenOnPurposeSlowTest, NothingCrashes) {
    std::uint64_t seed = 1'000'000;
    for (const auto& [name, bytes] : good_files())
        for (int round = 0; round < 25; ++round) {
            BoundedRun run = read_broken(name, bytes, seed += 1000, 1000);
            EXPECT_EQ(run.ending, Ending::done) << name << " " << seed << ": " << run.message;
        }
}

// OpenEXR reads channels up to their end mark and goes on there: a larger data window behind it would write beyond the
// picture.
TEST(BrokenOnPurpose, ChannelListsHideNothing) {
    std::string bytes = make_exr({});
    const std::string list("channels\0chlist\0", 16);
    const std::size_t size_at = bytes.find(list) + list.size();
    ASSERT_LT(size_at, bytes.size());
    std::uint32_t size = 0;
    std::memcpy(&size, bytes.data() + size_at, 4);
    const std::string hidden = std::string("dataWindow\0box2i\0\x10\0\0\0", 21) + std::string(8, '\0') +
                               std::string("\xff\3\0\0\xff\3\0\0", 8);
    bytes.insert(size_at + 4 + size, hidden);
    size += static_cast<std::uint32_t>(hidden.size());
    std::memcpy(bytes.data() + size_at, &size, 4);
    expect_error(
        [&] {
            read_image({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}, "a.exr");
        },
        {"the channel list has 37 bytes behind its end"});
}

// The machinery above must notice what it is there for.
TEST(BoundedRun, SeesCrashesHangsAndGreed) {
    EXPECT_EQ(bounded_run([] { std::abort(); }).ending, Ending::crashed);
    EXPECT_EQ(bounded_run(
                  [] {
                      while (true) ::pause();
                  },
                  1)
                  .ending,
              Ending::timed_out);
    EXPECT_EQ(bounded_run([] { throw Error("a", "b"); }).message, "a: b");
    if (!under_sanitizers) {
        EXPECT_EQ(bounded_run([] { std::vector<char> v(std::size_t{2} << 30); }).ending, Ending::crashed);
    }
}

} // namespace
} // namespace montelux
