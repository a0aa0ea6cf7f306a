// WritePbrt: the fixture of what scenes become when they are written in pbrt's syntax and read again.
#pragma once

#include "test/formats/pbrt/parse.h"
#include "test/formats/pbrt/round_trip.h"

#include "montelux/image/image_write.h"

namespace montelux {

class WritePbrt : public ::testing::Test {
  protected:
    SceneDescription parse(const std::string& text) {
        Warnings ignored;
        return parse_pbrt(text, "scene", folder_.path(), ignored);
    }
    // What the writer warns of.
    std::vector<std::string> round_trip(const std::string& text) {
        return test::expect_round_trip(parse(text)).messages();
    }
    std::vector<std::string> world_round_trip(const std::string& world) {
        return round_trip("WorldBegin\n" + world);
    }

    // RGBA of 8 bits, grey of 16, half and 32-bit floats.
    void make_pictures() {
        Image small(3, 2, {"R", "G", "B", "A"}, PixelFormat::u8, ColorEncoding::srgb());
        for (std::size_t i = 0; i < small.sample_count(); ++i)
            small.u8()[i] = static_cast<std::uint8_t>(31 * i);
        write_image(folder_ / "rgba.png", small);
        Image wide(2, 2, {"Y"}, PixelFormat::u16, ColorEncoding::srgb());
        for (std::size_t i = 0; i < 4; ++i) wide.u16()[i] = static_cast<std::uint16_t>(20001 * i);
        write_image(folder_ / "grey16.png", wide, {.png_bits = 16});
        Image map(8, 8, {"R", "G", "B"});
        for (std::size_t i = 0; i < map.sample_count(); ++i) map.f32()[i] = static_cast<float>(noise(i));
        write_image(folder_ / "map.exr", map);
        write_image(folder_ / "half.exr", map, {.exr_half = {"R", "G", "B"}});
    }

    TemporaryFolder folder_;
};

using Texts = std::vector<std::string>;

} // namespace montelux
