// montelux formats: what is read of a scene format.
#include "app/commands.h"
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "montelux/formats/gltf/coverage.h"
#include "montelux/formats/mitsuba/coverage.h"
#include "montelux/formats/pbrt/coverage.h"

namespace montelux::app {

namespace {

// A line of a table: an area of the format, a feature of it, how much of that is read.
struct FormatLine {
    std::string area, feature;
    Support support = Support::full;
    std::string note;
};

std::vector<FormatLine> pbrt_lines() {
    std::vector<FormatLine> lines;
    for (const pbrt::PluginCoverage& p : pbrt::plugin_coverage())
        lines.push_back({std::string(p.directive), p.plugin, p.support, std::string(p.note)});
    return lines;
}
std::vector<FormatLine> gltf_lines() {
    std::vector<FormatLine> lines;
    for (const gltf::FeatureCoverage& f : gltf::feature_coverage())
        lines.push_back({std::string(f.area), std::string(f.feature), f.support, std::string(f.note)});
    return lines;
}
std::vector<FormatLine> mitsuba_lines() {
    std::vector<FormatLine> lines;
    for (const mitsuba::PluginCoverage& p : mitsuba::plugin_coverage())
        lines.push_back({std::string(p.kind), std::string(p.plugin), p.support, std::string(p.note)});
    return lines;
}

struct Table {
    const char *name, *help, *area, *feature; // the latter two: keys of the JSON
    std::vector<FormatLine> (*lines)();
};
constexpr Table tables[] = {
    {"pbrt", "The plugins of pbrt-v4's scene files, directive by directive", "directive", "plugin",
     pbrt_lines},
    {"gltf", "The features and extensions of glTF 2.0", "area", "feature", gltf_lines},
    {"mitsuba", "The plugins of Mitsuba 3, kind by kind", "kind", "plugin", mitsuba_lines},
};

void print(const std::vector<FormatLine>& lines) {
    std::size_t area_width = 0, feature_width = 0;
    for (const FormatLine& line : lines) {
        area_width = std::max(area_width, line.area.size());
        feature_width = std::max(feature_width, line.feature.size());
    }
    std::string area;
    for (const FormatLine& line : lines) {
        const std::string_view support = name_of(line.support);
        std::printf("%-*s %-*s %.*s", static_cast<int>(area_width),
                    line.area == area ? "" : line.area.c_str(), static_cast<int>(feature_width),
                    line.feature.c_str(), static_cast<int>(support.size()), support.data());
        area = line.area;
        if (!line.note.empty()) std::printf(": %s", line.note.c_str());
        std::printf("\n");
    }
}

void print_json(const Table& table) {
    nlohmann::ordered_json all = nlohmann::ordered_json::array();
    for (const FormatLine& line : table.lines())
        all.push_back({{table.area, line.area},
                       {table.feature, line.feature},
                       {"support", name_of(line.support)},
                       {"note", line.note}});
    std::printf("%s\n", all.dump(2).c_str());
}

} // namespace

void add_formats(CLI::App& app, int& exit_code) {
    CLI::App* command = app.add_subcommand("formats", "Print what is read of a scene format");
    command->require_subcommand(1);
    auto json = std::make_shared<bool>(false);
    for (const Table& table : tables) {
        CLI::App* format = command->add_subcommand(table.name, table.help);
        format->add_flag("--json", *json, "Print JSON");
        format->footer(std::string("Example:\n  montelux formats ") + table.name + " --json");
        format->callback([json, &table, &exit_code] {
            *json ? print_json(table) : print(table.lines());
            exit_code = exit_done;
        });
    }
}

} // namespace montelux::app
