// GuidingLearner: from the records of many paths to a GuidingField.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "montelux/transport/guiding/guiding_field.h"
#include "montelux/transport/guiding/guiding_trace.h"

namespace montelux {

struct GuidingLearnerSettings {
    std::size_t region_records = 4000;               // a region with more is halved
    std::size_t most_bytes = std::size_t{128} << 20; // of the field, roughly
    QuadtreeSettings directions{};
};

// The field depends on the order of the records, and not on the number of threads.
class GuidingLearner {
  public:
    // `records`: in lists, one after another. `expected`: of the pixels of `bounds`, GuidingField::expected.
    static GuidingField learn(std::span<const std::vector<GuidingRecord>> records,
                              const GuidingLearnerSettings& settings, const PixelBounds& bounds,
                              std::vector<float> expected);
};

} // namespace montelux
