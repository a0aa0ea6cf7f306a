// Writes any scene in the format of pbrt-v4: the inverse of load_pbrt.
#pragma once

#include <filesystem>
#include <vector>

#include "montelux/formats/warnings.h"
#include "montelux/scene/render_settings.h"

namespace montelux {

// Writes "NAME.pbrt" and, in the folder "NAME-files" beside it, the meshes, pictures and tables that it refers to.
// Read again, the scene has the same values in the same order, so that it renders to the same bits; but inverses of
// matrices, which the format does not hold, are computed anew, to the last bits of double precision. What the format
// cannot hold becomes a warning that says what is left out or changed, or an Error where the scene would be a different
// one. All files appear when all are complete; the scene is the last. Returns them.
std::vector<std::filesystem::path> write_pbrt(const SceneDescription& description,
                                              const std::filesystem::path& path, Warnings& warnings);

} // namespace montelux
