#include "montelux/formats/mitsuba/pictures.h"

#include <array>
#include <vector>

#include "montelux/image/image_read.h"
#include "montelux/mc/math/error.h"
#include "montelux/scene/build/float_range.h"

namespace montelux::mitsuba {

TextureMapping uv_mapping(Plugin& texture, bool of_picture, double repetitions) {
    const Transform to_uv = texture.transform("to_uv");
    if (!fits_float(to_uv)) texture.error("'to_uv' is beyond what single-precision numbers hold");
    const auto& m = to_uv.matrix().m;
    // Factors of u and v, and the offset. The third axis has no effect.
    std::array<double, 3> s{m[0][0], m[0][1], m[0][3]}, t{m[1][0], m[1][1], m[1][3]};
    if (of_picture) t = {-t[0], -t[1], 1 - t[2]};
    const auto f = [&](double x) { return static_cast<float>(repetitions * x); };
    TextureMapping mapping;
    mapping.du = f(s[2]);
    mapping.dv = f(t[2]);
    if (s[1] == 0 && t[0] == 0) {
        mapping.su = f(s[0]);
        mapping.sv = f(t[1]);
        return mapping;
    }
    mapping.kind = TextureMapping::Kind::affine;
    mapping.vs = {f(s[0]), f(s[1]), 0};
    mapping.vt = {f(t[0]), f(t[1]), 0};
    return mapping;
}

Index PictureLibrary::image(Plugin& bitmap) {
    // How pixels are stored has no effect on their values.
    bitmap.choice("format", "auto", {"auto", "variant", "float16", "fp16", "uint8"});
    bitmap.skip("accel");
    const std::filesystem::path path = bitmap.file("filename");
    const SourceLocation at = bitmap.find("filename")->at;
    const bool raw = bitmap.flag("raw", false);
    const auto key = std::pair(path.lexically_normal().string(), raw);
    if (const auto known = images_.find(key); known != images_.end()) return known->second;
    const std::vector<std::uint8_t> bytes = bitmap.graph().files.read(path, at);
    try {
        Image picture = read_image(bytes, path.string());
        const bool integers = picture.format() == PixelFormat::u8 || picture.format() == PixelFormat::u16;
        if (raw && integers) picture.set_encoding(ColorEncoding::linear());
        return images_[key] = builder_.add_image(std::move(picture), path.string(), at);
    } catch (const LocatedError&) {
        throw;
    } catch (const Error& e) {
        bitmap.graph().diagnostics.error(at, e.what());
    }
}

ImageTexture PictureLibrary::texture(Plugin bitmap) {
    ImageTexture t;
    t.mapping = uv_mapping(bitmap, true);
    const bool nearest = bitmap.choice("filter_type", "bilinear", {"bilinear", "nearest"}) == "nearest";
    t.filter = nearest ? TextureFilter::point : TextureFilter::bilinear;
    const std::string wrap = bitmap.choice("wrap_mode", "repeat", {"repeat", "mirror", "clamp"});
    t.wrap = wrap == "repeat"   ? TextureWrap::repeat
             : wrap == "mirror" ? TextureWrap::mirror
                                : TextureWrap::clamp;
    t.image = image(bitmap);
    bitmap.finish();
    return t;
}

bool PictureLibrary::has_colors(const ImageTexture& texture) const {
    return builder_.scene().images[texture.image].color_channels().size() == 3;
}

Index PictureLibrary::normal_map(Plugin texture) {
    if (const auto known = normal_maps_.find(texture.index()); known != normal_maps_.end())
        return known->second;
    ImageTexture map;
    if (texture.type() == "bitmap") {
        map = this->texture(texture);
        if (!has_colors(map)) texture.error("a normal map needs a picture with the channels R, G and B");
    } else if (texture.type() == "rawconstant") {
        const Property* value = texture.find("value");
        const auto* vector = value == nullptr ? nullptr : std::get_if<Vec3d>(&value->value);
        if (vector == nullptr) texture.error("a normal map needs a vector or a picture");
        Image pixel(1, 1, {"R", "G", "B"});
        for (int c = 0; c < 3; ++c) pixel.set(0, 0, c, static_cast<float>((*vector)[c]));
        map.image = builder_.add_image(std::move(pixel), "'value'", texture.at());
        texture.finish();
    } else {
        texture.error("a normal map is a texture 'bitmap' or 'rawconstant', not " + texture.describe());
    }
    map.right_handed = true;
    std::vector<ImageTexture>& all = builder_.scene().normal_maps;
    all.push_back(map);
    return normal_maps_[texture.index()] = static_cast<Index>(all.size() - 1);
}

} // namespace montelux::mitsuba
