// montelux integrate: from a formula to a value, or log Z, with its error.
#include "app/commands.h"
#include "app/integrate/compiled_function.h"
#include "app/integrate/convergence_plot.h"
#include "app/integrate/density_notes.h"
#include "app/integrate/integrate_options.h"
#include "app/integrate/integration_report.h"
#include "app/integrate/point_recorder.h"
#include "app/interrupt.h"
#include "app/output_files.h"
#include "app/progress_line.h"
#include "app/table_file.h"
#include "app/usage_error.h"
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "montelux/mc/integrate/trained/trained_density.h"
#include "montelux/mc/io/generation_file.h"
#ifdef MONTELUX_WITH_RENDER
#include "app/integrate/cluster_integrate.h"
#endif

namespace montelux::app {
namespace {

void check_extension(const std::string& path, const std::string& option, const std::string& extension) {
    if (std::filesystem::path(path).extension() != extension)
        throw UsageError(option, "'" + path + "' was given; expected a name that ends in " + extension);
}

bool may_train(const std::string& method) {
    return method == "auto" || method == "adaptive" || method == "vegas" || method == "vegas_sobol";
}

std::string trains_none(const std::string& method) {
    return "the method '" + method + "' trains no density; expected --method adaptive, vegas or vegas_sobol";
}

std::vector<std::string> inputs_of(const IntegrateOptions& o) {
    std::vector<std::string> inputs;
    for (const std::string& place : {o.library, o.source})
        if (!place.empty()) inputs.push_back(CompiledFunction::file_of(place));
    return inputs;
}

// Before the work begins, not after hours of it.
void check_files(const IntegrateOptions& o, const IntegrationTask& task) {
    if (!o.plot.empty()) check_extension(o.plot, "--plot", ".svg");
    if (!o.points.empty()) check_extension(o.points, "--points", ".csv");
    check_output_names({o.plot, o.points, o.checkpoint, o.save_density}, inputs_of(o));
    for (const std::string& path : {o.plot, o.points, o.checkpoint, o.save_density})
        if (!path.empty()) check_output(path);
    if (!o.save_density.empty() && !may_train(task.method.name()))
        throw UsageError("--save-density", trains_none(task.method.name()));
    if (!o.checkpoint.empty() && !o.resume && generation_exists(o.checkpoint))
        throw UsageError(o.checkpoint,
                         "exists already; add --resume to continue from it, or remove it to start again");
}

void show_progress(ProgressLine& line, const IntegrationTask& task, const IntegrationResult& r) {
    if (!line.due(r.seconds)) return;
    // Of logarithms the reference of the value still moves.
    std::string text = (task.logarithm ? "" : to_string(r.estimate()) + "  ") +
                       count_text(static_cast<double>(r.evaluations)) + "evaluations, " +
                       duration_text(r.seconds);
    if (task.targeted()) text += ", relative error " + percent_text(r.estimate().relative_error());
    line.show("integrating", text);
}

int exit_code_of(const IntegrationTask& task, const IntegrationResult& r) {
    if (r.stop == StopReason::interrupted) return exit_interrupted;
    if (r.stop == StopReason::diverges) return exit_stopped;
    return r.converged() || !task.targeted() ? exit_done : exit_stopped;
}

void save_density(const IntegrateOptions& o, const IntegrationResult& result) {
    if (!result.density) throw Error("--save-density", trains_none(result.method));
    TrainedDensity density = *result.density;
    density.set_notes(density_notes(o));
    density.save(o.save_density);
    if (density.unit().uniform() && !o.quiet)
        std::fprintf(stderr,
                     "montelux: uniform points were enough, so the density in '%s' is uniform; --evaluations "
                     "instead of "
                     "an error trains one\n",
                     o.save_density.c_str());
}

int run(const IntegrateOptions& o) {
    end_on_signals();
    std::signal(SIGPIPE, SIG_IGN);
    IntegrationTask task = make_task(o);
#ifdef MONTELUX_WITH_RENDER
    // Points are written in the order of one thread, and a device is one process's.
    SharedIntegration shared(task, !o.points.empty() || task.integrand.compiled);
    if (shared.helped()) return exit_done;
#endif
    check_files(o, task);

    PointRecorder recorder(task.points_limit);
    auto evaluate = [&, record = !o.points.empty()](const PointBatch& x, ValueBatch y) {
        task.integrand.function(x, y);
        if (record) recorder.add(x, y);
    };
    ProgressLine line(o.quiet);
    task.options.progress = [&](const IntegrationResult& r) { show_progress(line, task, r); };
    task.options.cancel = &cancel_on_signals();
    LogIntegrationResult logarithm; // of which `relative` alone is used without --log
    auto work = [&](const Integrand& f, const IntegrationOptions& options) {
        if (task.logarithm)
            logarithm = integrate_log(f, task.domain, task.method, task.budget, options);
        else
            logarithm.relative = integrate(f, task.domain, task.method, task.budget, options);
    };
    if (task.integrand.compiled)
        work(task.integrand.hinted(Integrand::compiled(task.integrand.compiled)), task.options);
    else
#ifdef MONTELUX_WITH_RENDER
        shared.integrate(task, evaluate, work);
#else
        work(task.integrand.integrand(evaluate), task.options);
#endif
    line.finish();
    const IntegrationResult& result = logarithm.relative;

    finish_on_signals();
    if (!result.checkpoint_refused_because.empty())
        std::fprintf(stderr, "montelux: warning: %s; went on from the checkpoint before it\n",
                     result.checkpoint_refused_because.c_str());
    if (!o.plot.empty()) write_convergence_plot(o.plot, task, result);
    if (!o.points.empty()) recorder.write(o.points, task.variables, task.integrand.names);
    if (result.history.empty())
        std::fprintf(stderr,
                     "montelux: warning: the run ended before its first step; nothing is known yet\n");
    std::string text;
    if (o.json) {
        const nlohmann::ordered_json json =
            task.logarithm ? report_json(task, logarithm) : report_json(task, result);
        text = json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
    } else {
        text = task.logarithm ? report_text(logarithm) : report_text(task, result);
    }
    std::fputs(text.c_str(), stdout);
    if (!o.save_density.empty()) save_density(o, result);
    return exit_code_of(task, result);
}

} // namespace

void add_integrate(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<IntegrateOptions>();
    CLI::App* command = app.add_subcommand("integrate", "Integrate formulas: values with standard errors");
    declare(*command, *options);
    command->callback([options, &exit_code] { exit_code = run(*options); });
}

} // namespace montelux::app
