#include "montelux/formats/pbrt/scene_writer.h"

#include <array>
#include <map>

#include "montelux/image/image_write.h"
#include "montelux/mc/math/error.h"
#include "montelux/scene/scene_digest.h"
#include "montelux/spectrum/named_spectra.h"

namespace montelux::pbrt {
namespace {

struct DigestOrder {
    bool operator()(const ContentDigest& a, const ContentDigest& b) const {
        return a.high != b.high ? a.high < b.high : a.low < b.low;
    }
};

// Null for spectra that have no name.
const std::string* name_of_spectrum(const Spectrum& s) {
    static const std::map<ContentDigest, std::string, DigestOrder> names = [] {
        std::map<ContentDigest, std::string, DigestOrder> result;
        for (const std::string_view name : named_spectrum_names())
            result.emplace(digest_of(*find_named_spectrum(name)), name);
        return result;
    }();
    const auto found = names.find(digest_of(s));
    return found != names.end() ? &found->second : nullptr;
}

const RgbColor* color_of(const Spectrum& s, RgbMeaning meaning) {
    const RgbColor* color = nullptr;
    if (const auto* albedo = std::get_if<RgbAlbedoSpectrum>(&s.kind());
        albedo != nullptr && meaning == RgbMeaning::albedo)
        color = &albedo->color();
    if (const auto* unbounded = std::get_if<RgbUnboundedSpectrum>(&s.kind());
        unbounded != nullptr && meaning == RgbMeaning::unbounded)
        color = &unbounded->color();
    if (const auto* light = std::get_if<RgbIlluminantSpectrum>(&s.kind());
        light != nullptr && meaning == RgbMeaning::illuminant)
        color = &light->filter().color();
    return color != nullptr && color->space != nullptr &&
                   find_rgb_color_space(color->space->name()) == color->space
               ? color
               : nullptr;
}

// The pairs of which it was made, or nothing.
std::vector<float> pairs_of(const PiecewiseLinear& lines) {
    const std::span<const PiecewiseLinear::Knot> knots = lines.knots();
    std::vector<float> pairs;
    for (std::size_t i = 1; i + 2 < knots.size(); ++i) {
        pairs.push_back(knots[i].lambda);
        pairs.push_back(knots[i].value);
    }
    if (pairs.empty() ||
        digest_of(Spectrum(PiecewiseLinear::from_pairs(pairs))) != digest_of(Spectrum(lines)))
        return {};
    return pairs;
}

} // namespace

void SceneWriter::put_block(std::string_view text) {
    put("AttributeBegin\n");
    put(text);
    put("AttributeEnd\n");
}

void SceneWriter::tabulated(DirectiveText& d, std::string_view name, const Spectrum& s,
                            const std::string& what) {
    std::vector<float> pairs;
    for (float lambda = lambda_min; lambda <= lambda_max; ++lambda) {
        pairs.push_back(lambda);
        pairs.push_back(s(lambda));
    }
    d.numbers("spectrum", name, pairs);
    warn(what, "the spectrum of " + std::string(name) + " is written by its values at each nanometre");
}

void SceneWriter::spectrum(DirectiveText& d, std::string_view name, SceneSpectrum s, RgbMeaning meaning,
                           const std::string& what) {
    spectrum(d, name, spectrum_of(s, scene_.spectra), meaning, what);
}

void SceneWriter::spectrum(DirectiveText& d, std::string_view name, const Spectrum& s, RgbMeaning meaning,
                           const std::string& what) {
    if (const auto* constant = std::get_if<ConstantSpectrum>(&s.kind())) {
        const std::array<float, 4> pairs = {lambda_min, constant->value, lambda_max, constant->value};
        return d.numbers("spectrum", name, pairs);
    }
    if (const auto* body = std::get_if<BlackbodySpectrum>(&s.kind())) {
        const float kelvins = body->temperature();
        return d.numbers("blackbody", name, {&kelvins, 1});
    }
    if (const RgbColor* color = color_of(s, meaning); color != nullptr && d.use_color_space(*color->space))
        return d.vector("rgb", name, color->rgb);
    if (const std::string* known = name_of_spectrum(s)) {
        const std::string_view value = *known;
        return d.strings("spectrum", name, {&value, 1});
    }
    if (const auto* lines = std::get_if<PiecewiseLinearSpectrum>(&s.kind()))
        if (const std::vector<float> pairs = pairs_of(lines->data()); !pairs.empty())
            return d.numbers("spectrum", name, pairs);
    tabulated(d, name, s, what);
}

std::optional<std::string> SceneWriter::encoding_of(Index image) const {
    const Image& picture = scene_.images[image];
    if (picture.format() != PixelFormat::u8 && picture.format() != PixelFormat::u16) return std::nullopt;
    switch (picture.encoding().kind()) {
    case ColorEncoding::Kind::srgb:
        return std::nullopt;
    case ColorEncoding::Kind::gamma:
        return "gamma " + digits_of(picture.encoding().exponent());
    case ColorEncoding::Kind::linear:
        break;
    }
    return "linear";
}

std::string SceneWriter::image_file(Index image) {
    std::string& reference = image_files_[image];
    if (!reference.empty()) return reference;
    const Image& picture = scene_.images[image];
    const bool integers = picture.format() == PixelFormat::u8 || picture.format() == PixelFormat::u16;
    const std::string name = "image-" + std::to_string(image) + (integers ? ".png" : ".exr");
    const std::filesystem::path place = files_.add(name);
    if (integers) {
        Image codes = picture; // the scene says what they mean
        codes.set_encoding(ColorEncoding::srgb());
        write_image(place, codes, {.png_bits = picture.format() == PixelFormat::u8 ? 8 : 16});
    } else {
        write_image(place, picture);
    }
    return reference = files_.reference(name);
}

std::string SceneWriter::environment_file(Index environment) {
    std::string& reference = environment_files_[environment];
    if (!reference.empty()) return reference;
    const std::string name = "light-" + std::to_string(environment) + ".exr";
    write_image(files_.add(name), scene_.environments[environment]);
    return reference = files_.reference(name);
}

void SceneWriter::write() {
    put("# Written by Montelux.\n");
    camera();
    film();
    filter();
    sampler();
    integrator();
    put("\nWorldBegin\n\n");
    media();
    materials();
    shapes();
    lights_before(scene_.lights.size());
    instances_before(scene_.instances.size());
}

} // namespace montelux::pbrt
