#include "montelux/formats/file_kind.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>

namespace montelux {
namespace {

using namespace std::string_view_literals;

struct Beginning {
    std::string_view text, name, hint = {};
    std::size_t offset = 0;
};

constexpr auto mesh_hint = "a scene file of pbrt-v4 refers to it by Shape \"plymesh\""sv;
constexpr auto checkpoint_hint = "give the scene itself, with --checkpoint FILE --resume"sv;

constexpr auto binary_gltf = "a glTF scene (binary)"sv, gltf_text = "a glTF scene (JSON)"sv;

constexpr auto beginnings = std::to_array<Beginning>({
    {"mtlxgen\n", "a checkpoint of Montelux", checkpoint_hint},
    // Scenes.
    {"glTF", binary_gltf},
    {"#usda", "a USD scene (text)"},
    {"PXR-USDC", "a USD scene (binary)"},
    {"Kaydara FBX Binary", "an FBX scene"},
    {"; FBX", "an FBX scene"},
    {"BLENDER", "a Blender file"},
    {"Ogawa", "an Alembic scene"},
    {"##RenderMan RIB", "a RenderMan scene"},
    {"#VRML", "a VRML scene"},
    // Meshes and volumes.
    {"ply\n", "a PLY mesh", mesh_hint},
    {"ply\r", "a PLY mesh", mesh_hint},
    {"solid ", "an STL mesh"},
    {"OFF\n", "an OFF mesh"},
    {"mtllib ", "an OBJ mesh"},
    {"v ", "an OBJ mesh"},
    {"o ", "an OBJ mesh"},
    {"NanoVDB", "a NanoVDB volume"},
    {" BDV", "an OpenVDB volume"},
    // Pictures.
    {"\x89PNG", "a PNG picture"},
    {"\xff\xd8\xff", "a JPEG picture"},
    {"\x76\x2f\x31\x01", "an OpenEXR picture"},
    {"#?RADIANCE", "a Radiance HDR picture"},
    {"#?RGBE", "a Radiance HDR picture"},
    {"PF\n", "a PFM picture"},
    {"Pf\n", "a PFM picture"},
    {"P6\n", "a PPM picture"},
    {"II*\0"sv, "a TIFF picture"},
    {"MM\0*"sv, "a TIFF picture"},
    {"GIF8", "a GIF picture"},
    {"WEBP", "a WebP picture", {}, 8},
    {"8BPS", "a Photoshop picture"},
    {"DDS ", "a DDS texture"},
    {"\xabKTX ", "a KTX texture"},
    // Others.
    {"\x1f\x8b", "a gzip file", "the name of a compressed scene ends in .gz"},
    {"\x28\xb5\x2f\xfd", "a Zstandard file"},
    {"PK\x03\x04", "a ZIP archive"},
    {"%PDF", "a PDF document"},
    {"\x7f"
     "ELF",
     "a program"},
});

bool contains(std::string_view text, std::string_view part) {
    return std::search(text.begin(), text.end(), part.begin(), part.end()) != text.end();
}

std::string_view kind_of_xml(std::string_view text) {
    const std::string_view start = text.substr(0, 4096);
    if (contains(start, "<scene")) return "a Mitsuba scene (XML)";
    if (contains(start, "<COLLADA")) return "a COLLADA scene";
    if (contains(start, "<X3D")) return "an X3D scene";
    if (contains(start, "<html") || contains(start, "<!DOCTYPE html")) return "a web page";
    if (contains(start, "<svg")) return "an SVG picture";
    return "an XML file";
}

std::string_view kind_of_json(std::string_view text) {
    const bool is_gltf =
        contains(text, "\"asset\"") && (contains(text, "\"scenes\"") || contains(text, "\"nodes\"") ||
                                        contains(text, "\"meshes\"") || contains(text, "\"version\""));
    return is_gltf ? gltf_text : "a JSON file"sv;
}

// Behind white space, a byte order mark, and lines that begin with '#'.
std::string_view first_word_on(std::string_view text) {
    if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
    for (;;) {
        const std::size_t begin = text.find_first_not_of(" \t\r\n");
        if (begin == std::string_view::npos) return {};
        text.remove_prefix(begin);
        if (!text.starts_with('#')) return text;
        const std::size_t end = text.find('\n');
        if (end == std::string_view::npos) return {};
        text.remove_prefix(end);
    }
}

} // namespace

FileKind file_kind(std::span<const std::uint8_t> bytes) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    auto find = [](std::string_view at) -> const Beginning* {
        for (const Beginning& b : beginnings)
            if (at.size() > b.offset && at.substr(b.offset).starts_with(b.text)) return &b;
        return nullptr;
    };
    const Beginning* found = find(text);
    const std::string_view word = first_word_on(text);
    // OBJ files often begin with comments.
    if (found == nullptr) found = find(word);
    if (found != nullptr)
        return {std::string(found->name), std::string(found->hint), found->name == binary_gltf};
    if (word.starts_with('<')) return {std::string(kind_of_xml(word)), {}};
    if (word.starts_with('{')) {
        const std::string_view kind = kind_of_json(word);
        return {std::string(kind), {}, kind == gltf_text};
    }
    if (contains(text.substr(0, 1024), "\0"sv)) return {"a binary file of no kind that is known", {}};
    return {};
}

} // namespace montelux
