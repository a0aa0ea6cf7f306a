// A mistake of the command line, as opposed to one of a file or of the work itself: exit code 2.
#pragma once

#include "montelux/mc/math/error.h"

namespace montelux::app {

struct UsageError : Error {
    using Error::Error;
};

} // namespace montelux::app
