#include "montelux/scene/light/sampler/light_parts.h"

#include "montelux/mc/math/error.h"

namespace montelux {

LightParts::LightParts(std::span<const Index> counts) {
    first_.reserve(counts.size() + 1);
    for (const Index count : counts) {
        if (count >= no_index - first_.back()) throw Error("lights", "more than 2^32 emissive triangles");
        single_ = single_ && count == 1;
        first_.push_back(first_.back() + count);
    }
}

} // namespace montelux
