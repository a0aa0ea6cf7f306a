// montelux.Guide: what a guided render has learned.
#pragma once

#include <memory>

#include "montelux/transport/guiding/guiding_field.h"

namespace montelux::python {

struct Guide {
    std::shared_ptr<const GuidingField> field;
};

} // namespace montelux::python
