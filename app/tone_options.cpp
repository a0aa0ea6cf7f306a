#include "app/tone_options.h"

#include "app/joined.h"
#include "app/option_values.h"
#include "app/progress_line.h"
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "montelux/image/exposure.h"
#include "montelux/mc/math/nearest_name.h"

namespace montelux::app {
namespace {

std::string lower_extension_of(const std::string& path) {
    std::string extension = std::filesystem::path(path).extension().string();
    for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return extension;
}
bool is_png(const std::string& path) { return lower_extension_of(path) == ".png"; }
bool is_jpeg(const std::string& path) {
    return lower_extension_of(path) == ".jpg" || lower_extension_of(path) == ".jpeg";
}

ToneKind parse_tone(const std::string& option, const std::string& s) {
    if (const auto kind = tone_named(s)) return *kind;
    refuse(option, s, "one of " + joined(tone_names()) + " is expected" + did_you_mean(s, tone_names()));
}

int parse_bits(const std::string& option, const std::string& s) {
    if (s != "8" && s != "16") refuse(option, s, "8 or 16 is expected");
    return s == "8" ? 8 : 16;
}

std::string stops_text(float stops) {
    char text[32];
    std::snprintf(text, sizeof text, "%+.2f", static_cast<double>(stops));
    return text;
}

// Why nothing can be seen at `shares`, or nothing.
std::string blank_text(const ToneShares& shares) {
    if (shares.white > blank_share) return percent_text(shares.white) + " of the pixels are white";
    if (shares.black > blank_share) return percent_text(shares.black) + " of the pixels are black";
    return "";
}

void print_exposure(const std::string& path, const Image& picture, const ToneCurve& tone, bool chosen) {
    if (chosen && tone.exposure != 0) {
        const std::string reason = blank_text(tone_shares(picture, {0, tone.kind}));
        std::fprintf(stderr, "montelux: %s: exposure %s stops%s; --exposure STOPS sets it\n", path.c_str(),
                     stops_text(tone.exposure).c_str(), reason.empty() ? "" : (", at 0 " + reason).c_str());
        return;
    }
    const ToneShares shares = tone_shares(picture, tone);
    const std::string blank = blank_text(shares);
    if (blank.empty()) return;
    const float better = automatic_exposure(picture);
    const std::string advice = !shares.any_light ? "there is no light in the picture"
                               : std::abs(better - tone.exposure) < 0.5f
                                   ? "most of it has no light"
                                   : "--exposure auto chooses " + stops_text(better) + " stops";
    std::fprintf(stderr, "montelux: warning: %s: %s; %s\n", path.c_str(), blank.c_str(), advice.c_str());
}

} // namespace

void declare(CLI::App& c, ToneOptions& o) {
    c.add_option_function<std::string>(
         "--exposure",
         [&o](const std::string& s) {
             o.automatic = s == "auto";
             o.exposure.reset();
             if (o.automatic) return;
             std::string number = s;
             if (!number_within(double{least_exposure}, double{most_exposure})(number).empty())
                 refuse("--exposure", s, "a number from -100 to 100 is expected, or auto");
             o.exposure = std::stof(number);
         },
         ".png and .jpg: light is multiplied by 2^STOPS; auto: its log-average becomes 0.18. Default: 0, or "
         "auto where that would be black or white all over")
        ->type_name("STOPS|auto")
        ->take_last();
    add_parsed(c, "--tone", "CURVE", o.tone, parse_tone,
               ".png and .jpg: the curve from light to codes: " + joined(tone_names()) + ". Default: srgb");
    add_parsed(c, "--bits", "8|16", o.bits, parse_bits, ".png: bits per channel. Default: 8");
    add_parsed(
        c, "--quality", "N", o.quality,
        [](const std::string& option, const std::string& s) {
            return static_cast<int>(parse_whole_number(option, s, 1, 100));
        },
        ".jpg: from 1 to 100. Default: 95");
}

void check(const ToneOptions& o, const std::vector<std::string>& outputs) {
    const bool png = std::ranges::any_of(outputs, is_png), jpeg = std::ranges::any_of(outputs, is_jpeg);
    if ((o.exposure || o.automatic) && !png && !jpeg)
        throw UsageError("--exposure", "it is for .png and .jpg pictures; none is written");
    if (o.tone && !png && !jpeg)
        throw UsageError("--tone", "it is for .png and .jpg pictures; none is written");
    if (o.bits && !png) throw UsageError("--bits", "it is for .png pictures; none is written");
    if (o.quality && !jpeg) throw UsageError("--quality", "it is for .jpg pictures; none is written");
}

ToneCurve tone_curve_of(const ToneOptions& o, const Image& picture, DefaultExposure by_default) {
    ToneCurve curve{.exposure = 0, .kind = o.tone.value_or(ToneKind::srgb)};
    if (o.exposure)
        curve.exposure = *o.exposure;
    else if (o.automatic)
        curve.exposure = automatic_exposure(picture);
    else if (by_default == DefaultExposure::suitable)
        curve.exposure = suitable_exposure(picture, curve.kind);
    return curve;
}

WriteOptions tone_of(const ToneOptions& o, const std::string& path, const Image& picture,
                     DefaultExposure by_default, bool quiet) {
    WriteOptions writing;
    if (!is_png(path) && !is_jpeg(path)) return writing;
    writing.png_bits = o.bits.value_or(8);
    writing.jpeg_quality = o.quality.value_or(95);
    writing.tone.kind = o.tone.value_or(ToneKind::srgb);
    if (picture.color_channels().empty()) return writing; // write_image says so
    writing.tone = tone_curve_of(o, picture, by_default);
    const bool chosen = o.automatic || (!o.exposure && by_default == DefaultExposure::suitable);
    if (!quiet) print_exposure(path, picture, writing.tone, chosen);
    return writing;
}

} // namespace montelux::app
