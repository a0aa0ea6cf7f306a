// run_render: a render as the options of the command line ask for it.
#pragma once

#include "app/render/render_options.h"

namespace montelux::app {

// Returns the exit code.
int run_render(const RenderOptions& options);

} // namespace montelux::app
