// Progress of a render on standard error: a bar on a terminal, plain lines elsewhere.
#pragma once

#include "app/progress_line.h"
#include <string>
#include <utility>

#include "montelux/render/render_control.h"

namespace montelux::app {

class ProgressPrinter {
  public:
    // `doing`: what a line begins with where there is no terminal.
    ProgressPrinter(bool quiet, std::string doing) : line_(quiet), doing_(std::move(doing)) {}

    void update(const RenderProgress& progress);
    // Ends the line of an unfinished bar.
    void finish() { line_.finish(); }

  private:
    ProgressLine line_;
    std::string doing_;
};

} // namespace montelux::app
