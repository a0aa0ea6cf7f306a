// Progress of a render on standard error: a bar on a terminal, plain lines elsewhere.
#pragma once

#include "app/progress_line.h"
#include <string>
#include <utility>

#include "montelux/render/renderer.h"

namespace montelux::app {

class ProgressPrinter {
  public:
    // While the error is above `target` (unless 0), the end is not near whatever number of samples was
    // expected, except for the upper limit. `doing`: what a line begins with where there is no terminal.
    ProgressPrinter(bool quiet, double target, double most_samples, std::string doing)
        : line_(quiet), target_(target), most_samples_(most_samples), doing_(std::move(doing)) {}

    void update(const RenderProgress& progress);
    // Ends the line of an unfinished bar.
    void finish() { line_.finish(); }

  private:
    ProgressLine line_;
    double target_, most_samples_;
    std::string doing_;
};

} // namespace montelux::app
