#include "montelux/formats/file_kind.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>

#include "montelux/formats/stl.h"

namespace montelux {
namespace {

using namespace std::string_view_literals;

struct Beginning {
    std::string_view text, name, hint = {};
    std::size_t offset = 0;
};
constexpr auto checkpoint_hint = "give the scene itself, with --checkpoint FILE --resume"sv;

constexpr auto beginnings = std::to_array<Beginning>({
    {"mtlxgen\n", "a checkpoint of Montelux", checkpoint_hint},
    // Scenes.
    {"#usda", "a USD scene (text)"},
    {"PXR-USDC", "a USD scene (binary)"},
    {"Kaydara FBX Binary", "an FBX scene"},
    {"; FBX", "an FBX scene"},
    {"BLENDER", "a Blender file"},
    {"Ogawa", "an Alembic scene"},
    {"##RenderMan RIB", "a RenderMan scene"},
    {"#VRML", "a VRML scene"},
    // Meshes and volumes.
    {"OFF\n", "an OFF mesh"},
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
    if (contains(start, "<COLLADA")) return "a COLLADA scene";
    if (contains(start, "<X3D")) return "an X3D scene";
    if (contains(start, "<html") || contains(start, "<!DOCTYPE html")) return "a web page";
    if (contains(start, "<svg")) return "an SVG picture";
    return "an XML file";
}

// The outermost element is <scene>, behind declarations and comments.
bool is_mitsuba(std::string_view xml) {
    while (xml.starts_with("<?") || xml.starts_with("<!")) {
        const std::string_view end = xml.starts_with("<?") ? "?>" : xml.starts_with("<!--") ? "-->" : ">";
        const std::size_t found = xml.find(end);
        if (found == std::string_view::npos) return false;
        xml.remove_prefix(found + end.size());
        xml.remove_prefix(std::min(xml.find_first_not_of(" \t\r\n"), xml.size()));
    }
    return xml.starts_with("<scene") && xml.size() > 6 &&
           " \t\r\n/>"sv.find(xml[6]) != std::string_view::npos;
}

bool is_gltf(std::string_view json) {
    return contains(json, "\"asset\"") && (contains(json, "\"scenes\"") || contains(json, "\"nodes\"") ||
                                           contains(json, "\"meshes\"") || contains(json, "\"version\""));
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

// OBJ files have no mark: their first word is one of their statements, which are in small letters as no directive of
// pbrt is.
bool begins_obj(std::string_view text) {
    const std::string_view word = text.substr(0, text.find_first_of(" \t\r\n"));
    constexpr std::array statements{"v"sv, "vt"sv, "vn"sv, "vp"sv, "f"sv,      "o"sv,      "g"sv,
                                    "s"sv, "l"sv,  "p"sv,  "mg"sv, "mtllib"sv, "usemtl"sv, "cstype"sv};
    return std::ranges::find(statements, word) != statements.end();
}
bool begins_text_stl(std::string_view text) {
    return text.starts_with("solid") && contains(text.substr(0, 4096), "facet");
}

} // namespace

FileKind file_kind(std::span<const std::uint8_t> bytes) {
    if (is_binary_stl(bytes)) return {SceneFormat::stl};
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    auto find = [](std::string_view at) -> const Beginning* {
        for (const Beginning& b : beginnings)
            if (at.size() > b.offset && at.substr(b.offset).starts_with(b.text)) return &b;
        return nullptr;
    };
    if (text.starts_with("glTF")) return {SceneFormat::gltf};
    if (text.starts_with("ply\n") || text.starts_with("ply\r")) return {SceneFormat::ply};
    const Beginning* found = find(text);
    const std::string_view word = first_word_on(text);
    if (found == nullptr) found = find(word); // text that begins with a comment
    if (found != nullptr) return {SceneFormat::none, std::string(found->name), std::string(found->hint)};
    if (begins_text_stl(text)) return {SceneFormat::stl};
    if (begins_obj(word)) return {SceneFormat::obj};
    if (is_mitsuba(word)) return {SceneFormat::mitsuba};
    if (word.starts_with('<')) return {SceneFormat::none, std::string(kind_of_xml(word))};
    if (word.starts_with('{')) {
        if (is_gltf(word)) return {SceneFormat::gltf};
        return {SceneFormat::none, "a JSON file"};
    }
    if (contains(text.substr(0, 1024), "\0"sv))
        return {SceneFormat::none, "a binary file of an unknown kind"};
    return {SceneFormat::pbrt};
}

} // namespace montelux
