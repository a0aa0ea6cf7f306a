// SceneGraph: the objects of a Mitsuba 3 scene with all files that it includes; references resolved, without cycles.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "montelux/formats/mitsuba/object.h"
#include "montelux/formats/scene_files.h"
#include "montelux/formats/text_diagnostics.h"

namespace montelux::mitsuba {

struct SceneGraph {
    std::vector<Object> objects; // the scene first
    TextDiagnostics& diagnostics;
    SceneFiles& files;
};

// Reads the XML in `bytes`, which `path` names, and what it includes. `definitions`: values of `$name`, which come
// before those of <default>. Names of before version 2 become those of today. Throws Error "file:line:column: sentence"
// for what is no such scene: unknown elements and attributes, wrong numbers, parameters without a value, references to
// nothing or in a circle, entities. Both of `diagnostics` and `files` must outlive the graph.
SceneGraph read_scene_graph(const std::vector<std::uint8_t>& bytes, const std::filesystem::path& path,
                            const std::map<std::string, std::string>& definitions,
                            TextDiagnostics& diagnostics, SceneFiles& files);

} // namespace montelux::mitsuba
