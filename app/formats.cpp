// montelux formats: what is read of a scene format.
#include "app/commands.h"
#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "montelux/formats/gltf/coverage.h"
#include "montelux/formats/pbrt/coverage.h"

namespace montelux::app {

namespace {

void print_pbrt_coverage() {
    std::string_view directive;
    for (const pbrt::PluginCoverage& p : pbrt::plugin_coverage()) {
        const std::string_view shown = p.directive == directive ? std::string_view() : p.directive;
        directive = p.directive;
        std::printf("%-16s %-20s %.*s", std::string(shown).c_str(), p.plugin.c_str(),
                    static_cast<int>(name_of(p.support).size()), name_of(p.support).data());
        if (!p.note.empty()) std::printf(": %s", std::string(p.note).c_str());
        std::printf("\n");
    }
}

void print_pbrt_coverage_json() {
    nlohmann::ordered_json all = nlohmann::ordered_json::array();
    for (const pbrt::PluginCoverage& p : pbrt::plugin_coverage())
        all.push_back({{"directive", p.directive},
                       {"plugin", p.plugin},
                       {"support", name_of(p.support)},
                       {"note", p.note}});
    std::printf("%s\n", all.dump(2).c_str());
}

void print_gltf_coverage() {
    std::string_view area;
    for (const gltf::FeatureCoverage& f : gltf::feature_coverage()) {
        const std::string_view shown = f.area == area ? std::string_view() : f.area;
        area = f.area;
        std::printf("%-10s %-36s %.*s", std::string(shown).c_str(), std::string(f.feature).c_str(),
                    static_cast<int>(name_of(f.support).size()), name_of(f.support).data());
        if (!f.note.empty()) std::printf(": %s", std::string(f.note).c_str());
        std::printf("\n");
    }
}

void print_gltf_coverage_json() {
    nlohmann::ordered_json all = nlohmann::ordered_json::array();
    for (const gltf::FeatureCoverage& f : gltf::feature_coverage())
        all.push_back(
            {{"area", f.area}, {"feature", f.feature}, {"support", name_of(f.support)}, {"note", f.note}});
    std::printf("%s\n", all.dump(2).c_str());
}

} // namespace

void add_formats(CLI::App& app, int& exit_code) {
    CLI::App* command = app.add_subcommand("formats", "Print what is read of a scene format");
    command->require_subcommand(1);
    auto json = std::make_shared<bool>(false);
    CLI::App* pbrt =
        command->add_subcommand("pbrt", "The plugins of pbrt-v4's scene files, directive by directive");
    pbrt->add_flag("--json", *json, "Print JSON");
    pbrt->footer("Example:\n  montelux formats pbrt --json");
    pbrt->callback([json, &exit_code] {
        *json ? print_pbrt_coverage_json() : print_pbrt_coverage();
        exit_code = exit_done;
    });
    CLI::App* gltf = command->add_subcommand("gltf", "The features and extensions of glTF 2.0");
    gltf->add_flag("--json", *json, "Print JSON");
    gltf->footer("Example:\n  montelux formats gltf --json");
    gltf->callback([json, &exit_code] {
        *json ? print_gltf_coverage_json() : print_gltf_coverage();
        exit_code = exit_done;
    });
}

} // namespace montelux::app
