// What each part of montelux bake does around its work: threads, a clock, the progress line, signals.
#pragma once

#include "app/progress_line.h"
#include <chrono>
#include <functional>
#include <string>

#include "montelux/mc/parallel/parallel_for.h"

namespace CLI {
class App;
}

namespace montelux::app {

struct BakeRunOptions {
    int threads = 0;
    bool json = false, quiet = false;
};

// --threads, --json and --quiet; `run` is called with so many threads, and its result is the exit code.
void declare(CLI::App& command, BakeRunOptions& options);
void on_command(CLI::App& command, const BakeRunOptions& options, int& exit_code, std::function<int()> run);

// Begins with the work and lives as long as it.
class BakeRun {
  public:
    // `whole` is what the progress line has a share of: "the texels".
    BakeRun(bool quiet, std::string whole);

    double seconds() const;
    const CancelFlag* cancel() const { return cancel_; }
    std::function<void(double)> progress();
    // To be asked when the work has ended: whether a signal broke it off, which is told. If not, files can
    // be written, and no signal leaves a part of one behind.
    bool interrupted(bool cancelled);

  private:
    std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
    ProgressLine line_;
    std::string whole_;
    const CancelFlag* cancel_;
};

} // namespace montelux::app
