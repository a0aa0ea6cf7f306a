// SceneDigest: hashes of the values of a scene. Equal digests mean equal samples.
#pragma once

#include "montelux/scene/content_digest.h"
#include "montelux/scene/scene.h"

namespace montelux {

// By parts, so that messages can name the part that differs.
struct SceneDigest {
    // Meshes, quadrics, shapes, objects, instances, and the motions of these and of lights.
    ContentDigest geometry;
    // Their parameters; the assignment to shapes is part of the geometry. With media, and where they are.
    ContentDigest materials;
    ContentDigest textures; // with their images
    ContentDigest lights;   // with their maps
    ContentDigest camera;

    ContentDigest whole() const;
    bool operator==(const SceneDigest&) const = default;
};

// Values only: addresses, file names, comments and the order of calls have no effect. The order of values
// counts, since they refer to one another by index, but not that of Scene::spectra. About 10 GB/s.
SceneDigest digest_of(const Scene& scene);

// Equal for spectra of the same kind and values.
ContentDigest digest_of(const Spectrum& spectrum);

} // namespace montelux
