#include "montelux/formats/gltf/textures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "montelux/formats/gltf/uri.h"
#include "montelux/image/image_read.h"
#include "montelux/mc/math/error.h"

namespace montelux::gltf {
namespace {

// KHR_texture_transform: uv is scaled, turned counter-clockwise as seen on the picture, and moved. The file's v grows
// downwards.
TextureMapping mapping_of(const Value& info) {
    TextureMapping m;
    const std::optional<Value> transform = info.extension("KHR_texture_transform");
    if (!transform) return m;
    const auto two = [&](std::string_view key, double otherwise) {
        const std::optional<Value> found = transform->find(key);
        return found ? found->numbers(2) : std::vector<double>{otherwise, otherwise};
    };
    const std::vector<double> offset = two("offset", 0), scale = two("scale", 1);
    const double angle = transform->number("rotation", 0), c = std::cos(angle), s = std::sin(angle);
    const auto f = [](double x) { return static_cast<float>(x); };
    if (angle == 0) {
        m.su = f(scale[0]);
        m.sv = f(scale[1]);
        m.du = f(offset[0]);
        m.dv = f(1 - offset[1] - scale[1]);
        return m;
    }
    m.kind = TextureMapping::Kind::affine;
    m.vs = {f(scale[0] * c), f(-scale[1] * s), 0};
    m.vt = {f(scale[0] * s), f(scale[1] * c), 0};
    m.du = f(offset[0] + scale[1] * s);
    m.dv = f(1 - offset[1] - scale[1] * c);
    return m;
}

TextureWrap wrap_of(const Value& sampler, std::string_view key) {
    const std::uint64_t code = sampler.whole(key, 10497);
    if (code == 10497) return TextureWrap::repeat;
    if (code == 33071) return TextureWrap::clamp;
    if (code == 33648) return TextureWrap::mirror;
    sampler.required(key).error("wrapping mode " + std::to_string(code) +
                                " is unknown; expected 10497, 33071 or 33648");
}

// The channel A alone, linear: an image's own A would be decoded as its colours are.
Image alpha_channel_of(const Image& picture) {
    Image alpha(picture.width(), picture.height(), {"Y"}, picture.format(), ColorEncoding::linear());
    const std::optional<int> channel = picture.find_channel("A");
    const std::size_t channels = static_cast<std::size_t>(picture.channels());
    const auto copy = [&](const auto& from, const auto& to) {
        for (std::size_t i = 0; i < to.size(); ++i)
            to[i] = from[i * channels + static_cast<std::size_t>(*channel)];
    };
    const auto fill = [](const auto& to, auto value) {
        for (auto& v : to) v = value;
    };
    switch (picture.format()) {
    case PixelFormat::u8:
        channel ? copy(picture.u8(), alpha.u8()) : fill(alpha.u8(), std::uint8_t{255});
        break;
    case PixelFormat::u16:
        channel ? copy(picture.u16(), alpha.u16()) : fill(alpha.u16(), std::uint16_t{65535});
        break;
    case PixelFormat::f16:
        channel ? copy(picture.u16(), alpha.u16()) : fill(alpha.u16(), std::uint16_t{0x3c00});
        break;
    case PixelFormat::f32:
        channel ? copy(picture.f32(), alpha.f32()) : fill(alpha.f32(), 1.0f);
        break;
    }
    return alpha;
}

// One texel, without effect but for colours, which are magenta.
template <typename Use>
Image missing_picture(Use use) {
    std::array<std::uint8_t, 3> texel{255, 255, 255};
    if (use == Use::color) texel = {255, 0, 255};
    if (use == Use::normal) texel = {128, 128, 255};
    if (use == Use::emission) texel = {0, 0, 0};
    Image picture(1, 1, {"R", "G", "B"}, PixelFormat::u8, ColorEncoding::srgb());
    std::ranges::copy(texel, picture.u8().begin());
    return picture;
}

// Memory of pictures counts less than that of meshes: flat ones are well packed.
constexpr double share_of_pictures = 1.0 / 16;

} // namespace

std::uint64_t TextureLibrary::uv_set(const Value& info) {
    const std::uint64_t own = info.whole("texCoord", 0);
    const std::optional<Value> transform = info.extension("KHR_texture_transform");
    return transform ? transform->whole("texCoord", own) : own;
}

Value TextureLibrary::source_of(const Value& texture) {
    if (reads_webp())
        if (const std::optional<Value> webp = texture.extension("EXT_texture_webp"))
            return webp->required("source");
    if (const std::optional<Value> source = texture.find("source")) return *source;
    for (const char* name :
         {"EXT_texture_webp", "KHR_texture_basisu", "MSFT_texture_dds", "EXT_texture_avif"})
        if (texture.extension(name))
            texture.error(std::string("has a picture of ") + name +
                          " only, which is not read; expected a PNG or JPEG "
                          "picture beside it");
    texture.error("has no 'source'");
}

Image TextureLibrary::read_picture(const Value& index, Use use) {
    if (!pictures_) return missing_picture(use);
    const Value& source = document_.refer(index, "images", "image");
    std::vector<std::uint8_t> read;
    std::span<const std::uint8_t> bytes;
    std::string name = source.diagnostics().file() + ": " + source.pointer();
    if (const std::optional<Value> uri = source.find("uri")) {
        try {
            read = document_.read(*uri);
        } catch (const Error& e) {
            if (is_data_uri(uri->text())) throw;
            const std::string reason = e.what(), place = name + "/uri: ";
            uri->warn(
                reason.substr(reason.starts_with(place) ? place.size() : 0) +
                (use == Use::color ? "; magenta stands for the picture" : "; the material is without it"));
            return missing_picture(use);
        }
        bytes = read;
    } else {
        bytes = document_.view(source.required("bufferView"));
    }
    Image picture;
    try {
        picture = read_image(bytes, name);
    } catch (const Error& e) {
        throw LocatedError(e.what());
    }
    if (picture.color_channels().empty()) source.error("the picture has neither channels R, G and B nor Y");
    document_.charge(static_cast<double>(picture.byte_count()) * share_of_pictures, source);
    return picture;
}

Index TextureLibrary::image(const Value& texture, Use use) {
    const Value source = source_of(texture);
    const std::uint64_t number = source.whole();
    if (const auto known = images_.find({number, use}); known != images_.end()) return known->second;
    Image picture = read_picture(source, use);
    const bool integers = picture.format() == PixelFormat::u8 || picture.format() == PixelFormat::u16;
    if (use == Use::alpha)
        picture = alpha_channel_of(picture);
    else if (integers && use != Use::color)
        picture.set_encoding(ColorEncoding::linear());
    return images_[{number, use}] = builder_.add_image(std::move(picture), "the picture",
                                                       document_.refer(source, "images", "image").place());
}

// The filter of magnification decides: a path is seen through few pixels, and minification is always filtered.
void TextureLibrary::read_sampler(const Value& texture, ImageTexture& to) {
    constexpr std::uint64_t nearest = 9728, linear = 9729;
    to.filter = TextureFilter::trilinear;
    const std::optional<Value> index = texture.find("sampler");
    if (!index) return;
    const Value& sampler = document_.refer(*index, "samplers", "sampler");
    to.wrap = {wrap_of(sampler, "wrapS"), wrap_of(sampler, "wrapT")};
    if (const std::optional<Value> filter = sampler.find("magFilter")) {
        const std::uint64_t code = filter->whole();
        if (code != nearest && code != linear)
            filter->error("filter " + std::to_string(code) + " is unknown; expected 9728 or 9729");
        if (code == nearest) to.filter = TextureFilter::point;
    }
}

ImageTexture TextureLibrary::texture(const Value& info, Use use) {
    const Value& texture = document_.refer(info.required("index"), "textures", "texture");
    ImageTexture t;
    t.image = image(texture, use);
    t.mapping = mapping_of(info);
    t.mapping.second_uv = sets_.second && uv_set(info) == *sets_.second;
    read_sampler(texture, t);
    return t;
}

SpectrumParameter TextureLibrary::color(const std::optional<Value>& info, Vec3f factor, RgbMeaning meaning,
                                        bool vertices) {
    std::vector<SpectrumTexture>& all = builder_.scene().spectrum_textures;
    if (info) {
        ImageTexture t = texture(*info, Use::color);
        t.meaning = meaning;
        t.factor = factor;
        t.vertex_colors = vertices;
        all.emplace_back(t);
    } else if (vertices) {
        all.emplace_back(VertexColorTexture{factor});
    } else {
        const RgbColorSpace& srgb = RgbColorSpace::srgb();
        return {builder_.add_spectrum(meaning == RgbMeaning::albedo
                                          ? Spectrum(RgbAlbedoSpectrum(srgb, factor))
                                          : Spectrum(RgbUnboundedSpectrum(srgb, factor)))};
    }
    return {{}, static_cast<Index>(all.size() - 1)};
}

FloatParameter TextureLibrary::number(const std::optional<Value>& info, float factor, ImageChannels channel,
                                      bool vertices) {
    std::vector<FloatTexture>& all = builder_.scene().float_textures;
    if (info) {
        const bool alpha = channel == ImageChannels::alpha;
        ImageTexture t = texture(*info, alpha ? Use::alpha : Use::linear);
        t.channels = alpha ? ImageChannels::color : channel;
        t.scale = factor;
        t.vertex_colors = vertices;
        all.emplace_back(t);
    } else if (vertices) {
        all.emplace_back(VertexColorTexture{{factor, factor, factor}});
    } else {
        return {factor};
    }
    return {0, static_cast<Index>(all.size() - 1)};
}

NormalMapParameter TextureLibrary::normal_map(const Value& info) {
    ImageTexture t = texture(info, Use::normal);
    if (builder_.scene().images[t.image].color_channels().size() != 3)
        info.error("the normal map has no channels R, G and B");
    const auto scale = static_cast<float>(info.number("scale", 1));
    t.factor = {scale, scale, 1};
    std::vector<ImageTexture>& all = builder_.scene().normal_maps;
    all.push_back(t);
    return {static_cast<Index>(all.size() - 1)};
}

Index TextureLibrary::emission(const Value& info, Vec3f factor) {
    if (info.extension("KHR_texture_transform"))
        info.warn("KHR_texture_transform is ignored for emissive pictures");
    const Value& texture = document_.refer(info.required("index"), "textures", "texture");
    Image map = rgb_map(read_picture(source_of(texture), Use::emission));
    for (std::size_t i = 0; i < map.sample_count(); ++i) map.f32()[i] *= factor[static_cast<int>(i % 3)];
    return builder_.add_light_picture(map, "the picture", info.place());
}

} // namespace montelux::gltf
