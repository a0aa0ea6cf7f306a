// Serialized meshes of Mitsuba: all versions, several in a file, and damaged files.
#include <bit>
#include <cstdint>
#include <cstring>
#include <gtest/gtest.h>
#include <string>
#include <vector>
#include <zlib.h>

#include "montelux/formats/mitsuba/serialized.h"
#include "montelux/mc/math/error.h"

namespace montelux::mitsuba_serialized {
namespace {

using mitsuba::parse_serialized;
using mitsuba::SerializedMesh;

using Bytes = std::vector<std::uint8_t>;

template <typename T>
void put(Bytes& to, T value) {
    const std::size_t at = to.size();
    to.resize(at + sizeof(T));
    std::memcpy(to.data() + at, &value, sizeof(T));
}
template <typename T>
void put_all(Bytes& to, const std::vector<double>& values) {
    for (const double v : values) put(to, static_cast<T>(v));
}

Bytes stream(std::uint16_t version, const Bytes& content) {
    uLongf size = compressBound(content.size());
    Bytes packed(size);
    compress(packed.data(), &size, content.data(), content.size());
    Bytes bytes;
    put<std::uint16_t>(bytes, 0x041c);
    put<std::uint16_t>(bytes, version);
    bytes.insert(bytes.end(), packed.begin(), packed.begin() + static_cast<std::ptrdiff_t>(size));
    return bytes;
}

// A triangle in the plane z = `z`, of version 3 or 4.
Bytes triangle_content(std::uint16_t version, double z, bool doubles = false, bool with_extras = false,
                       std::uint64_t vertices = 3, std::uint32_t last_index = 2) {
    Bytes content;
    put<std::uint32_t>(content,
                       (doubles ? 0x2000u : 0x1000u) | (with_extras ? 0x1u | 0x2u | 0x8u | 0x10u : 0u));
    if (version == 4)
        for (const char c : {'a', 'b', '\0'}) put(content, c);
    put<std::uint64_t>(content, vertices);
    put<std::uint64_t>(content, 1);
    const auto numbers = [&](const std::vector<double>& values) {
        if (doubles)
            put_all<double>(content, values);
        else
            put_all<float>(content, values);
    };
    numbers({0, 0, z, 1, 0, z, 0, 1, z});
    if (with_extras) {
        numbers({0, 0, 1, 0, 0, 1, 0, 0, 1});
        numbers({0, 0, 1, 0, 0.25, 1});
        numbers({1, 0, 0, 1, 0, 0, 1, 0, 0});
    }
    put<std::uint32_t>(content, 0);
    put<std::uint32_t>(content, 1);
    put<std::uint32_t>(content, last_index);
    return content;
}

// The streams of meshes, then where they begin.
Bytes file(std::uint16_t version, const std::vector<Bytes>& contents) {
    Bytes bytes;
    std::vector<std::size_t> offsets;
    for (const Bytes& content : contents) {
        offsets.push_back(bytes.size());
        const Bytes s = stream(version, content);
        bytes.insert(bytes.end(), s.begin(), s.end());
    }
    for (const std::size_t offset : offsets)
        if (version == 3)
            put(bytes, static_cast<std::uint32_t>(offset));
        else
            put(bytes, static_cast<std::uint64_t>(offset));
    put(bytes, static_cast<std::uint32_t>(offsets.size()));
    return bytes;
}

std::string error(const Bytes& bytes, std::uint32_t number = 0) {
    try {
        parse_serialized(bytes, "a.serialized", number);
    } catch (const Error& e) {
        return e.what();
    }
    return {};
}
void expect_error(const Bytes& bytes, const std::string& part, std::uint32_t number = 0) {
    const std::string message = error(bytes, number);
    EXPECT_NE(message.find(part), std::string::npos) << message << "\n  does not say: " << part;
}

TEST(MitsubaSerialized, Versions3And4) {
    for (const std::uint16_t version : {std::uint16_t{3}, std::uint16_t{4}})
        for (const bool doubles : {false, true}) {
            const Bytes bytes = file(version, {triangle_content(version, 1, doubles),
                                               triangle_content(version, 2, doubles, true),
                                               triangle_content(version, 3, doubles)});
            for (std::uint32_t number = 0; number < 3; ++number) {
                const SerializedMesh read = parse_serialized(bytes, "a", number);
                ASSERT_EQ(read.mesh.positions.size(), 3u);
                EXPECT_EQ(read.mesh.positions[2], Point3f(0, 1, static_cast<float>(number + 1)));
                EXPECT_EQ(read.mesh.indices, (std::vector<Index>{0, 1, 2}));
                EXPECT_EQ(read.mesh.normals.size(), number == 1 ? 3u : 0u);
                EXPECT_EQ(read.face_normals, number == 1);
            }
            EXPECT_EQ(parse_serialized(bytes, "a", 1).mesh.uvs.at(2), Point2f(0.25f, 1));
            expect_error(bytes, "there is no mesh 3; the file has 3", 3);
        }
}

Bytes rows(std::uint32_t flags) {
    Bytes content;
    put<std::uint32_t>(content, flags);
    put<std::uint32_t>(content, 2); // the name
    for (const char c : {'a', 'b'}) put(content, c);
    for (const std::uint64_t n : {3u, 1u, 0u, 0u}) put<std::uint64_t>(content, n);
    put_all<float>(content,
                   {0, 0, 5, 0, 0, 1, 0, 0, /**/ 1, 0, 5, 0, 0, 1, 1, 0, /**/ 0, 1, 5, 0, 0, 1, 0, 1});
    for (const std::uint32_t i : {0u, 1u, 2u, 7u}) put(content, i);
    put<std::uint32_t>(content, 0); // further attributes
    return content;
}

TEST(MitsubaSerialized, Version5) {
    const SerializedMesh all = parse_serialized(file(5, {rows(0x1015)}), "a", 0);
    EXPECT_EQ(all.mesh.positions.at(2), Point3f(0, 1, 5));
    EXPECT_EQ(all.mesh.normals.at(1), Normal3f(0, 0, 1));
    EXPECT_EQ(all.mesh.uvs.at(1), Point2f(1, 0));
    EXPECT_EQ(all.mesh.indices, (std::vector<Index>{0, 1, 2}));
    EXPECT_TRUE(all.face_normals);
    const SerializedMesh bare = parse_serialized(file(5, {rows(0x1000)}), "a", 0);
    EXPECT_TRUE(bare.mesh.normals.empty() && bare.mesh.uvs.empty());
    EXPECT_FALSE(bare.face_normals);
    expect_error(file(5, {rows(0x1003)}), "tangents");
    expect_error(file(5, {rows(0x2000)}), "single precision");
}

TEST(MitsubaSerialized, OtherFiles) {
    expect_error({}, "ends early");
    expect_error({0x1c}, "ends early");
    expect_error({'p', 'l', 'y', '\n'}, "no serialized mesh");
    expect_error(stream(2, triangle_content(3, 0)), "version 2");
    expect_error(stream(4, triangle_content(4, 0, false, false, 3, 3)), "refers to vertex 3; there are 3");
    expect_error(stream(4, triangle_content(4, std::bit_cast<float>(0x7fc00000u))), "is not finite");
    expect_error(stream(4, triangle_content(4, 0, false, false, 0)), "the mesh is empty");
    // Counts that the data does not have, though a reader might allocate them.
    expect_error(stream(4, triangle_content(4, 0, false, false, std::uint64_t{1} << 31)), "ends early");
    expect_error(stream(4, triangle_content(4, 0, false, false, std::uint64_t{1} << 60)), "2^32");
    Bytes offset_beyond = file(4, {triangle_content(4, 0), triangle_content(4, 1)});
    for (std::size_t i = offset_beyond.size() - 12; i < offset_beyond.size() - 4; ++i)
        offset_beyond[i] = 0xff;
    expect_error(offset_beyond, "beyond the end", 1);
    // Each bit of the offset's upper half alone is 4 GiB or more.
    for (std::size_t bit = 32; bit < 64; ++bit) {
        Bytes far_beyond = file(4, {triangle_content(4, 0), triangle_content(4, 1)});
        std::uint8_t& byte = far_beyond[far_beyond.size() - 12 + bit / 8];
        byte = static_cast<std::uint8_t>(byte | 1u << bit % 8);
        expect_error(far_beyond, "beyond the end", 1);
    }
    Bytes many = file(4, {triangle_content(4, 0)});
    for (std::size_t i = many.size() - 4; i < many.size(); ++i) many[i] = 0xff;
    expect_error(many, "ends early", 1);
    Bytes elsewhere = file(4, {triangle_content(4, 0), triangle_content(4, 1)});
    elsewhere[elsewhere.size() - 12] = 1;
    expect_error(elsewhere, "no mesh begins", 1);
}

// Zeros shrink a thousandfold: a small file must not fill the memory.
TEST(MitsubaSerialized, OutOfProportion) {
    Bytes content;
    put<std::uint32_t>(content, 0x1000);
    put<std::uint64_t>(content, std::uint64_t{5} << 20);
    put<std::uint64_t>(content, 1);
    content.resize(content.size() + (std::size_t{60} << 20));
    expect_error(stream(3, content), "out of proportion");
}

TEST(MitsubaSerialized, EveryTruncationIsAnError) {
    const Bytes whole = stream(4, triangle_content(4, 0, false, true));
    for (std::size_t size = 0; size + 16 < whole.size(); ++size)
        EXPECT_NE(error({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)}), "") << size;
    const Bytes two = file(4, {triangle_content(4, 0), triangle_content(4, 1)});
    for (std::size_t size = 0; size < two.size(); ++size)
        EXPECT_NE(error({two.begin(), two.begin() + static_cast<std::ptrdiff_t>(size)}, 1), "") << size;
}

// Any changed bit is an error or another mesh, but no crash.
TEST(MitsubaSerialized, ChangedBits) {
    const Bytes whole = file(4, {triangle_content(4, 0, false, true), triangle_content(4, 1)});
    for (std::size_t bit = 0; bit < 8 * whole.size(); ++bit) {
        Bytes changed = whole;
        changed[bit / 8] = static_cast<std::uint8_t>(changed[bit / 8] ^ (1u << bit % 8));
        for (const std::uint32_t number : {0u, 1u}) static_cast<void>(error(changed, number));
    }
}

} // namespace
} // namespace montelux::mitsuba_serialized
