// Looks: the textures, materials and media of a Mitsuba scene from a text.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <gtest/gtest.h>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "montelux/formats/mitsuba/materials.h"
#include "montelux/formats/mitsuba/media.h"
#include "montelux/formats/mitsuba/plugin.h"
#include "montelux/formats/mitsuba/scene_graph.h"
#include "montelux/formats/mitsuba/textures.h"
#include "montelux/mc/math/error.h"
#include "montelux/scene/build/scene_builder.h"
#include "montelux/scene/scene_tables.h"
#include "montelux/scene/texture/evaluate.h"
#include "montelux/spectrum/rgb_colorspace.h"
#include "montelux/spectrum/rgb_spectra.h"

namespace montelux::test {

// Files in memory, by name.
class LookFiles final : public FileSource {
  public:
    std::map<std::string, std::vector<std::uint8_t>> files;

    bool exists(const std::filesystem::path& path) override {
        return files.contains(path.lexically_normal().string());
    }
    std::vector<std::uint8_t> read(const std::filesystem::path& path, std::size_t) override {
        return files.at(path.lexically_normal().string());
    }
};

// A PFM file of `width` columns; the rows of `colors` from top to bottom.
inline std::vector<std::uint8_t> picture_file(int width, const std::vector<Vec3f>& colors) {
    const int height = static_cast<int>(colors.size()) / width;
    const std::string header = "PF\n" + std::to_string(width) + " " + std::to_string(height) + "\n-1.0\n";
    std::vector<std::uint8_t> bytes(header.begin(), header.end());
    for (int y = height - 1; y >= 0; --y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < 3; ++c) {
                const auto v = std::bit_cast<std::array<std::uint8_t, 4>>(colors[y * width + x][c]);
                bytes.insert(bytes.end(), v.begin(), v.end());
            }
    return bytes;
}
// Two by two pixels.
inline const Vec3f upper_left{0.8f, 0.1f, 0.1f}, upper_right{0.1f, 0.7f, 0.1f}, lower_left{0.1f, 0.1f, 0.6f},
    lower_right{0.9f, 0.9f, 0.9f};

struct Looks {
    LookFiles source;
    Warnings warnings;
    TextDiagnostics diagnostics{warnings};
    SceneFiles files{"", source, diagnostics};
    mitsuba::SceneGraph graph{{}, diagnostics, files};
    Scene scene;
    SceneBuilder builder{scene, diagnostics};
    mitsuba::TextureLibrary textures{builder};
    mitsuba::MaterialLibrary materials{builder, textures};
    mitsuba::MediumLibrary media{builder};

    // "four.pfm" has the four colours above.
    explicit Looks(std::string_view content, std::map<std::string, std::vector<std::uint8_t>> others = {}) {
        source.files = std::move(others);
        source.files["four.pfm"] = picture_file(2, {upper_left, upper_right, lower_left, lower_right});
        const std::string text = "<scene version=\"3.0.0\">" + std::string(content) + "</scene>";
        graph.objects =
            mitsuba::read_scene_graph({text.begin(), text.end()}, "scene.xml", {}, diagnostics, files)
                .objects;
    }

    // The first object of a kind.
    mitsuba::Plugin plugin(std::string_view kind) const {
        for (std::size_t i = 0; i < graph.objects.size(); ++i)
            if (graph.objects[i].kind == kind) return {graph, i};
        throw Error("test", "no " + std::string(kind));
    }
    mitsuba::SurfaceLook look() { return materials.of(plugin("bsdf")); }

    // Of the type M.
    template <typename M>
    const M& material(Index index) const {
        return std::get<M>(scene.materials.at(index));
    }

    float value(const FloatParameter& p, Point2f uv = {}) const {
        const SceneTables tables(scene);
        return evaluate(tables.view(), p, context(uv));
    }
    SampledSpectrum value(const SpectrumParameter& p, Point2f uv = {}) const {
        const SceneTables tables(scene);
        return evaluate(tables.view(), p, context(uv), lambda);
    }
    // Whether it is the albedo of a colour.
    void expect_albedo(const SpectrumParameter& p, Point2f uv, Vec3f rgb) const {
        const SampledSpectrum v = value(p, uv);
        const SampledSpectrum expected = RgbAlbedoSpectrum(RgbColorSpace::srgb(), rgb).sample(lambda);
        for (int i = 0; i < 4; ++i) EXPECT_NEAR(v[i], expected[i], 1e-5) << uv.x << ", " << uv.y;
    }

    SampledWavelengths lambda = SampledWavelengths::sample_visible(0.5f);

  private:
    static TextureContext context(Point2f uv) {
        return {.p = {}, .n = {0, 0, 1}, .uv = uv, .dpdx = {}, .dpdy = {}, .duvdx = {}, .duvdy = {}};
    }
};

inline void expect_says(const std::string& message, std::string_view part) {
    EXPECT_NE(message.find(part), std::string::npos) << message << "\n  does not say: " << part;
}

// What the error of `read` says about a scene; empty without one.
template <typename Read>
std::string look_error(std::string_view content, const Read& read,
                       std::map<std::string, std::vector<std::uint8_t>> files = {}) {
    try {
        Looks looks(content, std::move(files));
        read(looks);
    } catch (const Error& e) {
        return e.what();
    }
    return {};
}

} // namespace montelux::test
