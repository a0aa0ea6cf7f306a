// DomainProbe: a domain at four points, which tell it from others.
#pragma once

#include <vector>

#include "montelux/mc/integrate/domain.h"

namespace montelux {

struct DomainProbe {
    PointBuffer x;
    std::vector<double> volume; // the change of volume at each

    explicit DomainProbe(const Domain& domain);
    // The volumes, then the points coordinate by coordinate.
    std::vector<double> numbers() const;
};

} // namespace montelux
