// The pictures, textures and measurements that Python adds to a scene.
#pragma once

#include "python/src/bindings.h"
#include "python/src/scene_object.h"
#include "python/src/scene_values.h"
#include <filesystem>
#include <string>
#include <vector>

namespace montelux::python {

// What they take is described where they are bound, in scene.cpp.
nb::object image_texture(const SceneObject& s, const nb::object& image, const std::string& filter,
                         const std::string& wrap, double scale, bool invert, const std::vector<double>& uv,
                         bool as_float);
NormalMapHandle normal_map(const SceneObject& s, const nb::object& image, const std::string& filter,
                           const std::string& wrap, const std::vector<double>& uv);
MeasuredBrdfHandle measured_brdf(const SceneObject& s, const std::filesystem::path& path);
SpectrumTextureHandle checkerboard(const SceneObject& s, const nb::object& a, const nb::object& b, double su,
                                   double sv);

} // namespace montelux::python
