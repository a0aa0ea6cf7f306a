// montelux compare: how far a picture is from a reference, and whether its errors explain the distance.
#include "app/commands.h"
#include "app/json_number.h"
#include "app/option_values.h"
#include "app/output_files.h"
#include "app/picture_layer.h"
#include "app/usage_error.h"
#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

#include "montelux/image/difference_picture.h"
#include "montelux/image/image_read.h"
#include "montelux/image/image_write.h"
#include "montelux/image/metrics.h"
#include "montelux/image/placement.h"

namespace montelux::app {

namespace {

using Json = nlohmann::ordered_json;

struct CompareSettings {
    std::string a, b, layer_a, layer_b, error_a, error_b, difference, measure = "relative";
    ComparisonOptions options;
    double full_scale = 0;
    bool json = false;
};

// A picture as read, with the file that its errors came from.
struct Side {
    Image image, error;
    MeasuredPicture picture;
    std::string error_source; // empty without errors
};

// The name of the errors' file when a picture is called mean.exr and stderr.exr lies beside it.
std::string sibling_error_file(const std::filesystem::path& path) {
    if (path.filename() != "mean.exr") return {};
    auto sibling = path.parent_path() / "stderr.exr";
    std::error_code ignored;
    return std::filesystem::is_regular_file(sibling, ignored) ? sibling.string() : std::string();
}

void load(Side& side, const std::string& file, const std::string& layer, const std::string& error_option) {
    side.image = read_image(file);
    // Errors belong to the mean alone.
    if (!layer.empty() && layer != "mean") side.image = layer_of(side.image, layer, file).image;
    side.picture = measured_picture(file, side.image);
    std::string error_file = error_option;
    if (error_file.empty() && side.picture.has_error()) {
        side.error_source = "its stderr layer";
        return;
    }
    if (error_file.empty()) error_file = sibling_error_file(file);
    if (error_file.empty()) return;
    side.error = read_image(error_file);
    side.picture = measured_picture(file, side.image, error_file, side.error);
    side.error_source = error_file;
}

// Leaves of a picture and its errors the pixels of `window`.
void cut(Side& side, const std::string& file, const PixelWindow& window) {
    const Placement place = placement_of(side.image);
    const bool own_file = !side.error.empty();
    if (own_file) {
        set_placement(side.error, place.data.x0, place.data.y0, place.display);
        side.error = cut_out(side.error, window);
    }
    side.image = cut_out(side.image, window);
    side.picture = own_file ? measured_picture(file, side.image, side.error_source, side.error)
                            : measured_picture(file, side.image);
}

Json json_of(const ZScores& z) {
    Json out;
    out["count"] = z.count;
    out["mean"] = json_number(z.mean);
    out["standard_deviation"] = json_number(z.standard_deviation);
    out["within"] = {json_number(z.within[0]), json_number(z.within[1]), json_number(z.within[2])};
    out["expected_within"] = ZScores::expected_within;
    out["largest"] = json_number(z.largest);
    out["equal_without_error"] = z.equal_without_error;
    out["unexplained"] = z.unexplained;
    out["invalid_errors"] = z.invalid_errors;
    return out;
}

Json json_side(const std::string& file, const Side& side) {
    Json out;
    out["file"] = file;
    out["standard_errors"] = side.error_source.empty() ? Json(nullptr) : Json(side.error_source);
    return out;
}

void print_json(const CompareSettings& s, const Side& a, const Side& b, const Comparison& r,
                double full_scale) {
    Json out;
    out["a"] = json_side(s.a, a);
    out["b"] = json_side(s.b, b);
    out["width"] = a.image.width();
    out["height"] = a.image.height();
    const PixelWindow window = placement_of(a.image).data;
    out["window"] = {window.x0, window.y0, window.x1, window.y1};
    out["pixels"] = r.pixels;
    out["set_aside"] = r.set_aside;
    out["not_finite"] = r.not_finite;
    out["rmse"] = json_number(r.rmse);
    out["rel_mse"] = json_number(r.rel_mse);
    out["rel_mse_epsilon"] = s.options.relative_epsilon;
    for (const ChannelComparison& c : r.channels) {
        Json channel;
        channel["name"] = c.name;
        channel["mean_a"] = json_number(c.mean_a);
        channel["mean_b"] = json_number(c.mean_b);
        channel["relative_mean_difference"] = json_number(c.relative_mean_difference);
        channel["mean_difference_error"] = json_number(c.mean_difference_error);
        channel["rmse"] = json_number(c.rmse);
        channel["rel_mse"] = json_number(c.rel_mse);
        out["channels"].push_back(channel);
    }
    out["z"] = r.a_has_error || r.b_has_error ? json_of(r.z) : Json(nullptr);
    out["z_pooled"] = r.a_has_error || r.b_has_error ? json_of(r.pooled) : Json(nullptr);
    out["z_skew_corrected"] = r.skew_known ? json_of(r.skew_corrected) : Json(nullptr);
    if (!s.difference.empty()) {
        out["difference"]["file"] = s.difference;
        out["difference"]["measure"] = s.measure;
        out["difference"]["full_scale"] = json_number(full_scale);
    }
    std::printf("%s\n", out.dump(2, ' ', false, Json::error_handler_t::replace).c_str());
}

unsigned long long count(std::uint64_t n) { return n; }

void print_scores(const char* what, const ZScores& z) {
    std::printf("%s of %llu samples: mean %.4f, standard deviation %.4f, largest %.2f\n", what,
                count(z.count), z.mean, z.standard_deviation, z.largest);
    for (int k = 0; k < 3; ++k)
        std::printf("  within %d: %7.3f%%  (Gaussian errors: %.3f%%)\n", k + 1, 100 * z.within[k],
                    100 * ZScores::expected_within[k]);
}

void print_z(const Comparison& r) {
    if (!r.a_has_error && !r.b_has_error) {
        std::printf("z-scores: none, for neither picture has standard errors\n");
        return;
    }
    if (!r.a_has_error || !r.b_has_error)
        std::printf("z-scores use the standard errors of %s alone, as if %s were exact\n",
                    r.a_has_error ? "A" : "B", r.a_has_error ? "B" : "A");
    const ZScores& z = r.z;
    print_scores("z-scores", z);
    print_scores("z-scores with errors pooled over 3 x 3 pixels", r.pooled);
    if (r.skew_known) print_scores("z-scores corrected for skewness", r.skew_corrected);
    if (z.equal_without_error)
        std::printf("  %llu samples are equal and have no error\n", count(z.equal_without_error));
    if (z.unexplained)
        std::printf("  %llu samples differ although their errors are 0\n", count(z.unexplained));
    if (z.invalid_errors)
        std::printf("  %llu samples have an error that is negative, NaN or infinite\n",
                    count(z.invalid_errors));
}

// "-" for what is not known: an error without standard errors, a ratio to a black picture.
std::string percent(double fraction) {
    if (!std::isfinite(fraction)) return "-";
    char buffer[64];
    std::snprintf(buffer, sizeof buffer, "%.4f%%", 100 * fraction);
    return buffer;
}

void print_text(const CompareSettings& s, const Side& a, const Side& b, const Comparison& r,
                double full_scale, bool in_common) {
    auto errors = [](const Side& side) {
        return side.error_source.empty() ? std::string("no standard errors")
                                         : "standard errors from " + side.error_source;
    };
    std::printf("A  %s  (%s)\nB  %s  (%s)\n", s.a.c_str(), errors(a).c_str(), s.b.c_str(), errors(b).c_str());
    std::printf("%d x %d pixels", a.image.width(), a.image.height());
    if (in_common) std::printf(" that both pictures have (%s)", text_of(placement_of(a.image).data).c_str());
    std::printf(", %llu compared", count(r.pixels));
    if (r.set_aside)
        std::printf(", %llu set aside (the noisiest %g%% of %s)", count(r.set_aside),
                    s.options.set_aside_percent, r.b_has_error ? "B" : "A");
    if (r.not_finite) std::printf(", %llu left out because they are not finite", count(r.not_finite));
    std::printf("\n%-8s %13s %13s %12s %12s %12s %12s\n", "channel", "mean A", "mean B", "A/B - 1",
                "its error", "RMSE", "relMSE");
    for (const ChannelComparison& c : r.channels)
        std::printf("%-8s %13.6g %13.6g %12s %12s %12.5g %12.5g\n", c.name.c_str(), c.mean_a, c.mean_b,
                    percent(c.relative_mean_difference).c_str(),
                    percent(c.mean_difference_error / std::abs(c.mean_b)).c_str(), c.rmse, c.rel_mse);
    std::printf("RMSE %.6g, relMSE %.6g (epsilon %g)\n", r.rmse, r.rel_mse, s.options.relative_epsilon);
    print_z(r);
    if (!s.difference.empty())
        std::printf("%s: %s difference, blue where A is darker, red where brighter, full at %.4g\n",
                    s.difference.c_str(), s.measure.c_str(), full_scale);
}

void run_compare(const CompareSettings& s) {
    if (!s.difference.empty()) {
        const std::string extension = std::filesystem::path(s.difference).extension().string();
        if (extension != ".png" && extension != ".PNG")
            throw UsageError("--difference",
                             "'" + s.difference + "' was given; expected a name that ends in .png");
        check_output_names({s.difference}, {s.a, s.b, s.error_a, s.error_b, sibling_error_file(s.a),
                                            sibling_error_file(s.b)});
        check_writable(s.difference);
    }
    Side a, b;
    load(a, s.a, s.layer_a, s.error_a);
    load(b, s.b, s.layer_b, s.error_b);
    const std::optional<PixelWindow> common = common_pixels(s.a, a.image, s.b, b.image);
    if (common) {
        cut(a, s.a, *common);
        cut(b, s.b, *common);
    }
    Comparison result = compare_pictures(a.picture, b.picture, s.options);
    double full_scale = 0;
    if (!s.difference.empty()) {
        auto measure = s.measure == "z" ? DifferenceMeasure::z_score : DifferenceMeasure::relative;
        DifferencePicture d = difference_picture(a.picture, b.picture, measure, s.full_scale);
        write_image(s.difference, d.picture);
        full_scale = d.full_scale;
    }
    if (s.json)
        print_json(s, a, b, result, full_scale);
    else
        print_text(s, a, b, result, full_scale, common.has_value());
}

} // namespace

void add_compare(CLI::App& app, int& exit_code) {
    auto s = std::make_shared<CompareSettings>();
    CLI::App* command = app.add_subcommand("compare", "Measure how far a picture is from a reference");
    command->add_option("A", s->a, "The picture")->required();
    command->add_option("B", s->b, "The reference; errors are read from stderr.exr beside a mean.exr")
        ->required();
    for (const auto& [option, layer, of] :
         {std::tuple("--layer-a", &s->layer_a, "A"), std::tuple("--layer-b", &s->layer_b, "B")})
        command
            ->add_option(option, *layer,
                         std::string("The layer of ") + of + ", such as denoised. Default: mean")
            ->type_name("NAME")
            ->take_last();
    command->add_option("--stderr-a", s->error_a, "Standard errors of A, in place of its stderr layer");
    command->add_option("--stderr-b", s->error_b, "Standard errors of B, in place of its stderr layer");
    command
        ->add_option("--set-aside", s->options.set_aside_percent,
                     "Leave out this per cent of the pixels, where the reference is noisiest")
        ->check(number_within(0.0, 99.999));
    add_parsed(*command, "--epsilon", "EPSILON", s->options.relative_epsilon, parse_positive,
               "Epsilon of relMSE")
        ->default_str("0.01");
    auto* difference =
        command->add_option("--difference", s->difference, "Write a picture of the signed difference (.png)");
    command->add_option("--difference-of", s->measure, "What it shows: relative difference or z-scores")
        ->check(CLI::IsMember({"relative", "z"}))
        ->capture_default_str()
        ->needs(difference);
    add_parsed(*command, "--full-scale", "DIFFERENCE", s->full_scale, parse_positive,
               "Difference shown by the fullest colour; default: the 99th percentile")
        ->needs(difference);
    command->add_flag("--json", s->json, "Print JSON");
    command->footer(
        "Examples:\n"
        "  montelux compare out.exr ref/mean.exr\n"
        "  montelux compare out.exr other.exr --difference d.png --difference-of z\n"
        "\n"
        "Crops are compared with the whole, and with one another, where both have pixels (EXR alone "
        "keeps a crop's place).\n"
        "The exit code is 0 however far apart the pictures are.");
    command->callback([s, &exit_code] {
        run_compare(*s);
        exit_code = exit_done;
    });
}

} // namespace montelux::app
