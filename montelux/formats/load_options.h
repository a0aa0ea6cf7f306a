// LoadOptions: what a user asks of a scene file beside its path.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "montelux/formats/file_source.h"
#include "montelux/image/texel_file.h"

namespace montelux {

struct LoadOptions {
    // Receives every file that was read, so that no picture overwrites one.
    std::vector<std::filesystem::path>* files_read = nullptr;
    FileSource* source = nullptr;            // null: the disk
    std::shared_ptr<TexelFile> texel_file{}; // becomes Scene::texel_file
    // Of formats whose files hold several; an Error in others and for names that the file does not have.
    std::optional<std::string> camera{};  // by its name, or its number from 0; empty: the first one
    std::optional<std::string> variant{}; // of the materials; empty: the default ones
    std::optional<double> time{};         // of animations, seconds; empty: everything at rest
    // Values of the parameters `$name` of Mitsuba's XML, before those of its <default>; an Error in other formats.
    std::map<std::string, std::string> definitions{};
    // How long the shutter stays open from `time` on, seconds: what moves meanwhile is blurred. 0: a still.
    double shutter = 0;
    // False: pictures of textures and lights are not read, for callers that only ask where things are.
    bool pictures = true;
};

} // namespace montelux
