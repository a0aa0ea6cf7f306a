// Scenes in the XML of Mitsuba 3.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "montelux/formats/load_options.h"
#include "montelux/formats/warnings.h"
#include "montelux/scene/render_settings.h"

namespace montelux {

// Reads an XML file with the content `bytes`, and the files that it refers to. What is read, and what differs from
// Mitsuba: docs/mitsuba.md. Throws Error "file:line:column: sentence" for what is broken, and for plugins that are not
// supported; adds what it ignores to `warnings`.
SceneDescription load_mitsuba(const std::vector<std::uint8_t>& bytes, const std::filesystem::path& path,
                              Warnings& warnings, FileSource& source, const LoadOptions& options = {});

} // namespace montelux
