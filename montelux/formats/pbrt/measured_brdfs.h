// MeasuredBrdfLibrary: the files of measured BRDFs of a pbrt scene, each added to the scene once.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "montelux/formats/pbrt/files.h"
#include "montelux/scene/build/scene_builder.h"

namespace montelux::pbrt {

class MeasuredBrdfLibrary {
  public:
    MeasuredBrdfLibrary(SceneBuilder& builder, Files& files, Diagnostics& diagnostics)
        : builder_(builder), files_(files), diagnostics_(diagnostics) {}

    // Into Scene::measured_brdfs.
    Index index(const std::string& file, Location at);

  private:
    SceneBuilder& builder_;
    Files& files_;
    Diagnostics& diagnostics_;
    std::map<std::filesystem::path, Index> known_;
};

} // namespace montelux::pbrt
