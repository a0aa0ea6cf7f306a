#include "app/bake/bake_run.h"

#include "app/commands.h"
#include "app/interrupt.h"
#include <CLI/CLI.hpp>
#include <cstdio>
#include <utility>

#include "montelux/mc/parallel/parallel_for.h"

namespace montelux::app {

void declare(CLI::App& command, BakeRunOptions& options) {
    command.add_option("--threads", options.threads, "Threads at most; 0: one per processor")
        ->type_name("N")
        ->check(CLI::Range(0, most_threads));
    command.add_flag("--json", options.json, "Print a summary as JSON");
    command.add_flag("--quiet", options.quiet, "Print only errors and warnings");
}

void on_command(CLI::App& command, const BakeRunOptions& options, int& exit_code, std::function<int()> run) {
    command.callback([&options, &exit_code, run = std::move(run)] {
        end_on_signals();
        exit_code = with_threads(options.threads, run);
    });
}

BakeRun::BakeRun(bool quiet, std::string whole)
    : line_(quiet), whole_(std::move(whole)), cancel_(&cancel_on_signals()) {}

double BakeRun::seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
}

std::function<void(double)> BakeRun::progress() {
    return [this](double fraction) {
        if (line_.due(seconds()))
            line_.show("bake", percent_text(fraction) + " of " + whole_ + ", " + duration_text(seconds()));
    };
}

bool BakeRun::interrupted(bool cancelled) {
    line_.finish();
    if (cancelled)
        std::fprintf(stderr, "montelux: interrupted, nothing was written\n");
    else
        finish_on_signals();
    return cancelled;
}

} // namespace montelux::app
