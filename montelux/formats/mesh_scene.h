// Scenes of a mesh by itself: an OBJ, PLY or STL file as a model that a studio lights and frames.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "montelux/formats/load_options.h"
#include "montelux/formats/warnings.h"
#include "montelux/scene/material/diffuse_material.h"
#include "montelux/scene/render_settings.h"

namespace montelux {

// A scene without shapes, lights and camera, with the settings for pictures of models: 800 x 600 pixels, 128 samples
// per pixel, 8 scattering events.
SceneDescription model_description();

// Of meshes whose files name no material: light grey clay.
inline DiffuseMaterial model_material() { return {.reflectance = {0.5f}}; }

// Files with the content `bytes`. Vertices of PLY files may have colours. A mesh without normals gets those of corner_normals. STL files have their z axis up,
// as printers and CAD programs have it; PLY files the y axis. Throw Error for the errors of parse_ply and parse_stl, and
// for files without triangles.
SceneDescription load_ply(const std::vector<std::uint8_t>& bytes, const std::filesystem::path& path,
                          Warnings& warnings, const LoadOptions& options);
SceneDescription load_stl(const std::vector<std::uint8_t>& bytes, const std::filesystem::path& path,
                          Warnings& warnings, const LoadOptions& options);

} // namespace montelux
