#include "montelux/formats/mitsuba/light_pictures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "montelux/image/image_read.h"
#include "montelux/mc/math/error.h"
#include "montelux/scene/build/scene_builder.h"

namespace montelux::mitsuba {
namespace {

// Whether it permutes the corners of the unit square.
bool keeps_unit_square(const Transform& to_uv) {
    std::array<bool, 4> met{};
    for (const Vec3d corner : {Vec3d(0, 0, 0), Vec3d(1, 0, 0), Vec3d(0, 1, 0), Vec3d(1, 1, 0)}) {
        const Vec3d p = to_uv.point(corner);
        const double x = std::round(p.x), y = std::round(p.y);
        if (std::abs(p.x - x) > 1e-4 || std::abs(p.y - y) > 1e-4 || x < 0 || x > 1 || y < 0 || y > 1)
            return false;
        met[static_cast<std::size_t>(x + 2 * y)] = true;
    }
    return std::ranges::all_of(met, [](bool m) { return m; });
}

} // namespace

Image picture_in_file(Plugin& owner, std::string_view property) {
    const std::filesystem::path path = owner.file(property);
    const std::vector<std::uint8_t> bytes = owner.graph().files.read(path, owner.at());
    try {
        Image picture = rgb_map(read_image(bytes, path.string()));
        if (picture.empty())
            throw Error(path.string(), "the picture has neither channels R, G and B nor Y alone");
        return picture;
    } catch (const Error& e) {
        owner.error(e.what());
    }
}

LightPicture picture_of_texture(Plugin texture) {
    if (texture.type() != "bitmap")
        texture.error("a light with " + texture.describe() +
                      " is not supported; expected a 'bitmap' or a spectrum");
    const Image picture = picture_in_file(texture, "filename");
    const Transform to_uv = texture.transform("to_uv");
    if (!keeps_unit_square(to_uv))
        texture.error("the 'to_uv' of a light's picture must map the unit square onto itself");
    texture.ignore("raw", "colours of lights are spectra");
    PictureLookup lookup = PictureLookup::bilinear; // which a mirrored picture is on the unit square, too
    if (texture.choice("wrap_mode", "repeat", {"repeat", "mirror", "clamp"}) == "repeat")
        lookup = PictureLookup::repeating;
    if (texture.choice("filter_type", "bilinear", {"bilinear", "nearest"}) == "nearest")
        lookup = PictureLookup::nearest;
    for (const char* name : {"format", "accel"}) texture.skip(name);
    texture.finish();
    const bool turned = std::abs(to_uv.matrix().m[0][0]) < 0.5; // u is the picture's v
    const int width = turned ? picture.height() : picture.width(),
              height = turned ? picture.width() : picture.height();
    Image shown(width, height, {"R", "G", "B"});
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const Vec3d p = to_uv.point(Vec3d((x + 0.5) / width, (y + 0.5) / height, 0));
            const int from_x = static_cast<int>(p.x * picture.width()),
                      from_y = static_cast<int>(p.y * picture.height());
            for (int c = 0; c < 3; ++c) shown.set(x, y, c, picture.value(from_x, from_y, c));
        }
    return {std::move(shown), lookup};
}

Image environment_rows(const Image& map) {
    // The rows of ours are bands, whose centres lie up to half a row off Mitsuba's. Of maps with few rows each row
    // becomes several, so that this is small.
    constexpr int enough_rows = 1024;
    if (map.height() >= enough_rows || map.height() < 2 || map.width() > 4 * enough_rows) return map;
    const int rows = (map.height() - 1) * ((enough_rows + map.height() - 2) / (map.height() - 1));
    Image finer(map.width(), rows, {"R", "G", "B"});
    for (int y = 0; y < rows; ++y) {
        const double at = (y + 0.5) / rows * (map.height() - 1);
        const int above = std::min(static_cast<int>(at), map.height() - 2);
        const auto share = static_cast<float>(at - above);
        for (int x = 0; x < map.width(); ++x)
            for (int c = 0; c < 3; ++c)
                finer.set(x, y, c, (1 - share) * map.value(x, above, c) + share * map.value(x, above + 1, c));
    }
    return finer;
}

} // namespace montelux::mitsuba
