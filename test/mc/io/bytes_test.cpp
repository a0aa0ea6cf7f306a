// Bytes of files and of serialised values: round trips, and errors where bytes are missing.
#include "test/temporary_folder.h"
#include <cstdint>
#include <filesystem>
#include <gtest/gtest.h>
#include <numeric>
#include <span>
#include <string>
#include <vector>

#include "montelux/mc/io/byte_stream.h"
#include "montelux/mc/io/file.h"
#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

template <typename Action>
std::string sentence_of(Action action) {
    try {
        action();
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

TEST(InputFile, ReadsOnWhereItStopped) {
    const TemporaryFolder folder;
    const std::filesystem::path path = folder.write("a", "0123456789");
    InputFile file(path);
    EXPECT_EQ(file.size(), 10u);
    std::string text;
    for (const std::size_t size : {4, 0, 6}) {
        std::vector<std::uint8_t> part(size);
        file.read(part);
        text.append(part.begin(), part.end());
    }
    EXPECT_EQ(text, "0123456789");
}

TEST(InputFile, AFileThatBecomesShorterIsAnError) {
    const TemporaryFolder folder;
    const std::filesystem::path path = folder.write("a", "0123456789");
    for (const std::size_t left : {9, 4, 0}) {
        std::filesystem::resize_file(path, 10);
        InputFile file(path);
        std::filesystem::resize_file(path, left);
        std::vector<std::uint8_t> bytes(10);
        EXPECT_EQ(sentence_of([&] { file.read(bytes); }),
                  path.string() + ": became shorter while it was read")
            << left;
    }
}

TEST(ByteReader, GivesWhatWasWritten) {
    ByteWriter out;
    out.put(std::uint16_t{7});
    out.put(0.1);
    out.put_text("text");
    const std::vector<std::uint32_t> words{1, 2, 3};
    out.put_all(std::span(words));
    out.put_bytes({});
    const std::vector<std::uint8_t> bytes = out.take();
    ByteReader in(bytes);
    EXPECT_EQ(in.get<std::uint16_t>(), 7);
    EXPECT_EQ(in.get<double>(), 0.1);
    EXPECT_EQ(in.get_text(), "text");
    std::vector<std::uint32_t> back(3);
    in.get_all(std::span(back));
    EXPECT_EQ(back, words);
    EXPECT_TRUE(in.get_bytes().empty());
    EXPECT_TRUE(in.at_end());
}

// An incomplete value is an error and leaves its destination unchanged.
TEST(ByteReader, AValueThatIsNotWholeIsAnError) {
    std::vector<std::uint8_t> bytes(24);
    std::iota(bytes.begin(), bytes.end(), std::uint8_t{1});
    for (std::size_t size = 0; size < bytes.size(); ++size) {
        ByteReader in(std::span<const std::uint8_t>(bytes).first(size), "a.state");
        std::vector<std::uint64_t> values(3);
        EXPECT_EQ(sentence_of([&] { in.get_all(std::span(values)); }), "a.state: it ends too early") << size;
        EXPECT_EQ(values, std::vector<std::uint64_t>(3)) << size;
        EXPECT_EQ(in.remaining(), size);
        if (size < 8) {
            EXPECT_EQ(sentence_of([&] { in.get<double>(); }), "a.state: it ends too early") << size;
        }
    }
    ByteReader whole(bytes);
    std::vector<std::uint64_t> values(3);
    whole.get_all(std::span(values));
    EXPECT_TRUE(whole.at_end());
    // A length that promises more bytes than follow it.
    ByteWriter out;
    out.put_text("text");
    const std::vector<std::uint8_t> text = out.take();
    ByteReader cut(std::span<const std::uint8_t>(text).first(text.size() - 1));
    EXPECT_THROW(cut.get_text(), Error);
}

} // namespace
} // namespace montelux
