// BadSampleReport: the samples left out of a picture: counts by kind, and the first.
#pragma once

#include <cstdint>
#include <optional>

#include "montelux/film/film.h"

namespace montelux {

struct BadSampleReport {
    std::uint64_t nan = 0, infinite = 0, negative = 0;
    std::optional<BadSample> first; // the one of lowest sample index, then row, then column

    std::uint64_t count() const { return nan + infinite + negative; }
    void add(const BadSample& bad);
    // In any order.
    void merge(const BadSampleReport& other);
};

} // namespace montelux
