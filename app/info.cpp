// montelux info: what is in a picture, a texture or a scene.
#include "app/commands.h"
#include "app/definitions.h"
#include "app/json_number.h"
#include "app/scene_info.h"
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <system_error>
#include <type_traits>
#include <vector>

#include "montelux/image/image_read.h"
#include "montelux/image/metrics.h"
#include "montelux/image/texture_header.h"
#include "montelux/mc/io/file.h"

namespace montelux::app {

namespace {

using Json = nlohmann::ordered_json;

struct InfoSettings {
    std::string file;
    std::map<std::string, std::string> definitions;
    std::optional<std::string> camera;
    bool json = false;
};

Json json_of(const Attribute& attribute) {
    return std::visit(
        [](const auto& v) -> Json {
            using T = std::decay_t<decltype(v)>;
            if constexpr (std::is_same_v<T, Matrix4>) {
                Json rows = Json::array();
                for (const auto& row : v.m) {
                    Json r = Json::array();
                    for (double x : row) r.push_back(json_number(x));
                    rows.push_back(r);
                }
                return rows;
            } else if constexpr (std::is_same_v<T, std::vector<float>>) {
                Json list = Json::array();
                for (float x : v) list.push_back(json_number(static_cast<double>(x)));
                return list;
            } else if constexpr (std::is_same_v<T, std::string> || std::is_same_v<T, int>) {
                return v;
            } else {
                return json_number(static_cast<double>(v));
            }
        },
        attribute);
}

std::string encoding_name(ColorEncoding encoding) {
    switch (encoding.kind()) {
    case ColorEncoding::Kind::srgb:
        return "sRGB";
    case ColorEncoding::Kind::gamma:
        return "gamma " + std::to_string(encoding.exponent());
    case ColorEncoding::Kind::linear:
        break;
    }
    return "linear";
}

// Bytes that are not UTF-8 become U+FFFD.
std::string dump(const Json& json, int indent) {
    return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

void print_json(const InfoSettings& settings, const Image& image) {
    Json out;
    out["file"] = settings.file;
    out["width"] = image.width();
    out["height"] = image.height();
    out["format"] = name_of(image.format());
    out["encoding"] = encoding_name(image.encoding());
    for (int c = 0; c < image.channels(); ++c) {
        ChannelSummary s = summarize_channel(image, c);
        Json channel;
        channel["name"] = image.channel_names()[c];
        channel["minimum"] = json_number(s.minimum);
        channel["mean"] = json_number(s.mean);
        channel["maximum"] = json_number(s.maximum);
        channel["nan"] = s.nan;
        channel["infinite"] = s.infinite;
        channel["negative"] = s.negative;
        out["channels"].push_back(channel);
    }
    out["attributes"] = Json::object();
    for (const auto& [name, value] : image.attributes()) out["attributes"][name] = json_of(value);
    std::printf("%s\n", dump(out, 2).c_str());
}

// "-" where no sample is finite.
std::string value_text(double v) {
    if (!std::isfinite(v)) return "-";
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", v);
    return text;
}

void print_text(const InfoSettings& settings, const Image& image) {
    std::printf("%s: %d x %d pixels, %d channels, %s, %s\n", settings.file.c_str(), image.width(),
                image.height(), image.channels(), std::string(name_of(image.format())).c_str(),
                encoding_name(image.encoding()).c_str());
    std::printf("%-20s %13s %13s %13s %9s %9s %9s\n", "channel", "minimum", "mean", "maximum", "NaN",
                "infinite", "negative");
    for (int c = 0; c < image.channels(); ++c) {
        ChannelSummary s = summarize_channel(image, c);
        std::printf("%-20s %13s %13s %13s %9llu %9llu %9llu\n", image.channel_names()[c].c_str(),
                    value_text(s.minimum).c_str(), value_text(s.mean).c_str(), value_text(s.maximum).c_str(),
                    static_cast<unsigned long long>(s.nan), static_cast<unsigned long long>(s.infinite),
                    static_cast<unsigned long long>(s.negative));
    }
    if (!image.attributes().empty()) std::printf("header\n");
    // JSON quoting keeps control characters of a file away from the terminal.
    for (const auto& [name, value] : image.attributes())
        std::printf("  %s = %s\n", dump(name, -1).c_str(), dump(json_of(value), -1).c_str());
}

void print_texture(const InfoSettings& settings, const TextureHeader& h) {
    if (!settings.json) {
        std::printf("%s: %s, %u x %u texels, %u level%s, %u layer%s, %u face%s, %s%s%s\n",
                    settings.file.c_str(), h.container.c_str(), h.width, h.height, h.levels,
                    h.levels == 1 ? "" : "s", h.layers, h.layers == 1 ? "" : "s", h.faces,
                    h.faces == 1 ? "" : "s", h.format.c_str(), h.supercompression.empty() ? "" : ", ",
                    h.supercompression.c_str());
        for (std::size_t level = 0; level < h.level_bytes.size(); ++level)
            std::printf("  level %zu: %llu bytes\n", level,
                        static_cast<unsigned long long>(h.level_bytes[level]));
        for (const auto& [key, text] : h.notes)
            std::printf("  %s = %s\n", dump(key, -1).c_str(), dump(text, -1).c_str());
        return;
    }
    Json out;
    out["file"] = settings.file;
    out["container"] = h.container;
    out["format"] = h.format;
    out["supercompression"] = h.supercompression.empty() ? Json(nullptr) : Json(h.supercompression);
    out["width"] = h.width;
    out["height"] = h.height;
    out["depth"] = h.depth;
    out["levels"] = h.levels;
    out["layers"] = h.layers;
    out["faces"] = h.faces;
    out["level_bytes"] = h.level_bytes;
    out["notes"] = h.notes;
    std::printf("%s\n", dump(out, 2).c_str());
}

bool has_extension(const std::string& file, std::span<const std::string_view> extensions) {
    std::string extension = std::filesystem::path(file).extension().string();
    for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return std::ranges::find(extensions, extension) != extensions.end();
}

// A file that is none of a picture's by its name or its content is taken for a scene.
void print_info(const InfoSettings& settings) {
    constexpr std::array<std::string_view, 15> pictures = {".exr", ".png", ".jpg", ".jpeg", ".hdr",
                                                           ".pic", ".pfm", ".pbm", ".pgm",  ".ppm",
                                                           ".pnm", ".tga", ".bmp", ".rgbe", ".tif"};
    constexpr std::size_t most_bytes = std::size_t{1} << 30; // as of pictures
    const auto print_scene = [&] {
        print_scene_info(settings.file, {.camera = settings.camera, .definitions = settings.definitions},
                         settings.json);
    };
    if (has_extension(settings.file, std::array<std::string_view, 2>{".pbrt", ".gz"})) return print_scene();
    const bool is_named_picture = has_extension(settings.file, pictures);
    std::error_code missing;
    if (!is_named_picture && std::filesystem::file_size(settings.file, missing) > most_bytes && !missing)
        return print_scene();
    std::vector<std::uint8_t> bytes = read_file_bytes(settings.file, most_bytes);
    if (const auto header = texture_header(bytes, settings.file)) return print_texture(settings, *header);
    if (!is_named_picture && !bytes.empty() && !is_picture(bytes)) {
        // The file may be as large as the scene, which is read next.
        bytes = std::vector<std::uint8_t>();
        return print_scene();
    }
    const Image image = read_image(bytes, settings.file);
    if (settings.json)
        print_json(settings, image);
    else
        print_text(settings, image);
}

} // namespace

void add_info(CLI::App& app, int& exit_code) {
    auto settings = std::make_shared<InfoSettings>();
    CLI::App* command = app.add_subcommand("info", "Print what a picture, a texture or a scene contains");
    command
        ->add_option(
            "FILE", settings->file,
            "A picture (EXR, PNG, JPEG, HDR, PFM, PNM, TGA, BMP), a texture (KTX 2, KTX 1, DDS) or a scene")
        ->required();
    declare_definitions(*command, settings->definitions);
    command->add_option(
        "--camera", settings->camera,
        "Of a glTF or Mitsuba scene: its camera, by name or number from 0. Default: the first");
    command->add_flag("--json", settings->json, "Print JSON");
    command->footer("Examples:\n  montelux info out.exr --json\n  montelux info scene.pbrt");
    command->callback([settings, &exit_code] {
        print_info(*settings);
        exit_code = exit_done;
    });
}

} // namespace montelux::app
