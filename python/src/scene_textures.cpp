#include "python/src/scene_textures.h"

#include "python/src/images.h"
#include <cmath>
#include <cstdint>
#include <utility>

#include "montelux/formats/file_source.h"
#include "montelux/formats/measured_brdf_file.h"
#include "montelux/scene/build/scene_builder.h"

namespace montelux::python {
namespace {

ImageTexture texture_of(const std::string& filter, const std::string& wrap, const std::vector<double>& uv,
                        const std::string& what) {
    ImageTexture t;
    const std::vector<std::pair<std::string, TextureFilter>> filters{{"point", TextureFilter::point},
                                                                     {"bilinear", TextureFilter::bilinear},
                                                                     {"trilinear", TextureFilter::trilinear},
                                                                     {"ewa", TextureFilter::ewa}};
    const std::vector<std::pair<std::string, TextureWrap>> wraps{
        {"repeat", TextureWrap::repeat}, {"black", TextureWrap::black}, {"clamp", TextureWrap::clamp}};
    auto pick = [&](const auto& table, const std::string& name, const char* kind) {
        for (const auto& [text, value] : table)
            if (text == name) return value;
        throw Error(what, "there is no " + std::string(kind) + " '" + name + "'");
    };
    t.filter = pick(filters, filter, "filter");
    t.wrap = pick(wraps, wrap, "wrap");
    if (uv.size() != 4) throw Error(what + ", uv", "expected four numbers: su, sv, du, dv");
    t.mapping.su = static_cast<float>(uv[0]);
    t.mapping.sv = static_cast<float>(uv[1]);
    t.mapping.du = static_cast<float>(uv[2]);
    t.mapping.dv = static_cast<float>(uv[3]);
    return t;
}

} // namespace

nb::object image_texture(const SceneObject& s, const nb::object& image, const std::string& filter,
                         const std::string& wrap, double scale, bool invert, const std::vector<double>& uv,
                         bool as_float) {
    ImageTexture t = texture_of(filter, wrap, uv, "image_texture");
    if (!(scale >= 0 && std::isfinite(scale)))
        throw Error("image_texture, scale", "expected a number that is not negative");
    t.scale = static_cast<float>(scale);
    t.invert = invert;
    Image picture = picture_of(image, "image_texture");
    Scene& now = s.holder->edit().scene;
    CallMessages messages("image_texture", &s.holder->warnings);
    t.image = SceneBuilder(now, messages).add_image(std::move(picture), "the picture");
    if (as_float) {
        now.float_textures.emplace_back(t);
        return nb::cast(FloatTextureHandle{s.holder, static_cast<Index>(now.float_textures.size() - 1)});
    }
    now.spectrum_textures.emplace_back(t);
    return nb::cast(SpectrumTextureHandle{s.holder, static_cast<Index>(now.spectrum_textures.size() - 1)});
}

NormalMapHandle normal_map(const SceneObject& s, const nb::object& image, const std::string& filter,
                           const std::string& wrap, const std::vector<double>& uv) {
    ImageTexture t = texture_of(filter, wrap, uv, "normal_map");
    Image picture = picture_of(image, "normal_map");
    if (picture.color_channels().size() != 3)
        throw Error("normal_map", "the picture has no channels R, G and B");
    if (picture.format() == PixelFormat::u8 || picture.format() == PixelFormat::u16)
        picture.set_encoding(ColorEncoding::linear());
    CallMessages messages("normal_map", &s.holder->warnings);
    t.image = SceneBuilder(s.holder->edit().scene, messages).add_image(std::move(picture), "the picture");
    std::vector<ImageTexture>& all = s.holder->edit().scene.normal_maps;
    all.push_back(t);
    return {s.holder, static_cast<Index>(all.size() - 1)};
}

MeasuredBrdfHandle measured_brdf(const SceneObject& s, const std::filesystem::path& path) {
    DiskFiles disk;
    const std::vector<std::uint8_t> bytes = read_unpacked(disk, path);
    std::vector<MeasuredBrdf>& all = s.holder->edit().scene.measured_brdfs;
    all.push_back(read_measured_brdf(bytes, path.string()));
    return {s.holder, static_cast<Index>(all.size() - 1)};
}

SpectrumTextureHandle checkerboard(const SceneObject& s, const nb::object& a, const nb::object& b, double su,
                                   double sv) {
    const Spectrum first = spectrum_of(a, RgbMeaning::albedo, "checkerboard_texture"),
                   second = spectrum_of(b, RgbMeaning::albedo, "checkerboard_texture");
    Scene& scene = s.holder->edit().scene;
    CheckerboardTexture<SpectrumParameter> t;
    t.values = {SpectrumParameter{add_spectrum(scene, first)},
                SpectrumParameter{add_spectrum(scene, second)}};
    t.mapping.su = static_cast<float>(su);
    t.mapping.sv = static_cast<float>(sv);
    std::vector<SpectrumTexture>& all = scene.spectrum_textures;
    all.emplace_back(t);
    return {s.holder, static_cast<Index>(all.size() - 1)};
}

void bind_textures(nb::module_& m) {
    nb::class_<SpectrumTextureHandle>(m, "SpectrumTexture", "A texture of colours, of one scene.")
        .def("__repr__", [](const SpectrumTextureHandle& t) {
            return "<SpectrumTexture " + std::to_string(t.index) + ">";
        });
    nb::class_<FloatTextureHandle>(m, "FloatTexture", "A texture of numbers, of one scene.")
        .def("__repr__",
             [](const FloatTextureHandle& t) { return "<FloatTexture " + std::to_string(t.index) + ">"; });
    nb::class_<NormalMapHandle>(m, "NormalMap", "Shading normals over surfaces, of one scene.")
        .def("__repr__",
             [](const NormalMapHandle& t) { return "<NormalMap " + std::to_string(t.index) + ">"; });
    nb::class_<MeasuredBrdfHandle>(m, "MeasuredBrdf", "The measurements of a surface, of one scene.")
        .def("__repr__",
             [](const MeasuredBrdfHandle& b) { return "<MeasuredBrdf " + std::to_string(b.index) + ">"; });
}

} // namespace montelux::python
