// What the tests of the viewer share: a small scene, and pictures compared by their bits.
#pragma once

#include "test/render/mixed_scene.h"
#include <cstdint>
#include <cstring>
#include <memory>

namespace montelux::testing {

inline std::shared_ptr<SceneDescription> viewed_scene(std::uint32_t spp) {
    SceneBuilder b = mixed_scene(1, 40, 24);
    b.description.sampler.kind = SamplerKind::sobol;
    b.description.sampler.spp = spp;
    return std::make_shared<SceneDescription>(b.description);
}

inline bool same_bits(const Image& a, const Image& b) {
    const auto x = a.f32(), y = b.f32();
    return a.channel_names() == b.channel_names() && x.size() == y.size() &&
           std::memcmp(x.data(), y.data(), x.size_bytes()) == 0;
}

} // namespace montelux::testing
