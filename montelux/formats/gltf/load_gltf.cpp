#include "montelux/formats/gltf/load_gltf.h"

#include <charconv>
#include <utility>

#include "montelux/formats/gltf/container.h"
#include "montelux/formats/gltf/coverage.h"
#include "montelux/formats/gltf/scene_reader.h"
#include "montelux/formats/mesh_scene.h"
#include "montelux/scene/build/quoted.h"

namespace montelux {
namespace {

// "2.1" from "2" on; anything else gives 0.
double version_of(const gltf::Value& text) {
    const std::string& s = text.text();
    double version = 0;
    const auto [end, error] =
        std::from_chars(s.data(), s.data() + s.size(), version, std::chars_format::fixed);
    return error == std::errc() && end == s.data() + s.size() ? version : 0;
}

void check_asset(const gltf::Value& root) {
    const gltf::Value asset = root.required("asset"), version = asset.required("version");
    if (const double v = version_of(version); !(v >= 2 && v < 3))
        version.error("version " + gltf::in_quotes(version.text()) + " of glTF; expected 2.0");
    if (const std::optional<gltf::Value> least = asset.find("minVersion"))
        if (!(version_of(*least) <= 2.0))
            least->error("needs version " + gltf::in_quotes(least->text()) + " of glTF");
}

void check_extensions(const gltf::Value& root) {
    for (const gltf::Value& name : root.elements("extensionsRequired"))
        if (!gltf::is_supported_extension(name.text())) {
            const gltf::FeatureCoverage* const known = gltf::find_feature(name.text());
            name.error("the scene requires the extension " + gltf::in_quotes(name.text()) +
                       ", which is not supported" +
                       (known != nullptr && !known->note.empty() ? ": " + std::string(known->note) : ""));
        }
    std::string unknown;
    for (const gltf::Value& name : root.elements("extensionsUsed"))
        if (!gltf::is_supported_extension(name.text()))
            unknown += (unknown.empty() ? "" : ", ") + shown(name.text());
    if (!unknown.empty()) root.warn("extensions that are ignored: " + unknown);
}

} // namespace

SceneDescription load_gltf(std::vector<std::uint8_t> bytes, const std::filesystem::path& path,
                           Warnings& warnings, FileSource& source, const LoadOptions& options) {
    gltf::Diagnostics diagnostics(path.string(), warnings);
    if (options.files_read != nullptr) options.files_read->push_back(path);
    const gltf::Container container = gltf::open_container(std::move(bytes), diagnostics);
    gltf::Document document(container, path, source, options.files_read, diagnostics);
    check_asset(document.root());
    check_extensions(document.root());
    SceneDescription description = model_description();
    description.scene.texel_file = options.texel_file;
    gltf::SceneReader(document, description, options).read();
    return description;
}

} // namespace montelux
