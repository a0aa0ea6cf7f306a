// montelux bake environment: a map as a prefiltered cube map, an irradiance cube map and spherical harmonics.
#include "app/bake/bake.h"
#include "app/bake/bake_files.h"
#include "app/bake/bake_map.h"
#include "app/bake/bake_run.h"
#include "app/commands.h"
#include "app/json_number.h"
#include "app/option_values.h"
#include "app/output_files.h"
#include "app/progress_line.h"
#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "montelux/bake/prefilter.h"
#include "montelux/bake/spherical_harmonics.h"
#include "montelux/image/image_write.h"
#include "montelux/mc/io/file.h"

namespace montelux::app {
namespace {

using Json = nlohmann::ordered_json;

struct EnvironmentOptions {
    BakeMapOptions map;
    BakeFileOptions files;
    std::vector<std::string> outputs, irradiance, harmonics;
    std::string preview, roughness = "linear", sampling = "cells";
    int size = 256, irradiance_size = 32;
    std::optional<int> levels;
    std::optional<double> target_error;
    std::optional<std::uint64_t> samples, samples_max;
    double dark_floor = 0.01;
    bool source_mips = false;
    std::uint64_t seed = 0;
    BakeRunOptions run;
};

std::vector<double> roughness_of(const EnvironmentOptions& o) {
    static const std::map<std::string, RoughnessRule> rules{{"linear", RoughnessRule::linear},
                                                            {"filament", RoughnessRule::filament},
                                                            {"babylon", RoughnessRule::babylon}};
    auto check_levels = [&](const char* option, int levels) {
        if (levels > level_count(o.size))
            throw UsageError(option, "faces of " + std::to_string(o.size) + " texels have at most " +
                                         std::to_string(level_count(o.size)) + " levels");
    };
    if (const auto rule = rules.find(o.roughness); rule != rules.end()) {
        if (o.levels) check_levels("--levels", *o.levels);
        return roughness_by_rule(rule->second, o.levels, o.size);
    }
    std::vector<double> list;
    for (std::size_t begin = 0; begin <= o.roughness.size();) {
        const std::size_t end = std::min(o.roughness.find(',', begin), o.roughness.size());
        const std::string text = o.roughness.substr(begin, end - begin);
        char* rest = nullptr;
        const double r = std::strtod(text.c_str(), &rest);
        if (text.empty() || *rest != 0 || !(r >= 0 && r <= 1))
            throw UsageError("--roughness",
                             "expected linear, filament, babylon, or numbers from 0 to 1 with commas between "
                             "them, found '" +
                                 o.roughness + "'");
        list.push_back(r);
        begin = end + 1;
    }
    if (o.levels && *o.levels != static_cast<int>(list.size()))
        throw UsageError("--levels", std::to_string(*o.levels) + " levels and " +
                                         std::to_string(list.size()) +
                                         " values of --roughness do not go together");
    check_levels("--roughness", static_cast<int>(list.size()));
    return list;
}

BakeSettings settings_of(const EnvironmentOptions& o) {
    BakeSettings s;
    s.sampling = o.sampling == "lobe" ? PrefilterSampling::lobe : PrefilterSampling::cells;
    if (o.source_mips && s.sampling != PrefilterSampling::lobe)
        throw UsageError("--source-mips", "needs --sampling lobe; cells do without");
    s.source_mips = o.source_mips;
    if (o.samples) {
        if (o.target_error || o.samples_max)
            throw UsageError("--samples", "does not go with --target-error and --samples-max");
        s.target_error.reset();
        s.samples = *o.samples;
    } else {
        s.target_error = o.target_error.value_or(0.01);
        s.samples = o.samples_max.value_or(s.samples);
    }
    s.dark_floor = o.dark_floor;
    s.seed = o.seed;
    s.frame = frame_of(o.map);
    return s;
}

// Nine lines as Filament's tools read them.
std::string harmonics_text(const DiffuseHarmonics& h) {
    static constexpr const char* names[] = {"L00", "L1-1", "L10", "L11", "L2-2", "L2-1", "L20", "L21", "L22"};
    std::string text;
    for (std::size_t i = 0; i < h.polynomial.size(); ++i) {
        char line[160];
        std::snprintf(line, sizeof line,
                      "(%.9g, %.9g, %.9g); // %s, irradiance over pi, constants multiplied in\n",
                      h.polynomial[i].x, h.polynomial[i].y, h.polynomial[i].z, names[i]);
        text += line;
    }
    return text;
}

// As above without the rest: the note "sh" of a .ktx file.
std::string harmonics_note(const DiffuseHarmonics& h) {
    std::string text;
    for (const Vec3d& c : h.polynomial) {
        char line[120];
        std::snprintf(line, sizeof line, "%.9g %.9g %.9g\n", c.x, c.y, c.z);
        text += line;
    }
    return text;
}

Json json_of(const DiffuseHarmonics::Coefficients& coefficients) {
    Json out = Json::array();
    for (const Vec3d& c : coefficients) out.push_back({json_number(c.x), json_number(c.y), json_number(c.z)});
    return out;
}
Json json_of(const DiffuseHarmonics& h) {
    return {{"radiance", json_of(h.radiance)},
            {"irradiance", json_of(h.irradiance)},
            {"polynomial", json_of(h.polynomial)}};
}

void write_text(const std::string& path, const std::string& text) {
    AtomicFile file(path);
    file.write(text.data(), text.size());
    file.commit();
}

void check_files(const EnvironmentOptions& o, std::size_t levels) {
    if (o.outputs.empty() && o.irradiance.empty() && o.harmonics.empty() && o.preview.empty())
        throw UsageError("nothing to bake: give --output, --irradiance, --harmonics or --preview");
    std::vector<std::string> files = o.outputs;
    files.insert(files.end(), o.irradiance.begin(), o.irradiance.end());
    if (!o.preview.empty()) files.push_back(o.preview);
    check(o.files, files);
    std::vector<std::string> names = o.harmonics;
    names.push_back(o.preview);
    auto add = [&](const std::string& path, std::size_t count) {
        const std::vector<std::string> more = cube_file_names(path, o.files, count);
        names.insert(names.end(), more.begin(), more.end());
    };
    for (const std::string& path : o.outputs) add(path, levels);
    for (const std::string& path : o.irradiance) add(path, 1);
    check_output_names(names, {o.map.file});
    for (const std::string& path : o.outputs) check_cube_file(path, o.files, levels);
    for (const std::string& path : o.irradiance) check_cube_file(path, o.files, 1);
    for (const std::string& path : o.harmonics) {
        const std::string extension = std::filesystem::path(path).extension().string();
        if (extension != ".json" && extension != ".txt")
            throw UsageError(path, "spherical harmonics go into .json or .txt");
        const AtomicFile never_committed(path);
    }
    if (!o.preview.empty()) {
        if (o.outputs.empty()) throw UsageError("--preview", "shows the chain of --output, which is missing");
        check_writable(o.preview);
    }
}

Json json_of(const std::vector<LevelReport>& levels) {
    Json out = Json::array();
    for (const LevelReport& l : levels) {
        const double texels = 6.0 * l.size * l.size;
        Json level{{"size", l.size}};
        level["roughness"] = l.roughness < 0 ? Json(nullptr) : Json(l.roughness);
        level["samples_per_texel"] = static_cast<double>(l.samples) / texels;
        level["mean_error"] = json_number(l.mean_error);
        level["largest_error"] = json_number(l.largest_error);
        level["missed"] = l.missed;
        out.push_back(level);
    }
    return out;
}

void print_levels(const char* what, const std::vector<LevelReport>& levels) {
    std::printf("%-11s %6s %10s %14s %11s %14s %8s\n", what, "size", "roughness", "samples/texel",
                "mean error", "largest error", "missed");
    for (std::size_t i = 0; i < levels.size(); ++i) {
        const LevelReport& l = levels[i];
        char roughness[24] = "-";
        if (l.roughness >= 0) std::snprintf(roughness, sizeof roughness, "%.4g", l.roughness);
        std::printf("%-11zu %6d %10s %14.4g %11s %14s %8llu\n", i, l.size, roughness,
                    static_cast<double>(l.samples) / (6.0 * l.size * l.size),
                    percent_text(l.mean_error).c_str(), percent_text(l.largest_error).c_str(),
                    static_cast<unsigned long long>(l.missed));
    }
}

std::uint64_t missed(const BakedCubes& baked) {
    std::uint64_t sum = 0;
    for (const LevelReport& l : baked.levels) sum += l.missed;
    return sum;
}

int run(const EnvironmentOptions& o) {
    const std::vector<double> roughness = roughness_of(o);
    BakeSettings settings = settings_of(o);
    check_files(o, roughness.size());
    const EnvironmentMap map = read_map(o.map, o.run.quiet);
    const DiffuseHarmonics harmonics = diffuse_harmonics(map, settings.frame);

    BakeRun bake(o.run.quiet, "the texels");
    settings.progress = bake.progress();
    settings.cancel = bake.cancel();
    BakedCubes chain, irradiance;
    if (!o.outputs.empty()) chain = prefilter_environment(map, o.size, roughness, settings);
    if (!o.irradiance.empty() && !chain.cancelled)
        irradiance = irradiance_cube(map, o.irradiance_size, settings);
    if (bake.interrupted(chain.cancelled || irradiance.cancelled)) return exit_interrupted;
    const double time = bake.seconds();

    std::string list;
    for (double r : roughness) {
        char text[32];
        std::snprintf(text, sizeof text, "%.9g", r);
        list += (list.empty() ? "" : " ") + std::string(text);
    }
    OutputFiles files;
    for (const std::string& path : o.outputs) {
        std::map<std::string, std::string> notes{{"montelux.roughness", list}};
        if (std::filesystem::path(path).extension() == ".ktx") notes["sh"] = harmonics_note(harmonics);
        files.write(path, [&] { write_cube_file(path, o.files, chain, notes, o.run.quiet); });
    }
    for (const std::string& path : o.irradiance)
        files.write(path, [&] { write_cube_file(path, o.files, irradiance, {}, o.run.quiet); });
    for (const std::string& path : o.harmonics)
        files.write(path, [&] {
            write_text(path, std::filesystem::path(path).extension() == ".json"
                                 ? json_of(harmonics).dump(2) + "\n"
                                 : harmonics_text(harmonics));
        });
    if (!o.preview.empty())
        files.write(o.preview, [&] {
            const ContactSheet sheet = contact_sheet(chain.value);
            ToneOptions tone = o.files.tone;
            if (!tone.exposure) tone.exposure = sheet.exposure;
            write_image(o.preview, sheet.picture,
                        tone_of(tone, o.preview, sheet.picture, DefaultExposure::zero, o.run.quiet));
        });
    if (o.run.json) {
        Json out;
        out["map"] = {{"file", o.map.file},
                      {"layout", name_of(map.grid().layout())},
                      {"width", map.grid().width()},
                      {"height", map.grid().height()}};
        const Vec3d mean = map.mean_radiance();
        out["mean_radiance"] = {json_number(mean.x), json_number(mean.y), json_number(mean.z)};
        out["levels"] = json_of(chain.levels);
        out["irradiance"] = json_of(irradiance.levels);
        out["harmonics"] = json_of(harmonics);
        out["seconds"] = time;
        std::printf("%s\n", out.dump(2, ' ', false, Json::error_handler_t::replace).c_str());
    } else if (!o.run.quiet) {
        if (!chain.levels.empty()) print_levels("level", chain.levels);
        if (!irradiance.levels.empty()) print_levels("irradiance", irradiance.levels);
        std::printf("%s map of %d x %d texels, %s\n", std::string(name_of(map.grid().layout())).c_str(),
                    map.grid().width(), map.grid().height(), duration_text(time).c_str());
        if (o.source_mips)
            std::printf("averages over texels were used: the errors do not include their bias\n");
    }
    files.throw_failures();
    const std::uint64_t texels_missed = missed(chain) + missed(irradiance);
    if (texels_missed == 0) return exit_done;
    std::fprintf(stderr, "montelux: %llu texels exceed the target error; --samples-max limits them\n",
                 static_cast<unsigned long long>(texels_missed));
    return exit_stopped;
}

} // namespace

void add_bake_environment(CLI::App& bake, int& exit_code) {
    auto o = std::make_shared<EnvironmentOptions>();
    CLI::App* command = bake.add_subcommand(
        "environment", "Prefilter an environment map: GGX chain, irradiance, spherical harmonics");
    declare(*command, o->map);
    command
        ->add_option(
            "-o,--output", o->outputs,
            "Chain of cube maps; may be given several times. .ktx2, .ktx and .dds hold all levels; .exr "
            "(with standard errors), .hdr, .pfm, .png and .jpg are a picture per level, named _m0, _m1, ...")
        ->type_name("FILE")
        ->allow_extra_args(false);
    command->add_option("--size", o->size, "Texels along an edge of level 0")
        ->type_name("N")
        ->check(CLI::Range(1, 8192));
    command
        ->add_option("--levels", o->levels,
                     "Levels of the chain; without it, down to 16 texels, or to 1 for babylon")
        ->type_name("N")
        ->check(CLI::Range(1, 14));
    command
        ->add_option(
            "--roughness", o->roughness,
            "Perceptual roughness of the levels. linear: level / (levels - 1); filament: 1 - sqrt(1 "
            "- level / (levels - 1)); babylon: the root of 2^(level / 0.8) / size; or a list such as "
            "0,0.1,0.3,1")
        ->type_name("RULE");
    CLI::Option* irradiance = command
                                  ->add_option("--irradiance", o->irradiance,
                                               "Irradiance / pi as a cube map; files as for --output")
                                  ->type_name("FILE")
                                  ->allow_extra_args(false);
    command->add_option("--irradiance-size", o->irradiance_size, "Texels along its edge")
        ->type_name("N")
        ->check(CLI::Range(1, 8192))
        ->needs(irradiance);
    command
        ->add_option("--harmonics", o->harmonics,
                     "Order-2 spherical harmonics. .json: radiance, irradiance and the polynomial for "
                     "shaders; .txt: the "
                     "polynomial in nine lines")
        ->type_name("FILE")
        ->allow_extra_args(false);
    command
        ->add_option("--preview", o->preview,
                     "Contact sheet of the chain: a row per level, a column per face")
        ->type_name("FILE");
    declare(*command, o->files);
    add_parsed(
        *command, "--target-error", "ERROR", o->target_error, parse_share,
        "Standard error of each channel of each texel, relative to the mean of its channels: 0.01 (taken "
        "without the option) or 1%");
    add_whole_number(*command, "--samples", o->samples, 1, 1u << 30, "Number of samples per texel instead");
    add_whole_number(*command, "--samples-max", o->samples_max, 2, 1u << 30,
                     "Limit on the samples per round of a texel (1048576)");
    add_parsed(*command, "--dark-floor", "SHARE", o->dark_floor, parse_not_negative,
               "Texels darker than this share of the map's mean are measured by the share (0.01)");
    command
        ->add_option("--sampling", o->sampling,
                     "cells: within cells of the map that fit the lobe; lobe: directions from the lobe only")
        ->check(CLI::IsMember({"cells", "lobe"}))
        ->type_name("HOW");
    command->add_flag("--source-mips", o->source_mips,
                      "With --sampling lobe: look up averages over texels; less noise, but biased");
    add_whole_number(*command, "--seed", o->seed, 0, UINT64_MAX, "Seed of the noise");
    declare(*command, o->run);
    command->footer(
        "Example:\n  montelux bake environment sky.hdr -o sky.ktx2 --harmonics sky.json --preview sky.png");
    on_command(*command, o->run, exit_code, [o] { return run(*o); });
}

} // namespace montelux::app
