// SceneDigest: what a scene contains, as hashes of its values. Equal digests mean equal samples.
#pragma once

#include "montelux/scene/content_digest.h"
#include "montelux/scene/scene.h"

namespace montelux {

// By parts, so that a message can say which of them differs.
struct SceneDigest {
    ContentDigest geometry;  // meshes, quadrics, shapes, objects, instances
    ContentDigest materials; // parameters; which shape has which is geometry
    ContentDigest textures;  // and their images
    ContentDigest lights;    // and their maps
    ContentDigest camera;

    ContentDigest whole() const;
    bool operator==(const SceneDigest&) const = default;
};

// Of values alone: not of addresses, file names, comments, or how the scene came about. Order counts, since
// values refer to one another by index. Some 10 GB a second.
SceneDigest digest_of(const Scene& scene);

} // namespace montelux
