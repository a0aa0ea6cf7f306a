// Progress of a render on standard error: a bar on a terminal, plain lines elsewhere.
#pragma once

#include "app/progress_line.h"

#include "montelux/render/renderer.h"

namespace montelux::app {

class ProgressPrinter {
  public:
    // Above an error of `target`, unless that is 0, the end is not near however many samples were expected,
    // but for the largest number that there may be.
    ProgressPrinter(bool quiet, double target, double most_samples)
        : line_(quiet), target_(target), most_samples_(most_samples) {}

    void update(const RenderProgress& progress);
    // Ends the bar's line, if one is being drawn.
    void finish() { line_.finish(); }

  private:
    ProgressLine line_;
    double target_, most_samples_;
};

} // namespace montelux::app
