// Fixtures of the Mitsuba tests: scenes from texts, what they become, and the error of a broken one.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "montelux/formats/mitsuba/load_mitsuba.h"
#include "montelux/formats/mitsuba/plugin.h"
#include "montelux/formats/mitsuba/scene_graph.h"
#include "montelux/mc/math/error.h"

namespace montelux::test {

// Files in memory: a scene that has none but these, by path.
class SceneTexts final : public FileSource {
  public:
    std::map<std::string, std::string> files;

    bool exists(const std::filesystem::path& path) override {
        return files.contains(path.lexically_normal().string());
    }
    std::vector<std::uint8_t> read(const std::filesystem::path& path, std::size_t) override {
        const std::string& text = files.at(path.lexically_normal().string());
        return {text.begin(), text.end()};
    }
};

inline std::string mitsuba_scene(std::string_view content) {
    return "<scene version=\"3.0.0\">" + std::string(content) + "</scene>";
}

// The graph of a text that is the file "scene.xml", beside `files`.
struct LoadedGraph {
    SceneTexts source;
    Warnings warnings;
    TextDiagnostics diagnostics{warnings};
    SceneFiles files{"", source, diagnostics};
    mitsuba::SceneGraph graph{{}, diagnostics, files};

    explicit LoadedGraph(const std::string& text, const std::map<std::string, std::string>& definitions = {},
                         std::map<std::string, std::string> others = {}) {
        source.files = std::move(others);
        graph.objects = mitsuba::read_scene_graph({text.begin(), text.end()}, "scene.xml", definitions,
                                                  diagnostics, files)
                            .objects;
    }
    // The first object of a kind.
    mitsuba::Plugin plugin(std::string_view kind) const {
        for (std::size_t i = 0; i < graph.objects.size(); ++i)
            if (graph.objects[i].kind == kind) return {graph, i};
        throw Error("test", "no " + std::string(kind));
    }
};

// What the error says; empty without one.
inline std::string graph_error(const std::string& text, std::map<std::string, std::string> others = {}) {
    try {
        const LoadedGraph loaded(text, {}, std::move(others));
    } catch (const Error& e) {
        return e.what();
    }
    return {};
}

} // namespace montelux::test
