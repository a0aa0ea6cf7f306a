// Progress of a render on standard error: a bar on a terminal, plain lines elsewhere.
#pragma once

#include "montelux/render/renderer.h"

namespace montelux::app {

class ProgressPrinter {
  public:
    explicit ProgressPrinter(bool quiet);

    void update(const RenderProgress& progress);
    // Ends the bar's line, if one is being drawn.
    void finish();

  private:
    bool quiet_, terminal_, drawn_ = false;
    double last_update_seconds_ = 0;
};

// 75 -> "1:15", 3700 -> "1:01:40", 2.5 -> "2.5 s"
std::string duration_text(double seconds);
// 0.0213 -> "2.13 %"; infinite or unknown -> "?"
std::string percent_text(double fraction);
// 1234567 -> "1.23 M"
std::string count_text(double count);

} // namespace montelux::app
