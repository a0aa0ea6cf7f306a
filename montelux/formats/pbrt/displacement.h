// DisplacementReader: the parameter 'displacement' of plymesh shapes.
#pragma once

#include <cstddef>
#include <vector>

#include "montelux/formats/pbrt/parameter_reader.h"
#include "montelux/formats/pbrt/textures.h"

namespace montelux::pbrt {

class DisplacementReader {
  public:
    DisplacementReader(SceneBuilder& builder, TextureLibrary& textures)
        : builder_(builder), textures_(textures) {}

    // Of the file's option 'displacementedgescale': factor of all edge lengths.
    void scale_edges(float factor) { edge_scale_ = factor; }

    // Refines and displaces a mesh in object space, if the shape has 'displacement'. Heights are in units of
    // object space, 'edgelength' in those of the world. Textures are evaluated in world space, unfiltered.
    void displace(ParameterReader& r, TriangleMesh& mesh, const Transform& world_from_object);

  private:
    std::vector<float> heights(const TriangleMesh& mesh, const FloatParameter& height,
                               const Transform& world_from_object) const;

    SceneBuilder& builder_;
    TextureLibrary& textures_;
    float edge_scale_ = 1;
    std::size_t triangles_ = 0; // of all displaced shapes so far
};

} // namespace montelux::pbrt
