// What each part of montelux bake does around its work: threads, a clock, the progress line, signals.
#pragma once

#include "app/progress_line.h"
#include <chrono>
#include <functional>
#include <string>

#include "montelux/mc/parallel/cancel_flag.h"

namespace CLI {
class App;
}

namespace montelux::app {

struct BakeRunOptions {
    int threads = 0;
    bool json = false, quiet = false;
};

// --threads, --json and --quiet; `run` runs with that number of threads and returns the exit code.
void declare(CLI::App& command, BakeRunOptions& options);
void on_command(CLI::App& command, const BakeRunOptions& options, int& exit_code, std::function<int()> run);

// Lives as long as the work.
class BakeRun {
  public:
    // `whole` is what the progress line has a share of: "the texels".
    BakeRun(bool quiet, std::string whole);

    double seconds() const;
    const CancelFlag* cancel() const { return cancel_; }
    std::function<void(double)> progress();
    // Call when the work has ended: returns whether a signal interrupted it, and reports that. If not, files
    // can be written, and signals leave no partial file.
    bool interrupted(bool cancelled);

  private:
    std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
    ProgressLine line_;
    std::string whole_;
    const CancelFlag* cancel_;
};

} // namespace montelux::app
