// Progress of a render on standard error: a bar on a terminal, plain lines elsewhere.
#pragma once

#include "app/progress_line.h"

#include "montelux/render/renderer.h"

namespace montelux::app {

class ProgressPrinter {
  public:
    explicit ProgressPrinter(bool quiet) : line_(quiet) {}

    void update(const RenderProgress& progress);
    // Ends the bar's line, if one is being drawn.
    void finish() { line_.finish(); }

  private:
    ProgressLine line_;
};

} // namespace montelux::app
