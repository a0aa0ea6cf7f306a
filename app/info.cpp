// montelux info: what is in a picture file.
#include "app/commands.h"
#include "app/json_number.h"
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <type_traits>

#include "montelux/image/image_read.h"
#include "montelux/image/metrics.h"

namespace montelux::app {

namespace {

using Json = nlohmann::ordered_json;

struct InfoSettings {
    std::string file;
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

} // namespace

void add_info(CLI::App& app, int& exit_code) {
    auto settings = std::make_shared<InfoSettings>();
    CLI::App* command =
        app.add_subcommand("info", "Print what a picture contains: size, channels, header, values");
    command->add_option("FILE", settings->file, "The picture (EXR, PNG, JPEG, HDR, PFM, PNM, TGA, BMP)")
        ->required();
    command->add_flag("--json", settings->json, "Print JSON");
    command->footer("Example:\n  montelux info out.exr --json");
    command->callback([settings, &exit_code] {
        Image image = read_image(settings->file);
        if (settings->json)
            print_json(*settings, image);
        else
            print_text(*settings, image);
        exit_code = exit_done;
    });
}

} // namespace montelux::app
