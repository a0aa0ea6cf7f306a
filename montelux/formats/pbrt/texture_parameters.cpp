#include "montelux/formats/pbrt/texture_parameters.h"

#include <cmath>
#include <string>
#include <vector>

#include "montelux/mc/math/error.h"
#include "montelux/scene/build/float_range.h"

namespace montelux::pbrt {
namespace {

// A look-up sums all octaves; finer ones have periods below any rounding error.
constexpr int most_octaves = 64;

} // namespace

std::optional<ColorEncoding> parse_encoding(const std::string& name) {
    if (name == "sRGB") return ColorEncoding::srgb();
    if (name == "linear") return ColorEncoding::linear();
    if (!name.starts_with("gamma ")) return std::nullopt;
    Warnings ignored;
    Diagnostics diagnostics(ignored);
    diagnostics.add_file("encoding");
    try {
        Tokenizer tokens(std::string_view(name).substr(6), 0, diagnostics);
        std::vector<float> numbers;
        if (tokens.read_numbers(numbers) != 1 || tokens.next().kind != Token::Kind::end) return std::nullopt;
        return ColorEncoding::gamma(numbers[0]);
    } catch (const Error&) {
        return std::nullopt;
    }
}

Transform texture_space(ParameterReader& r, const TextureDeclaration& d) {
    if (!fits_float(d.world_from_texture))
        r.error("the texture's transformation is beyond what single-precision numbers hold");
    return d.world_from_texture.inverse();
}

Vec3f mix_direction(ParameterReader& r, const TextureDeclaration& d) {
    const Vec3d v = d.world_from_texture.vector(Vec3d(r.vector3("dir").value_or(Vec3f(0, 1, 0))));
    const double l = length(v);
    if (!(l > 0 && std::isfinite(l))) r.error("dir", "parameter 'dir' has no direction");
    return Vec3f(v / l);
}

NoiseOctaves noise_octaves(ParameterReader& r) {
    const NoiseOctaves n{r.integer("octaves", 8), r.number("roughness", 0.5f)};
    if (n.octaves < 0 || n.octaves > most_octaves)
        r.error("octaves", "parameter 'octaves' is " + std::to_string(n.octaves) + "; expected 0 to " +
                               std::to_string(most_octaves));
    return n;
}

std::optional<Vec3f> color_factor(ParameterReader& r) {
    const std::vector<Vec3f> factor = r.triples("factor", ParameterType::rgb);
    if (factor.size() > 1)
        r.error("factor", "parameter 'factor' has " + std::to_string(factor.size()) + " colours; expected 1");
    return factor.empty() ? std::nullopt : std::optional(factor[0]);
}

TextureWrap wrap_named(std::string_view name) {
    return name == "repeat"   ? TextureWrap::repeat
           : name == "black"  ? TextureWrap::black
           : name == "clamp"  ? TextureWrap::clamp
           : name == "mirror" ? TextureWrap::mirror
                              : TextureWrap::octahedral_sphere;
}

std::optional<ImageChannels> channels_asked(ParameterReader& r) {
    const std::string_view name =
        r.choice("channel", {"default", "color", "alpha", "red", "green", "blue", "angle"}, "default");
    if (name == "color") return ImageChannels::color;
    if (name == "alpha") return ImageChannels::alpha;
    if (name == "red") return ImageChannels::red;
    if (name == "green") return ImageChannels::green;
    if (name == "blue") return ImageChannels::blue;
    if (name == "angle") return ImageChannels::angle;
    return std::nullopt;
}

bool has_transparency(const Image& picture) {
    const auto alpha = picture.find_channel("A");
    if (!alpha || picture.color_channels().size() != 3) return false;
    for (int y = 0; y < picture.height(); ++y)
        for (int x = 0; x < picture.width(); ++x)
            if (picture.value(x, y, *alpha) != 1) return true;
    return false;
}

} // namespace montelux::pbrt
