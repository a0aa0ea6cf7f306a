// Progress of a render on standard error: a bar on a terminal, plain lines elsewhere.
#pragma once

#include "app/progress_line.h"

#include "montelux/render/renderer.h"

namespace montelux::app {

class ProgressPrinter {
  public:
    // While the error is above `target` (unless 0), the end is not near whatever number of samples was
    // expected, except for the upper limit.
    ProgressPrinter(bool quiet, double target, double most_samples)
        : line_(quiet), target_(target), most_samples_(most_samples) {}

    void update(const RenderProgress& progress);
    // Ends the line of an unfinished bar.
    void finish() { line_.finish(); }

  private:
    ProgressLine line_;
    double target_, most_samples_;
};

} // namespace montelux::app
