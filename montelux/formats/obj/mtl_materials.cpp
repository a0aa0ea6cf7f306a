#include "montelux/formats/obj/mtl_materials.h"

#include <algorithm>
#include <cmath>

#include "montelux/image/image_read.h"
#include "montelux/mc/math/constants.h"
#include "montelux/mc/math/error.h"
#include "montelux/scene/build/quoted.h"
#include "montelux/spectrum/rgb_colorspace.h"

namespace montelux {
namespace {

constexpr float least_gloss_exponent = 5; // below it Phong's lobe is as wide as a matt surface's
constexpr double bump_unit = 0.01;        // of the model's size

bool is_black(std::optional<Vec3f> rgb) { return !rgb || max_component(*rgb) == 0; }

bool is_transmitting(const MtlMaterial& m) {
    const int illum = m.illumination.value_or(2);
    const bool refracts = illum == 4 || illum == 6 || illum == 7 || illum == 9;
    return refracts && (m.opacity < 1 || is_black(m.diffuse.value_or(Vec3f{1, 1, 1})));
}

float alpha_of(const MtlMaterial& m) { return std::sqrt(2 / (m.exponent.value_or(0) + 2)); }
bool has_gloss(const MtlMaterial& m) {
    return m.illumination.value_or(2) > 1 && !is_black(m.specular) &&
           m.exponent.value_or(0) >= least_gloss_exponent;
}

RoughnessParameter roughness(float alpha) { return {.u = {alpha}, .v = {alpha}, .remap = false}; }

} // namespace

std::optional<std::filesystem::path> MtlMaterials::find(std::string name) const {
    if (name.empty() || name.find('\0') != std::string::npos) return std::nullopt;
    std::ranges::replace(name, '\\', '/');
    const std::filesystem::path path = std::filesystem::path(name).lexically_normal();
    const bool stays = path.is_relative() && !path.empty() && *path.begin() != "..";
    if (stays && files_.exists(folder_ / path)) return folder_ / path;
    const std::filesystem::path beside = folder_ / path.filename();
    if (path.has_filename() && files_.exists(beside)) return beside;
    return std::nullopt;
}

std::optional<Index> MtlMaterials::image(const MtlMap& map, bool is_color, std::uint32_t file) {
    const auto [known, is_new] = images_.try_emplace({map.file, is_color});
    if (!is_new) return known->second;
    const SourceLocation at{file, static_cast<std::uint32_t>(map.line), 1};
    const std::optional<std::filesystem::path> path = find(map.file);
    if (!path) {
        messages_.warn(at, "there is no picture " + montelux::quoted(map.file) +
                               " in the folder of the file; the material is "
                               "without it");
        return std::nullopt;
    }
    if (files_read_ != nullptr) files_read_->push_back(*path);
    try {
        Image picture = read_image(read_unpacked(files_, *path), path->string());
        const bool integers = picture.format() == PixelFormat::u8 || picture.format() == PixelFormat::u16;
        if (!is_color && integers) picture.set_encoding(ColorEncoding::linear());
        known->second = builder_.add_image(std::move(picture), path->string(), at);
    } catch (const Error& e) {
        messages_.warn(at, std::string(e.what()) + "; the material is without the picture");
    }
    return known->second;
}

ImageTexture MtlMaterials::texture(const MtlMap& map, Index image) const {
    ImageTexture t;
    t.image = image;
    t.mapping.su = map.scale.x;
    t.mapping.sv = map.scale.y;
    t.mapping.du = map.offset.x;
    t.mapping.dv = map.offset.y;
    t.filter = TextureFilter::trilinear;
    t.wrap = map.clamp ? TextureWrap::clamp : TextureWrap::repeat;
    return t;
}

SpectrumParameter MtlMaterials::color(Vec3f rgb) {
    const Vec3f limited{std::min(rgb.x, 1.0f), std::min(rgb.y, 1.0f), std::min(rgb.z, 1.0f)};
    if (limited.x == limited.y && limited.y == limited.z) return {limited.x};
    return {builder_.add_spectrum(RgbAlbedoSpectrum(RgbColorSpace::srgb(), limited))};
}

// A grey Kd scales its picture; exporters leave black there, which means the picture alone.
SpectrumParameter MtlMaterials::diffuse_color(const MtlMaterial& m, std::uint32_t file) {
    const Vec3f kd = m.diffuse.value_or(Vec3f{0.8f, 0.8f, 0.8f});
    const std::optional<Index> picture =
        m.diffuse_map.file.empty() ? std::nullopt : image(m.diffuse_map, true, file);
    if (!picture) return color(kd);
    ImageTexture t = texture(m.diffuse_map, *picture);
    const bool grey = kd.x == kd.y && kd.y == kd.z;
    if (m.diffuse && grey && kd.x > 0) t.scale = std::min(kd.x, 1.0f);
    if (!grey)
        messages_.warn({file, static_cast<std::uint32_t>(m.diffuse_map.line), 1},
                       "'Kd' of material " + montelux::quoted(m.name) +
                           " is ignored beside its picture: it is not grey");
    builder_.scene().spectrum_textures.emplace_back(t);
    SpectrumParameter p;
    p.texture = static_cast<Index>(builder_.scene().spectrum_textures.size() - 1);
    return p;
}

FloatParameter MtlMaterials::alpha(const MtlMaterial& m, std::uint32_t file) {
    const std::optional<Index> picture =
        m.opacity_map.file.empty() ? std::nullopt : image(m.opacity_map, false, file);
    if (!picture) return {m.opacity};
    ImageTexture t = texture(m.opacity_map, *picture);
    t.scale = m.opacity;
    if (builder_.scene().images[*picture].find_channel("A")) t.channels = ImageChannels::alpha;
    builder_.scene().float_textures.emplace_back(t);
    FloatParameter p;
    p.texture = static_cast<Index>(builder_.scene().float_textures.size() - 1);
    return p;
}

FloatParameter MtlMaterials::number(const MtlMap& map, float otherwise, std::uint32_t file) {
    const std::optional<Index> picture = map.file.empty() ? std::nullopt : image(map, false, file);
    if (!picture) return {otherwise};
    builder_.scene().float_textures.emplace_back(texture(map, *picture));
    return {0, static_cast<Index>(builder_.scene().float_textures.size() - 1)};
}

// A picture takes the place of its number. Without Pr the roughness is that of Ns.
PrincipledMaterial MtlMaterials::principled(const MtlMaterial& m, float ior, std::uint32_t file) {
    PrincipledMaterial p;
    p.base_color = diffuse_color(m, file);
    p.roughness = number(m.roughness_map, m.roughness.value_or(std::sqrt(alpha_of(m))), file);
    p.metallic = number(m.metallic_map, m.metallic.value_or(0), file);
    p.ior = {ior};
    p.clearcoat = {m.coat};
    p.clearcoat_roughness = {m.coat_roughness};
    // Negative: elongated across the tangent.
    p.anisotropy = {std::abs(m.anisotropy)};
    p.anisotropy_rotation = {m.anisotropy_turns * 2 * pi_f + (m.anisotropy < 0 ? pi_f / 2 : 0)};
    if (const float sheen = m.sheen.value_or(0); sheen > 0) p.sheen_color = color({sheen, sheen, sheen});
    if (!m.sheen_map.file.empty())
        if (const std::optional<Index> picture = image(m.sheen_map, false, file)) {
            builder_.scene().spectrum_textures.emplace_back(texture(m.sheen_map, *picture));
            p.sheen_color = {{}, static_cast<Index>(builder_.scene().spectrum_textures.size() - 1)};
        }
    p.sheen_roughness = {0.3f}; // the format has none; that of the Disney model's sheen looks like it
    return p;
}

// Exporters write normal maps as map_bump, too: those have colours.
SurfaceDetail MtlMaterials::detail(const MtlMaterial& m, std::uint32_t file, double size) {
    SurfaceDetail detail;
    const bool is_normal_map = !m.normal_map.file.empty();
    const MtlMap& map = is_normal_map ? m.normal_map : m.bump_map;
    if (map.file.empty()) return detail;
    const std::optional<Index> picture = image(map, false, file);
    if (!picture) return detail;
    Scene& scene = builder_.scene();
    const bool has_colors = scene.images[*picture].color_channels().size() == 3;
    if (has_colors) {
        scene.normal_maps.push_back(texture(map, *picture));
        detail.normal_map.map = static_cast<Index>(scene.normal_maps.size() - 1);
        return detail;
    }
    if (is_normal_map) {
        messages_.warn({file, static_cast<std::uint32_t>(map.line), 1},
                       "the normal map " + montelux::quoted(map.file) +
                           " has no channels R, G and B; it is ignored");
        return detail;
    }
    ImageTexture t = texture(map, *picture);
    t.scale = static_cast<float>(double(map.bumps) * bump_unit * size);
    scene.float_textures.emplace_back(t);
    detail.displacement.texture = static_cast<Index>(scene.float_textures.size() - 1);
    return detail;
}

MtlSurface MtlMaterials::add(const MtlMaterial& m, std::uint32_t file, double size) {
    MtlSurface surface;
    Scene& scene = builder_.scene();
    const float ior = m.ior.value_or(0) > 1 ? *m.ior : 1.5f; // many files have 1 or 0, which would be nothing
    const int illum = m.illumination.value_or(2);
    const bool is_mirror = m.diffuse && is_black(m.diffuse) && m.diffuse_map.file.empty() &&
                           !is_black(m.specular) && (illum == 3 || illum == 5);
    Material material;
    const SurfaceDetail detail = this->detail(m, file, size);
    if (is_transmitting(m)) {
        const float alpha = m.roughness ? *m.roughness * *m.roughness : 0;
        material = DielectricMaterial{.eta = ior, .roughness = roughness(alpha), .detail = detail};
    } else if (m.is_physically_based()) {
        PrincipledMaterial p = principled(m, ior, file);
        p.detail = detail;
        material = p;
    } else if (is_mirror) {
        ConductorMaterial metal{.detail = detail};
        metal.metal.from_reflectance = true;
        metal.metal.reflectance = color(*m.specular);
        metal.roughness = roughness(m.exponent ? alpha_of(m) : 0.0f);
        material = metal;
    } else if (has_gloss(m)) {
        CoatedDiffuseMaterial coated{.reflectance = diffuse_color(m, file), .detail = detail};
        coated.coating.eta = ior;
        coated.coating.roughness = roughness(alpha_of(m));
        material = coated;
    } else {
        material = DiffuseMaterial{.reflectance = diffuse_color(m, file), .detail = detail};
    }
    scene.materials.push_back(material);
    surface.material = static_cast<Index>(scene.materials.size() - 1);
    scene.material_names.resize(scene.materials.size());
    scene.material_names.back() = m.name;
    if (!is_transmitting(m)) surface.alpha = alpha(m, file);
    if (!is_black(m.emission)) {
        const Spectrum light = RgbIlluminantSpectrum(RgbColorSpace::srgb(), *m.emission);
        surface.emission = Emission{builder_.add_spectrum(light), photometric_scale(light)};
    }
    return surface;
}

} // namespace montelux
